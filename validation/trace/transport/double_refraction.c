#include "validation/trace/transport/double_refraction.h"

#include <math.h>
#include <string.h>

static bool is_crystal(const abbe_uniaxial *m) {
  return m->n_o != m->n_e;
}

/* Both waves of an isotropic medium run along one ray. */
static void add_side(const abbe_uniaxial *medium, const abbe_uniaxial_wave wave[2], bool reflected,
                     abbe_wave_ways *out) {
  const bool two = is_crystal(medium);
  for (int i = 0; i < (two ? 2 : 1); i++) {
    const double share = two ? wave[i].share : wave[0].share + wave[1].share;
    const abbe_uniaxial_wave *w = !two && !wave[0].travels ? &wave[1] : &wave[i];
    if (!(share > 0)) continue;
    abbe_wave_way *way = &out->way[out->count++];
    *way = (abbe_wave_way){
        .share = (float)share, .wave = (uint8_t)(two ? i : 0), .reflected = reflected};
    for (int k = 0; k < 3; k++) way->d[k] = (float)w->ray[k];
  }
}

static void to_unit(const float n[3], const float d[3], double normal[3], double ray[3]) {
  double lengths[2] = {0, 0};
  for (int k = 0; k < 3; k++) {
    normal[k] = (double)n[k];
    ray[k] = (double)d[k];
    lengths[0] += normal[k] * normal[k];
    lengths[1] += ray[k] * ray[k];
  }
  for (int k = 0; k < 3; k++) {
    normal[k] /= sqrt(lengths[0]);
    ray[k] /= sqrt(lengths[1]);
  }
}

void abbe_wave_ways_balance(size_t reflected, bool film, abbe_wave_ways *out) {
  float all = 0;
  for (size_t i = 0; i < out->count; i++) all += out->way[i].share;
  for (size_t i = 0; i < out->count; i++) {
    out->way[i].share /= all;
    if (i < reflected) out->reflected += out->way[i].share;
  }
  if (reflected == out->count) out->reflected = 1;
  out->passes = film ? fminf(all, 1) : 1;
}

void abbe_wave_ways_find(const abbe_uniaxial *from, const abbe_uniaxial *to, const float n[3],
                         const float d[3], uint8_t wave, abbe_wave_ways *out) {
  double normal[3], ray[3];
  to_unit(n, d, normal, ray);
  abbe_uniaxial_split split;
  if (is_crystal(from))
    abbe_uniaxial_meet(from, to, normal, (abbe_uniaxial_mode)wave, ray, &split);
  else
    abbe_uniaxial_meet_unpolarised(from, to, normal, ray, &split);
  *out = (abbe_wave_ways){0};
  add_side(from, split.reflected, true, out);
  const size_t reflected = out->count;
  add_side(to, split.transmitted, false, out);
  abbe_wave_ways_balance(reflected, false, out);
}

/* Its first index is there twice: the ordinary one is the slower where its index is larger. */
int abbe_wave_ways_rename(const abbe_biaxial *m, int wave) {
  return m->n[0] == m->n[1] && m->n[0] > m->n[2] ? 1 - wave : wave;
}

/* Both waves of an isotropic medium run along one ray. */
static void add_waves(const abbe_biaxial *medium, const abbe_biaxial_wave wave[2], bool reflected,
                      abbe_wave_ways *out) {
  const bool two = medium->n[0] != medium->n[1] || medium->n[1] != medium->n[2];
  for (int i = 0; i < (two ? 2 : 1); i++) {
    const double share = two ? wave[i].share : wave[0].share + wave[1].share;
    const abbe_biaxial_wave *w = !two && !wave[0].travels ? &wave[1] : &wave[i];
    if (!(share > 0)) continue;
    abbe_wave_way *way = &out->way[out->count++];
    *way = (abbe_wave_way){
        .share = (float)share,
        .wave = (uint8_t)(two ? abbe_wave_ways_rename(medium, (int)wave[i].mode) : 0),
        .reflected = reflected};
    for (int k = 0; k < 3; k++) way->d[k] = (float)w->state.ray[k];
  }
}

void abbe_wave_ways_find_biaxial(const abbe_biaxial *from, const abbe_biaxial *to, const float n[3],
                                 const float d[3], uint8_t wave, const abbe_biaxial_film *film,
                                 abbe_wave_ways *out) {
  double normal[3], ray[3];
  abbe_biaxial_split split;
  to_unit(n, d, normal, ray);
  if (from->n[0] != from->n[1] || from->n[1] != from->n[2])
    abbe_biaxial_meet(from, to, normal, (abbe_biaxial_mode)abbe_wave_ways_rename(from, wave), ray,
                      film, &split);
  else
    abbe_biaxial_meet_unpolarised(from, to, normal, ray, film, &split);
  *out = (abbe_wave_ways){0};
  add_waves(from, split.reflected, true, out);
  const size_t reflected = out->count;
  add_waves(to, split.transmitted, false, out);
  abbe_wave_ways_balance(reflected, film != NULL, out);
}

