# The program and the installed library, as those outside the house meet them.
add_test(NAME install
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install/check ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR}
          ${CMAKE_C_COMPILER} ${CMAKE_CXX_COMPILER})
if(ABBE_HARDEN AND NOT ABBE_SANITIZE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  add_test(NAME hardened COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/hardened $<TARGET_FILE:abbe>
           $<TARGET_FILE:abbe_shared>)
  abbe_label(program NAMES hardened)
endif()
add_test(NAME pages COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install/pages ${CMAKE_COMMAND}
         ${PROJECT_BINARY_DIR})
add_test(NAME package COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install/package ${PROJECT_BINARY_DIR}
         ${CMAKE_CPACK_COMMAND})
abbe_label(program NAMES pages package)
execute_process(COMMAND ${ABBE_PYTHON} -c "import numpy" RESULT_VARIABLE no_numpy ERROR_QUIET)
if(no_numpy EQUAL 0)
  add_test(NAME python COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/python/check ${CMAKE_COMMAND}
           ${PROJECT_BINARY_DIR} ${ABBE_PYTHON} ${PROJECT_SOURCE_DIR})
  add_test(NAME design_page
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
      docs/design.md)
  abbe_label(program NAMES python design_page)
endif()
add_test(NAME scripts COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/check)
add_test(NAME measuring_scripts
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/measure $<TARGET_FILE:abbe>)
add_test(NAME slits
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/slits $<TARGET_FILE:abbe>)
add_test(NAME slits_all
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/slits $<TARGET_FILE:abbe> all)
abbe_label(program NAMES install scripts measuring_scripts slits)
abbe_label(program long NAMES slits_all)

foreach(name
    arguments
    bad_input
    newcomers
    export_command
    materials_change_command
    materials_numbers
    materials_plot_command
    materials_exchange_command
    gem_command
    gem_report_command
    derive_command
    pixel_command
    printable_output
    relight_command
    render_command
    trace_command
    time_frames turntable
    validate_command)
  abbe_test(${name} program abbe_colorimetry abbe_spectral abbe_base PkgConfig::CJSON)
  target_compile_definitions(test_${name} PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>")
  add_dependencies(test_${name} abbe)
endforeach()

add_test(NAME readme_commands
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/readme_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR})
abbe_label(program NAMES readme_commands)

add_test(NAME thesis_pictures
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/thesis_pictures $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR})
abbe_label(program NAMES thesis_pictures)

add_test(NAME full_disk_command
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/full_disk $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR})
add_test(NAME killed_writers
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/full_disk $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
    $<TARGET_FILE:faults_preload>)
add_test(NAME killed_parts
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/killed_parts $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR})
add_test(NAME distributed_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
    docs/distributed.md)
abbe_label(program NAMES full_disk_command killed_writers killed_parts distributed_page)
add_test(NAME gems_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
    docs/gems.md)
add_test(NAME gem_measures_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
    docs/gem-measures.md)
abbe_label(program NAMES gems_page gem_measures_page)

add_test(NAME materials_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          docs/materials.md)
abbe_label(program NAMES materials_page)

add_test(NAME colour_check_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          docs/colour-check.md)
abbe_label(program NAMES colour_check_page)

add_test(NAME export_page
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/page_commands $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          docs/export.md)
abbe_label(program NAMES export_page)

# All known answers at full size keep both cores busy for minutes. With fewer samples, the tests of
# known_answers, known_light and validate_command have the groups but this one.
add_test(NAME known_answers_whole COMMAND abbe validate --quiet)
add_test(NAME known_answers_white COMMAND abbe validate --quiet --only white --samples 262144)
add_test(NAME known_answers_mirror COMMAND abbe validate --quiet --only mirror)
add_test(NAME known_answers_lamp COMMAND abbe validate --quiet --only lamp)
abbe_label(program long NAMES known_answers_whole)
abbe_label(program NAMES known_answers_white known_answers_mirror known_answers_lamp)
foreach(scene sphere ring gem bunny glass prism rainbow metal-ring metals octahedra
    diamond-studio metal-ball spoon glass-studio)
  add_test(NAME reference_${scene}
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/references $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR} ${scene})
  abbe_label(program NAMES reference_${scene})
  # Their shaders are compiled as users have them, with all of LLVM's passes (script/test).
  set_tests_properties(reference_${scene} PROPERTIES ENVIRONMENT_MODIFICATION GALLIVM_PERF=unset:)
endforeach()
# Tolerances that catch nothing are none.
add_test(NAME reference_broken_exits
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/references $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          --broken gem --exits 1)
add_test(NAME reference_broken_wavelengths
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/references $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR}
          --broken prism --wavelengths 1)
abbe_label(program NAMES reference_broken_exits reference_broken_wavelengths)

foreach(name inspect_packet view_camera view_document view_events view_feed view_files view_guard view_inspect view_outline view_pace view_show view_refine
    view_scene view_state)
  abbe_test(${name} cpu abbe_view_state abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
endforeach()
target_link_libraries(test_view_inspect PRIVATE exr_library)
abbe_test(view_command program SHARES 3 abbe_colorimetry abbe_spectral abbe_base)
target_compile_definitions(test_view_command PRIVATE ABBE_PROGRAM="$<TARGET_FILE:abbe>"
  $<$<BOOL:${ABBE_VIEWER}>:ABBE_HAVE_VIEW>)
if(ABBE_VIEWER)
  add_library(faults_lost_context MODULE faults/lost_context.c)
  target_link_libraries(faults_lost_context PRIVATE abbe_build PkgConfig::EGL ${CMAKE_DL_LIBS})
  target_compile_definitions(test_view_command PRIVATE
    ABBE_LOST_CONTEXT="$<TARGET_FILE:faults_lost_context>")
  add_dependencies(test_view_command faults_lost_context)
endif()
add_dependencies(test_view_command abbe)
if(ABBE_VIEWER)
  add_test(NAME view_window COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/view/window
    $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR})
  abbe_label(program NAMES view_window)
  abbe_test(view_listener cpu abbe_view_state abbe_scenes abbe_colorimetry abbe_spectral abbe_base)
  target_sources(test_view_listener PRIVATE ${PROJECT_SOURCE_DIR}/cli/view/view_listen.c)
  abbe_test(view_settings cpu abbe_view_work abbe_view_state abbe_gl abbe_validation abbe_scenes
    abbe_colorimetry abbe_spectral abbe_base)
  abbe_test(view_worker gl abbe_view_work abbe_view_state abbe_gl abbe_validation abbe_scenes
    abbe_colorimetry abbe_spectral abbe_base)
  abbe_test(view_spot program abbe_view_work abbe_view_state abbe_gl abbe_validation abbe_scenes
    abbe_colorimetry abbe_spectral abbe_base)
  abbe_test(view_look gl abbe_view_work abbe_view_state abbe_gl abbe_validation abbe_scenes
    abbe_colorimetry abbe_spectral abbe_base)
  set_tests_properties(view_window PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME view_serve COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/view/serve
    $<TARGET_FILE:abbe> ${PROJECT_SOURCE_DIR} $<IF:$<BOOL:${MICROHTTPD_FOUND}>,yes,no>)
  abbe_label(program NAMES view_serve)
  add_test(NAME view_listen COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/view/listen $<TARGET_FILE:abbe>)
  abbe_label(program NAMES view_listen)
endif()
