#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/trace_run.h"

#include <unistd.h>

static char folder[64], path[80];
static abbe_scene scene;

/* The layout of the map is given, for trying where the light lands takes longer than the rest. */
static abbe_map_layout layout;
static const abbe_trace_desc small =
    FIELDS(.layout = &layout,

           .width = 10, .height = 7, .map_width = 8, .photons = 2000, .threads = 1, .bands = 2);

#define SCENE(more) CAMERA POINT_LIGHT FLOOR BEADS("crown") more

static void setup(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-checkpoint-XXXXXX");
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/run.checkpoint", folder);
  scene = scene_of(SCENE(""));
  abbe_trace_desc fitted = small;
  fitted.layout = NULL;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &fitted);
  MADE(abbe_image, map, abbe_tracer_map(tracer, &map, &error));
  OK(abbe_map_layout_read(&map, "map", &layout, &error));
}

static void teardown(void) {
  unlink(path);
  abbe_scene_free(&scene);
  assert_false(rmdir(folder));
}

/* Saves a run of that many passes. */
static void save(const abbe_trace_desc *desc, size_t passes) {
  HELD(abbe_tracer, tracer) = make_tracer(&scene, desc);
  run_passes(tracer, passes);
  OK(abbe_checkpoint_save(tracer, path, &error));
}

static abbe_result load(abbe_tracer *tracer, abbe_error *error) {
  *error = (abbe_error){0};
  return abbe_checkpoint_load(tracer, path, error);
}

static void check_same(const abbe_tracer *a, const abbe_tracer *b) {
  assert_int_equal(abbe_tracer_passes(a), abbe_tracer_passes(b));
  MADE(abbe_image, x, abbe_tracer_picture(a, &x, &error));
  MADE(abbe_image, y, abbe_tracer_picture(b, &y, &error));
  check_same_image(&x, &y);
  abbe_image_free(&x);
  abbe_image_free(&y);
  OK(abbe_tracer_map(a, &x, &error));
  OK(abbe_tracer_map(b, &y, &error));
  check_same_image(&x, &y);
  abbe_trace_statistics s, t;
  abbe_tracer_statistics(a, &s);
  abbe_tracer_statistics(b, &t);
  assert_true(s.photons == t.photons && s.light_rays == t.light_rays);
  assert_true(s.eye_rays == t.eye_rays && s.cuts == t.cuts);
  assert_memory_equal(&s.ledger, &t.ledger, sizeof s.ledger);
}

GROUP(setup, teardown);

/* Saved after 2, taken up on another number of threads, 3 more: the image of 5. */
TEST(resumed_runs_give_the_image_of_unbroken_ones) {
  for (int guides = 0; guides < 2; guides++) {
    abbe_trace_desc desc = small;
    desc.guides = guides;
    save(&desc, 2);
    HELD(abbe_tracer, whole) = make_tracer(&scene, &desc);
    run_passes(whole, 5);
    desc.threads = 2;
    HELD(abbe_tracer, broken) = make_tracer(&scene, &desc);
    OK(load(broken, &error));
    assert_int_equal(abbe_tracer_passes(broken), 2);
    run_passes(broken, 3);
    check_same(whole, broken);
  }
}

/* Refused by a sentence that holds part, and the tracer goes on as if nothing had been. */
static void check_refused(const abbe_scene *of, const abbe_trace_desc *desc, abbe_result why,
                          const char *part) {
  abbe_error error;
  HELD(abbe_tracer, tracer) = make_tracer(of, desc);
  abbe_result result = load(tracer, &error);
  if (result != why) print_error("%d: %s\n", result, error.text);
  assert_int_equal(result, why);
  assert_contains(error.text, path);
  assert_contains(error.text, part);
  assert_int_equal(abbe_tracer_passes(tracer), 0);
}

TEST(a_refusal_changes_nothing) {
  save(&small, 2);
  abbe_trace_desc other = small;
  other.seed = 9;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &other);
  HELD(abbe_tracer, same) = make_tracer(&scene, &other);
  run_passes(tracer, 1);
  REFUSED(ABBE_INVALID_ARGUMENT, "ask for the same, or start anew without", load(tracer, &error));
  run_passes(tracer, 1);
  run_passes(same, 2);
  check_same(tracer, same);
}

