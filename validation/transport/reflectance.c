#include "validation/transport/reflectance.h"

void abbe_reflectance_make(const abbe_geometry *geometry, abbe_rgb_space space,
                           abbe_reflectance *out) {
  double to_xyz[9], from_xyz[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  abbe_rgb_space_from_xyz(space, from_xyz);
  *out = (abbe_reflectance){.geometry = geometry};
  for (int i = 0; i < 3; i++) {
    double column[3] = {to_xyz[i], to_xyz[3 + i], to_xyz[6 + i]};
    abbe_rgb_space_apply(from_xyz, column, column);
    for (int k = 0; k < 3; k++) out->to_space[3 * k + i] = (float)column[k];
  }
  /* of white: greys are neutral also where the space's white is not (1, 1, 1), as in XYZ */
  for (int k = 0; k < 3; k++) {
    float *row = &out->to_space[3 * k], white = row[0] + row[1] + row[2];
    for (int i = 0; i < 3; i++) row[i] /= white;
  }
}

/* Bilinear, repeated; v runs upwards, rows downwards. */
static void sample(const abbe_image *t, double u, double v, float out[3]) {
  double x = u * (double)t->width - 0.5, y = (1 - v) * (double)t->height - 0.5;
  double left = floor(x), top = floor(y);
  float fx = (float)(x - left), fy = (float)(y - top);
  for (int k = 0; k < 3; k++) out[k] = 0;
  for (int i = 0; i < 4; i++) {
    double column = fmod(left + (i & 1), (double)t->width);
    double row = fmod(top + (i >> 1), (double)t->height);
    if (column < 0) column += (double)t->width;
    if (row < 0) row += (double)t->height;
    const float *texel = t->data + ((size_t)row * t->width + (size_t)column) * t->channels;
    float weight = (i & 1 ? fx : 1 - fx) * (i >> 1 ? fy : 1 - fy);
    for (size_t k = 0; k < 3; k++) out[k] += weight * texel[k];
  }
}

/* Apart, so that the many receivers without a texture do not wait for its registers. */
__attribute__((noinline)) static void multiply_by_texture(const abbe_object *object,
                                                          const abbe_surface *s, uint32_t face,
                                                          float u, float v, float out[3]) {
  const uint32_t *f = s->face[face];
  double at[2];
  for (int k = 0; k < 2; k++)
    at[k] = object->texture_repeat[k] *
            (s->uv[f[0]][k] + (double)u * (s->uv[f[1]][k] - s->uv[f[0]][k]) +
             (double)v * (s->uv[f[2]][k] - s->uv[f[0]][k]));
  float texel[3];
  sample(&object->texture, at[0], at[1], texel);
  for (int k = 0; k < 3; k++) out[k] *= texel[k];
}

void abbe_reflectance_rec709(const abbe_reflectance *r, uint32_t surface, uint32_t face, float u,
                             float v, float out[3]) {
  const abbe_surface *s = &r->geometry->surface[surface];
  const abbe_object *object = &r->geometry->scene->object[s->object];
  for (int k = 0; k < 3; k++) out[k] = (float)object->reflectance[k];
  if (object->texture.data == NULL || s->uv == NULL || s->sphere) return;
  multiply_by_texture(object, s, face, u, v, out);
}

void abbe_reflectance_at(const abbe_reflectance *r, uint32_t surface, uint32_t face, float u,
                         float v, float out[3]) {
  float c[3];
  abbe_reflectance_rec709(r, surface, face, u, v, c);
  for (int k = 0; k < 3; k++)
    out[k] =
        r->to_space[3 * k] * c[0] + r->to_space[3 * k + 1] * c[1] + r->to_space[3 * k + 2] * c[2];
}
