/* A scene by handle: pictures are those of the renderer and the tracer; changes are those of a
 * scene opened anew; what fails leaves all as it was. */
#include "tests/check.h"

#include "library/lib_comparison.h"
#include "library/lib_handles.h"
#include "library/lib_scene.h"

HOLDS(abbe_lib_picture);
HOLDS(abbe_lib_scene);

static const char *const sphere = ABBE_SOURCE_DIR "/scenes/sphere.yaml";
static const char *const small[] = {"width=48", "height=48", "photons=64", "map_size=128"};
static const char *const quick[] = {"width=48", "height=48", "photons=20000", "passes=4"};
#define COUNT(list) (sizeof list / sizeof *list)

static abbe_lib_scene *opened(const char *const *set, size_t count) {
  abbe_lib_scene *s = NULL;
  abbe_error error = {0};
  if (abbe_lib_scene_open(sphere, NULL, NULL, set, count, &s, &error) != ABBE_OK)
    print_error("%s\n", error.text);
  assert_non_null(s);
  return s;
}

static abbe_lib_picture *rendered(abbe_lib_scene *s) {
  abbe_lib_picture *p = NULL;
  abbe_error error = {0};
  if (abbe_lib_scene_render(s, small, COUNT(small), &p, &error) != ABBE_OK)
    print_error("%s\n", error.text);
  assert_non_null(p);
  return p;
}

static bool same(abbe_lib_picture *a, abbe_lib_picture *b) {
  const size_t size = abbe_lib_picture_width(a) * abbe_lib_picture_height(a) *
                      abbe_lib_picture_channels(a) * sizeof(float);
  return memcmp(abbe_lib_picture_pixels(a), abbe_lib_picture_pixels(b), size) == 0;
}

/* Frees both. */
static void assert_same(abbe_lib_picture *a, abbe_lib_picture *b, bool expected) {
  assert_int_equal(same(a, b), expected);
  abbe_lib_picture_free(a);
  abbe_lib_picture_free(b);
}

TEST(a_change_is_a_scene_opened_so) {
  const char *const dim[] = {"camera.fov=20"}, *const both[] = {"camera.fov=20", "ambient=0.5"};
  HELD(abbe_lib_scene, changed) = opened(NULL, 0);
  HELD(abbe_lib_scene, fresh) = opened(both, 2);
  abbe_lib_picture *before = rendered(changed);
  OK(abbe_lib_scene_change(changed, dim, 1, &error));
  OK(abbe_lib_scene_change(changed, both + 1, 1, &error));
  assert_same(rendered(changed), rendered(fresh), true);
  assert_same(before, rendered(changed), false);
}

TEST(the_camera_moves_and_comes_back) {
  HELD(abbe_lib_scene, s) = opened(NULL, 0);
  double eye[3], target[3], up[3], fov, moved[3], unused[3], angle;
  assert_int_equal(abbe_lib_scene_camera(s, eye, target, up, &fov, NULL), ABBE_OK);
  abbe_lib_picture *first = rendered(s);
  for (int i = 0; i < 3; i++) moved[i] = eye[i] + 0.3 * (target[i] - eye[i]);
  OK(abbe_lib_scene_look(s, moved, NULL, NULL, 0, &error));
  abbe_lib_picture *nearer = rendered(s);
  assert_false(same(first, nearer));
  /* other values of the file leave the camera where it was put */
  OK(abbe_lib_scene_change(s, (const char *const[]){"ambient=0"}, 1, &error));
  OK(abbe_lib_scene_camera(s, unused, target, up, &angle, &error));
  for (int i = 0; i < 3; i++) assert_near(unused[i], moved[i], 0);
  assert_near(angle, fov, 0);
  abbe_lib_picture_free(nearer);
  abbe_lib_scene_free(s);
  s = opened(NULL, 0);
  OK(abbe_lib_scene_look(s, moved, NULL, NULL, 0, &error));
  OK(abbe_lib_scene_look(s, eye, NULL, NULL, 0, &error));
  assert_same(first, rendered(s), true);
}

/* A focus at the target stays there; one that was given stays as far, and the pupil as wide. */
TEST(a_camera_that_moves_stays_sharp) {
  static const char *const given[] = {"camera.aperture=16", "camera.focus=0.2"};
  for (size_t count = 1; count <= 2; count++) {
    HELD(abbe_lib_scene, s) = opened(given, count);
    const abbe_camera before = s->now->camera;
    double moved[3], far = 0;
    for (int i = 0; i < 3; i++) {
      moved[i] = before.eye[i] + 0.3 * (before.target[i] - before.eye[i]);
      far = hypot(far, moved[i] - before.target[i]);
    }
    OK(abbe_lib_scene_look(s, moved, NULL, NULL, 0, &error));
    assert_near(s->now->camera.focus, count == 1 ? far : 0.2, 1e-12);
    assert_near(s->now->camera.aperture, before.aperture, 0);
  }
}

TEST(a_trace_agrees_with_the_picture) {
  HELD(abbe_lib_scene, s) = opened(NULL, 0);
  HELD(abbe_lib_picture, truth) = NULL, *map = NULL;
  HELD(abbe_lib_picture, mapped) = NULL;
  HELD(abbe_lib_picture, picture) = rendered(s);
  abbe_lib_comparison *c = NULL;
  double value, noise, limit;
  OK(abbe_lib_scene_map(s, NULL, 0, &map, &error));
  OK(abbe_lib_scene_trace(s, quick, COUNT(quick), map, &truth, &mapped, &error));
  assert_int_equal(abbe_lib_picture_width(mapped), abbe_lib_picture_width(map));
  OK(abbe_lib_comparison_make(truth, picture, NULL, NULL, 0, &c, &error));
  OK(abbe_lib_comparison_value(c, "energy_ratio", false, &value, &noise, &limit, &error));
  assert_near(value, 1, 0.03);
  assert_false(isnan(noise));
  abbe_lib_comparison_free(c);
  OK(abbe_lib_comparison_make(mapped, map, NULL, NULL, 0, &c, &error));
  OK(abbe_lib_comparison_value(c, "energy_ratio", false, &value, &noise, &limit, &error));
  assert_near(value, 1, 0.05);
  abbe_lib_comparison_free(c);
}