TEST(another_request_is_named) {
  save(&small, 1);
  static const struct {
    abbe_trace_desc desc;
    const char *part;
  } others[] = {
      {{.width = 11, .height = 7, .map_width = 8, .photons = 2000, .bands = 2}, "picture 10 x 7"},
      /* much smaller and much larger files than what is asked for */
      {{.width = 2, .height = 2, .map_width = 1, .photons = 2000}, "picture 10 x 7"},
      {{.width = 90, .height = 90, .map_width = 8, .photons = 2000}, "picture 90 x 90"},
      {{.width = 10, .height = 7, .map_width = 9, .photons = 2000, .bands = 2}, "map 8 x 8"},
      {{.width = 10, .height = 7, .map_width = 8, .photons = 2001, .bands = 2}, "photons 2001"},
      {{.width = 10, .height = 7, .map_width = 8, .photons = 2000, .bands = 3}, "bands 3"},
      {{.width = 10, .height = 7, .map_width = 8, .photons = 2000, .bands = 2, .seed = 1},
       "seed 1"},
      {FIELDS(.width = 10, .height = 7, .map_width = 8, .photons = 2000, .bands = 2,
              .physics = {.matched = true, .orders = 4}),
       "physics matched"},
      {FIELDS(.width = 10, .height = 7, .map_width = 8, .photons = 2000, .bands = 2,
              .space = ABBE_RGB_SPACE_REC709),
       "space rec709"},
      {FIELDS(.width = 10, .height = 7, .map_width = 8, .photons = 2000, .bands = 2,
              .observer = ABBE_OBSERVER_CIE_1964),
       "observer 1964"},
      {{.width = 10, .height = 7, .no_map = true, .photons = 2000, .bands = 2}, "map 0 x 0"},
      {{.width = 10, .height = 7, .map_width = 8, .photons = 2000, .bands = 2, .guides = true},
       "guides for a filter"},
      {{.no_picture = true, .map_width = 8, .photons = 2000, .bands = 2}, "picture 0 x 0"},
  };
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    abbe_trace_desc desc = others[i].desc;
    desc.threads = 1;
    desc.layout = &layout;
    check_refused(&scene, &desc, ABBE_INVALID_ARGUMENT, others[i].part);
  }
}

/* Whatever the light meets belongs to the scene: places, glasses, colours, and how the textures
 * and normals lie. */
TEST(another_scene_is_told) {
  save(&small, 1);
  scene.light[0].position[0] += 1e-9;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  scene.light[0].position[0] -= 1e-9;
  scene.object[0].reflectance[1] = 0.25;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  scene.object[0].reflectance[1] = 0.5;
  scene.background = 1;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  scene.background = 0;
  scene.camera.fov_y_rad *= 1.001;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  scene.camera.fov_y_rad /= 1.001;
  abbe_map_layout moved = layout;
  abbe_trace_desc other_layout = small;
  moved.view.window[1] *= 1.5;
  other_layout.layout = &moved;
  check_refused(&scene, &other_layout, ABBE_INVALID_ARGUMENT, "layout");
  static const char *const others[] = {SCENE(HILL), CAMERA POINT_LIGHT FLOOR BEADS("flat"),
                                       CAMERA SUN FLOOR BEADS("crown")};
  for (int i = 0; i < 3; i++) {
    OWNED(abbe_scene, other) = scene_of(others[i]);
    check_refused(&other, &small, ABBE_INVALID_ARGUMENT, "another scene");
  }
}

TEST(textures_and_normals_are_part_of_the_scene) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_scene kept = scene;
  scene = scene_of(CAMERA POINT_LIGHT FLOOR RING("crown"));
  abbe_object *floor = &scene.object[0], *ring = &scene.object[1];
  OK(abbe_image_make(4, 2, 3, names, &floor->texture, &error));
  floor->texture_repeat[0] = floor->texture_repeat[1] = 1;
  save(&small, 1);
  floor->texture_repeat[1] = 2;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  floor->texture_repeat[1] = 1;
  floor->texture.width = 2;
  floor->texture.height = 4;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  floor->texture.width = 4;
  floor->texture.height = 2;
  double kept_normal = ring->mesh.normal[7][0];
  ring->mesh.normal[7][0] += 0.1;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  ring->mesh.normal[7][0] = kept_normal;
  abbe_scene_free(&scene);
  scene = kept;
}

