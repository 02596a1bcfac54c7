# What happens when things fail.

# Every allocation of Abbe's own objects, and what allocates for them (faults/memory.h).
add_library(faults_memory OBJECT faults/memory.c)
target_link_libraries(faults_memory PUBLIC abbe_build PkgConfig::GSL PkgConfig::YAML PNG::PNG)
foreach(name malloc calloc realloc aligned_alloc strdup strndup realpath fopen fdopen open_memstream
    newlocale yaml_parser_initialize yaml_parser_parse png_create_write_struct
    png_create_read_struct png_create_info_struct gsl_vector_alloc gsl_matrix_alloc gsl_interp_alloc
    gsl_integration_workspace_alloc gsl_multifit_linear_alloc gsl_multifit_nlinear_alloc)
  target_link_options(faults_memory INTERFACE LINKER:--wrap=${name})
endforeach()

abbe_test(no_memory_tables cpu faults_memory abbe_spectral)
abbe_test(no_memory_scenes cpu faults_memory abbe_gl abbe_scenes abbe_colorimetry abbe_spectral)
abbe_test(no_memory_trace cpu faults_memory abbe_validation abbe_scenes abbe_colorimetry abbe_spectral)

# The calls with which Abbe's own objects write files (faults/disk.h).
add_library(faults_disk OBJECT faults/disk.c)
target_link_libraries(faults_disk PUBLIC abbe_build)
foreach(name open linkat fdopen fchmod fsync fclose rename pwrite)
  target_link_options(faults_disk INTERFACE LINKER:--wrap=${name})
endforeach()
abbe_test(full_disk cpu faults_disk abbe_validation abbe_scenes abbe_colorimetry abbe_spectral)
