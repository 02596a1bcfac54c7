/* frame.h: small frames for tests: a renderer of a scene, its pictures and its map. */
#ifndef ABBE_TESTS_GL_FRAME_H
#define ABBE_TESTS_GL_FRAME_H

#include "tests/gl/gl_context.h"
#include "tests/scenes/scene_text.h"

#include "gl/renderer.h"

HOLDS(abbe_renderer);

/* Small, and complete: every pass runs as it does in a large one. */
static const abbe_render_desc small_frame = {
    .width = 64, .height = 64, .photons = 64, .map_size = 128};

/* How far it is from the view of p to that of the scene's refractors, rad. */
static inline double angle_to_refractors(const abbe_scene *scene, const double p[3]) {
  const double *eye = scene->camera.eye;
  double least = INFINITY;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    if (object->material == NULL) continue;
    double dot = 0, to_p = 0, to_object = 0;
    for (int c = 0; c < 3; c++) {
      const double a = p[c] - eye[c], b = 0.5 * (object->min[c] + object->max[c]) - eye[c];
      dot += a * b;
      to_p += a * a;
      to_object += b * b;
    }
    least = fmin(least, acos(fmax(-1, fmin(1, dot / sqrt(to_p * to_object)))));
  }
  return least;
}

/* Turns the camera to the corner of a receiver that is farthest from all refractors: where only
 * light counts, the camera's rays through them need no shader. */
static inline void look_aside(abbe_scene *scene) {
  double farthest = -1;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    for (size_t k = 0; object->material == NULL && k < object->mesh.vertex_count; k++) {
      double p[3];
      for (int c = 0; c < 3; c++)
        p[c] =
            0.97 * (double)object->mesh.position[k][c] + 0.015 * (object->min[c] + object->max[c]);
      const double angle = angle_to_refractors(scene, p);
      if (angle <= farthest) continue;
      farthest = angle;
      memcpy(scene->camera.target, p, sizeof p);
    }
  }
  scene->camera.fov_y_rad = 0.01;
}

static inline abbe_renderer *make_renderer(const abbe_scene *scene, const abbe_render_desc *desc) {
  abbe_renderer *renderer = NULL;
  OK(abbe_renderer_make(context, scene, desc, &renderer, &error));
  return renderer;
}

static inline abbe_statistics draw_frame(abbe_renderer *renderer) {
  abbe_statistics statistics;
  OK(abbe_renderer_frame(renderer, NULL, NULL, &statistics, &error));
  return statistics;
}

static inline abbe_renderer *drawn_renderer(const abbe_scene *scene, const abbe_render_desc *desc) {
  abbe_renderer *renderer = make_renderer(scene, desc);
  draw_frame(renderer);
  return renderer;
}

static inline abbe_image read_picture(abbe_renderer *renderer, bool aovs) {
  abbe_image image = {0};
  OK(abbe_renderer_read(renderer, aovs, &image, &error));
  return image;
}
static inline abbe_image picture_of(abbe_renderer *renderer) {
  return read_picture(renderer, false);
}
static inline abbe_image aovs_of(abbe_renderer *renderer) {
  return read_picture(renderer, true);
}

static inline void assert_finite(const abbe_image *image) {
  for (size_t i = 0; i < image->width * image->height * image->channels; i++)
    assert_true(isfinite(image->data[i]));
}

/* One frame of a scene that is given as text. */
static inline abbe_statistics draw_text(const char *text, const abbe_render_desc *desc,
                                        abbe_image *out) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, desc);
  const abbe_statistics statistics = draw_frame(renderer);
  *out = picture_of(renderer);
  assert_finite(out);
  return statistics;
}

static inline abbe_image map_of(abbe_renderer *renderer, size_t light) {
  abbe_image map = {0};
  OK(abbe_renderer_read_map(renderer, light, true, &map, &error));
  return map;
}

/* The map of one frame of a scene. */
static inline void make_map(const abbe_scene *scene, const abbe_render_desc *desc,
                            abbe_image *out) {
  abbe_scene aside = *scene;
  look_aside(&aside);
  HELD(abbe_renderer, renderer) = make_renderer(&aside, desc);
  draw_frame(renderer);
  *out = map_of(renderer, 0);
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

/* Of one channel, over all pixels. */
static inline double channel_mean(const abbe_image *image, const char *name) {
  const size_t channel = abbe_image_find_channel(image, name);
  assert_true(channel < image->channels);
  return image_sum(image, channel) / (double)(image->width * image->height);
}

#endif
