# The house as a whole: who may include whom, and each header by itself.
foreach(name circles directions sizes)
  abbe_test(${name} cpu abbe_build)
  target_sources(test_${name} PRIVATE house/sources.c)
endforeach()
target_sources(test_circles PRIVATE house/graph.c)
# The objects of the library and of the program, whose symbols say who uses whom.
get_property(rooms GLOBAL PROPERTY ABBE_ROOMS)
set(objects "")
foreach(target ${rooms} abbe)
  string(APPEND objects "$<JOIN:$<TARGET_OBJECTS:${target}>,\n>\n")
endforeach()
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/objects.txt CONTENT "${objects}")
foreach(name circles directions)
  target_sources(test_${name} PRIVATE house/symbols.c)
  target_compile_definitions(test_${name} PRIVATE ABBE_NM="${CMAKE_NM}"
    ABBE_OBJECT_LIST="${CMAKE_CURRENT_BINARY_DIR}/objects.txt")
  add_dependencies(test_${name} abbe)
endforeach()
abbe_test(number_places cpu abbe_base)

# Each header stands alone in C17: it is what its own source reads first, or else a file here includes
# it and no more. One file in C++17 includes the API's headers, each twice.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/base/*.h ${PROJECT_SOURCE_DIR}/spectral/*.h
  ${PROJECT_SOURCE_DIR}/colorimetry/*.h ${PROJECT_SOURCE_DIR}/scenes/*.h
  ${PROJECT_SOURCE_DIR}/gl/*.h ${PROJECT_SOURCE_DIR}/validation/*.h
  ${PROJECT_SOURCE_DIR}/library/*.h)
set(alone "")
foreach(header ${headers})
  string(REGEX REPLACE "h$" "c" source ${PROJECT_SOURCE_DIR}/${header})
  set(directive "")
  if(EXISTS ${source})
    file(STRINGS ${source} directive REGEX "^#" LIMIT_COUNT 1)
  endif()
  if(NOT directive STREQUAL "#include \"${header}\"")
    list(APPEND alone ${header})
  endif()
endforeach()
set(checks "")
foreach(header ${alone})
  string(MAKE_C_IDENTIFIER ${header} symbol)
  file(CONFIGURE OUTPUT headers/${symbol}.c @ONLY CONTENT
"#include \"@header@\"
typedef int alone_@symbol@; // no file may be empty
")
  list(APPEND checks ${CMAKE_CURRENT_BINARY_DIR}/headers/${symbol}.c)
endforeach()
set(all "")
foreach(header ${api})
  string(APPEND all "#include \"${header}\"\n")
endforeach()
file(CONFIGURE OUTPUT headers/all.cpp @ONLY CONTENT "@all@@all@")
string(REPLACE ";" "\n" alone "${alone}\n")
file(CONFIGURE OUTPUT headers/alone.txt @ONLY CONTENT "@alone@")
abbe_test(headers program abbe_build)
target_sources(test_headers PRIVATE house/sources.c ${checks}
  ${CMAKE_CURRENT_BINARY_DIR}/headers/all.cpp)
target_compile_definitions(test_headers PRIVATE
  ABBE_ALONE_LIST="${CMAKE_CURRENT_BINARY_DIR}/headers/alone.txt")
target_include_directories(test_headers SYSTEM PRIVATE
  $<TARGET_PROPERTY:abbe_gl,INTERFACE_INCLUDE_DIRECTORIES>)

# Every function of the API that returns a result, called with NULL and with zeros.
list(TRANSFORM api PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE header_files)
set(calls ${CMAKE_CURRENT_BINARY_DIR}/null_calls.c)
add_custom_command(OUTPUT ${calls}
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/null_arguments/generate ${calls} ${api}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  DEPENDS ${header_files} ${CMAKE_CURRENT_SOURCE_DIR}/null_arguments/generate
  VERBATIM)
abbe_test(null_arguments cpu abbe_library abbe_gl abbe_validation abbe_scenes abbe_colorimetry
  abbe_spectral abbe_base)
target_sources(test_null_arguments PRIVATE ${calls})
abbe_label(cpu memory NAMES null_arguments)
