/* Passes until enough are done: by number, by error, by time, and by whoever stops them. */
#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/light_pass.h"
#include "validation/trace/tracer/trace_run.h"

#include <unistd.h>

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")
static const abbe_trace_desc small = {
    .width = 8, .height = 8, .map_width = 8, .map_height = 8, .photons = 4096, .threads = 2};

typedef struct watch {
  size_t left;
  double last;
} watch;

static bool look(void *user, double done) {
  watch *w = user;
  assert_true(done >= w->last && done <= 1);
  w->last = done;
  return w->left > 0 && w->left-- > 0;
}

TEST(what_ends_a_run) {
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  HELD(abbe_tracer, t) = make_tracer(&scene, &small);
  watch w = {.left = 2};
  abbe_trace_run_desc run = {.passes = 5, .checkpoint_s = 1e9, .progress = look, .user = &w};
  REFUSED(ABBE_CANCELLED, "stopped after 2 of 5 passes", abbe_trace_run(t, &run, &error));
  w = (watch){.left = 99};
  OK(abbe_trace_run(t, &run, &error));
  assert_int_equal(abbe_tracer_passes(t), 5);
  /* Any error is reached by four passes, any time is over after two: there are more already. */
  run = (abbe_trace_run_desc){.error = 1e9, .checkpoint_s = 1e9};
  OK(abbe_trace_run(t, &run, &error));
  run = (abbe_trace_run_desc){.seconds = 1e-9, .checkpoint_s = 1e9};
  OK(abbe_trace_run(t, &run, &error));
  assert_int_equal(abbe_tracer_passes(t), 5);
  abbe_tracer_free(t);
  t = make_tracer(&scene, &small);
  OK(abbe_trace_run(t, &run, &error));
  assert_int_equal(abbe_tracer_passes(t), 2);
  run = (abbe_trace_run_desc){.error = 1e9, .checkpoint_s = 1e9};
  OK(abbe_trace_run(t, &run, &error));
  assert_int_equal(abbe_tracer_passes(t), 4);
}

TEST(checkpoints) {
  char path[64];
  snprintf(path, sizeof path, "/tmp/abbe_test_trace_run_%ld", (long)getpid());
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  HELD(abbe_tracer, t) = make_tracer(&scene, &small);
  HELD(abbe_tracer, again) = make_tracer(&scene, &small);
  abbe_trace_run_desc run = {.passes = 2, .checkpoint = path};
  OK(abbe_trace_keep(t, &run, &error)); /* no pass: nothing to keep */
  assert_int_equal(access(path, F_OK), -1);
  OK(abbe_trace_run(t, &run, &error));
  OK(abbe_checkpoint_load(again, path, &error));
  assert_int_equal(abbe_tracer_passes(again), 2);
  unlink(path);
  run.checkpoint = "/no/such/folder/c";
  run.passes = 3;
  REFUSED(ABBE_IO, "", abbe_trace_run(t, &run, &error));
}

/* Whoever asks for an end has it before another ray is traced, whatever is being made. */
TEST(an_end_is_heard_everywhere) {
  volatile int stop = 0;
  abbe_trace_desc desc = small;
  OWNED(abbe_image, image);
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  desc.stop = &stop;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  run_passes(tracer, 2);
  stop = 1;
  const uint64_t walked = abbe_tracer_walk_rays(tracer);
  REFUSED(ABBE_CANCELLED, "", abbe_tracer_pass(tracer, &stop, &error));
  assert_true(abbe_tracer_walk_rays(tracer) == walked);
  REFUSED(ABBE_CANCELLED, "", abbe_tracer_picture(tracer, &image, &error));
  assert_null(image.data);
  REFUSED(ABBE_CANCELLED, "", abbe_tracer_map(tracer, &image, &error));
  abbe_tracer *other = NULL;
  REFUSED(ABBE_CANCELLED, "", abbe_tracer_make(&scene, &desc, &other, &error));
  assert_null(other);
  stop = 0;
  OK(abbe_tracer_picture(tracer, &image, &error));
}
