foreach(name difference display_ocio exr illuminant image observer png_file rgb_space weights)
  abbe_test(${name} cpu abbe_colorimetry abbe_spectral)
endforeach()
