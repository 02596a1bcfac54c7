# The program and the installed library, as those outside the house meet them.
add_test(NAME install
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install/check ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR}
          ${CMAKE_C_COMPILER})
set_tests_properties(install PROPERTIES LABELS program TIMEOUT 300)
