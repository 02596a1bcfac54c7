/* The viewer without its window, by scripted events. */
#include "tests/check.h"

#include "cli/view/state/view_camera.h"
#include "cli/view/state/view_state.h"
#include "scenes/import/scene_file.h"

#include <stdlib.h>

static const char gem[] = ABBE_SOURCE_DIR "/scenes/gem.yaml";

static void see(abbe_view_state *s) {
  abbe_view_state_picture(s, &s->camera);
}

/* What the document's changes make of the scene, learnt as from a job. */
static void find(const abbe_view_state *s, abbe_view_outline *out) {
  const abbe_view_document *now = abbe_view_history_now(&s->history);
  const abbe_scene_options options = {.set = (const char *const *)now->set,
                                      .set_count = now->set_count};
  abbe_scene scene;
  abbe_error error = {0};
  char *text;
  size_t size;
  if (abbe_scene_load(now->path, &options, &scene, &error) != ABBE_OK) fail_msg("%s", error.text);
  assert_int_equal(abbe_scene_text(now->path, &options, &text, &size, NULL), ABBE_OK);
  assert_int_equal(abbe_view_outline_make(&scene, text, size, out, NULL), ABBE_OK);
  out->camera = scene.camera;
  free(text);
  abbe_scene_free(&scene);
}

static void learn(abbe_view_state *s) {
  static abbe_view_outline outline;
  find(s, &outline);
  abbe_view_state_learn(s, &outline, true);
  see(s);
}

/* The gem in a picture of 512 x 512. */
static abbe_view_state *begun(void) {
  static abbe_view_state s;
  char path[sizeof gem];
  memset(&s, 0, sizeof s);
  strcpy(path, gem);
  const abbe_view_document document = {.path = path};
  assert_int_equal(abbe_view_state_begin(&s, &document, NULL), ABBE_OK);
  abbe_view_state_resize(&s, 512, 512, 0);
  learn(&s);
  return &s;
}

static const char *value(const abbe_view_state *s, const char *key) {
  return abbe_view_document_value(abbe_view_history_now(&s->history), key);
}

static void drag(abbe_view_state *s, abbe_view_button button, double x0, double y0, double x1,
                 double y1, int modifiers) {
  abbe_view_state_press(s, button, x0, y0, modifiers, 1);
  for (int i = 1; i <= 4; i++)
    abbe_view_state_move(s, x0 + i * (x1 - x0) / 4, y0 + i * (y1 - y0) / 4, 1 + 0.05 * i);
  abbe_view_state_release(s, button, 1.3);
}

static void test_what_can_be_held_is_found(void **state) {
  (void)state;
  abbe_view_state *s = begun();
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
  assert_string_equal(o->object[0].before, "{rotate: {axis: [0, 0, 1], angle: 12}}, "
                                           "{rotate: {axis: [1, 0, 0], angle: 5}}");
  assert_string_equal(o->object[0].value[0].key, "objects.gem.crown");
  assert_near(o->object[0].value[0].value, 0.013, 1e-12);
  abbe_view_state_free(s);
}

