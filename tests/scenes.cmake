foreach(name transform topology vector mesh mesh_charts mesh_import shape brilliant scene object_file scene_file view map_layout map_resample)
  abbe_test(${name} cpu abbe_scenes abbe_colorimetry abbe_spectral)
endforeach()
target_link_options(test_mesh_import PRIVATE LINKER:--wrap=fork)
