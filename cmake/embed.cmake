# abbe_embed(TARGET SYMBOL FILE): compiles FILE into TARGET as
#   const unsigned char abbe_embedded_SYMBOL[]; const size_t abbe_embedded_SYMBOL_size;
# with a terminating zero that the size does not count, so that text is a C string.
function(abbe_embed target symbol file)
  get_filename_component(path ${file} ABSOLUTE)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/embedded_${symbol}.c)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DIN=${path} -DOUT=${out} -DSYMBOL=${symbol}
            -P ${PROJECT_SOURCE_DIR}/cmake/embed_file.cmake
    DEPENDS ${path} ${PROJECT_SOURCE_DIR}/cmake/embed_file.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()