/* Of a studio: its surroundings turn, and the angles of a cut are set. */
static void test_a_studio_can_be_turned_and_its_stone_cut(void **state) {
  (void)state;
  char path[] = ABBE_SOURCE_DIR "/scenes/diamond-studio.yaml";
  static abbe_view_state s;
  memset(&s, 0, sizeof s);
  const abbe_view_document document = {.path = path};
  assert_int_equal(abbe_view_state_begin(&s, &document, NULL), ABBE_OK);
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
  assert_true(s.outline.stone_count > 10);                            /* to choose from */
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
static void test_a_design_begins_with_its_own_angles(void **state) {
  (void)state;
  const double turn = 3.14159265358979323846 / 180;
  char path[] = ABBE_SOURCE_DIR "/scenes/stone.yaml";
  static abbe_view_state s;
  memset(&s, 0, sizeof s);
  const abbe_view_document document = {.path = path};
  assert_int_equal(abbe_view_state_begin(&s, &document, NULL), ABBE_OK);
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
  abbe_view_state_free(&s);
}

/* That file in a window of 512 x 512, learnt. */
static void begin_with(abbe_view_state *s, char *path) {
  const abbe_view_document document = {.path = path};
  memset(s, 0, sizeof *s);
  assert_int_equal(abbe_view_state_begin(s, &document, NULL), ABBE_OK);
  abbe_view_state_resize(s, 512, 512, 0);
  learn(s);
}

/* A mirror is taken hold of as a stone is, and is of a metal, which no stone is. */
static void test_mirrors_are_held_and_of_a_metal(void **state) {
  (void)state;
  char path[] = ABBE_SOURCE_DIR "/scenes/metals.yaml";
  static abbe_view_state s;
  double xy[2];
  begin_with(&s, path);
  const abbe_view_object *ring = &s.outline.object[1];
  assert_true(ring->mirror && ring->bends && !s.outline.object[0].bends);
  assert_string_equal(ring->material, "gold");
  assert_string_equal(ring->value[0].key, "objects.ring.major");
  size_t gold = 0;
  for (size_t i = 0; i < s.outline.metal_count; i++)
    gold += strcmp(s.outline.metal[i], "gold") == 0;
  for (size_t i = 0; i < s.outline.stone_count; i++)
    assert_string_not_equal(s.outline.stone[i], "gold");
  assert_int_equal(gold, 1);
  assert_true(abbe_view_camera_project(&s.camera, 512, 512, ring->middle, xy));
  drag(&s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 20, xy[1], 0);
  assert_non_null(value(&s, "objects.ring.transform"));
  abbe_view_state_set(&s, "objects.ring.mirror", "copper", false, 2);
  learn(&s);
  assert_string_equal(s.outline.object[1].material, "copper");
  abbe_view_state_free(&s);
}

static void test_a_drag_turns_the_camera_in_one_step(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  const abbe_camera before = s->camera;
  drag(s, ABBE_VIEW_LEFT, 40, 400, 140, 400, 0);
  assert_int_equal(s->history.count, 2);
  assert_non_null(value(s, "camera.eye"));
  assert_true(s->camera.eye[0] < before.eye[0] - 0.01); /* the scene goes right, the eye left */
  assert_near(s->camera.target[0], before.target[0], 1e-12);
  const abbe_camera led = s->camera;
  learn(s); /* the scene that is written has the camera that was led */
  assert_memory_equal(s->camera.eye, led.eye, sizeof led.eye);
  assert_true(abbe_view_state_undo(s, 2));
  assert_null(value(s, "camera.eye"));
  learn(s);
  assert_memory_equal(s->camera.eye, before.eye, sizeof before.eye);
  assert_true(abbe_view_state_key(s, 'y', true, ABBE_VIEW_CONTROL, 3));
  assert_memory_equal(s->camera.eye, led.eye, sizeof led.eye);
  abbe_view_state_free(s);
}

static void test_other_buttons_pan_and_look(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  const abbe_camera before = s->camera;
  drag(s, ABBE_VIEW_MIDDLE, 40, 400, 140, 400, 0);
  assert_true(s->camera.eye[0] < before.eye[0] && s->camera.target[0] < before.target[0]);
  const abbe_camera panned = s->camera;
  assert_true(abbe_view_state_undo(s, 2)); /* so also without a middle button */
  drag(s, ABBE_VIEW_LEFT, 40, 400, 140, 400, ABBE_VIEW_SHIFT);
  assert_memory_equal(s->camera.eye, panned.eye, sizeof panned.eye);
  assert_memory_equal(s->camera.target, panned.target, sizeof panned.target);
  drag(s, ABBE_VIEW_RIGHT, 40, 400, 140, 400, 0);
  assert_memory_equal(s->camera.eye, panned.eye, sizeof panned.eye);
  assert_true(s->camera.target[0] > panned.target[0]);
  abbe_view_state_press(s, ABBE_VIEW_RIGHT, 40, 40, 0, 5);
  assert_true(abbe_view_state_key(s, 'w', true, 0, 5));
  const abbe_camera still = s->camera;
  abbe_view_state_tick(s, 0.1, 5.1);
  assert_true(s->camera.eye[1] > still.eye[1]);
  abbe_view_state_key(s, 'w', false, 0, 5.2);
  const abbe_camera there = s->camera;
  abbe_view_state_tick(s, 0.1, 5.3);
  assert_memory_equal(&s->camera, &there, sizeof there);
  abbe_view_state_free(s);
}

static void test_handles_move_and_tilt_objects(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  double xy[2], middle[3];
  memcpy(middle, s->outline.object[0].middle, sizeof middle);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, middle, xy));
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 60, xy[1], 0);
  assert_int_equal(s->history.count, 2);
  assert_null(value(s, "camera.eye"));
  learn(s);
  const abbe_view_object *o = &s->outline.object[0];
  assert_true(o->middle[0] > middle[0] + 0.01);
  assert_near(o->middle[2], middle[2], 1e-6); /* six digits are written */
  drag(s, ABBE_VIEW_LEFT, xy[0] + 60, xy[1], xy[0] + 60, xy[1] - 40, ABBE_VIEW_SHIFT);
  learn(s);
  assert_true(s->outline.object[0].middle[2] > middle[2] + 0.01);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, s->outline.object[0].middle, xy));
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0], xy[1] + 80, ABBE_VIEW_CONTROL);
  assert_int_equal(s->history.count, 4);
  assert_contains(value(s, "objects.gem.transform"), "angle: 28.6");
  learn(s);
  assert_contains(s->outline.object[0].before, "angle: 5}}, {rotate");
  abbe_view_state_free(s);
}

