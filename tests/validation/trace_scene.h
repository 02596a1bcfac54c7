/* trace_scene.h: scenes and requests for tests of the tracer that are done in a moment. */
#ifndef ABBE_TESTS_VALIDATION_TRACE_SCENE_H
#define ABBE_TESTS_VALIDATION_TRACE_SCENE_H

#include "tests/scenes/scene_text.h"

#include "validation/trace/tracer/tracer.h"

/* Two small balls: they fill few of the cells that a light is aimed by, so that a tracer is made
 * in a moment. */
#define BEADS(material)                                                                            \
  "- {name: east, shape: sphere, radius: 0.02, levels: 2, transform: [{translate: [0.15, 0, "      \
  "0.1]}], material: " material "}\n"                                                              \
  "- {name: west, shape: sphere, radius: 0.02, levels: 2, transform: [{translate: [-0.15, 0, "     \
  "0.1]}], material: " material "}\n"

static inline abbe_tracer *make_tracer(const abbe_scene *scene, const abbe_trace_desc *desc) {
  abbe_tracer *tracer = NULL;
  OK(abbe_tracer_make(scene, desc, &tracer, &error));
  return tracer;
}

static inline void run_passes(abbe_tracer *tracer, size_t passes) {
  for (size_t i = 0; i < passes; i++) OK(abbe_tracer_pass(tracer, NULL, &error));
}

/* The picture, or the map, after so many passes. */
static inline abbe_image traced_picture(const abbe_scene *scene, const abbe_trace_desc *desc,
                                        size_t passes) {
  abbe_image out = {0};
  HELD(abbe_tracer, tracer) = make_tracer(scene, desc);
  run_passes(tracer, passes);
  OK(abbe_tracer_picture(tracer, &out, &error));
  return out;
}
static inline abbe_image traced_map(const abbe_scene *scene, const abbe_trace_desc *desc,
                                    size_t passes) {
  abbe_image out = {0};
  HELD(abbe_tracer, tracer) = make_tracer(scene, desc);
  run_passes(tracer, passes);
  OK(abbe_tracer_map(tracer, &out, &error));
  return out;
}

/* A progress function: counts its calls in an int, and ends the work at the first. */
static inline bool stop_at_once(void *user, double done) {
  assert_true(done >= 0 && done <= 1);
  ++*(int *)user;
  return false;
}

/* Sum of a channel over all pixels. */
static inline double channel_sum(const abbe_image *image, const char *name) {
  size_t channel = abbe_image_find_channel(image, name);
  assert_true(channel < image->channels);
  double sum = 0;
  for (size_t i = 0; i < image->width * image->height; i++)
    sum += (double)image->data[i * image->channels + channel];
  return sum;
}

static inline void check_same_image(const abbe_image *a, const abbe_image *b) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  assert_int_equal(a->channels, b->channels);
  assert_memory_equal(a->data, b->data, a->width * a->height * a->channels * sizeof *a->data);
}

#endif
