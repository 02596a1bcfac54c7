# What happens when things fail.

# Every allocation of Abbe's own objects, and what allocates for them (faults/memory.h).
add_library(faults_memory OBJECT faults/memory.c)
target_link_libraries(faults_memory PUBLIC abbe_build PkgConfig::GSL PkgConfig::SQLITE PkgConfig::YAML
  PkgConfig::EXPAT)
foreach(name malloc calloc realloc aligned_alloc strdup strndup realpath fopen fdopen open_memstream
    newlocale yaml_parser_initialize yaml_parser_parse sqlite3_open_v2 sqlite3_prepare_v2
    sqlite3_step sqlite3_serialize gsl_vector_alloc gsl_matrix_alloc gsl_eigen_symmv_alloc gsl_interp_alloc
    gsl_integration_workspace_alloc gsl_multifit_linear_alloc gsl_multifit_nlinear_alloc
    XML_ParserCreate)
  target_link_options(faults_memory INTERFACE LINKER:--wrap=${name})
endforeach()

# Feeds fuzz targets with allocations failing.
add_library(faults_starve OBJECT EXCLUDE_FROM_ALL faults/starve.c)
target_link_libraries(faults_starve PUBLIC abbe_build)

abbe_test(no_memory_tables cpu WRAPPED faults_memory abbe_spectral abbe_base)
abbe_test(no_memory_scenes cpu WRAPPED faults_memory abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
abbe_test(no_memory_imports cpu WRAPPED faults_memory abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
abbe_test(no_memory_trace cpu WRAPPED faults_memory abbe_validation abbe_scenes abbe_colorimetry abbe_spectral abbe_base)

# The calls with which Abbe's own objects write files (faults/disk.h).
add_library(faults_disk OBJECT faults/disk.c)
target_link_libraries(faults_disk PUBLIC abbe_build)
foreach(name open linkat fdopen fchmod fsync fclose rename pwrite)
  target_link_options(faults_disk INTERFACE LINKER:--wrap=${name})
endforeach()
abbe_test(full_disk cpu WRAPPED faults_disk abbe_validation abbe_scenes abbe_colorimetry abbe_spectral abbe_base)

# The calls of Abbe's own objects of OpenEXR and Little CMS, and for reading (faults/library.h).
add_library(faults_library OBJECT faults/library.c)
target_link_libraries(faults_library PUBLIC abbe_build OpenEXR::OpenEXRCore PkgConfig::LCMS)
foreach(name exr_get_count exr_get_storage exr_get_compression exr_get_data_window
    exr_get_display_window exr_get_channels exr_get_scanlines_per_chunk exr_get_attribute_count
    exr_get_attribute_by_index exr_get_tile_descriptor exr_get_level_sizes
    exr_read_scanline_chunk_info exr_read_tile_chunk_info exr_decoding_initialize
    exr_decoding_update exr_decoding_choose_default_routines exr_decoding_run
    exr_encoding_initialize exr_encoding_update exr_encoding_choose_default_routines
    exr_encoding_run exr_start_write exr_set_longname_support exr_add_part
    exr_initialize_required_attr_simple exr_attr_set_string exr_attr_set_chromaticities
    exr_add_channel exr_write_header exr_write_scanline_chunk_info cmsBuildParametricToneCurve
    cmsCreateRGBProfile cmsMLUalloc cmsSaveProfileToMem cmsOpenProfileFromMem
    cmsCreate_sRGBProfile cmsCreateTransform pread pwrite fseek fseeko fread ferror)
  target_link_options(faults_library INTERFACE LINKER:--wrap=${name})
endforeach()
if(DEFLATE_FOUND)
  target_link_libraries(faults_library PUBLIC PkgConfig::DEFLATE)
  target_compile_definitions(faults_library PRIVATE ABBE_HAS_DEFLATE)
  target_link_options(faults_library INTERFACE LINKER:--wrap=libdeflate_alloc_compressor
    LINKER:--wrap=libdeflate_alloc_decompressor)
endif()
abbe_test(library_faults cpu WRAPPED faults_library exr_library abbe_colorimetry abbe_spectral abbe_base)
abbe_label(cpu memory NAMES no_memory_tables no_memory_scenes no_memory_imports no_memory_trace full_disk library_faults)

# Kills the program, or starves it, at a chosen call (faults/preload.c).
add_library(faults_preload MODULE faults/preload.c)
target_link_libraries(faults_preload PRIVATE abbe_build ${CMAKE_DL_LIBS})
foreach(name killed_command starved_command)
  abbe_test(${name} program abbe_spectral abbe_base)
  target_compile_definitions(test_${name} PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>"
    ABBE_PRELOAD="$<TARGET_FILE:faults_preload>")
  add_dependencies(test_${name} abbe faults_preload)
endforeach()

abbe_test(gl_faults gl WRAPPED abbe_own_context abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
abbe_test(device_memory gl WRAPPED abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
foreach(name gl_faults device_memory)
  target_link_options(test_${name} PRIVATE LINKER:--wrap=abbe_context_egl)
endforeach()
target_link_options(test_gl_faults PRIVATE LINKER:--wrap=abbe_context_osmesa)
abbe_test(barriers gl WRAPPED abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
target_link_options(test_barriers PRIVATE LINKER:--wrap=abbe_gl_load)
abbe_test(watchdog gl WRAPPED abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
target_link_options(test_watchdog PRIVATE LINKER:--wrap=abbe_gl_load LINKER:--wrap=abbe_gpu_make
  LINKER:--wrap=abbe_photon_paths_serve)
abbe_test(photons gl WRAPPED abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
target_link_options(test_photons PRIVATE LINKER:--wrap=abbe_photon_paths_serve)

# The text of every shader, and what the reference compiler of GLSL says of it.
add_executable(shader_texts gl/device/shader_texts.c)
target_link_libraries(shader_texts PRIVATE abbe_gl abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
target_link_options(shader_texts PRIVATE LINKER:--wrap=abbe_gl_load LINKER:--wrap=abbe_program_make)
find_program(ABBE_GLSLANG glslangValidator)
if(ABBE_GLSLANG)
  foreach(name glslang glslang_all)
    add_test(NAME ${name} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/gl/device/glslang
             $<TARGET_FILE:shader_texts> ${ABBE_GLSLANG} ${name})
  endforeach()
  abbe_label(gl NAMES glslang)
  abbe_label(gl long NAMES glslang_all)
endif()
