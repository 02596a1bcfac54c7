# cpack -G DEB: one Debian package of what is installed.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME abbe)
set(CPACK_PACKAGE_VENDOR Abbe)
set(CPACK_PACKAGE_CONTACT "Abbe <abbe@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "spectral dispersion caustics in gems, prisms and glass")
set(CPACK_PACKAGE_DESCRIPTION "Abbe renders what light does in gems, prisms and glass, with a reference
tracer that says how far off its pictures are. The program, its library (shared and as an archive),
a Python module, scenes and tables of materials.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Loaded when a context is wanted, so that no linker tells of it.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy")
include(CPack)
