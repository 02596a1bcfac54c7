/* What can be taken hold of, and where it stands by the changes of a document. */
#include "tests/cli/view/learnt.h"

#include <unistd.h>

HOLDS(abbe_view_state);

TEST(what_can_be_held_is_found) {
  HELD(abbe_view_state, s) = begun();
  const abbe_view_outline *o = &s->outline;
  assert_int_equal(o->light_count, 1);
  assert_string_equal(o->light[0].key, "lights.lamp");
  assert_string_equal(o->light[0].power.key, "lights.lamp.intensity");
  assert_near(o->light[0].power.value, 0.265, 1e-12);
  assert_int_equal(o->object_count, 6);
  assert_string_equal(o->object[0].key, "objects.gem");
  assert_string_equal(o->object[0].material, "n-sf11");
  assert_string_equal(o->object[1].material, "");
  assert_near(o->object[0].translate[2], 0.15, 1e-12);
  assert_string_equal(
      o->object[0].before,
      "{rotate: {axis: [0, 0, 1], angle: 12}}, {rotate: {axis: [1, 0, 0], angle: 5}}");
  assert_string_equal(o->object[0].value[0].key, "objects.gem.crown");
  assert_near(o->object[0].value[0].value, 0.013, 1e-12);
}

/* Of a studio: its surroundings turn, and the angles of a cut are set. */
TEST(a_studio_can_be_turned_and_its_stone_cut) {
  char path[] = ABBE_SOURCE_DIR "/scenes/diamond-studio.yaml";
  static abbe_view_state s;
  memset(&s, 0, sizeof s);
  const abbe_view_document document = {.path = path};
  OK(abbe_view_state_begin(&s, &document, &error));
  learn(&s);
  const abbe_view_outline *o = &s.outline;
  assert_true(o->surrounded);
  assert_near(o->rotate.value, 0, 0);
  assert_near(o->rotate.max - o->rotate.min, 360, 0);
  assert_string_equal(o->object[0].value[1].label, "pavilion angle");
  assert_near(o->object[0].value[1].value, 40.75, 0);
  abbe_view_state_set(&s, o->rotate.key, "30", false, 1);
  abbe_view_state_set(&s, o->object[0].value[1].key, "42", false, 2);
  learn(&s); /* the scene takes both */
  assert_near(s.outline.rotate.value, 30, 0);
  assert_near(s.outline.object[0].value[1].value, 42, 0);
  size_t at = 0; /* stones to choose from, red ones too, and glasses behind them */
  while (strcmp(o->stone[at], "ruby") != 0) at++;
  assert_true(at < o->glasses_from && o->glasses_from < o->stone_count);
  assert_true(o->stone_colour[at] >> 16 > 2 * (o->stone_colour[at] >> 8 & 255));
  while (strcmp(o->stone[at], "n-bk7") != 0) at++;
  assert_true(at >= o->glasses_from && o->stone_colour[at] > 0xf0f0f0);
  abbe_view_state_set(&s, o->object[0].value[0].key, "18", false, 3); /* beyond its slider's end */
  abbe_view_state_set(&s, o->object[0].value[3].key, "2e-4", false, 4);
  learn(&s);
  assert_near(s.outline.object[0].value[0].min, 18, 0);
  const abbe_view_value *diameter = &s.outline.object[0].value[3];
  assert_string_equal(diameter->label, "diameter");
  assert_true(diameter->min < 1e-4 && diameter->max > 2e-4 && diameter->max < 0.01);
  abbe_view_state_free(&s);
}

