#include "validation/trace/transport/reflectance.h"

#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* ---- tables ---- */

/* Objects of one spectrum share a set. */
static void number_sets(const abbe_scene *scene, const abbe_spectrum **spectrum,
                        abbe_reflectance *r) {
  r->sets = 1;
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].spectrum != NULL) {
      spectrum[r->sets] = scene->object[i].spectrum;
      r->set[i] = (uint32_t)r->sets++;
    }
}

static void set_white(const abbe_spectral_sampling *s, size_t light, const double from_xyz[9],
                      const float (*step)[3], float white[3][3]) {
  for (int j = 0; j < 3; j++) {
    double sum[3] = {0};
    for (size_t k = 0; k < s->steps; k++)
      for (int c = 0; c < 3; c++)
        sum[c] += (double)step[k][j] * (double)s->xyz[light * s->steps + k][c];
    abbe_rgb_space_apply(from_xyz, sum, sum);
    for (int c = 0; c < 3; c++) white[j][c] = (float)(sum[c] / (double)s->steps);
  }
}

/* By the power that the steps carry, or evenly where they carry none. */
static void set_bands(const abbe_spectral_sampling *s, const abbe_bands *b, size_t light,
                      const float (*step)[3], float (*band)[3]) {
  double sum[ABBE_BANDS_MAX][4] = {{0}};
  for (size_t k = 0; k < s->steps; k++) {
    double *to = sum[b->of_step[k]];
    const double power = (double)s->power[light * s->steps + k] + 1e-30;
    for (int j = 0; j < 3; j++) to[j] += power * (double)step[k][j];
    to[3] += power;
  }
  for (size_t i = 0; i < b->count; i++)
    for (int j = 0; j < 3; j++) band[i][j] = sum[i][3] > 0 ? (float)(sum[i][j] / sum[i][3]) : 0;
}

static void set_lifted(const abbe_spectral_sampling *s, const abbe_environment_light *e,
                       const double from_xyz[9], const float (*step)[3], float lifted[3][3][3]) {
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3; i++) {
      double sum[3] = {0};
      for (size_t k = 0; k < s->steps; k++)
        for (int c = 0; c < 3; c++)
          sum[c] += (double)step[k][j] * (double)e->lift[k][i] *
                    (double)s->xyz[e->light * s->steps + k][c];
      abbe_rgb_space_apply(from_xyz, sum, sum);
      for (int c = 0; c < 3; c++) lifted[j][i][c] = (float)(sum[c] / (double)s->steps);
    }
}

static void set_whiten(const abbe_spectral_sampling *s, abbe_rgb_space space,
                       const double from_xyz[9], float whiten[9]) {
  double to_xyz[9], white[3] = {1, 1, 1}, scaled[9], matrix[9];
  abbe_rgb_space_to_xyz(space, to_xyz);
  abbe_rgb_space_apply(to_xyz, white, white);
  for (int row = 0; row < 3; row++)
    for (int k = 0; k < 3; k++)
      scaled[3 * row + k] =
          s->white[0][row] > 0 ? to_xyz[3 * row + k] * white[row] / s->white[0][row] : 0;
  abbe_matrix3_multiply(from_xyz, scaled, matrix);
  for (int i = 0; i < 9; i++) whiten[i] = (float)matrix[i];
}

static void fill(const abbe_spectral_sampling *s, const abbe_bands *b,
                 const abbe_environment_light *e, const double from_xyz[9],
                 const abbe_spectrum *const *spectrum, abbe_reflectance *r) {
  for (size_t set = 0; set < r->sets; set++) {
    float(*step)[3] = r->step + set * s->steps;
    for (size_t k = 0; k < s->steps; k++) {
      double share[3];
      abbe_reflectance_channels(spectrum[set], 0.5 * (s->lambda_nm[k] + s->lambda_nm[k + 1]),
                                share);
      for (int j = 0; j < 3; j++) step[k][j] = (float)share[j];
    }
    const float(*of)[3] = (const float(*)[3])step;
    for (size_t l = 0; l < s->lights; l++) {
      set_white(s, l, from_xyz, of, r->white[set * s->lights + l]);
      if (b->count > 0) set_bands(s, b, l, of, r->band + (set * s->lights + l) * b->count);
    }
    if (e->environment != NULL) set_lifted(s, e, from_xyz, of, r->lifted[set]);
  }
}

