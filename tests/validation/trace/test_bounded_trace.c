/* A traced picture that goes on until its own error keeps a bound: how many passes, and that the
 * picture is the tracer's own to the bit.
 */
#include "tests/validation/trace_scene.h"

#include "validation/trace/checked_picture.h"
#include "validation/trace/denoise.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")

static abbe_scene scene;

static abbe_bounded_trace_desc describe(size_t passes, bool filtered, double max_error) {
  return (abbe_bounded_trace_desc){
      .trace = {.no_map = true, .width = 24, .height = 24, .photons = 1024, .seed = 3},
      .passes = passes,
      .filtered = filtered,
      .max_error = max_error};
}

static abbe_bounded_trace make(const abbe_bounded_trace_desc *desc, abbe_image *picture) {
  abbe_bounded_trace out;
  OK(abbe_bounded_trace_make(&scene, desc, picture, &out, &error));
  return out;
}

/* The tracer's own after so many passes. */
static void check_picture(const abbe_bounded_trace_desc *desc, size_t passes,
                          const abbe_image *picture) {
  abbe_trace_desc own = desc->trace;
  abbe_image filtered;
  own.guides = desc->filtered;
  OWNED(abbe_image, raw) = traced_picture(&scene, &own, passes);
  const abbe_denoise_desc denoise = {0};
  if (desc->filtered) {
    OK(abbe_denoise_picture(&raw, &denoise, &filtered, &error));
    check_same_image(picture, &filtered);
    abbe_image_free(&filtered);
  } else {
    check_same_image(picture, &raw);
  }
}

static void begin(void) {
  scene = scene_of(SCENE);
}

static void finish(void) {
  abbe_scene_free(&scene);
}

GROUP(begin, finish);

TEST(without_a_bound) {
  OWNED(abbe_image, picture);
  abbe_bounded_trace_desc desc = describe(4, false, 0);
  abbe_bounded_trace t = make(&desc, &picture);
  assert_int_equal(t.passes, 4);
  assert_true(t.own.estimate > 0 && t.own.bound > t.own.estimate);
  check_picture(&desc, 4, &picture);
  abbe_image_free(&picture);
  desc.passes = 1;
  t = make(&desc, &picture);
  assert_int_equal(t.passes, 1);
  assert_true(isnan(t.own.estimate));
  abbe_image_free(&picture);
  desc = describe(2, true, 0);
  t = make(&desc, &picture);
  assert_true(isnan(t.own.estimate)); /* nobody asked, and it takes another filter's run */
  check_picture(&desc, 2, &picture);
}

TEST(until_it_is_kept) {
  for (int filtered = 0; filtered < 2; filtered++) {
    OWNED(abbe_image, picture);
    abbe_bounded_trace_desc desc = describe(2, filtered, 1000);
    abbe_bounded_trace t = make(&desc, &picture);
    assert_int_equal(t.passes, filtered ? 4 : 2);
    assert_true(t.own.bound < 1000);
    abbe_image_free(&picture);
    desc.max_error = 0.6 * t.own.bound;
    t = make(&desc, &picture);
    assert_true(t.passes >= 4 && t.passes % 2 == 0);
    if (!(t.own.bound <= desc.max_error))
      fail_msg("%zu passes: %g, of %g", t.passes, t.own.bound, desc.max_error);
    check_picture(&desc, t.passes, &picture);
    abbe_image_free(&picture);
    /* What takes too long is given up before, not after. */
    desc.max_error = 1e-3;
    t = make(&desc, &picture);
    assert_int_equal(t.passes, filtered ? 4 : 2);
    assert_true(t.own.bound > desc.max_error);
  }
}

TEST(what_ends_it) {
  int asked = 0;
  abbe_image picture;
  abbe_bounded_trace t;
  abbe_bounded_trace_desc desc = describe(4, false, 1);
  desc.progress = stop_at_once;
  desc.user = &asked;
  REFUSED(ABBE_CANCELLED, "", abbe_bounded_trace_make(&scene, &desc, &picture, &t, &error));
  assert_int_equal(asked, 1);
  desc = describe(1, true, 0);
  REFUSED(ABBE_INVALID_ARGUMENT, "1 passes are too few, at least 2",
          abbe_bounded_trace_make(&scene, &desc, &picture, &t, &error));
}
