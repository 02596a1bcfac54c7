#include "base/maths.h"
#include "spectral/polarisation.h"
#include "validation/trace/transport/double_refraction.h"

#include <math.h>
#include <string.h>

typedef double complex number;

static const double grazing = 1e-6; /* below, all of it is reflected */

/* Light along a ray has its x and y where abbe_geometry_across has them. */
typedef struct frame {
  double x[3], y[3], z[3];
} frame;

static frame frame_of(const float d[3]) {
  frame f;
  float x[3], y[3];
  abbe_geometry_across(d, x, y);
  for (int k = 0; k < 3; k++) {
    f.x[k] = (double)x[k];
    f.z[k] = (double)d[k];
  }
  abbe_vector_normalise(f.z);
  abbe_vector_cross(f.z, f.x, f.y);
  abbe_vector_normalise(f.y);
  abbe_vector_cross(f.y, f.z, f.x);
  return f;
}

static void take(const float stokes[3], double out[4]) {
  out[0] = 1;
  for (int i = 0; i < 3; i++) out[i + 1] = (double)stokes[i];
}

/* Over I; rounding does not polarise more than wholly. */
static void give(const double s[4], float out[3]) {
  const double degree = fmax(abbe_stokes_degree(s), 1);
  for (int i = 0; i < 3; i++) out[i] = s[0] > 0 ? (float)(s[i + 1] / (s[0] * degree)) : 0;
}

/* ---- waves that leave a face ---- */

/* Amplitudes of four waves, reflected and transmitted ones, of the one or two that come: their
 * squares are shares of the power. */
typedef struct meeting {
  number amplitude[4][2];
  double field[4][3], ray[4][3]; /* unit; the field of what travels */
  double comes[2][3];            /* fields of s and p that come from an isotropic medium */
  uint8_t wave[4];
} meeting;

static number amplitude_of(const double amplitude[2], double share) {
  const number a = amplitude[0] + I * amplitude[1];
  const double size = cabs(a);
  return share > 0 && size > 0 ? a / size * sqrt(share) : 0;
}

static void add_wave(meeting *m, int i, int comes, number amplitude, const double field[3],
                     const double ray[3]) {
  m->amplitude[i][comes] = amplitude;
  if (amplitude == 0 && comes > 0) return;
  memcpy(m->field[i], field, sizeof m->field[i]);
  memcpy(m->ray[i], ray, sizeof m->ray[i]);
  m->wave[i] = (uint8_t)(i & 1);
}

static void meet_uniaxial(const abbe_uniaxial media[2], const double n[3], const double ray[3],
                          uint8_t wave, meeting *m) {
  abbe_uniaxial_split split[2];
  const bool crystal = media[0].n_o != media[0].n_e;
  if (crystal)
    abbe_uniaxial_meet(&media[0], &media[1], n, (abbe_uniaxial_mode)wave, ray, split);
  else
    abbe_uniaxial_meet_both(&media[0], &media[1], n, ray, split);
  for (int c = 0; c < (crystal ? 1 : 2); c++) {
    memcpy(m->comes[c], split[c].field, sizeof m->comes[c]);
    for (int i = 0; i < 4; i++) {
      const abbe_uniaxial_wave *w = i < 2 ? &split[c].reflected[i] : &split[c].transmitted[i - 2];
      add_wave(m, i, c, amplitude_of(w->amplitude, w->share), w->field, w->ray);
    }
  }
}

static bool is_isotropic(const abbe_biaxial *m) {
  return m->n[0] == m->n[1] && m->n[1] == m->n[2];
}

static void meet_biaxial(const abbe_biaxial media[2], const double n[3], const double ray[3],
                         uint8_t wave, const abbe_biaxial_film *film, meeting *m) {
  abbe_biaxial_split split[2];
  const bool crystal = !is_isotropic(&media[0]);
  if (crystal)
    abbe_biaxial_meet(&media[0], &media[1], n,
                      (abbe_biaxial_mode)abbe_wave_ways_rename(&media[0], wave), ray, film, split);
  else
    abbe_biaxial_meet_both(&media[0], &media[1], n, ray, film, split);
  for (int c = 0; c < (crystal ? 1 : 2); c++) {
    memcpy(m->comes[c], split[c].field, sizeof m->comes[c]);
    for (int i = 0; i < 4; i++) {
      const abbe_biaxial_wave *w = i < 2 ? &split[c].reflected[i] : &split[c].transmitted[i - 2];
      add_wave(m, i, c, amplitude_of(w->amplitude, w->share), w->state.field, w->state.ray);
      if (w->share > 0) m->wave[i] = (uint8_t)abbe_wave_ways_rename(&media[i / 2], (int)w->mode);
    }
  }
}