/* Of a design its own angles are where the sliders begin, and their ends stay while it is recut. */
TEST(a_design_begins_with_its_own_angles) {
  const double turn = 3.14159265358979323846 / 180;
  char path[] = ABBE_SOURCE_DIR "/scenes/stone.yaml";
  static abbe_view_state s;
  memset(&s, 0, sizeof s);
  const abbe_view_document document = {.path = path};
  OK(abbe_view_state_begin(&s, &document, &error));
  learn(&s);
  const abbe_view_object *stone = &s.outline.object[0];
  assert_int_equal(stone->value_count, 3);
  assert_string_equal(stone->value[0].key, "objects.stone.crown");
  assert_string_equal(stone->value[1].label, "pavilion angle");
  assert_near(stone->value[0].value, 42, 0);
  assert_near(stone->value[1].value, 43, 0);
  assert_near(tan(stone->value[0].max * turn), 2 * tan(42 * turn), 1e-12);
  abbe_view_state_set(&s, "objects.stone.crown", "38", false, 1);
  learn(&s);
  assert_near(stone->value[0].value, 38, 0);
  assert_near(tan(stone->value[0].min * turn), 0.5 * tan(42 * turn), 1e-12);
  assert_near(stone->value[1].value, 43, 0);
  abbe_view_state_undo(&s, 2);
  learn(&s);
  assert_near(stone->value[0].value, 42, 0);
  /* a slider is where the document has it, whatever unit that is in, also before it is learnt */
  const abbe_view_value *width = &stone->value[2];
  const double own = abbe_view_outline_value(width, abbe_view_history_now(&s.history));
  assert_near(own, width->value, 0);
  abbe_view_state_set(&s, width->key, "6.5mm", false, 3);
  assert_near(abbe_view_outline_value(width, abbe_view_history_now(&s.history)), 0.0065, 1e-12);
  abbe_view_state_set(&s, width->key, "0.007", false, 4);
  assert_near(abbe_view_outline_value(width, abbe_view_history_now(&s.history)), 0.007, 0);
  abbe_view_state_set(&s, width->key, "wide", false, 5);
  assert_near(abbe_view_outline_value(width, abbe_view_history_now(&s.history)), own, 0);
  abbe_view_state_free(&s);
}

/* Whoever takes hold again before the scene is read again goes on from where it was left. */
TEST(what_was_pulled_stands_at_once) {
  HELD(abbe_view_state, s) = begun();
  const abbe_view_object *gem_of = &s->outline.object[0];
  double xy[2], middle[3];
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, gem_of->middle, xy));
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 60, xy[1], 0);
  memcpy(middle, gem_of->middle, sizeof middle);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, middle, xy));
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0], xy[1] + 80, ABBE_VIEW_CONTROL);
  assert_contains(gem_of->before, "angle: 5}}, {rotate");
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0], xy[1] - 40, ABBE_VIEW_SHIFT);
  assert_near(gem_of->middle[0], middle[0], 1e-6);
  assert_true(gem_of->middle[2] > middle[2] + 0.01);
  const abbe_view_object guessed = *gem_of;
  const double placed[3] = {guessed.middle[0], guessed.middle[1], guessed.middle[2]};
  learn(s); /* and there it is, tilted */
  assert_near(s->outline.object[0].translate[2], guessed.translate[2], 1e-6);
  assert_contains(s->outline.object[0].before, "angle: 5}}, {rotate");
  for (int k = 0; k < 3; k++) assert_near(s->outline.object[0].middle[k], placed[k], 0.01);
  abbe_view_state_wheel(s, -6, 9);
  see(s);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, s->outline.light[0].position, xy));
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] - 30, xy[1], 0);
  const double lamp = s->outline.light[0].position[0];
  assert_true(lamp < -0.03);
  learn(s);
  assert_near(s->outline.light[0].position[0], lamp, 1e-6);
}

/* Back and forth, and taken hold of before the scene is read again: from where the document has it.
 */
TEST(what_was_undone_stands_at_once) {
  HELD(abbe_view_state, s) = begun();
  double lamp[2], stone[2], moved[2][3];
  const abbe_view_outline *o = &s->outline;
  abbe_view_state_wheel(s, -6, 0.5);
  see(s);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, o->light[0].position, lamp));
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, o->object[0].middle, stone));
  const double own[2][3] = {
      {o->light[0].position[0], o->light[0].position[1], o->light[0].position[2]},
      {o->object[0].middle[0], o->object[0].middle[1], o->object[0].middle[2]}};
  const char *before = printed("%s", o->object[0].before);
  drag(s, ABBE_VIEW_LEFT, lamp[0], lamp[1], lamp[0] - 30, lamp[1], 0);
  learn(s);
  memcpy(moved[0], o->light[0].position, sizeof moved[0]);
  drag(s, ABBE_VIEW_LEFT, stone[0], stone[1], stone[0], stone[1] + 80, ABBE_VIEW_CONTROL);
  drag(s, ABBE_VIEW_LEFT, stone[0], stone[1], stone[0] + 60, stone[1], 0);
  learn(s);
  memcpy(moved[1], o->object[0].middle, sizeof moved[1]);
  assert_true(moved[0][0] < own[0][0] - 0.01 && moved[1][0] > own[1][0] + 0.01);
  for (int i = 0; i < 3; i++) assert_true(abbe_view_state_undo(s, 2));
  assert_memory_equal(o->light[0].position, own[0], sizeof own[0]);
  assert_memory_equal(o->object[0].middle, own[1], sizeof own[1]);
  assert_string_equal(o->object[0].before, before);
  drag(s, ABBE_VIEW_LEFT, lamp[0], lamp[1], lamp[0] - 30, lamp[1], 0); /* the same once more */
  for (int k = 0; k < 3; k++) assert_near(o->light[0].position[k], moved[0][k], 1e-6);
  drag(s, ABBE_VIEW_LEFT, stone[0], stone[1], stone[0] + 60, stone[1], 0);
  assert_true(o->object[0].middle[0] > own[1][0] + 0.01);
  assert_true(abbe_view_state_undo(s, 3));
  assert_memory_equal(o->object[0].middle, own[1], sizeof own[1]);
  assert_true(abbe_view_state_redo(s, 4));
  assert_true(o->object[0].middle[0] > own[1][0] + 0.01);
}

