foreach(name wavelengths spectrum optics film polarisation microfacets biaxial uniaxial uniaxial_answers
        dispersion index_points fit points csv_points
        material material_numbers material_query material_table crystal_record partners absorption glass_distance convert
        agf agf_lines agf_write rii material_write mtlx material_import
        import_batch
        check check_right table_edit table_fix)
  abbe_test(${name} cpu abbe_spectral abbe_base)
endforeach()
abbe_test(material_store cpu abbe_spectral abbe_base PkgConfig::SQLITE)
abbe_test(materials_command cpu abbe_spectral abbe_base PkgConfig::CJSON)
target_compile_definitions(test_materials_command PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
add_dependencies(test_materials_command abbe)