/* Between isotropic media; s and p of each ray are the waves. */
static void meet_isotropic(const double index[2], const double n[3], const double d[3],
                           const abbe_biaxial_film *film, meeting *m) {
  const double cos_i = fmin(fmax(-abbe_vector_dot(d, n), 0), 1), eta = index[0] / index[1];
  const double square = (1 - eta) * (1 + eta) + eta * eta * cos_i * cos_i;
  const double cos_t = sqrt(fmax(square, 0)), to[2] = {index[1], 0};
  abbe_film_light light;
  abbe_film_light_at(film ? film->layer : NULL, film ? film->count : 0, film && film->reversed,
                     index[0], to, cos_i, film ? film->lambda_nm : 1, &light);
  if (cos_i < grazing) light = (abbe_film_light){.r = {{-1, 0}, {-1, 0}}};
  double s[3], p[3], ray[3];
  abbe_vector_cross(d, n, s);
  if (!(abbe_vector_length(s) > 1e-9)) { /* head on: any direction does */
    const double any[3] = {fabs(d[0]) < 0.6, !(fabs(d[0]) < 0.6), 0};
    abbe_vector_cross(d, any, s);
  }
  abbe_vector_normalise(s);
  for (int side = 0; side < 2; side++) {
    const double along = side == 0 ? 2 * cos_i : eta * cos_i - cos_t, stretch = side == 0 ? 1 : eta;
    double(*a)[2] = side == 0 ? light.r : light.t;
    for (int k = 0; k < 3; k++) ray[k] = stretch * d[k] + along * n[k];
    abbe_vector_normalise(ray);
    abbe_vector_cross(ray, s, p);
    abbe_vector_normalise(p);
    for (int c = 0; c < 2; c++)
      add_wave(m, 2 * side + c, c, a[c][0] + I * a[c][1], c == 0 ? s : p, ray);
  }
  memcpy(m->comes[0], s, sizeof s);
  abbe_vector_cross(d, s, m->comes[1]);
}

static void meet(const abbe_media *m, const abbe_wave_face *face, uint32_t step, float within,
                 const double n[3], const double d[3], meeting *out) {
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_biaxial_film made = {.layer = layer, .reversed = !face->entering}, *film = NULL;
  if (face->film >= 0) {
    film = &made;
    film->count = m->films.layers[face->film];
    film->lambda_nm = abbe_films_at(&m->films, face->film, step, within, layer);
  }
  *out = (meeting){0};
  const bool clings = !(abbe_vector_dot(d, n) < -grazing);
  if (!abbe_media_is_crystal(m, face->from) && (clings || !abbe_media_is_crystal(m, face->to))) {
    const double index[2] = {(double)abbe_media_n(m, face->from, step, within),
                             (double)abbe_media_n(m, face->to, step, within)};
    meet_isotropic(index, n, d, film, out);
  } else if (film != NULL || abbe_media_is_biaxial(m, face->from) ||
             abbe_media_is_biaxial(m, face->to)) {
    abbe_biaxial media[2];
    abbe_media_place(m, face->from, step, within, &media[0]);
    abbe_media_place(m, face->to, step, within, &media[1]);
    meet_biaxial(media, n, d, face->wave, film, out);
  } else {
    abbe_uniaxial media[2];
    abbe_media_crystal(m, face->from, step, within, &media[0]);
    abbe_media_crystal(m, face->to, step, within, &media[1]);
    meet_uniaxial(media, n, d, face->wave, out);
  }
}

/* ---- the ways on ---- */