void abbe_media_crystal(const abbe_media *m, int i, uint32_t k, float f, abbe_uniaxial *out) {
  *out = (abbe_uniaxial){.axis = {0, 0, 1}};
  out->n_o = out->n_e = (double)abbe_media_n(m, i, k, f);
  if (!abbe_media_is_crystal(m, i)) return;
  const float *n = m->extraordinary + (size_t)i * (m->steps + 1) + k;
  out->n_e = (double)(n[0] + f * (n[1] - n[0]));
  for (int c = 0; c < 3; c++) out->axis[c] = m->axis[i][c];
}

void abbe_media_place(const abbe_media *m, int i, uint32_t k, float f, abbe_biaxial *out) {
  if (abbe_media_is_crystal(m, i) && m->principal != NULL) {
    abbe_media_axes(m, i, k, f, out);
    return;
  }
  if (abbe_media_is_crystal(m, i)) {
    abbe_uniaxial two;
    abbe_media_crystal(m, i, k, f, &two);
    *out = (abbe_biaxial){.n = {two.n_o, two.n_o, two.n_e}};
    memcpy(out->axis, m->frame[i], sizeof out->axis);
    return;
  }
  *out = (abbe_biaxial){.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int axis = 0; axis < 3; axis++) out->n[axis] = (double)abbe_media_n(m, i, k, f);
}

static void biaxial_ways(const abbe_media *m, const abbe_wave_face *face, uint32_t step,
                         float within, abbe_wave_ways *out) {
  abbe_biaxial media[2];
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_biaxial_film film = {.layer = layer, .reversed = !face->entering};
  abbe_media_place(m, face->from, step, within, &media[0]);
  abbe_media_place(m, face->to, step, within, &media[1]);
  if (face->film >= 0) {
    film.count = m->films.layers[face->film];
    film.lambda_nm = abbe_films_at(&m->films, face->film, step, within, layer);
  }
  abbe_wave_ways_find_biaxial(&media[0], &media[1], face->n, face->d, face->wave,
                              face->film >= 0 ? &film : NULL, out);
}

void abbe_unpolarised_ways(const abbe_media *m, const abbe_wave_face *face, uint32_t step,
                           float within, abbe_wave_ways *out) {
  if (face->film >= 0 || abbe_media_is_biaxial(m, face->from) ||
      abbe_media_is_biaxial(m, face->to)) {
    biaxial_ways(m, face, step, within, out);
    return;
  }
  abbe_uniaxial media[2];
  abbe_media_crystal(m, face->from, step, within, &media[0]);
  abbe_media_crystal(m, face->to, step, within, &media[1]);
  abbe_wave_ways_find(&media[0], &media[1], face->n, face->d, face->wave, out);
}

const abbe_wave_way *abbe_wave_ways_choose(const abbe_wave_ways *w, float chance, float which) {
  size_t mirrored = 0;
  while (mirrored < w->count && w->way[mirrored].reflected) mirrored++;
  const bool reflects = mirrored == w->count || (mirrored > 0 && chance < w->reflected);
  const size_t first = reflects ? 0 : mirrored, end = reflects ? mirrored : w->count;
  const float all = reflects ? w->reflected : 1 - w->reflected;
  size_t i = first;
  for (float sum = w->way[i].share; i + 1 < end && which * all >= sum; sum += w->way[i].share) i++;
  return &w->way[i];
}

void abbe_media_wave_vector(const abbe_media *m, int medium, uint32_t step, float within,
                            uint8_t wave, const double ray[3], double out[3]) {
  double n = (double)abbe_media_n(m, medium, step, within), normal[3] = {ray[0], ray[1], ray[2]};
  if (abbe_media_is_biaxial(m, medium)) {
    abbe_biaxial crystal;
    abbe_biaxial_state state;
    abbe_media_axes(m, medium, step, within, &crystal);
    abbe_biaxial_of_ray(&crystal, (abbe_biaxial_mode)wave, ray, &state);
    n = state.index;
    memcpy(normal, state.normal, sizeof normal);
  } else if (abbe_media_is_crystal(m, medium) && wave == ABBE_UNIAXIAL_EXTRAORDINARY) {
    abbe_uniaxial crystal;
    abbe_media_crystal(m, medium, step, within, &crystal);
    abbe_uniaxial_normal(&crystal, ABBE_UNIAXIAL_EXTRAORDINARY, ray, normal);
    double along = 0;
    for (int k = 0; k < 3; k++) along += normal[k] * crystal.axis[k];
    n = abbe_uniaxial_index(crystal.n_o, crystal.n_e, along);
  }
  for (int k = 0; k < 3; k++) out[k] = n * normal[k];
}
