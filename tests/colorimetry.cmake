foreach(name axis chart colour_map difference display_ocio exr illuminant image material_chart text_plot observer png_file
        rgb_space weights)
  abbe_test(${name} cpu abbe_colorimetry abbe_spectral)
endforeach()
abbe_test(colour_commands cpu abbe_colorimetry abbe_spectral PkgConfig::CJSON)
target_compile_definitions(test_colour_commands PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
add_dependencies(test_colour_commands abbe)
