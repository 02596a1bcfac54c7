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

# Each header is included twice, first and alone, in a C17 and a C++17 file of its own.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/base/*.h ${PROJECT_SOURCE_DIR}/spectral/*.h
  ${PROJECT_SOURCE_DIR}/colorimetry/*.h ${PROJECT_SOURCE_DIR}/scenes/*.h
  ${PROJECT_SOURCE_DIR}/gl/*.h ${PROJECT_SOURCE_DIR}/validation/*.h
  ${PROJECT_SOURCE_DIR}/cli/library/*.h)
set(sources "")
set(declarations "")
set(sum "0")
foreach(header ${headers})
  string(MAKE_C_IDENTIFIER ${header} symbol)
  foreach(language c cpp)
    set(name header_${symbol}_${language})
    file(CONFIGURE OUTPUT headers/${name}.${language} @ONLY CONTENT
"#include \"@header@\"
#include \"@header@\"
#ifdef __cplusplus
extern \"C\"
#endif
int @name@(void);
int @name@(void) { return 1; }
")
    list(APPEND sources ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.${language})
    string(APPEND declarations "int ${name}(void);\n")
    string(APPEND sum " + ${name}()")
  endforeach()
endforeach()
list(LENGTH sources count)
file(CONFIGURE OUTPUT headers/main.c @ONLY CONTENT
"#include <stdio.h>
@declarations@
int main(void) {
  printf(\"%d of @count@ compiled\\n\", @sum@);
  return @sum@ == @count@ ? 0 : 1;
}
")
add_executable(test_headers ${sources} ${CMAKE_CURRENT_BINARY_DIR}/headers/main.c)
target_link_libraries(test_headers PRIVATE abbe_build)
target_include_directories(test_headers PRIVATE
  $<TARGET_PROPERTY:abbe_gl,INTERFACE_INCLUDE_DIRECTORIES>)
add_test(NAME headers COMMAND test_headers)
abbe_label(program NAMES headers)

# Every function of the headers that returns a result, called with NULL and with zeros.
list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE header_files)
set(calls ${CMAKE_CURRENT_BINARY_DIR}/null_calls.c)
add_custom_command(OUTPUT ${calls}
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/null_arguments/generate ${calls} ${headers}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  DEPENDS ${header_files} ${CMAKE_CURRENT_SOURCE_DIR}/null_arguments/generate
  VERBATIM)
abbe_test(null_arguments cpu abbe_library abbe_sweep abbe_gl abbe_validation abbe_scenes abbe_colorimetry
  abbe_spectral abbe_base)
target_sources(test_null_arguments PRIVATE ${calls})
abbe_label(cpu memory NAMES null_arguments)