/* Which way an optic axis points, a crystal's other index, and how a light's sides lie. */
TEST(axes_and_edges_are_part_of_the_scene) {
  abbe_scene kept = scene;
  scene =
      scene_of(CAMERA "lights:\n- {name: panel, kind: rectangle, position: [0, 0, 0.6], direction: "
                      "[0, 0, -1], width: 0.02, height: 0.05, radiance: 1}\n" FLOOR BEADS("crown"));
  abbe_object *bead = &scene.object[1];
  abbe_dispersion *other = NULL;
  for (size_t i = 0; i < scene.table.count; i++)
    if (&scene.table.material[i] == bead->material) other = &scene.table.material[i].extraordinary;
  assert_non_null(other);
  *other = (abbe_dispersion){.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.4}};
  save(&small, 1);
  other->c[0] = 1.41;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  other->c[0] = 1.4;
  bead->axis[0] = 0.6;
  bead->axis[2] = 0.8;
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  bead->axis[0] = 0;
  bead->axis[2] = 1;
  double(*edge)[3] = scene.light[0].edge, turned[3];
  memcpy(turned, edge[0], sizeof turned);
  memcpy(edge[0], edge[1], sizeof turned);
  memcpy(edge[1], turned, sizeof turned);
  check_refused(&scene, &small, ABBE_INVALID_ARGUMENT, "another scene");
  abbe_scene_free(&scene);
  scene = kept;
}

TEST(broken_files_are_told) {
  save(&small, 2);
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 24, &data, &size, &error));
  FREED char *broken = malloc(size + 8);
  assert_non_null(broken);
  abbe_error why;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  /* cut off anywhere, or with something behind it */
  for (size_t i = 0; i <= 40; i++) {
    size_t length = i < 40 ? size * i / 40 : size - 1;
    OK(abbe_file_write(path, data, length, &error));
    REFUSED(ABBE_PARSE, path, load(tracer, &error));
  }
  memcpy(broken, data, size);
  memset(broken + size, 0, 8);
  OK(abbe_file_write(path, broken, size + 8, &error));
  REFUSED(ABBE_PARSE, "damaged", load(tracer, &error));
  /* one bit turned over, anywhere */
  for (size_t i = 0; i < 60; i++) {
    size_t at = i < 59 ? size * i / 59 : size - 1;
    memcpy(broken, data, size);
    broken[at] = (char)(broken[at] ^ 1 << i % 8);
    OK(abbe_file_write(path, broken, size, &error));
    abbe_result result = load(tracer, &why);
    assert_true(result == ABBE_PARSE || (at < 600 && result == ABBE_INVALID_ARGUMENT));
    assert_contains(why.text, path);
  }
  assert_int_equal(abbe_tracer_passes(tracer), 0);
}

#define LONGER                                                                                     \
  "a line that is longer than all that a checkpoint says of its run in its first lines "
#define LONG LONGER LONGER LONGER LONGER

TEST(what_is_no_checkpoint_is_told) {
  static const struct {
    const char *text, *part;
  } files[] = {{"", "not a checkpoint"},
               {"description: a scene\n", "not a checkpoint"},
               {"abbe checkpoint 1\nscene 1\n\n", "another version"},
               {"abbe checkpoint 11\n", "broken"},
               {"abbe checkpoint 11\nscene 0123", "broken"},
               {"abbe checkpoint 11\n" LONG LONG LONG LONG "\n\n", "broken"},
               {"abbe checkpoint 11\n\n\n", "start anew"}};
  abbe_error why;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    OK(abbe_file_write(path, files[i].text, strlen(files[i].text), &error));
    assert_true(load(tracer, &why) != ABBE_OK);
    assert_contains(why.text, files[i].part);
  }
  unlink(path);
  REFUSED(ABBE_IO, path, load(tracer, &error));
  /* a file that opens and cannot be read: what it begins with is no memory of this process */
  REFUSED(ABBE_IO, "/proc/self/mem", abbe_checkpoint_load(tracer, "/proc/self/mem", &error));
  REFUSED(ABBE_IO, "/nowhere/at/all", abbe_checkpoint_save(tracer, "/nowhere/at/all", &error));
}

/* ---- parts ---- */

enum { PARTS = 4, ROOM = 96 };

/* The passes first to end - 1 into the part's own file. */
static void save_part(const abbe_trace_desc *desc, size_t first, size_t end, char file[ROOM],
                      int number) {
  snprintf(file, ROOM, "%s/part-%d.ck", folder, number);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, desc);
  OK(abbe_tracer_begin_at(tracer, first, 1, &error));
  run_passes(tracer, end - first);
  OK(abbe_checkpoint_save(tracer, file, &error));
}

/* Any split, put together in any order, is one run to the last bit, guides and ledger too, and goes
 * on like one. */
