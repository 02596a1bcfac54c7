#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/tracer_state.h"
#include "validation/trace/walks/camera.h"

enum { SIDE = 40 };
#define BUBBLE                                                                                     \
  "- {name: ball, shape: sphere, radius: 0.1, transform: [{translate: [0, 0, 0.2]}], material: "   \
  "crown}\n"

typedef struct fixture {
  abbe_scene scene;
  abbe_tracer *tracer;
  uint8_t samples[SIDE * SIDE];
} fixture;

static void share(const char *text, double rays, size_t threads, fixture *f) {
  f->scene = scene_of(text);
  f->tracer = make_tracer(
      &f->scene,
      &(abbe_trace_desc){
          .width = SIDE, .height = SIDE, .no_map = true, .threads = threads, .photons = 64});
  abbe_eye_samples_share(&f->tracer->geometry, &f->tracer->camera, rays, threads, f->samples);
}

static void fixture_free(fixture *f) {
  abbe_tracer_free(f->tracer);
  abbe_scene_free(&f->scene);
}

/* How many pixels take so many samples. */
static size_t count(const fixture *f, uint8_t samples) {
  size_t n = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++) n += f->samples[i] == samples;
  return n;
}

/* Every pixel that may show the ball has its share, what is well off it has one. */
TEST(glass_takes_more_samples) {
  FILLED(fixture, f, share(CAMERA POINT_LIGHT FLOOR BUBBLE, 1e9, 1, &f));
  size_t most = count(&f, ABBE_EYE_MOST_SAMPLES), seen = 0;
  assert_int_equal(most + count(&f, 1), SIDE * SIDE);
  for (size_t pixel = 0; pixel < SIDE * SIDE; pixel++)
    for (uint32_t pass = 0; pass < 40; pass++) {
      abbe_eye_sample s;
      abbe_eye_walk_pixel(&f.tracer->eye, pixel, pass, &s);
      if (!s.refractor) continue;
      assert_int_equal(f.samples[pixel], ABBE_EYE_MOST_SAMPLES);
      seen++;
      break;
    }
  assert_true(seen > 40 && most < 2 * seen);
}

/* As many as the rays allow, and one where they allow none. */
TEST(rays_are_shared_out) {
  FILLED(fixture, f, share(CAMERA POINT_LIGHT FLOOR BUBBLE, 1e9, 1, &f));
  double pixels = (double)count(&f, ABBE_EYE_MOST_SAMPLES);
  for (int samples = 2; samples < ABBE_EYE_MOST_SAMPLES; samples += 5) {
    double rays = (samples + 0.4) * 32 * pixels / (1 + 4 * pixels / (SIDE * SIDE));
    abbe_eye_samples_share(&f.tracer->geometry, &f.tracer->camera, rays, 1, f.samples);
    assert_int_equal(count(&f, (uint8_t)samples), (size_t)pixels);
  }
  abbe_eye_samples_share(&f.tracer->geometry, &f.tracer->camera, 10, 1, f.samples);
  assert_int_equal(count(&f, 1), SIDE * SIDE);
}

TEST(no_glass_takes_one) {
  FILLED(fixture, f, share(CAMERA POINT_LIGHT FLOOR, 1e9, 1, &f));
  assert_int_equal(count(&f, 1), SIDE * SIDE);
}

TEST(threads_do_not_matter) {
  FILLED(fixture, a, share(CAMERA POINT_LIGHT FLOOR RING("crown"), 1e9, 1, &a));
  FILLED(fixture, b, share(CAMERA POINT_LIGHT FLOOR RING("crown"), 1e9, 3, &b));
  assert_memory_equal(a.samples, b.samples, sizeof a.samples);
}
