# The install step: the program, the library as an archive and shared, its headers, what ships, and
# the ways to find them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# What needs MPI is a component, and so a package, of its own.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME main)

# One archive from the objects of every room, with what the rooms rest on.
get_property(rooms GLOBAL PROPERTY ABBE_ROOMS)
set(objects "")
set(libraries "")
foreach(room ${rooms})
  list(APPEND objects $<TARGET_OBJECTS:${room}>)
  get_target_property(linked ${room} LINK_LIBRARIES)
  list(APPEND libraries ${linked})
endforeach()
list(FILTER libraries EXCLUDE REGEX "^abbe_")
list(REMOVE_ITEM libraries glm::glm) # headers, of which the installed ones include none
list(REMOVE_DUPLICATES libraries)

add_library(abbe_archive STATIC ${objects})
set_target_properties(abbe_archive PROPERTIES OUTPUT_NAME abbe EXPORT_NAME abbe LINKER_LANGUAGE C)
# The C++ of the two bridges is named, so that a project in C alone can link it.
target_link_libraries(abbe_archive PUBLIC ${libraries} stdc++)
target_include_directories(abbe_archive INTERFACE $<INSTALL_INTERFACE:include/abbe>)

# The same objects, of which only what cli/library/lib_*.h declares is to be seen. Its name and the
# version of its symbols change with what callers must be built anew for.
set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(NOT ABBE_SANITIZE) # whose run-time library must come first in a program
  set(exports ${CMAKE_CURRENT_BINARY_DIR}/abbe.map)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/abbe.map.in ${exports} @ONLY)
  add_library(abbe_shared SHARED ${objects})
  set_target_properties(abbe_shared PROPERTIES OUTPUT_NAME abbe LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${abi} LINK_DEPENDS ${exports})
  target_link_options(abbe_shared PRIVATE LINKER:--version-script,${exports} LINKER:-z,defs)
  target_link_libraries(abbe_shared PRIVATE abbe_build ${libraries})
endif()

# What each library is called to CMake and to pkg-config.
set(config_finds "")
set(pc_requires "")
set(pc_libs "-lstdc++")
foreach(library ${libraries})
  if(library MATCHES "^PkgConfig::(.*)$")
    set(module ${${CMAKE_MATCH_1}_MODULE_NAME})
    string(APPEND config_finds
      "find_dependency(PkgConfig)\npkg_check_modules(${CMAKE_MATCH_1} REQUIRED QUIET IMPORTED_TARGET ${module})\n")
    list(APPEND pc_requires ${module})
  elseif(library STREQUAL "OpenEXR::OpenEXRCore")
    string(APPEND config_finds "find_dependency(OpenEXR 3.1 CONFIG)\n")
    list(APPEND pc_requires OpenEXR)
  elseif(library STREQUAL "PNG::PNG")
    string(APPEND config_finds "find_dependency(PNG)\n")
    list(APPEND pc_requires libpng)
  elseif(library STREQUAL "Threads::Threads")
    string(APPEND config_finds "find_dependency(Threads)\n")
    string(APPEND pc_libs " -pthread")
  elseif(library STREQUAL "OpenMP::OpenMP_C")
    string(APPEND config_finds "find_dependency(OpenMP COMPONENTS C)\n")
    string(APPEND pc_libs " -fopenmp")
  elseif(library STREQUAL "embree")
    string(APPEND config_finds "find_dependency(embree ${embree_VERSION} CONFIG)\n")
    string(APPEND pc_libs " -lembree${embree_VERSION_MAJOR}")
  elseif(library MATCHES "^[a-z]+$")
    string(APPEND pc_libs " -l${library}")
  else()
    message(FATAL_ERROR "cmake/install.cmake does not know how to find '${library}'")
  endif()
endforeach()
string(REPLACE ";" ", " pc_requires "${pc_requires}")
set(share ${CMAKE_INSTALL_DATADIR}/abbe)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/abbe)

install(TARGETS abbe RUNTIME)
install(TARGETS abbe_archive EXPORT abbeTargets ARCHIVE)
if(TARGET abbe_shared)
  install(TARGETS abbe_shared LIBRARY)
endif()
if(ABBE_MPI)
  install(TARGETS abbe-mpi RUNTIME COMPONENT mpi)
endif()
install(EXPORT abbeTargets NAMESPACE abbe:: DESTINATION ${package})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/abbeConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/abbeConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/abbeConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/abbeConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/abbeConfigVersion.cmake DESTINATION ${package})

# Relative to the file itself, so that the prefix may be chosen or moved afterwards.
file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_prefix ${pc_prefix})
foreach(name abbe abbe-shared)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${name}.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

# The headers, but not those that say that they are a room's own.
foreach(room ${rooms})
  string(REPLACE "abbe_" "" name ${room})
  if(name STREQUAL "library")
    set(name cli/library)
  endif()
  file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${name}/*.h)
  foreach(header ${headers})
    file(READ ${header} text)
    if(NOT text MATCHES "Internal to ${name}/")
      get_filename_component(folder ${header} DIRECTORY)
      install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/abbe/${folder})
    endif()
  endforeach()
endforeach()

# What ships: scenes with their meshes and textures, material tables, the OCIO configuration.
file(GLOB scene_files CONFIGURE_DEPENDS scenes/*.yaml scenes/*.ply scenes/*.obj scenes/*.png)
install(FILES ${scene_files} DESTINATION ${share}/scenes)
install(DIRECTORY scenes/designs scenes/environments scenes/looks scenes/meshes scenes/mist scenes/papers scenes/pinholes scenes/water DESTINATION ${share}/scenes
  FILES_MATCHING PATTERN "*.asc" PATTERN "*.yaml" PATTERN "*.exr" PATTERN "*.obj" PATTERN "*.ply")
install(FILES spectral/materials/materials.yaml spectral/materials/thesis.yaml DESTINATION ${share}/materials)
install(FILES colorimetry/image/config.ocio DESTINATION ${share}/ocio)

# Made from the program's own option tables.
set(pages ${CMAKE_CURRENT_BINARY_DIR}/pages)
file(MAKE_DIRECTORY ${pages})
add_custom_command(OUTPUT ${pages}/abbe.1 ${pages}/abbe.bash ${pages}/_abbe
  COMMAND abbe --write-pages ${pages} DEPENDS abbe VERBATIM)
add_custom_target(abbe_pages ALL DEPENDS ${pages}/abbe.1)
install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN *.1
  PATTERN abbe-mpi.1 EXCLUDE)
if(ABBE_MPI)
  install(FILES ${pages}/abbe-mpi.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT mpi)
endif()
install(FILES ${pages}/abbe.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME abbe)
install(FILES ${pages}/_abbe DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

# The Python module, which finds the shared library from its own place.
if(TARGET abbe_shared)
  set(python lib/python3/dist-packages/abbe)
  file(RELATIVE_PATH library_beside /${python} /${CMAKE_INSTALL_LIBDIR}/libabbe.so.${abi})
  configure_file(cli/library/python/abbe/_place.py.in ${CMAKE_CURRENT_BINARY_DIR}/_place.py @ONLY)
  file(GLOB modules CONFIGURE_DEPENDS cli/library/python/abbe/*.py)
  install(FILES ${modules} ${CMAKE_CURRENT_BINARY_DIR}/_place.py DESTINATION ${python})
endif()

include(${CMAKE_CURRENT_LIST_DIR}/pack.cmake)
