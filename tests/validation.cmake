set(validation_rooms abbe_validation abbe_scenes abbe_colorimetry abbe_spectral)
foreach(name
    closed_form
    compare
    difference_picture
    field
    geometry
    interface
    known_answers
    mask
    media
    rings
    pov_file
    route
    sphere_quadrature
    ztest
    )
  abbe_test(${name} cpu ${validation_rooms})
endforeach()
