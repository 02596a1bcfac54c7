/* Grids of settings: without doubles, for every scene, and from files that may be broken. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/plan.h"
#include "library/choice/sweep_setting.h"
#include "validation/sweep/sweep_grid.h"

#include <unistd.h>

#define SPOT                                                                                       \
  "lights:\n- {name: lamp, kind: spot, position: [0.05, 0.03, 0.6], direction: [0, 0, -1], "       \
  "intensity: 1, cone: 40}\n"

static size_t expand(const abbe_scene *scene, const abbe_sweep_grid *grids, size_t count,
                     abbe_sweep_setting **out, size_t *refused) {
  abbe_error error = {0}, why = {0};
  size_t got = 0;
  abbe_result result =
      abbe_sweep_grid_expand(scene, grids, count, out, &got, refused, &why, &error);
  if (result != ABBE_OK) fail_msg("%s", error.text);
  return got;
}

TEST(grids_hold_each_setting_once) {
  OWNED(abbe_scene, scene) = {0};
  abbe_sweep_setting *list;
  size_t refused;
  load_text(CAMERA SPOT FLOOR BALL("crown"), &scene);
  /* 7 wavelengths are the default: the second grid has one setting of the first again. */
  const abbe_sweep_grid grids[] = {{.wavelengths = {2, {3, 7}},
                                    .photons = {2, {32, 64}},
                                    .share_count = 2,
                                    .share = {0.1, 0.01}},
                                   {.photons = {1, {64}}}};
  size_t count = expand(&scene, grids, 2, &list, &refused);
  assert_int_equal(count, 8);
  assert_int_equal(refused, 0);
  for (size_t i = 0; i < count; i++) {
    assert_true(list[i].wavelengths == 3 || list[i].wavelengths == 7);
    assert_int_equal(list[i].map, 1024);
    assert_string_equal(list[i].fill, "bridge");
    for (size_t k = 0; k < i; k++) assert_false(abbe_sweep_setting_same(&list[i], &list[k]));
    /* A setting's request resolves to itself. */
    abbe_render_desc desc;
    OWNED(abbe_plan, plan);
    abbe_sweep_setting again;
    OK(abbe_sweep_setting_desc(&list[i], &desc, &error));
    OK(abbe_plan_make(&scene, &desc, &plan, &error));
    abbe_sweep_setting_of(&plan.desc, &again);
    assert_true(abbe_sweep_setting_same(&list[i], &again));
  }
  free(list);
  /* Samples and exits are without effect in the thesis profile: one setting. */
  const abbe_sweep_grid thesis = {.profiles = {1, {ABBE_PROFILE_THESIS}},
                                  .samples = {3, {1, 2, 3}},
                                  .exits = {2, {1, 5}},
                                  .share_count = 2,
                                  .share = {0.1, 0.2}};
  assert_int_equal(expand(&scene, &thesis, 1, &list, &refused), 1);
  assert_string_equal(list[0].fill, "smear");
  free(list);
  /* Kinds of polygons go with polygons alone. */
  const abbe_sweep_grid polygons = {
      .profiles = {1, {ABBE_PROFILE_WYMAN2006}},
      .fills = {2, {ABBE_FILL_QUADS, ABBE_FILL_GATHER_LIGHT}},
      .polygons = {3, {0, ABBE_POLYGONS_EVEN, ABBE_POLYGONS_EVEN | ABBE_POLYGONS_CULLED}}};
  assert_int_equal(expand(&scene, &polygons, 1, &list, &refused), 4);
  assert_int_equal(refused, 2);
  assert_string_equal(list[0].polygons, "");
  assert_string_equal(list[3].polygons, "even+culled");
  free(list);
  /* Directions go with wyman2006 as printed; the mean is its own. */
  const abbe_sweep_grid directions = {
      .profiles = {2, {ABBE_PROFILE_WYMAN2006, ABBE_PROFILE_DEFAULT}},
      .directions = {
          4,
          {ABBE_DIRECTION_AUTO, ABBE_DIRECTION_OWN, ABBE_DIRECTION_MEAN, ABBE_DIRECTION_DIRECT}}};
  assert_int_equal(expand(&scene, &directions, 1, &list, &refused), 4);
  assert_int_equal(refused, 3);
  size_t own = 0, direct = 0;
  for (size_t i = 0; i < 4; i++) {
    own += strcmp(list[i].direction, "own") == 0;
    direct += strcmp(list[i].direction, "direct") == 0;
  }
  assert_true(own == 1 && direct == 1);
  free(list);
  /* Of the tracer only photons and passes make settings; without them it has some of its own. */
  abbe_sweep_grid traced = {
      .profiles = {2, {ABBE_SWEEP_PROFILE_TRACE, ABBE_SWEEP_PROFILE_TRACE_FILTER}},
      .wavelengths = {2, {3, 7}},
      .photons = {2, {64, 128}},
      .passes = {2, {2, 4}}};
  assert_int_equal(expand(&scene, &traced, 1, &list, &refused), 8);
  assert_int_equal(refused, 0);
  free(list);
  traced = (abbe_sweep_grid){.profiles = {1, {ABBE_SWEEP_PROFILE_TRACE}}};
  assert_int_equal(expand(&scene, &traced, 1, &list, &refused), 1);
  assert_string_equal(list[0].profile, "trace");
  assert_int_equal(list[0].photons, ABBE_SWEEP_TRACE_PHOTONS);
  assert_int_equal(list[0].passes, ABBE_SWEEP_TRACE_PASSES);
  free(list);
  abbe_sweep_grids grids_of_file;
  OK(abbe_sweep_grids_load(NULL, &grids_of_file, &error));
  assert_int_equal(grids_of_file.count, 3);
  static const char *const names[] = {"quick", "full", "thin"};
  static const size_t least[] = {30, 150, 18};
  for (size_t i = 0; i < grids_of_file.count; i++) {
    const abbe_sweep_named_grid *named = &grids_of_file.grid[i];
    assert_string_equal(named->name, names[i]);
    assert_true(expand(&scene, named->part, named->count, &list, &refused) >= least[i]);
    assert_int_equal(refused, 0);
    free(list);
  }
  abbe_sweep_grids_free(&grids_of_file);
}