/* Whoever takes hold again before the scene is read again goes on from where it was left. */
static void test_what_was_pulled_stands_at_once(void **state) {
  (void)state;
  abbe_view_state *s = begun();
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
  abbe_view_state_free(s);
}

/* Back and forth, and taken hold of before the scene is read again: from where the document has it.
 */
static void test_what_was_undone_stands_at_once(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  double lamp[2], stone[2], moved[2][3];
  const abbe_view_outline *o = &s->outline;
  abbe_view_state_wheel(s, -6, 0.5);
  see(s);
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, o->light[0].position, lamp));
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, o->object[0].middle, stone));
  const double own[2][3] = {
      {o->light[0].position[0], o->light[0].position[1], o->light[0].position[2]},
      {o->object[0].middle[0], o->object[0].middle[1], o->object[0].middle[2]}};
  char before[256];
  snprintf(before, sizeof before, "%s", o->object[0].before);
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
  abbe_view_state_free(s);
}

/* What a job has found of an older change is no place for what was undone since. */
static void test_an_older_scene_moves_nothing_back(void **state) {
  (void)state;
  abbe_view_state *s = begun();
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
  abbe_view_state_free(s);
}

/* Handles are where the picture that stands has them, and there they are taken hold of. */
static void test_handles_are_of_the_picture(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  abbe_view_handle first, then;
  assert_true(abbe_view_state_handle(s, 0, &first));
  drag(s, ABBE_VIEW_MIDDLE, 40, 400, 140, 400, 0);
  assert_true(abbe_view_state_handle(s, 0, &then));
  assert_memory_equal(then.xy, first.xy, sizeof first.xy);
  see(s);
  assert_true(abbe_view_state_handle(s, 0, &then));
  assert_true(hypot(then.xy[0] - first.xy[0], then.xy[1] - first.xy[1]) > 5);
  /* what is pulled goes with the pictures */
  abbe_view_state_press(s, ABBE_VIEW_LEFT, then.xy[0], then.xy[1], 0, 2);
  abbe_view_state_move(s, then.xy[0] + 50, then.xy[1], 2.1);
  learn(s);
  assert_true(abbe_view_state_handle(s, 0, &first));
  assert_near(first.xy[0], then.xy[0] + 50, 0.5);
  assert_near(first.xy[1], then.xy[1], 0.5);
  abbe_view_state_release(s, ABBE_VIEW_LEFT, 2.2);
  abbe_view_state_free(s);
}

