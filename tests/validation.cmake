set(validation_rooms abbe_validation abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
foreach(name
    accumulator
    bands band_trace
    camera
    catacaustic wave_caustic
    checkpoint checkpoint_forged
    closed_form
    compare compare_noise
    denoise
    difference_picture
    baseline_comparison
    error_decomposition
    estimator_study landing_rays
    environment_trace
    eye_samples
    eye_walk
    pareto_front
    gem_grid_file gem_maps gem_optimum gem_tilts gem_view
    guide_sums map_texels
    field
    file_comparison
    flip ssim frame_flicker
    geometry
    haze air_light haze_grid shaft_photons haze_trace
    solid
    interface
    light_walk lamp_rays path_splitting
    known_answers
    known_chart
    known_light
    mask
    media
    mirrors mirror_walk rough_mirrors crystal_walk double_refraction
    rings
    nl_means
    outline
    bounded_trace
    checked_picture
    pass_error
    time_left
    photon_grid
    projection_map
    random
    rank_files ranked_optimum ranked_run
    reflectance
    route
    scatter
    inner_walk
    spectral_sampling
    reference
    relit_trace
    sphere_quadrature
    trace_run
    tracer
    exit_fill exit_points exit_walk volume_checkpoint volume_fill volume_space volume_sums
    sweep_pictures
    sweep_plot
    sweep_presets
    sweep_table
    ztest
    )
  abbe_test(${name} cpu ${validation_rooms})
endforeach()
abbe_test(locale cpu abbe_sweep abbe_gl ${validation_rooms})
foreach(name sweep_grid sweep_hash sweep_process sweep_promises sweep_reference)
  abbe_test(${name} cpu abbe_sweep abbe_gl ${validation_rooms})
endforeach()
foreach(name ranked_sweep scaling_study sweep_measure sweep_page sweep_run node_errors pinhole_limits
        transport_study transport_table)
  abbe_test(${name} gl abbe_sweep abbe_gl ${validation_rooms})
endforeach()
abbe_test(compare_command program ${validation_rooms} PkgConfig::CJSON)
abbe_test(preset_command program ${validation_rooms} PkgConfig::CJSON)
abbe_test(sweep_command program ${validation_rooms} PkgConfig::CJSON)
foreach(name compare_command preset_command sweep_command)
  target_compile_definitions(test_${name} PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
  add_dependencies(test_${name} abbe)
endforeach()
