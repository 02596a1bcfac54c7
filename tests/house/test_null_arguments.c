/* Every public function that returns a result, called wrongly: a pointer to nowhere is an assertion
 * in a debug build and ABBE_INVALID_ARGUMENT in all others; zeros are used or refused. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MADV_DONTNEED */
#include "tests/check.h"
#include "tests/null_arguments/null_arguments.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
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
    {"abbe_cut_file_read_stone", "report"},
    {"abbe_cut_gcs_parse", "report"},
    {"abbe_cut_gcs_write", "report"},
    {"abbe_cut_gem_parse", "report"},
    {"abbe_cut_gem_write", "report"},
    {"abbe_checkpoint_merge", "how"},
    {"abbe_difference_picture_write", "title"},
    {"abbe_environment_lights_add", "before"},
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
    {"abbe_mesh_load", "others"},
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
    {"abbe_spectral_unit_read", "text"},
    {"abbe_route_follow", "vertex"},
    {"abbe_scaling_study_measure", "user"},
    {"abbe_transport_study_measure", "user"},
    {"abbe_transport_study_measure", "why"},
    {"abbe_scene_load", "options"},
    {"abbe_scene_load_lights", "options"},
    {"abbe_scene_parse", "options"},
    {"abbe_scene_text", "options"},
    {"abbe_studio_scene", "studio"},
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

enum { ROOM = 1 << 18, NONE = -2, ALL = -1, CRASHED = 256, MOST_TRIALS = 1 << 13 };
static int null_at;
static bool frees; /* the function called may free what it is given */
static char *zeros;
static FILE *sink;

/* A function to be called with the pointer of that number NULL, or with none or all of them; its
 * result, or CRASHED and the signal's number, 0 where the process left by itself. */
typedef struct trial {
  const null_call *call;
  int at, result;
} trial;

/* Shared with the children that fill in the results. */
static struct {
  size_t count, under_way;
  trial trial[MOST_TRIALS];
} * board;

void *null_pointer(int at, null_kind kind) {
  if (null_at == ALL || null_at == at || kind == NULL_HANDLE) return NULL;
  if (kind == NULL_FILE) return sink;
  return frees ? calloc(1, ROOM) : zeros + (size_t)at * ROOM;
}

static bool is_free(const char *function) {
  const size_t length = strlen(function);
  return length > 5 && strcmp(function + length - 5, "_free") == 0;
}

static void *map(size_t size, int flags) {
  void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, flags | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? NULL : memory;
}

static int setup(void **state) {
  (void)state;
  zeros = map(NULL_PARAMETERS * ROOM, MAP_PRIVATE);
  board = map(sizeof *board, MAP_SHARED);
  sink = fopen("/dev/null", "r+");
  return zeros == NULL || board == NULL || sink == NULL;
}

static int teardown(void **state) {
  (void)state;
  munmap(zeros, NULL_PARAMETERS * ROOM);
  munmap(board, sizeof *board);
  return fclose(sink);
}

static void add_trial(const null_call *call, int at) {
  assert_true(board->count < MOST_TRIALS);
  board->trial[board->count++] = (trial){call, at, 0};
}

/* The trials from one on, until they end or one of them ends the process. */
static void run_from(size_t first) {
  if (freopen("/dev/null", "w", stderr) == NULL) _exit(200);
  signal(SIGABRT, SIG_DFL);
  signal(SIGSEGV, SIG_DFL);
  for (size_t i = first; i < board->count; i++) {
    trial *t = &board->trial[i];
    board->under_way = i;
    /* what the last call wrote is nothing but zeros again */
    if (madvise(zeros, NULL_PARAMETERS * ROOM, MADV_DONTNEED) != 0) _exit(201);
    null_at = t->at;
    frees = is_free(t->call->name);
    alarm(600); /* for what hangs */
    t->result = (int)t->call->run();
  }
  board->under_way = board->count;
  _exit(0);
}

/* All trials, in children: one, and another after each crash. */
static void run_trials(void) {
  for (size_t first = 0; first < board->count; first = board->under_way + 1) {
    int status = 0;
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) run_from(first);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (board->under_way < board->count)
      board->trial[board->under_way].result =
          CRASHED + (WIFSIGNALED(status) ? WTERMSIG(status) : 0);
  }
}

static bool may_be_null(const char *function, const char *parameter) {
  if (is_free(function)) return true;
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
  return result >= CRASHED;
#else
  return result >= CRASHED && result != CRASHED + SIGABRT;
#endif
}

static bool is_refused(int result) {
#ifdef NDEBUG
  return result == ABBE_INVALID_ARGUMENT;
#else
  return result == CRASHED + SIGABRT;
#endif
}

/* Whether a call with this pointer NULL, or with ALL of them, has to be refused. */
static bool must_be_refused(const null_call *call, int at) {
  for (int p = at == ALL ? 0 : at; p < (at == ALL ? call->count : at + 1); p++)
    if (call->parameter[p][0] != '\0' && !may_be_null(call->name, call->parameter[p])) return true;
  return false;
}

static void test_a_pointer_to_nowhere_is_refused(void **state) {
  (void)state;
  size_t wrong = 0;
  assert_true(null_call_count > 200);
  board->count = 0;
  for (size_t i = 0; i < null_call_count; i++) {
    for (int p = 0; p < null_calls[i].count; p++)
      if (null_calls[i].parameter[p][0] != '\0') add_trial(&null_calls[i], p);
    add_trial(&null_calls[i], ALL);
  }
  assert_true(board->count > 600);
  run_trials();
  for (size_t i = 0; i < board->count; i++) {
    const trial *t = &board->trial[i];
    if (must_be_refused(t->call, t->at) ? is_refused(t->result) : !is_a_crash(t->result)) continue;
    wrong++;
    print_error("%s: with %s NULL it ends with %d\n", t->call->name,
                t->at == ALL ? "all pointers" : t->call->parameter[t->at], t->result);
  }
  assert_int_equal(wrong, 0);
}

static void test_zeros_are_used_or_refused(void **state) {
  (void)state;
  size_t wrong = 0;
  board->count = 0;
  for (size_t i = 0; i < null_call_count; i++)
    if (!is_long(null_calls[i].name)) add_trial(&null_calls[i], NONE);
  run_trials();
  for (size_t i = 0; i < board->count; i++) {
    if (!is_a_crash(board->trial[i].result)) continue;
    wrong++;
    print_error("%s: of zeros it ends with %d\n", board->trial[i].call->name,
                board->trial[i].result);
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