/* Turns of the wheel that follow each other are one step, apart from what was changed before. */
static void test_the_wheel_is_a_step(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  abbe_view_state_set(s, "ambient", "1", false, 1);
  const size_t before = s->history.at;
  abbe_view_state_wheel(s, 1, 1.1);
  assert_int_equal(s->history.at, before + 1);
  abbe_view_state_wheel(s, 1, 1.2);
  assert_int_equal(s->history.at, before + 1);
  abbe_view_state_wheel(s, 1, 3);
  assert_int_equal(s->history.at, before + 2);
  assert_true(abbe_view_state_undo(s, 4) && abbe_view_state_undo(s, 4));
  assert_string_equal(abbe_view_document_value(abbe_view_history_now(&s->history), "ambient"), "1");
  /* no farther and no nearer than a scene may have its camera */
  for (int i = 0; i < 30; i++) abbe_view_state_wheel(s, -20, 5 + 0.1 * i);
  assert_true(fabs(s->camera.eye[1]) < 1e6 && fabs(s->camera.eye[1]) > 1e3);
  learn(s);
  for (int i = 0; i < 60; i++) abbe_view_state_wheel(s, 20, 20 + 0.1 * i);
  assert_memory_not_equal(s->camera.eye, s->camera.target, sizeof s->camera.eye);
  const double nearest = s->camera.eye[1];
  abbe_view_state_wheel(s, -20, 40);
  assert_true(s->camera.eye[1] < nearest); /* and away from there again */
  abbe_view_state_free(s);
}

static void test_lights_move(void **state) {
  (void)state;
  enum { READY = 1u << ABBE_VIEW_MOVING };
  abbe_view_state *s = begun();
  double xy[2];
  abbe_view_state_wheel(s, -6, 0.9);
  see(s);
  assert_int_equal(s->history.count, 2);
  s->refine.hand[0].ready = READY;
  assert_true(abbe_view_camera_project(&s->camera, 512, 512, s->outline.light[0].position, xy));
  const abbe_view_handle handle = abbe_view_state_handle_at(s, xy[0] + 5, xy[1]);
  assert_int_equal(handle.kind, ABBE_VIEW_LIGHT_HANDLE);
  drag(s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] - 30, xy[1], 0);
  assert_non_null(value(s, "lights.lamp.position"));
  assert_int_equal(s->refine.scene, s->refine.serial); /* no light is of it, */
  assert_int_equal(s->refine.hand[0].ready, READY);    /* but programs are */
  abbe_view_state_set(s, "objects.gem.material", "diamond", false, 3);
  assert_int_equal(s->refine.hand[0].ready, 0);
  assert_true(abbe_view_state_undo(s, 4));
  learn(s);
  assert_true(s->outline.light[0].position[0] < -0.03);
  abbe_view_state_free(s);
}

/* A sun's handle stands on the way to it; dragged on its level it turns what it shines on. */
static void test_the_sun_moves(void **state) {
  (void)state;
  static abbe_view_state s;
  char path[] = ABBE_SOURCE_DIR "/docs/examples/ball.yaml";
  double xy[2];
  begin_with(&s, path);
  const abbe_view_light before = s.outline.light[0];
  assert_true(before.placed);
  static const double slopes[3] = {-0.5, 0.2, 1}; /* of [0.5, -0.2, -1], from there to the middle */
  for (int k = 0; k < 3; k++)
    assert_near((before.aim[k] - before.position[k]) / (before.aim[2] - before.position[2]),
                slopes[k], 1e-12);
  assert_true(abbe_view_camera_project(&s.camera, 512, 512, before.position, xy));
  assert_int_equal(abbe_view_state_handle_at(&s, xy[0], xy[1]).kind, ABBE_VIEW_LIGHT_HANDLE);
  drag(&s, ABBE_VIEW_LEFT, xy[0], xy[1], xy[0] + 60, xy[1], 0);
  double there[2]; /* its handle is where it was let go of */
  assert_true(abbe_view_camera_project(&s.camera, 512, 512, s.outline.light[0].position, there));
  assert_near(there[0], xy[0] + 60, 0.5);
  assert_non_null(value(&s, "lights.sun.direction"));
  assert_null(value(&s, "lights.sun.position"));
  learn(&s);
  const abbe_view_light *after = &s.outline.light[0];
  const double slope = (after->aim[0] - after->position[0]) / (after->aim[2] - after->position[2]);
  assert_true(slope > -0.4); /* it shines less to the right from farther right */
  abbe_view_state_free(&s);
}