static void put(abbe_wave_ways *out, double share, const double ray[3], uint8_t wave,
                bool reflected, abbe_wave_way **way) {
  const double least = 1e-30; /* single precision has no less */
  *way = NULL;
  if (!(share > least)) return;
  *way = &out->way[out->count++];
  **way = (abbe_wave_way){.share = (float)share, .wave = wave, .reflected = reflected};
  for (int k = 0; k < 3; k++) (*way)->d[k] = (float)ray[k];
}

/* Each wave of a crystal by itself: `comes` has the amplitudes of what came in x and y. */
static void leave_as_waves(const meeting *m, int first, number comes[4][2], const double in[4],
                           abbe_wave_ways *out) {
  for (int i = first; i < first + 2; i++) {
    const abbe_jones j = {{{comes[i][0], comes[i][1]}, {0, 0}}};
    abbe_wave_way *way;
    double s[4];
    abbe_jones_apply(&j, in, s);
    put(out, s[0], m->ray[i], m->wave[i], first == 0, &way);
  }
}

/* Both waves of an isotropic medium as light along one ray. */
static void leave_as_light(const meeting *m, int first, number comes[4][2], const double in[4],
                           abbe_wave_ways *out) {
  const bool second = m->amplitude[first][0] == 0 && m->amplitude[first][1] == 0;
  const double *ray = m->ray[second ? first + 1 : first];
  const float d[3] = {(float)ray[0], (float)ray[1], (float)ray[2]};
  if (!(abbe_vector_length(ray) > 0)) return;
  const frame f = frame_of(d);
  abbe_jones j = {{{0}}};
  for (int i = first; i < first + 2; i++)
    for (int c = 0; c < 2; c++) {
      j.m[0][c] += abbe_vector_dot(m->field[i], f.x) * comes[i][c];
      j.m[1][c] += abbe_vector_dot(m->field[i], f.y) * comes[i][c];
    }
  abbe_wave_way *way;
  double s[4];
  abbe_jones_apply(&j, in, s);
  put(out, s[0], ray, 0, first == 0, &way);
  if (way != NULL) give(s, way->stokes);
}

static void polarised_ways(const abbe_media *media, const abbe_wave_face *face, uint32_t step,
                           float within, abbe_wave_ways *out) {
  const frame f = frame_of(face->d);
  const bool crystal = abbe_media_is_crystal(media, face->from);
  double n[3], in[4] = {1, 1, 0, 0};
  for (int k = 0; k < 3; k++) n[k] = (double)face->n[k];
  abbe_vector_normalise(n);
  meeting m;
  meet(media, face, step, within, n, f.z, &m);
  number comes[4][2]; /* of what came in x and y; a crystal's wave is all in x */
  if (!crystal) take(face->stokes, in);
  for (int i = 0; i < 4; i++)
    for (int c = 0; c < 2; c++) {
      const double *axis = c == 0 ? f.x : f.y;
      comes[i][c] = crystal ? m.amplitude[i][c]
                            : m.amplitude[i][0] * abbe_vector_dot(m.comes[0], axis) +
                                  m.amplitude[i][1] * abbe_vector_dot(m.comes[1], axis);
    }
  *out = (abbe_wave_ways){0};
  size_t reflected = 0;
  for (int side = 0; side < 2; side++) {
    const int medium = side == 0 ? face->from : face->to;
    if (abbe_media_is_crystal(media, medium))
      leave_as_waves(&m, 2 * side, comes, in, out);
    else
      leave_as_light(&m, 2 * side, comes, in, out);
    if (side == 0) reflected = out->count;
  }
  abbe_wave_ways_balance(reflected, face->film >= 0, out);
}

void abbe_media_ways(const abbe_media *m, const abbe_wave_face *face, uint32_t step, float within,
                     abbe_wave_ways *out) {
  if (face->stokes != NULL)
    polarised_ways(m, face, step, within, out);
  else
    abbe_unpolarised_ways(m, face, step, within, out);
}

/* ---- mirrors, bends and sheets ---- */

/* From the frame of d to x = s = d x n of the plane in which it goes on along out, and behind the
 * face to the frame of that. */
