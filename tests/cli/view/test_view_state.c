/* The viewer without its window, by scripted events. */
#include "tests/cli/view/learnt.h"

HOLDS(abbe_view_state);

/* A mirror is taken hold of as a stone is, and is of a metal, which no stone is. */
TEST(mirrors_are_held_and_of_a_metal) {
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

TEST(a_drag_turns_the_camera_in_one_step) {
  HELD(abbe_view_state, s) = begun();
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
}

TEST(other_buttons_pan_and_look) {
  HELD(abbe_view_state, s) = begun();
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
}

TEST(handles_move_and_tilt_objects) {
  HELD(abbe_view_state, s) = begun();
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
}

/* Handles are where the picture that stands has them, and there they are taken hold of. */
TEST(handles_are_of_the_picture) {
  HELD(abbe_view_state, s) = begun();
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
}

/* Turns of the wheel that follow each other are one step, apart from what was changed before. */
TEST(the_wheel_is_a_step) {
  HELD(abbe_view_state, s) = begun();
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
}

TEST(lights_move) {
  enum { READY = 1u << ABBE_VIEW_MOVING };
  HELD(abbe_view_state, s) = begun();
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
}

/* A sun's handle stands on the way to it; dragged on its level it turns what it shines on. */
TEST(the_sun_moves) {
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
TEST(another_scene_is_a_step) {
  HELD(abbe_view_state, s) = begun();
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
}

TEST(a_click_asks_for_a_spectrum) {
  HELD(abbe_view_state, s) = begun();
  const uint64_t serial = s->refine.serial;
  drag(s, ABBE_VIEW_LEFT, 40, 400, 41, 400, 0);
  assert_true(s->picked && s->refine.spectrum);
  assert_int_equal(s->pixel[0], 40);
  assert_int_equal(s->refine.serial, serial); /* nothing has changed */
  assert_int_equal(s->history.count, 1);
}

TEST(edits_and_settings) {
  HELD(abbe_view_state, s) = begun();
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
}

TEST(a_window_without_room_takes_no_pointer) {
  HELD(abbe_view_state, s) = begun();
  abbe_view_state_resize(s, 0, 0, 1);
  drag(s, ABBE_VIEW_LEFT, 40, 400, 140, 400, 0);
  assert_int_equal(s->history.count, 1);
  assert_false(s->refine.held);
  assert_int_equal(abbe_view_state_handle_at(s, 1, 1).kind, ABBE_VIEW_NO_HANDLE);
}
