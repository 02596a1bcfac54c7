# spectral/: a test a header.
abbe_test(error cpu abbe_spectral)
abbe_test(file cpu abbe_spectral)
abbe_test(nearest cpu abbe_spectral)
abbe_test(yaml cpu abbe_spectral)
abbe_test(wavelengths cpu abbe_spectral)
abbe_test(spectrum cpu abbe_spectral)