static bool stop_at_once(void *user, double done) {
  (void)done;
  ++*(int *)user;
  return false;
}

TEST(progress_stops_the_work) {
  HELD(abbe_lib_scene, s) = opened(NULL, 0);
  abbe_lib_picture *p = NULL;
  int told = 0;
  abbe_lib_scene_set_progress(s, stop_at_once, &told);
  REFUSED(ABBE_CANCELLED, "", abbe_lib_scene_trace(s, quick, COUNT(quick), NULL, &p, NULL, &error));
  assert_true(told > 0);
  assert_null(p);
  REFUSED(ABBE_CANCELLED, "", abbe_lib_scene_render(s, small, COUNT(small), &p, &error));
  assert_null(p);
  abbe_lib_scene_set_progress(s, NULL, NULL);
  abbe_lib_picture_free(rendered(s));
}

static bool stop_at_a_third(void *user, double done) {
  (void)user;
  return fabs(done - 1.0 / 3) > 1e-9;
}

TEST(progress_stops_between_places_on_the_lens) {
  static const char *const aperture[] = {"camera.aperture=16"};
  static const char *const three[] = {"width=16", "height=16", "photons=16", "map_size=64",
                                      "lens=3"};
  HELD(abbe_lib_scene, s) = opened(aperture, 1);
  HELD(abbe_lib_picture, p) = NULL;
  abbe_lib_scene_set_progress(s, stop_at_a_third, NULL);
  REFUSED(ABBE_CANCELLED, "1 of 3 places on the lens",
          abbe_lib_scene_render(s, three, COUNT(three), &p, &error));
  assert_null(p);
  abbe_lib_scene_set_progress(s, NULL, NULL);
  OK(abbe_lib_scene_render(s, three, COUNT(three), &p, &error));
}

TEST(what_fails_leaves_all_as_it_was) {
  HELD(abbe_lib_scene, s) = opened(NULL, 0);
  abbe_lib_scene *none = NULL;
  abbe_lib_picture *p = NULL, *first = rendered(s);
  abbe_error error = {0};
  const double nowhere[3] = {NAN, 0, 0};
  assert_int_equal(abbe_lib_scene_open("/nowhere.yaml", NULL, NULL, NULL, 0, &none, &error),
                   ABBE_IO);
  assert_null(none);
  assert_int_not_equal(
      abbe_lib_scene_change(s, (const char *const[]){"camera.fov=1000"}, 1, &error), ABBE_OK);
  assert_contains(error.text, "fov");
  assert_int_equal(abbe_lib_scene_look(s, nowhere, NULL, NULL, 0, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_lib_scene_look(s, NULL, NULL, NULL, 4, &error), ABBE_INVALID_ARGUMENT);
  double eye[3], target[3], up[3], fov;
  assert_int_equal(abbe_lib_scene_camera(s, eye, target, up, &fov, NULL), ABBE_OK);
  assert_int_equal(abbe_lib_scene_look(s, target, NULL, NULL, 0, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_lib_scene_render(s, (const char *const[]){"widht=3"}, 1, &p, &error),
                   ABBE_INVALID_ARGUMENT);
  assert_contains(error.text, "width");
  assert_int_equal(
      abbe_lib_scene_trace(s, (const char *const[]){"passes=0"}, 1, NULL, &p, NULL, &error),
      ABBE_INVALID_ARGUMENT);
  assert_same(first, rendered(s), true);
}

TEST(a_map_wants_a_picture) {
  HELD(abbe_lib_scene, s) = opened(NULL, 0);
  HELD(abbe_lib_picture, map) = NULL;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_scene_map(s, NULL, 0, &map, &error));
  abbe_lib_picture_free(rendered(s));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_scene_map(s, "nobody's", 0, &map, &error));
  OK(abbe_lib_scene_map(s, "1", 4, &map, &error));
  assert_int_equal(abbe_lib_picture_channels(map), 7);
}

/* A lamp is no environment: settings of pinholes come to the request, which says what is missing.
 */
TEST(pinholes_are_asked_for) {
  static const struct {
    const char *const settings[2];
    abbe_result result;
    const char *says;
  } rows[] = {
      {{"transport=pinhole", "pinholes=20"}, ABBE_UNSUPPORTED, "an environment's light"},
      {{"pinholes=20", "footprint=off"}, ABBE_INVALID_ARGUMENT, "go with the transport 'pinhole'"},
      {{"transport=pinhole", "pinholes=5000"}, ABBE_INVALID_ARGUMENT, "4096"},
      {{"transport=pinhole", "footprint=wide"}, ABBE_INVALID_ARGUMENT, "off"},
  };
  HELD(abbe_lib_scene, s) = opened(NULL, 0);
  for (size_t i = 0; i < COUNT(rows); i++) {
    abbe_lib_picture *p = NULL;
    REFUSED(rows[i].result, rows[i].says,
            abbe_lib_scene_render(s, rows[i].settings, 2, &p, &error));
    assert_null(p);
  }
}
