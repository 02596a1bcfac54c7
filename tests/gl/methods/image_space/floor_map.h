/* floor_map.h: maps on the level plane z = 0, for laws of what falls there. */
#ifndef ABBE_TESTS_GL_IMAGE_SPACE_FLOOR_MAP_H
#define ABBE_TESTS_GL_IMAGE_SPACE_FLOOR_MAP_H

#include "tests/gl/frame.h"

#include "base/maths.h"

static const abbe_render_desc units =
    FIELDS(.profile = ABBE_PROFILE_WYMAN2006_CIE, .width = 16, .height = 16, .photons = 1024,
           .map_size = 128, .fill = ABBE_FILL_GATHER_LIGHT, .space = ABBE_RGB_SPACE_XYZ);

/* A map on the level plane z = 0: where its texels' corners lie, and what they hold. */
typedef struct floor_map {
  abbe_image image;
  abbe_view view;
} floor_map;

static inline void make_floor_map(const char *text, const abbe_render_desc *desc, floor_map *out) {
  abbe_map_layout layout;
  *out = (floor_map){0};
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, desc);
  out->image = map_of(renderer, 0);
  abbe_renderer_map_layout(renderer, 0, &layout);
  out->view = layout.view;
}

/* At texels, the first row at the top; false where the ray does not come down to the floor. */
static inline bool floor_at(const floor_map *m, double column, double row, double out[3]) {
  const double uv[2] = {column / (double)m->image.width, 1 - row / (double)m->image.height};
  double o[3], d[3];
  abbe_view_ray(&m->view, uv, o, d);
  if (!(d[2] < 0)) return false;
  for (int k = 0; k < 3; k++) out[k] = o[k] - d[k] * o[2] / d[2];
  return true;
}

/* Of a texel: its middle on the floor, its area there, m2, and its irradiance. */
static inline bool texel_at(const floor_map *m, size_t x, size_t y, double at[3], double *area,
                            double *light) {
  double corner[4][3], diagonal[2][3], across[3];
  for (int k = 0; k < 4; k++)
    if (!floor_at(m, (double)x + (k == 1 || k == 2), (double)y + (k > 1), corner[k])) return false;
  if (!floor_at(m, (double)x + 0.5, (double)y + 0.5, at)) return false;
  abbe_vector_subtract(corner[2], corner[0], diagonal[0]);
  abbe_vector_subtract(corner[3], corner[1], diagonal[1]);
  abbe_vector_cross(diagonal[0], diagonal[1], across);
  *area = 0.5 * abbe_vector_length(across);
  *light = (double)m->image.data[(y * m->image.width + x) * m->image.channels + 1] / *area;
  return true;
}

#endif
