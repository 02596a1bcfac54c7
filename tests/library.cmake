# The shared library's own functions; tests/install and tests/python use them from outside.
set(library_rooms abbe_library abbe_gl abbe_validation abbe_scenes abbe_colorimetry
  abbe_spectral abbe_base)
foreach(name lib_comparison lib_gem_report lib_picture lib_settings
    pareto_front picture_choice trace_times)
  abbe_test(${name} cpu ${library_rooms})
endforeach()
abbe_test(lib_scene gl ${library_rooms})
