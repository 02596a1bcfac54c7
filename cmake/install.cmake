# The install step: the program, the shared library with its headers, what ships, and the ways to find
# them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME main)

# One library from the objects of every room, of which only what library/lib_*.h declares is to be seen.
# Its name and the version of its symbols change with what callers must be built anew for.
set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(NOT ABBE_SANITIZE) # whose run-time library must come first in a program
  get_property(rooms GLOBAL PROPERTY ABBE_ROOMS)
  set(objects "")
  set(libraries "")
  foreach(room ${rooms})
    list(APPEND objects $<TARGET_OBJECTS:${room}>)
    get_target_property(linked ${room} LINK_LIBRARIES)
    list(APPEND libraries ${linked})
  endforeach()
  list(FILTER libraries EXCLUDE REGEX "^abbe_")
  list(REMOVE_DUPLICATES libraries)
  set(exports ${CMAKE_CURRENT_BINARY_DIR}/abbe.map)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/abbe.map.in ${exports} @ONLY)
  add_library(abbe_shared SHARED ${objects})
  set_target_properties(abbe_shared PROPERTIES OUTPUT_NAME abbe LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${abi} LINK_DEPENDS ${exports})
  target_link_options(abbe_shared PRIVATE LINKER:--version-script,${exports} LINKER:-z,defs)
  target_link_libraries(abbe_shared PRIVATE abbe_build ${libraries})
endif()
set(share ${CMAKE_INSTALL_DATADIR}/abbe)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/abbe)

install(TARGETS abbe RUNTIME)
if(TARGET abbe_shared)
  install(TARGETS abbe_shared LIBRARY)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/abbeConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/abbeConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/abbeConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/abbeConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/abbeConfigVersion.cmake DESTINATION ${package})

# Relative to the file itself, so that the prefix may be chosen or moved afterwards.
file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_prefix ${pc_prefix})
configure_file(${CMAKE_CURRENT_LIST_DIR}/abbe.pc.in ${CMAKE_CURRENT_BINARY_DIR}/abbe.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/abbe.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The headers of the API, and the one of the results and errors that they speak of.
install(FILES ${api} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/abbe/library)
install(FILES base/error.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/abbe/base)

# What ships: scenes with their meshes and textures, material tables, the OCIO configuration.
file(GLOB scene_files CONFIGURE_DEPENDS scenes/*.yaml scenes/*.ply scenes/*.obj scenes/*.png)
install(FILES ${scene_files} DESTINATION ${share}/scenes)
install(DIRECTORY scenes/designs scenes/environments scenes/looks scenes/meshes scenes/mist scenes/papers scenes/pinholes scenes/water DESTINATION ${share}/scenes
  FILES_MATCHING PATTERN "*.asc" PATTERN "*.yaml" PATTERN "*.exr" PATTERN "*.obj" PATTERN "*.ply")
install(FILES spectral/materials/materials.yaml spectral/materials/thesis.yaml DESTINATION ${share}/materials)
install(FILES colorimetry/image/config.ocio DESTINATION ${share}/ocio)

# Made from what the program's help says.
set(pages ${CMAKE_CURRENT_BINARY_DIR}/pages)
file(MAKE_DIRECTORY ${pages})
add_custom_command(OUTPUT ${pages}/abbe.1 ${pages}/abbe.bash ${pages}/_abbe
  COMMAND ${ABBE_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/cli/pages.py $<TARGET_FILE:abbe> ${pages}
  DEPENDS abbe cli/pages.py VERBATIM)
add_custom_target(abbe_pages ALL DEPENDS ${pages}/abbe.1)
install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN *.1)
install(FILES ${pages}/abbe.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME abbe)
install(FILES ${pages}/_abbe DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

# The Python module, which finds the shared library from its own place.
if(TARGET abbe_shared)
  set(python lib/python3/dist-packages/abbe)
  file(RELATIVE_PATH library_beside /${python} /${CMAKE_INSTALL_LIBDIR}/libabbe.so.${abi})
  configure_file(library/python/abbe/_place.py.in ${CMAKE_CURRENT_BINARY_DIR}/_place.py @ONLY)
  file(GLOB modules CONFIGURE_DEPENDS library/python/abbe/*.py)
  install(FILES ${modules} ${CMAKE_CURRENT_BINARY_DIR}/_place.py DESTINATION ${python})
  foreach(command design sweep)
    file(GLOB sources CONFIGURE_DEPENDS library/python/abbe/${command}/*.py)
    install(FILES ${sources} DESTINATION ${python}/${command})
    list(APPEND modules ${CMAKE_CURRENT_SOURCE_DIR}/library/python/abbe/${command})
  endforeach()
  # The same beside the program where it is built, which runs the commands.
  add_dependencies(abbe abbe_shared)
  set(library_beside ../../libabbe.so.${abi})
  configure_file(library/python/abbe/_place.py.in
    ${CMAKE_CURRENT_BINARY_DIR}/python/abbe/_place.py @ONLY)
  foreach(module ${modules})
    get_filename_component(name ${module} NAME)
    file(CREATE_LINK ${module} ${CMAKE_CURRENT_BINARY_DIR}/python/abbe/${name} SYMBOLIC)
  endforeach()
endif()

include(${CMAKE_CURRENT_LIST_DIR}/pack.cmake)