/* One brick, put where it is in four ways: by steps alone, by `fit`, by `centre`, by both. */
#define BRICK "material: n-bk7, shape: box, "
static const char *const brick[] = {
    BRICK "size: [0.02, 0.01, 0.006], transform: [{translate: [0.005, 0, 0.1]}]",
    BRICK "size: [20, 10, 6], fit: 0.02, transform: [{translate: [5, 0, 100]}]",
    BRICK "size: [0.02, 0.01, 0.006], centre: [0.005, 0, 0.1], transform: [{translate: [0, 3, 0]}]",
    BRICK "size: [20, 10, 6], transform: [{translate: [700, 0, 0]}], fit: 0.02, centre: [0.005, 0, "
          "0.1]"};
enum { BRICKS = sizeof brick / sizeof *brick };

static void begin_with_object(abbe_view_state *s, const char *text) {
  char path[] = "view_outline_XXXXXX";
  const int file = mkstemp(path);
  assert_true(file >= 0);
  dprintf(file,
          "camera: {eye: [0, -0.5, 0.3], target: [0, 0, 0.1], size: [32, 32]}\n"
          "environment: {uniform: 1}\nobjects:\n- {name: it, %s}\n"
          "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5}\n",
          text);
  close(file);
  begin_with(s, path);
}

static void end_with_object(abbe_view_state *s) {
  unlink(abbe_view_history_now(&s->history)->path);
  abbe_view_state_free(s);
}

/* Six digits are written. */
static void assert_same_bounds(const abbe_view_state *a, const abbe_view_state *b) {
  const abbe_view_object *one = &a->outline.object[0], *other = &b->outline.object[0];
  for (int k = 0; k < 3; k++) assert_near(one->middle[k], other->middle[k], 1e-6);
  assert_near(one->radius, other->radius, 1e-8);
}

/* The pointer leads them alike; a tilt leaves their size. */
TEST(what_is_fitted_or_centred_is_led_as_all) {
  static abbe_view_state s[BRICKS];
  const double own[3] = {0.005, 0, 0.1};
  const abbe_view_object *first = &s[0].outline.object[0];
  double xy[2];
  for (int i = 0; i < BRICKS; i++) begin_with_object(&s[i], brick[i]);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, own, xy));
  for (int i = 0; i < BRICKS; i++) {
    const abbe_view_object *it = &s[i].outline.object[0];
    drag(&s[i], ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 60, xy[1], 0);
    const double at_once = it->middle[0];
    learn(&s[i]);
    assert_true(it->middle[0] > own[0] + 0.01);
    assert_near(it->middle[0], at_once, 1e-6);
    assert_same_bounds(&s[i], &s[0]);
  }
  const double flat = first->radius;
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, first->middle, xy));
  for (int i = 0; i < BRICKS; i++) {
    drag(&s[i], ABBE_VIEW_LEFT, xy[0], xy[1], xy[0], xy[1] + 80, ABBE_VIEW_CONTROL);
    learn(&s[i]);
    assert_true(fabs(first->radius - flat) > 1e-4);
    assert_same_bounds(&s[i], &s[0]);
    assert_int_equal(s[i].history.count, 3);
  }
  for (int i = 0; i < BRICKS; i++) {
    for (int k = 0; k < 2; k++) assert_true(abbe_view_state_undo(&s[i], 2));
    learn(&s[i]);
    for (int k = 0; k < 3; k++) assert_near(s[i].outline.object[0].middle[k], own[k], 1e-9);
    end_with_object(&s[i]);
  }
}

/* A stone with its setting, receivers, and a mirror: each is dragged, tilted and dropped on the
 * table, which has no ring. */