static void reflect(const abbe_film_light *light, const float d[3], const float out[3],
                    const double in[4], double stokes[4]) {
  const frame from = frame_of(d), to = frame_of(out);
  const abbe_jones j = abbe_jones_of_face(light, true);
  double s[3], p[3];
  abbe_vector_cross(from.z, to.z, s); /* along d x n, n = out - d */
  if (!(abbe_vector_length(s) > 1e-7)) memcpy(s, from.x, sizeof s);
  abbe_vector_normalise(s);
  abbe_stokes_turn(in, abbe_vector_dot(s, from.x), abbe_vector_dot(s, from.y), stokes);
  abbe_jones_apply(&j, stokes, stokes);
  abbe_vector_cross(to.z, s, p);
  abbe_stokes_turn(stokes, abbe_vector_dot(to.x, s), abbe_vector_dot(to.x, p), stokes);
}

float abbe_polarised_mirror(const abbe_mirrors *mirrors, size_t mirror, const float d[3],
                            const float out[3], uint32_t step, float within, float stokes[3]) {
  double in[4], s[4], cosine = 0;
  /* an ideal conductor */
  abbe_film_light light = {.reflected = {1, 1}, .r = {{-1, 0}, {1, 0}}};
  for (int k = 0; k < 3; k++) cosine += (double)d[k] * (double)out[k];
  if (!abbe_mirrors_is_grey(mirrors, mirror)) {
    float nk[2];
    abbe_mirrors_nk(mirrors, mirror, step, within, nk);
    const double metal[2] = {(double)nk[0], (double)nk[1]};
    abbe_film_light_at(NULL, 0, false, 1, metal, sqrt(fmax(1 - cosine, 0) / 2), 1, &light);
  }
  const double mean = (light.reflected[0] + light.reflected[1]) / 2;
  if (!(mean > 0)) return 1;
  take(stokes, in);
  reflect(&light, d, out, in, s);
  give(s, stokes);
  return (float)(s[0] / mean);
}

void abbe_polarised_bend(const float from[3], const float to[3], float stokes[3]) {
  const frame f = frame_of(from), t = frame_of(to);
  double s[4], p[3], x[3];
  const double along = abbe_vector_dot(f.x, t.z);
  for (int k = 0; k < 3; k++) x[k] = f.x[k] - along * t.z[k];
  if (!abbe_vector_normalise(x)) return;
  abbe_vector_cross(t.z, x, p);
  take(stokes, s);
  abbe_stokes_turn(s, abbe_vector_dot(t.x, x), abbe_vector_dot(t.x, p), s);
  give(s, stokes);
}

/* A sheet at right angles to across and up. */
static void pass(const abbe_polariser *sheet, const double across[3], const double up[3],
                 const float d[3], float stokes[3]) {
  const frame f = frame_of(d);
  memset(stokes, 0, 3 * sizeof *stokes);
  if (sheet->kind == ABBE_POLARISER_RIGHT) stokes[2] = 1;
  if (sheet->kind == ABBE_POLARISER_LEFT) stokes[2] = -1;
  if (sheet->kind != ABBE_POLARISER_LINEAR) return;
  double axis[3];
  for (int k = 0; k < 3; k++)
    axis[k] = cos(sheet->angle_rad) * across[k] + sin(sheet->angle_rad) * up[k];
  const double x = abbe_vector_dot(axis, f.x), y = abbe_vector_dot(axis, f.y);
  const double square = x * x + y * y;
  if (!(square > 0)) return;
  stokes[0] = (float)((x * x - y * y) / square);
  stokes[1] = (float)(2 * x * y / square);
}

void abbe_polarised_lamp(const abbe_light *light, const float d[3], float stokes[3]) {
  double across[3], up[3];
  abbe_light_upright(light->direction, across, up);
  pass(&light->polariser, across, up, d, stokes);
}

void abbe_polarised_camera(const abbe_polariser *sheet, const float right[3], const float up[3],
                           const float d[3], float stokes[3]) {
  double x[3], y[3];
  for (int k = 0; k < 3; k++) {
    x[k] = (double)right[k];
    y[k] = (double)up[k];
  }
  pass(sheet, x, y, d, stokes);
}
