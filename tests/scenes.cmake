foreach(name transform
        mesh coarse_mesh mesh_fix topology shells
        convex shape shape_meshes water scene_time
        cut cut_asc designs cut_file cut_gcs cut_gem cut_meets cut_polyhedron cut_stretch
        digest scene scene_doubts object_file object_motion object_surface light_file camera_file coating_file scene_file scene_keys scene_changes refused_scenes
        setting studio
        polygon mesh_reading obj_file ply_file stl_file gltf_file gltf_keys
        area_lights environment environment_file environment_lights environment_picture environment_source
        radiance_map
        sphere_mesh exit_pages light_exits volume_body caustic_volume volume_file
        medium medium_file
        sample_tree surface_samples
        view estimator map_layout pov_file export_index)
  abbe_test(${name} cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
endforeach()
abbe_test(gltf_material cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
abbe_test(export_views cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
abbe_test(scene_export cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
abbe_test(cut_solid cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