/* Whoever picks another scene by mistake has lost nothing. */
static void test_another_scene_is_a_step(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  const abbe_camera gems = s->camera;
  abbe_view_state_set(s, "objects.gem.material", "diamond", false, 1);
  abbe_view_state_settings(s, 9, 128, 0, false, 2);
  s->picked = true;
  abbe_view_state_open(s, ABBE_SOURCE_DIR "/scenes/sphere.yaml", 3);
  assert_false(s->picked);
  assert_int_equal(s->outline.object_count, 0);
  assert_null(value(s, "objects.gem.material"));
  assert_int_equal(abbe_view_history_now(&s->history)->photons, 0);
  learn(s);
  assert_string_equal(s->outline.object[0].material, "fused-silica");
  const uint64_t serial = s->refine.serial;
  assert_true(abbe_view_state_undo(s, 4));
  assert_int_equal(s->refine.scene, serial + 1); /* no light is of it */
  assert_int_equal(s->outline.object_count, 0);
  assert_int_equal(abbe_view_history_now(&s->history)->photons, 128);
  learn(s);
  assert_string_equal(s->outline.object[0].material, "diamond");
  assert_memory_equal(s->camera.eye, gems.eye, sizeof gems.eye);
  abbe_view_state_free(s);
}

static void test_a_click_asks_for_a_spectrum(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  const uint64_t serial = s->refine.serial;
  drag(s, ABBE_VIEW_LEFT, 40, 400, 41, 400, 0);
  assert_true(s->picked && s->refine.spectrum);
  assert_int_equal(s->pixel[0], 40);
  assert_int_equal(s->refine.serial, serial); /* nothing has changed */
  assert_int_equal(s->history.count, 1);
  abbe_view_state_free(s);
}

static void test_edits_and_settings(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  abbe_view_state_set(s, "objects.gem.material", "diamond", false, 1);
  abbe_view_state_set(s, "lights.lamp.intensity", "0.3", false, 2);
  abbe_view_state_set(s, "lights.lamp.intensity", "0.4", true, 2.1);
  abbe_view_state_settings(s, 9, 128, 0, false, 3);
  assert_int_equal(s->history.count, 4);
  learn(s);
  assert_string_equal(s->outline.object[0].material, "diamond");
  assert_near(s->outline.light[0].power.value, 0.4, 1e-12);
  assert_true(abbe_view_state_undo(s, 4));
  assert_int_equal(abbe_view_history_now(&s->history)->photons, 0);
  assert_true(abbe_view_state_undo(s, 5));
  assert_null(value(s, "lights.lamp.intensity"));
  snprintf(s->refusal, sizeof s->refusal, "because");
  abbe_view_state_set(s, "ambient", "0.2", false, 6);
  assert_string_equal(s->refusal, ""); /* of what was before */
  abbe_view_state_free(s);
}

static void test_a_window_without_room_takes_no_pointer(void **state) {
  (void)state;
  abbe_view_state *s = begun();
  abbe_view_state_resize(s, 0, 0, 1);
  drag(s, ABBE_VIEW_LEFT, 40, 400, 140, 400, 0);
  assert_int_equal(s->history.count, 1);
  assert_false(s->refine.held);
  assert_int_equal(abbe_view_state_handle_at(s, 1, 1).kind, ABBE_VIEW_NO_HANDLE);
  abbe_view_state_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_what_can_be_held_is_found),
      cmocka_unit_test(test_a_studio_can_be_turned_and_its_stone_cut),
      cmocka_unit_test(test_a_design_begins_with_its_own_angles),
      cmocka_unit_test(test_mirrors_are_held_and_of_a_metal),
      cmocka_unit_test(test_a_drag_turns_the_camera_in_one_step),
      cmocka_unit_test(test_other_buttons_pan_and_look),
      cmocka_unit_test(test_handles_move_and_tilt_objects),
      cmocka_unit_test(test_what_was_pulled_stands_at_once),
      cmocka_unit_test(test_what_was_undone_stands_at_once),
      cmocka_unit_test(test_an_older_scene_moves_nothing_back),
      cmocka_unit_test(test_handles_are_of_the_picture),
      cmocka_unit_test(test_the_wheel_is_a_step),
      cmocka_unit_test(test_the_sun_moves),
      cmocka_unit_test(test_lights_move),
      cmocka_unit_test(test_another_scene_is_a_step),
      cmocka_unit_test(test_a_click_asks_for_a_spectrum),
      cmocka_unit_test(test_edits_and_settings),
      cmocka_unit_test(test_a_window_without_room_takes_no_pointer)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