TEST(any_split_gives_the_bits_of_one_run) {
  static const size_t split[][PARTS + 1] = {{0, 1, 2, 3, 6}, {0, 2, 3, 5, 6}, {0, 3, 4, 5, 6}};
  static const int order[][PARTS] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}};
  abbe_trace_desc desc = small;
  desc.guides = true;
  HELD(abbe_tracer, whole) = make_tracer(&scene, &desc);
  run_passes(whole, 6);
  for (size_t i = 0; i < sizeof split / sizeof *split; i++) {
    char file[PARTS][ROOM];
    const char *paths[PARTS];
    for (int k = 0; k < PARTS; k++) {
      desc.threads = 1 + (size_t)k % 2;
      save_part(&desc, split[i][k], split[i][k + 1], file[k], k);
    }
    for (int k = 0; k < PARTS; k++) paths[k] = file[order[i][k]];
    abbe_tracer *merged = make_tracer(&scene, &desc);
    OK(abbe_checkpoint_merge(merged, paths, PARTS, NULL, &error));
    check_same(whole, merged);
    if (i == 2) {
      run_passes(whole, 1);
      run_passes(merged, 1);
      check_same(whole, merged);
    }
    abbe_tracer_free(merged);
    for (int k = 0; k < PARTS; k++) unlink(file[k]);
  }
}

static void check_unmerged(const char *const *paths, size_t count, abbe_result why,
                           const char *part) {
  abbe_error error = {0};
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  abbe_result result = abbe_checkpoint_merge(tracer, paths, count, NULL, &error);
  if (result != why) print_error("%d: %s\n", result, error.text);
  assert_int_equal(result, why);
  assert_contains(error.text, part);
  assert_int_equal(abbe_tracer_passes(tracer), 0);
}

TEST(gaps_and_overlaps_are_named) {
  static const size_t range[PARTS][2] = {{0, 2}, {1, 4}, {4, 5}, {7, 8}};
  char file[PARTS][ROOM], other[ROOM];
  for (int k = 0; k < PARTS; k++) save_part(&small, range[k][0], range[k][1], file[k], k);
  check_unmerged((const char *[]){file[1], file[0]}, 2, ABBE_INVALID_ARGUMENT, "both hold pass 1");
  check_unmerged((const char *[]){file[0], file[0]}, 2, ABBE_INVALID_ARGUMENT,
                 "both hold passes 0 to 1");
  check_unmerged((const char *[]){file[2], file[0]}, 2, ABBE_INVALID_ARGUMENT,
                 "passes 2 to 3 are missing, between");
  check_unmerged((const char *[]){file[1]}, 1, ABBE_INVALID_ARGUMENT, "pass 0 is missing");
  check_unmerged((const char *[]){file[3], file[2]}, 2, ABBE_INVALID_ARGUMENT,
                 "passes 0 to 3 are missing");
  check_unmerged((const char *[]){file[0]}, 0, ABBE_INVALID_ARGUMENT, "no parts");
  abbe_trace_desc desc = small;
  desc.seed = 3;
  save_part(&desc, 2, 3, other, 9);
  check_unmerged((const char *[]){file[0], other}, 2, ABBE_INVALID_ARGUMENT, "seed 3");
  /* broken behind its head: found out while parts are added up */
  FREED char *data = NULL;
  size_t size = 0;
  save_part(&small, 2, 3, other, 9);
  OK(abbe_file_read(other, 1 << 24, &data, &size, &error));
  data[size - 20] = (char)(data[size - 20] ^ 1);
  OK(abbe_file_write(other, data, size, &error));
  check_unmerged((const char *[]){file[0], other}, 2, ABBE_PARSE, "damaged");
  /* cut behind the lines of text, and of no pass */
  OK(abbe_file_write(other, data, (size_t)(strstr(data, "\n\n") - data) + 6, &error));
  check_unmerged((const char *[]){file[0], other}, 2, ABBE_PARSE, "cut off or holds no pass");
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  OK(abbe_checkpoint_save(tracer, other, &error));
  check_unmerged((const char *[]){other}, 1, ABBE_PARSE, "cut off or holds no pass");
  unlink(other);
  for (int k = 0; k < PARTS; k++) unlink(file[k]);
}

/* Passes first, first + step, ... of that many. */
static void save_steps(size_t first, size_t step, size_t count, const char *file) {
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  OK(abbe_tracer_begin_at(tracer, first, step, &error));
  run_passes(tracer, count);
  OK(abbe_checkpoint_save(tracer, file, &error));
}