/* Presets join the scenes of a class by setting, whatever exits their own plans take. */
TEST(the_thin_grid_is_the_same_for_every_convex_solid) {
  static const char *const names[] = {"prism", "gem", "diamond"};
  abbe_sweep_setting *list[3];
  size_t counts[3];
  abbe_sweep_grids grids;
  OK(abbe_sweep_grids_load(NULL, &grids, &error));
  const abbe_sweep_named_grid *thin = &grids.grid[2];
  for (int i = 0; i < 3; i++) {
    abbe_scene scene = {0};
    size_t refused;
    load_shipped(names[i], &scene);
    counts[i] = expand(&scene, thin->part, thin->count, &list[i], &refused);
    abbe_scene_free(&scene);
    for (size_t k = 0; k < counts[0]; k++) {
      bool found =
          strcmp(list[0][k].profile, "default") != 0; /* its views do not hold every scene */
      for (size_t j = 0; j < counts[i] && !found; j++)
        found = abbe_sweep_setting_same(&list[i][j], &list[0][k]);
      if (!found) fail_msg("%s: setting %zu", names[i], k);
    }
  }
  for (int i = 0; i < 3; i++) free(list[i]);
  abbe_sweep_grids_free(&grids);
}

TEST(what_a_profile_does_not_know_is_left_out) {
  OWNED(abbe_scene, scene) = {0};
  abbe_sweep_setting *list;
  size_t refused, count;
  load_text(CAMERA SUN FLOOR BALL("crown"), &scene);
  abbe_sweep_grid grid = {.profiles = {2, {ABBE_PROFILE_DEFAULT, ABBE_PROFILE_THESIS}}};
  assert_int_equal(expand(&scene, &grid, 1, &list, &refused), 1);
  assert_int_equal(refused, 1);
  free(list);
  grid.profiles = (abbe_sweep_values){1, {ABBE_PROFILE_THESIS}};
  REFUSED(ABBE_INVALID_ARGUMENT, "'sun' is directional",
          abbe_sweep_grid_expand(&scene, &grid, 1, &list, &count, &refused, NULL, &error));
  assert_null(list);
}

TEST(files) {
  static const struct {
    const char *text, *part;
  } broken[] = {
      {"grids: []\n", "'grids' is a list of 1 to 8"},
      {"grids:\n- {name: a}\n", "parts"},
      {"grids:\n- {parts: [{}]}\n", "a grid has a name"},
      {"grids:\n- {name: a, parts: []}\n", "'parts' is a list of 1 to 64"},
      {"grids:\n- {name: a, parts: [{photons: [0]}]}\n", "photons"},
      {"grids:\n- {name: a, parts: [{photons: [2.5]}]}\n", "a whole number"},
      {"grids:\n- {name: a, parts: [{photons: 64}]}\n", "'photons' is a list"},
      {"grids:\n- {name: a, parts: [{fill: [glue]}]}\n",
       "'glue' is not known as a value of 'fill'"},
      {"grids:\n- {name: a, parts: [{share: [2]}]}\n", "above 0, to 1"},
      {"grids:\n- {name: a, parts: [{photon: [64]}]}\n", "did you mean 'photons'"},
  };
  char path[] = "/tmp/abbe-test-grids-XXXXXX";
  int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  abbe_sweep_grids grids;
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    OK(abbe_file_write(path, broken[i].text, strlen(broken[i].text), &error));
    REFUSED(ABBE_SCHEMA, broken[i].part, abbe_sweep_grids_load(path, &grids, &error));
    assert_int_equal(grids.count, 0);
  }
  static const char own[] =
      "grids:\n- name: own\n  fixed: true\n  parts:\n"
      "  - {photons: [8, 16], samples: [2], model: [layers], share: [0.5]}\n  - {}\n";
  OK(abbe_file_write(path, own, strlen(own), &error));
  OK(abbe_sweep_grids_load(path, &grids, &error));
  unlink(path);
  assert_int_equal(grids.grid[0].count, 2);
  const abbe_sweep_grid *first = &grids.grid[0].part[0], *second = &grids.grid[0].part[1];
  assert_int_equal(first->photons.value[1], 16);
  assert_int_equal(first->exits.value[0], ABBE_PLAN_LAYER_EXITS);
  assert_near(first->share[0], 0.5, 0);
  assert_int_equal(second->exits.value[0], ABBE_PLAN_EXITS);
  assert_near(second->share[0], ABBE_PLAN_SHARE, 0);
  assert_int_equal(second->photons.count, 0);
  abbe_sweep_grids_free(&grids);
}
