set(gl_rooms abbe_gl abbe_scenes abbe_colorimetry abbe_spectral)
abbe_test(program gl ${gl_rooms})
