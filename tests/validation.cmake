set(validation_rooms abbe_validation abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
foreach(name
    accumulator
    bands band_trace
    camera
    checkpoint checkpoint_forged checkpoint_scenes
    closed_form
    compare compare_noise
    denoise
    environment_trace
    eye_samples
    eye_walk
    gem_ascent gem_maps gem_optimum gem_slope gem_tilts gem_view
    guide_sums map_texels
    field
    surrogate
    file_comparison
    flip
    geometry
    haze air_light haze_grid shaft_photons haze_trace
    solid
    light_walk
    known_answers
    known_picture
    known_light
    mask
    media
    mirror_walk rough_mirrors coated_walk turned_paths crystal_walk double_refraction
    rings
    nl_means
    bounded_trace
    checked_picture
    pass_error
    photon_grid
    projection_map
    random
    reflectance
    route
    scatter
    inner_walk
    spectral_sampling
    sphere_quadrature
    trace_run
    tracer
    exit_fill exit_walk volume_fill volume_sums)
  abbe_test(${name} cpu ${validation_rooms})
endforeach()
abbe_test(locale cpu abbe_gl ${validation_rooms})
abbe_test(compare_command program ${validation_rooms} PkgConfig::CJSON)
abbe_test(preset_command program ${validation_rooms} PkgConfig::CJSON)
foreach(name compare_command preset_command)
  target_compile_definitions(test_${name} PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
  add_dependencies(test_${name} abbe)
endforeach()
