foreach(name transform topology vector mesh shape)
  abbe_test(${name} cpu abbe_scenes abbe_spectral)
endforeach()
