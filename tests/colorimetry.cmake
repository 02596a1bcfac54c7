foreach(name axis chart colour_map difference display_ocio exr illuminant image material_chart text_plot observer png_file
        rgb_space weights)
  abbe_test(${name} cpu abbe_colorimetry abbe_spectral)
endforeach()
abbe_test(colour_commands cpu abbe_colorimetry abbe_spectral PkgConfig::CJSON)
target_compile_definitions(test_colour_commands PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
add_dependencies(test_colour_commands abbe)
# OpenEXR's own C++ library, which shares no code with the C core that Abbe reads by.
add_library(exr_library OBJECT exr_library.cpp)
target_link_libraries(exr_library PUBLIC abbe_build OpenEXR::OpenEXR)
abbe_test(exr_files cpu exr_library abbe_colorimetry abbe_spectral)
abbe_test(picture_windows program exr_library abbe_colorimetry abbe_spectral)
target_compile_definitions(test_picture_windows PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
add_dependencies(test_picture_windows abbe)
