/* Every public function that returns a result, called wrongly: a pointer to nowhere is an assertion
 * in a debug build and ABBE_INVALID_ARGUMENT in all others; zeros are used or refused. */
#include "tests/check.h"
#include "tests/null_arguments/null_arguments.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

/* Parameters that may be NULL, by their headers. */
static const struct {
  const char *function, *parameter;
} optional[] = {
    {"abbe_agf_load", "report"},
    {"abbe_agf_parse", "report"},
    {"abbe_agf_write", "report"},
    {"abbe_band_reflection_fill", "measured"},
    {"abbe_compare", "options"},
    {"abbe_convex_find", "plane_of"},
    {"abbe_csv_points_load", "report"},
    {"abbe_csv_points_load", "options"},
    {"abbe_csv_points_parse", "report"},
    {"abbe_csv_points_parse", "options"},
    {"abbe_csv_write", "report"},
    {"abbe_csv_write", "sampling"},
    {"abbe_cut_asc_parse", "report"},
    {"abbe_cut_asc_write", "report"},
    {"abbe_cut_file_read", "report"},
    {"abbe_cut_gcs_parse", "report"},
    {"abbe_cut_gcs_write", "report"},
    {"abbe_cut_gem_parse", "report"},
    {"abbe_cut_gem_write", "report"},
    {"abbe_difference_picture_write", "title"},
    {"abbe_fit_dispersion", "max_error"},
    {"abbe_display_list", "config"},
    {"abbe_check_material", "known"},
    {"abbe_check_table", "known"},
    {"abbe_error_bars_check", "desc"},
    {"abbe_error_bars_make", "desc"},
    {"abbe_file_open", "size"},
    {"abbe_file_write", "data"},
    {"abbe_bvh_make", "triangle"},
    {"abbe_import_batch_run", "report"},
    {"abbe_import_load", "report"},
    {"abbe_import_load", "options"},
    {"abbe_import_parse", "report"},
    {"abbe_import_parse", "options"},
    {"abbe_medium_copy", "medium"},
    {"abbe_lib_comparison_draw", "title"},
    {"abbe_lib_comparison_make", "mask"},
    {"abbe_lib_comparison_make", "settings"},
    {"abbe_lib_gem_report_make", "progress"},
    {"abbe_lib_gem_report_make", "settings"},
    {"abbe_lib_gem_report_make", "user"},
    {"abbe_lib_materials_index", "lambda_nm"},
    {"abbe_lib_materials_index", "n"},
    {"abbe_lib_materials_index", "k"},
    {"abbe_lib_materials_load", "table"},
    {"abbe_lib_picture_make", "pixels"},
    {"abbe_lib_picture_save_png", "settings"},
    {"abbe_lib_scene_change", "set"},
    {"abbe_lib_scene_look", "eye"},
    {"abbe_lib_scene_look", "target"},
    {"abbe_lib_scene_look", "up"},
    {"abbe_lib_scene_map", "light"},
    {"abbe_lib_scene_open", "materials"},
    {"abbe_lib_scene_open", "stone"},
    {"abbe_lib_scene_open", "set"},
    {"abbe_lib_scene_render", "settings"},
    {"abbe_lib_scene_trace", "settings"},
    {"abbe_lib_scene_trace", "like"},
    {"abbe_lib_scene_trace", "picture"},
    {"abbe_lib_scene_trace", "map"},
    {"abbe_lib_weights_fill", "illuminant"},
    {"abbe_lib_weights_fill", "space"},
    {"abbe_local_scene_repeat_lights", "of"},
    {"abbe_map_layout_write", "light"},
    {"abbe_material_check_name", "name"},
    {"abbe_material_map_write", "left_out"},
    {"abbe_material_store_read", "names"},
    {"abbe_material_store_read", "unread"},
    {"abbe_material_table_load", "path"},
    {"abbe_material_table_load_named", "path"},
    {"abbe_material_table_load_lenient", "report"},
    {"abbe_material_table_load_lenient", "path"},
    {"abbe_material_table_parse_lenient", "report"},
    {"abbe_material_table_unique", "report"},
    {"abbe_mesh_import", "others"},
    {"abbe_mesh_load", "others"},
    {"abbe_mesh_import", "material"},
    {"abbe_mesh_load_part", "material"},
    {"abbe_mesh_load_part", "others"},
    {"abbe_gltf_material_load", "part"},
    {"abbe_scene_export_write", "options"},
    {"abbe_mesh_fix", "solids"},
    {"abbe_mesh_fix", "what"},
    {"abbe_outline_make", "options"},
    {"abbe_photon_grid_fill", "photon"},
    {"abbe_plan_make", "desc"},
    {"abbe_outline_load", "minus"},
    {"abbe_points_sort", "dropped"},
    {"abbe_pov_file_write", "options"},
    {"abbe_presets_load", "path"},
    {"abbe_program_make", "defines"},
    {"abbe_program_make_compute", "defines"},
    {"abbe_program_make_compute_text", "defines"},
    {"abbe_program_text", "defines"},
    {"abbe_record_draft_open", "path"},
    {"abbe_render_desc_resolve", "desc"},
    {"abbe_renderer_frame", "user"},
    {"abbe_renderer_read_hits", "user"},
    {"abbe_renderer_frame", "statistics"},
    {"abbe_renderer_make", "desc"},
    {"abbe_rii_load", "report"},
    {"abbe_rii_load", "name"},
    {"abbe_rii_parse", "report"},
    {"abbe_rii_parse", "name"},
    {"abbe_rii_write", "report"},
    {"abbe_route_follow", "vertex"},
    {"abbe_scaling_study_measure", "user"},
    {"abbe_transport_study_measure", "user"},
    {"abbe_transport_study_measure", "why"},
    {"abbe_scene_load", "options"},
    {"abbe_scene_load_lights", "options"},
    {"abbe_scene_parse", "options"},
    {"abbe_scene_text", "options"},
    {"abbe_shader_write", "report"},
    {"abbe_shadow_planes_make", "plane"},
    {"abbe_picture_front_load", "path"},
    {"abbe_spectral_channels_find", "layer"},
    {"abbe_sweep_grid_expand", "why"},
    {"abbe_sweep_grids_load", "path"},
    {"abbe_sweep_measure", "user"},
    {"abbe_sweep_measure", "picture"},
    {"abbe_sweep_preset_settings", "presets"},
    {"abbe_sweep_promises_make", "presets"},
    {"abbe_sweep_reference_load", "picture"},
    {"abbe_sweep_reference_load", "map"},
    {"abbe_sweep_table_mark", "profile"},
    {"abbe_sweep_trace_measure", "picture"},
    {"abbe_table_edit_make", "path"},
    {"abbe_table_edit_open", "path"},
    {"abbe_table_fix_make", "known"},
    {"abbe_text_diff", "before"},
    {"abbe_text_diff", "after"},
    {"abbe_tracer_pass", "stop"},
    {"abbe_light_exits_make", "symmetry"},
    {"abbe_volume_sums_make", "beam"},
    {"abbe_volume_sums_make", "share"},
    {"abbe_yaml_edit_list", "value"},
};