TEST(every_object_is_dragged_tilted_and_dropped) {
  static const char *const object[] = {
      "shape: brilliant, diameter: 0.01, stand: [0, 0, 0.1], material: diamond, setting: {kind: "
      "prongs, metal: gold}",
      "shape: brilliant, diameter: 0.01, stand: [0, 0, 0.1], material: diamond, setting: {kind: "
      "prongs, metal: gold}, clouds: [{radius: 0.0005},\n   {radius: 0.0004},\n   {radius: "
      "0.0003}]",
      "shape: box, size: [0.02, 0.01, 0.006], centre: [0, 0, 0.1], reflectance: 0.4",
      "shape: sphere, radius: 0.01, transform: [{translate: [0, 0, 0.1]}], reflectance: 0.4",
      "shape: sphere, radius: 0.01, centre: [0, 0, 0.1], mirror: gold",
  };
  static abbe_view_state s;
  const abbe_view_object *it = &s.outline.object[0];
  abbe_view_handle handle;
  double xy[2], underside = 0;
  for (size_t i = 0; i < sizeof object / sizeof *object; i++) {
    begin_with_object(&s, object[i]);
    assert_int_equal(s.outline.object_count, 2);
    assert_true(abbe_view_state_handle(&s, 0, &handle));
    assert_false(abbe_view_state_handle(&s, 1, &handle));
    assert_true(it->above > 0.08);
    if (i == 1) assert_near(it->above, underside, 1e-12); /* clouds change nothing */
    underside = it->above;
    assert_true(abbe_view_camera_project(&s.camera, 512, 512, it->middle, xy));
    drag(&s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 60, xy[1], 0);
    learn(&s);
    assert_true(it->middle[0] > 0.01);
    assert_true(abbe_view_camera_project(&s.camera, 512, 512, it->middle, xy));
    drag(&s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 30, xy[1] + 80, ABBE_VIEW_CONTROL);
    assert_true(isnan(it->above)); /* what is undermost now is not known */
    assert_true(abbe_view_state_key(&s, 'g', true, 0, 3));
    assert_contains(s.refusal, "'it' is not dropped");
    learn(&s);
    const double before = it->middle[2], above = it->above;
    assert_true(abbe_view_state_key(&s, 'g', true, 0, 4));
    assert_int_equal(s.history.count, 4);
    assert_near(it->above, 0, 1e-6);
    learn(&s);
    assert_near(it->above, 0, 1e-6);
    assert_near(it->middle[2], before - above, 1e-6);
    assert_string_equal(s.refusal, "");
    assert_true(abbe_view_state_undo(&s, 5));
    assert_near(it->above, above, 1e-6);
    end_with_object(&s);
  }
}

/* Of what is fitted the radius sets nothing, and `fit` the size. */
TEST(what_is_fitted_is_sized_by_its_longest_side) {
  static abbe_view_state s;
  begin_with_object(&s, "material: n-bk7, shape: sphere, radius: 7, levels: 1, fit: 0.02");
  const abbe_view_object *ball = &s.outline.object[0];
  assert_int_equal(ball->value_count, 1);
  assert_string_equal(ball->value[0].key, "objects.it.fit");
  assert_near(ball->value[0].value, 0.02, 0);
  abbe_view_state_set(&s, ball->value[0].key, "0.03", false, 1);
  learn(&s);
  assert_near(ball->radius, 0.015 * sqrt(3), 1e-9);
  end_with_object(&s);
}

/* What a job has found of an older change is no place for what was undone since. */
TEST(an_older_scene_moves_nothing_back) {
  HELD(abbe_view_state, s) = begun();
  static abbe_view_outline older;
  double lamp[2], own[3];
  const abbe_view_outline *o = &s->outline;
  abbe_view_state_wheel(s, -6, 0.5);
  see(s);
  memcpy(own, o->light[0].position, sizeof own);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, own, lamp));
  drag(s, ABBE_VIEW_LEFT, lamp[0], lamp[1], lamp[0] - 30, lamp[1], 0);
  assert_true(o->light[0].position[0] < own[0] - 0.01);
  find(s, &older);
  assert_true(abbe_view_state_undo(s, 2));
  abbe_view_state_learn(s, &older, false);
  assert_memory_equal(o->light[0].position, own, sizeof own);
  learn(s);
  assert_true(abbe_view_state_redo(s, 3));
  assert_true(o->light[0].position[0] < own[0] - 0.01);
}