/* Parts that take every second and third pass meet in some. */
TEST(overlaps_of_steps_are_named) {
  static const struct {
    size_t step[2], count[2];
    const char *says;
  } cases[] = {{{2, 2}, {2, 2}, "both hold pass 0 and others"},
               {{2, 3}, {3, 2}, "both hold pass 0"},
               {{1, 2}, {1, 2}, "both hold pass 0"},
               {{2, 1}, {1, 3}, "both hold pass 0"}};
  char file[2][ROOM];
  for (int k = 0; k < 2; k++) snprintf(file[k], ROOM, "%s/steps-%d.ck", folder, k);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    for (int k = 0; k < 2; k++) save_steps(0, cases[i].step[k], cases[i].count[k], file[k]);
    check_unmerged((const char *[]){file[0], file[1]}, 2, ABBE_INVALID_ARGUMENT, cases[i].says);
  }
  for (int k = 0; k < 2; k++) unlink(file[k]);
}

/* The passes first to done - 1, of a whole. */
static void save_asked(size_t first, size_t done, size_t whole, const char *file) {
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  const abbe_trace_run_desc run = {.passes = done - first, .whole = whole, .checkpoint = file};
  abbe_tracer_begin_at(tracer, first, 1, NULL);
  OK(abbe_trace_run(tracer, &run, &error));
  OK(abbe_trace_keep(tracer, &run, &error));
}

/* The last part, and what a part that was killed had not done, are missed as any other; and what is
 * there is the mean of its own passes. */
TEST(what_was_asked_for_is_missed) {
  char file[3][ROOM];
  const char *paths[3] = {file[0], file[1], file[2]};
  for (int k = 0; k < 3; k++) snprintf(file[k], ROOM, "%s/asked-%d.ck", folder, k);
  for (int k = 0; k < 3; k++) save_asked(2 * (size_t)k, 2 * (size_t)k + 2, 8, file[k]);
  check_unmerged(paths, 3, ABBE_INVALID_ARGUMENT,
                 "passes 6 to 7 are missing: there are to be 8, as");
  save_asked(0, 6, 40, file[0]);
  check_unmerged(paths, 1, ABBE_INVALID_ARGUMENT, "passes 6 to 39 are missing");
  save_asked(0, 2, 4, file[0]);
  save_asked(3, 4, 4, file[1]);
  check_unmerged(paths, 2, ABBE_INVALID_ARGUMENT, "pass 2 is missing, between");
  save_asked(0, 2, 8, file[0]);
  check_unmerged(paths, 2, ABBE_INVALID_ARGUMENT, "; in all 5 of 8 are missing");
  save_asked(0, 2, 4, file[0]);
  save_asked(0, 2, 0, file[0]);
  abbe_checkpoint_merging how = {.whole = 3};
  abbe_tracer *tracer = make_tracer(&scene, &small), *other = make_tracer(&scene, &small);
  REFUSED(ABBE_INVALID_ARGUMENT, "pass 2 is missing: there are to be 3, as is asked for",
          abbe_checkpoint_merge(tracer, paths, 1, &how, &error));
  how.incomplete = true;
  OK(abbe_checkpoint_merge(tracer, paths, 1, &how, &error));
  assert_contains(how.lacks, "pass 2 is missing");
  run_passes(other, 2);
  check_same(tracer, other);
  how = (abbe_checkpoint_merging){.incomplete = true}; /* a hole in the middle: three passes */
  OK(abbe_checkpoint_merge(tracer, paths, 2, &how, &error));
  assert_int_equal(abbe_tracer_passes(tracer), 3);
  abbe_tracer_free(tracer);
  abbe_tracer_free(other);
  for (int k = 0; k < 3; k++) unlink(file[k]);
}

TEST(a_trace_begins_once) {
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  assert_int_equal(abbe_tracer_begin_at(tracer, 1u << 20, 1, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_tracer_begin_at(tracer, 5, 0, NULL), ABBE_INVALID_ARGUMENT);
  OK(abbe_tracer_begin_at(tracer, 5, 1, &error));
  run_passes(tracer, 1);
  assert_int_equal(abbe_tracer_passes(tracer), 1);
  assert_int_equal(abbe_tracer_first_pass(tracer), 5);
  assert_int_equal(abbe_tracer_begin_at(tracer, 6, 1, NULL), ABBE_INVALID_ARGUMENT);
}
