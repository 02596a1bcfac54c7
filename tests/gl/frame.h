/* frame.h: small frames for tests: a renderer of a scene, its pictures and its map. */
#ifndef ABBE_TESTS_GL_FRAME_H
#define ABBE_TESTS_GL_FRAME_H

#include "tests/gl/gl_context.h"
#include "tests/scenes/scene_text.h"

#include "gl/renderer.h"

/* Small, and complete: every pass runs as it does in a large one. */
static const abbe_render_desc small_frame = {
    .width = 64, .height = 64, .photons = 64, .map_size = 128};

static inline void assert_ok(abbe_result result, const abbe_error *error) {
  if (result != ABBE_OK) print_error("%s\n", error->text);
  assert_int_equal(result, ABBE_OK);
}

static inline abbe_renderer *make_renderer(const abbe_scene *scene, const abbe_render_desc *desc) {
  abbe_renderer *renderer = NULL;
  abbe_error error = {0};
  assert_ok(abbe_renderer_make(context, scene, desc, &renderer, &error), &error);
  return renderer;
}

static inline abbe_statistics draw_frame(abbe_renderer *renderer) {
  abbe_statistics statistics;
  abbe_error error = {0};
  assert_ok(abbe_renderer_frame(renderer, NULL, NULL, &statistics, &error), &error);
  return statistics;
}

static inline void read_picture(abbe_renderer *renderer, bool aovs, abbe_image *out) {
  abbe_error error = {0};
  assert_ok(abbe_renderer_read(renderer, aovs, out, &error), &error);
}

static inline void read_map(abbe_renderer *renderer, size_t light, abbe_image *out) {
  abbe_error error = {0};
  assert_ok(abbe_renderer_read_map(renderer, light, true, out, &error), &error);
}

/* The map of one frame of a scene. */
static inline void make_map(const abbe_scene *scene, const abbe_render_desc *desc,
                            abbe_image *out) {
  abbe_renderer *renderer = make_renderer(scene, desc);
  draw_frame(renderer);
  read_map(renderer, 0, out);
  abbe_renderer_free(renderer);
}

static inline void assert_same_pixels(const abbe_image *a, const abbe_image *b) {
  assert_int_equal(a->width * a->height * a->channels, b->width * b->height * b->channels);
  assert_memory_equal(a->data, b->data, a->width * a->height * a->channels * sizeof *a->data);
}

static inline double image_sum(const abbe_image *image, size_t channel) {
  double sum = 0;
  for (size_t i = 0; i < image->width * image->height; i++)
    sum += (double)image->data[i * image->channels + channel];
  return sum;
}

static inline double image_max(const abbe_image *image, size_t channel) {
  double most = -INFINITY;
  for (size_t i = 0; i < image->width * image->height; i++)
    most = fmax(most, (double)image->data[i * image->channels + channel]);
  return most;
}

static inline void assert_finite(const abbe_image *image) {
  for (size_t i = 0; i < image->width * image->height * image->channels; i++)
    assert_true(isfinite(image->data[i]));
}

#endif