/* Of zeros it makes all known answers. */
static const char *const long_calls[] = {"abbe_known_answers_make"};

enum { ROOM = 1 << 18, NONE = -2, ALL = -1, ENDED_BY_SIGNAL = 256 };
static int null_at;
static char *zeros;
static FILE *sink;

void *null_pointer(int at, null_kind kind) {
  if (null_at == ALL || null_at == at || kind == NULL_HANDLE) return NULL;
  return kind == NULL_FILE ? (void *)sink : zeros + (size_t)at * ROOM;
}

static int setup(void **state) {
  (void)state;
  zeros = calloc(NULL_PARAMETERS, ROOM);
  sink = fopen("/dev/null", "r+");
  return zeros == NULL || sink == NULL;
}

static int teardown(void **state) {
  (void)state;
  free(zeros);
  return fclose(sink);
}

/* In a child of its own: its result, or ENDED_BY_SIGNAL and the signal's number. */
static int run(const null_call *call, int at) {
  int status = 0;
  fflush(NULL);
  pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    null_at = at;
    if (freopen("/dev/null", "w", stderr) == NULL) _exit(200);
    signal(SIGABRT, SIG_DFL);
    signal(SIGSEGV, SIG_DFL);
    alarm(600); /* for what hangs */
    _exit((int)call->run());
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : ENDED_BY_SIGNAL + WTERMSIG(status);
}

static bool may_be_null(const char *function, const char *parameter) {
  size_t length = strlen(function);
  if (length > 5 && strcmp(function + length - 5, "_free") == 0) return true;
  for (size_t i = 0; i < sizeof optional / sizeof *optional; i++)
    if (strcmp(optional[i].function, function) == 0 &&
        strcmp(optional[i].parameter, parameter) == 0)
      return true;
  return false;
}

static bool is_long(const char *function) {
  for (size_t i = 0; i < sizeof long_calls / sizeof *long_calls; i++)
    if (strcmp(long_calls[i], function) == 0) return true;
  return false;
}

/* An assertion is no crash where there are any. */
static bool is_a_crash(int result) {
#ifdef NDEBUG
  return result >= ENDED_BY_SIGNAL;
#else
  return result >= ENDED_BY_SIGNAL && result != ENDED_BY_SIGNAL + SIGABRT;
#endif
}

static bool is_refused(int result) {
#ifdef NDEBUG
  return result == ABBE_INVALID_ARGUMENT;
#else
  return result == ENDED_BY_SIGNAL + SIGABRT;
#endif
}

static void test_a_pointer_to_nowhere_is_refused(void **state) {
  (void)state;
  size_t wrong = 0, pointers = 0;
  assert_true(null_call_count > 200);
  for (size_t i = 0; i < null_call_count; i++) {
    const null_call *call = &null_calls[i];
    size_t required = 0;
    for (int p = 0; p < call->count; p++) {
      if (call->parameter[p][0] == '\0') continue;
      const bool free_to = may_be_null(call->name, call->parameter[p]);
      int result = run(call, p);
      bool right = free_to ? !is_a_crash(result) : is_refused(result);
      required += !free_to;
      pointers++;
      wrong += !right;
      if (!right)
        print_error("%s: with %s NULL it ends with %d\n", call->name, call->parameter[p], result);
    }
    int result = run(call, ALL);
    if (required == 0 ? !is_a_crash(result) : is_refused(result)) continue;
    wrong++;
    print_error("%s: with all pointers NULL it ends with %d\n", call->name, result);
  }
  assert_true(pointers > 400);
  assert_int_equal(wrong, 0);
}

static void test_zeros_are_used_or_refused(void **state) {
  (void)state;
  size_t wrong = 0;
  for (size_t i = 0; i < null_call_count; i++) {
    if (is_long(null_calls[i].name)) continue;
    int result = run(&null_calls[i], NONE);
    if (!is_a_crash(result)) continue;
    wrong++;
    print_error("%s: of zeros it ends with %d\n", null_calls[i].name, result);
  }
  assert_int_equal(wrong, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_a_pointer_to_nowhere_is_refused),
      cmocka_unit_test(test_zeros_are_used_or_refused),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
