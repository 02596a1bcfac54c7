foreach(name atlas axis chart chromaticity colour_map colour_temperature difference display_ocio exr false_colours gamut gamut_check gamut_map illuminant image material_chart text_plot observer oklab png_file screen_png sheet
        pixel_probe radiance_file relight rgb_encoding rgb_space spectral_channels spectral_colour upsampling weights colour_checker reflected_light)
  abbe_test(${name} cpu abbe_colorimetry abbe_spectral abbe_base)
endforeach()
target_link_libraries(test_rgb_encoding PRIVATE PkgConfig::LCMS)
abbe_test(animated_png cpu abbe_colorimetry abbe_spectral abbe_base PNG::PNG) # which brings zlib
abbe_test(stones cpu abbe_colorimetry abbe_spectral abbe_base)
abbe_test(colour_commands cpu abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
target_compile_definitions(test_colour_commands PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
add_dependencies(test_colour_commands abbe)
# OpenEXR's own C++ library, which shares no code with the C core that Abbe reads by.
add_library(exr_library OBJECT colorimetry/image/exr_library.cpp)
target_link_libraries(exr_library PUBLIC abbe_build OpenEXR::OpenEXR)
abbe_test(exr_files cpu exr_library abbe_colorimetry abbe_spectral abbe_base ZLIB::ZLIB)
abbe_test(picture_windows program exr_library abbe_colorimetry abbe_spectral abbe_base)
target_compile_definitions(test_picture_windows PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
add_dependencies(test_picture_windows abbe)
