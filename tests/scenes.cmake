foreach(name transform disjoint_sets
        mesh coarse_mesh mesh_fix mesh_repair mesh_charts topology shells
        convex shape brilliant brushing knot water scene_time scene_conditions
        cut cut_asc cut_diagram designs cut_file cut_gcs cut_gem cut_measures cut_polyhedron cut_stretch cut_text
        digest scene scene_doubts object_file object_motion refractor_tilt object_surface reflectance_file light_file camera_file object_axes coating_file scene_file scene_stop setting studio
        polygon mesh_reading obj_file ply_file stl_file gltf_file
        alias_table area_lights environment environment_file environment_lights environment_picture environment_source irradiance_map
        radiance_cube radiance_map sky
        sphere_mesh light_nodes body_symmetry exit_map exit_pages exit_sheets light_exits volume_region volume_body caustic_volume volume_file volume_tree
        medium medium_file
        point_grid sample_tree surface_curvature surface_samples
        view coverage estimator map_layout map_resample pov_file export_index)
  abbe_test(${name} cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
endforeach()
abbe_test(gltf_material cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
abbe_test(export_views cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
abbe_test(scene_export cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
abbe_test(cut_solid cpu abbe_scenes abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
