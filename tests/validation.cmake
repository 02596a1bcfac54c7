set(validation_rooms abbe_validation abbe_scenes abbe_colorimetry abbe_spectral)
foreach(name
    closed_form
    geometry
    interface
    mask
    media
    route
    sphere_quadrature
    )
  abbe_test(${name} cpu ${validation_rooms})
endforeach()