abbe_result abbe_reflectance_make(const abbe_geometry *geometry, const abbe_spectral_sampling *s,
                                  const abbe_bands *bands,
                                  const abbe_environment_light *environment, abbe_rgb_space space,
                                  abbe_reflectance *out, abbe_error *error) {
  assert(geometry->scene);
  const size_t objects = geometry->scene->object_count;
  double from_xyz[9];
  abbe_rgb_space_from_xyz(space, from_xyz);
  *out = (abbe_reflectance){
      .geometry = geometry, .steps = s->steps, .lights = s->lights, .bands = bands->count};
  const abbe_spectrum **spectrum = calloc(objects + 1, sizeof *spectrum);
  out->set = calloc(objects + 1, sizeof *out->set);
  if (spectrum != NULL && out->set != NULL) {
    number_sets(geometry->scene, spectrum, out);
    out->step = calloc(out->sets * s->steps + 1, sizeof *out->step);
    out->white = calloc(out->sets * s->lights + 1, sizeof *out->white);
    out->band = calloc(out->sets * s->lights * bands->count + 1, sizeof *out->band);
    out->lifted = calloc(out->sets, sizeof *out->lifted);
  }
  if (!out->step || !out->white || !out->band || !out->lifted) {
    free(spectrum);
    abbe_reflectance_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for reflectances");
  }
  fill(s, bands, environment, from_xyz, spectrum, out);
  set_whiten(s, space, from_xyz, out->whiten);
  free(spectrum);
  return ABBE_OK;
}

void abbe_reflectance_free(abbe_reflectance *r) {
  if (r == NULL) return;
  free(r->set);
  free(r->step);
  free(r->white);
  free(r->band);
  free(r->lifted);
  *r = (abbe_reflectance){0};
}

/* ---- a place ---- */

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

void abbe_reflectance_find(const abbe_reflectance *r, uint32_t surface, uint32_t face, float u,
                           float v, abbe_reflected *out) {
  const abbe_surface *s = &r->geometry->surface[surface];
  const abbe_object *object = &r->geometry->scene->object[s->object];
  out->set = r->set[s->object];
  for (int k = 0; k < 3; k++) out->share[k] = (float)object->reflectance[k];
  if (object->spectrum != NULL) {
    out->share[0] = 1;
    out->share[1] = out->share[2] = 0;
    return;
  }
  if (object->texture.data == NULL || s->uv == NULL || s->sphere) return;
  multiply_by_texture(object, s, face, u, v, out->share);
}

static float share_of(const abbe_reflected *of, const float channel[3]) {
  return of->share[0] * channel[0] + of->share[1] * channel[1] + of->share[2] * channel[2];
}

float abbe_reflectance_at_step(const abbe_reflectance *r, const abbe_reflected *of, uint32_t step) {
  return share_of(of, r->step[of->set * r->steps + step]);
}

float abbe_reflectance_in_band(const abbe_reflectance *r, const abbe_reflected *of, size_t light,
                               size_t band) {
  return share_of(of, r->band[(of->set * r->lights + light) * r->bands + band]);
}

void abbe_reflectance_of_white(const abbe_reflectance *r, const abbe_reflected *of, size_t light,
                               float out[3]) {
  const float(*white)[3] = (const float(*)[3])r->white[of->set * r->lights + light];
  for (int k = 0; k < 3; k++)
    out[k] = of->share[0] * white[0][k] + of->share[1] * white[1][k] + of->share[2] * white[2][k];
}

void abbe_reflectance_of_lifted(const abbe_reflectance *r, const abbe_reflected *of,
                                const float rgb[3], float out[3]) {
  const float(*lifted)[3][3] = (const float(*)[3][3])r->lifted[of->set];
  for (int k = 0; k < 3; k++) {
    out[k] = 0;
    for (int j = 0; j < 3; j++)
      for (int i = 0; i < 3; i++) out[k] += of->share[j] * rgb[i] * lifted[j][i][k];
  }
}

void abbe_reflectance_whiten(const abbe_reflectance *r, const float colour[3], float out[3]) {
  const float *m = r->whiten, c[3] = {colour[0], colour[1], colour[2]};
  for (int k = 0; k < 3; k++) out[k] = m[3 * k] * c[0] + m[3 * k + 1] * c[1] + m[3 * k + 2] * c[2];
}
