# The program and the installed library, as those outside the house meet them.
add_test(NAME install
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install/check ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR}
          ${CMAKE_C_COMPILER})
if(ABBE_HARDEN AND NOT ABBE_SANITIZE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  add_test(NAME hardened COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/hardened $<TARGET_FILE:abbe>
           $<TARGET_FILE:abbe_library>)
  set_tests_properties(hardened PROPERTIES LABELS program TIMEOUT ${hang_s})
endif()
add_test(NAME scripts COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/check)
add_test(NAME measuring_scripts
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/measure $<TARGET_FILE:abbe>)
add_test(NAME slits
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/slits $<TARGET_FILE:abbe>)
set_tests_properties(install scripts measuring_scripts slits PROPERTIES LABELS program TIMEOUT ${hang_s})

foreach(name
    arguments
    bad_input
    export_command
    materials_change_command
    materials_edit_command
    materials_numbers
    materials_plot_command
    materials_exchange_command
    outline_command
    printable_output
    render_command
    trace_command
    validate_command
    )
  abbe_test(${name} program abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
  target_compile_definitions(test_${name} PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
  add_dependencies(test_${name} abbe)
endforeach()

add_test(NAME readme_commands
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/readme_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR})
set_tests_properties(readme_commands PROPERTIES LABELS program TIMEOUT ${hang_s})

add_test(NAME materials_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          docs/materials.md)
set_tests_properties(materials_page PROPERTIES LABELS program TIMEOUT ${hang_s})

# All known answers at full size: it keeps both cores busy for a minute or so.
add_test(NAME known_answers_whole COMMAND abbe validate --quiet)
set_tests_properties(known_answers_whole PROPERTIES LABELS program TIMEOUT ${hang_s})
foreach(scene sphere ring gem bunny glass prism rainbow)
  add_test(NAME reference_${scene}
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/references $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR} ${scene})
  set_tests_properties(reference_${scene} PROPERTIES LABELS program TIMEOUT ${hang_s})
endforeach()
# Tolerances that catch nothing are none.
add_test(NAME reference_broken_exits
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/references $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          --broken gem --exits 1)
add_test(NAME reference_broken_wavelengths
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/references $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          --broken prism --wavelengths 1)
set_tests_properties(reference_broken_exits reference_broken_wavelengths
  PROPERTIES LABELS program TIMEOUT ${hang_s})
