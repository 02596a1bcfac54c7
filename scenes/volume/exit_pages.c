#include "scenes/volume/exit_pages.h"

#include "scenes/geometry/vector.h"

#include <stdlib.h>
#include <string.h>

enum { BINS = 512, MOST_TEXELS = 64 };
/* Of the points, and of the rows of maps, that threads do side by side; no result depends on who.
 */
enum { PARTS = 8, BANDS = 8 };

/* A window leaves so much of a side's light out on each of its ends. */
static const double left_out = 0.0025;
/* The width of a ray on a receiver: so many times the distance between rays as they come in. */
static const double widening = 1.5;

/* Where a part of a ray lands. */
typedef struct landing {
  float u, v, wide[2]; /* and half its width in each, in parts of the edges */
  float xyz[3];        /* W */
  uint32_t page;
} landing;

/* A parallelogram as rays ask for it. */
typedef struct sheet {
  double corner[3], normal[3], du[3], dv[3];
  double area;
} sheet;

typedef struct catching {
  const abbe_volume_place *place;
  const sheet *sheet;
  size_t sheets;
  double spacing; /* between rays as they come in, m */
  landing *landing;
  size_t count, room;
  bool full; /* no memory was left */
} catching;

static void make_sheet(const double p[9], sheet *out) {
  const double *u = p + 3, *v = p + 6;
  double n[3];
  abbe_vector_cross(u, v, n);
  const double square = abbe_vector_dot(n, n);
  memcpy(out->corner, p, sizeof out->corner);
  memcpy(out->normal, n, sizeof n);
  abbe_vector_cross(v, n, out->du);
  abbe_vector_cross(n, u, out->dv);
  for (int k = 0; k < 3; k++) {
    out->du[k] /= square;
    out->dv[k] /= square;
  }
  out->area = sqrt(square);
  abbe_vector_normalise(out->normal);
}

/* The first sheet on the way, and where on it; false for none. */
static bool meet(const catching *c, const double o[3], const double d[3], size_t *which,
                 double uv[2]) {
  double least = INFINITY;
  for (size_t i = 0; i < c->sheets; i++) {
    const sheet *s = &c->sheet[i];
    double from[3], at[3];
    abbe_vector_subtract(s->corner, o, from);
    const double t = abbe_vector_dot(s->normal, from) / abbe_vector_dot(s->normal, d);
    if (!(t > 0) || !(t < least)) continue;
    for (int k = 0; k < 3; k++) at[k] = t * d[k] - from[k];
    const double u = abbe_vector_dot(at, s->du), v = abbe_vector_dot(at, s->dv);
    if (!(u >= 0) || !(u <= 1) || !(v >= 0) || !(v <= 1)) continue;
    least = t;
    *which = i;
    uv[0] = u;
    uv[1] = v;
  }
  return isfinite(least);
}

static bool make_room(catching *c) {
  if (c->count < c->room) return true;
  const size_t room = c->room > 0 ? 2 * c->room : 1 << 14;
  landing *more = realloc(c->landing, room * sizeof *more);
  if (more == NULL) return false;
  c->landing = more;
  c->room = room;
  return true;
}

static void catch_ray(void *user, const abbe_exit_ray *ray, double flux, const double xyz[3]) {
  catching *c = user;
  double o[3], d[3], uv[2] = {0};
  size_t which = 0;
  (void)flux;
  for (int i = 0; i < 3; i++) {
    o[i] = c->place->centre[i] + abbe_vector_dot(&c->place->turn[3 * i], ray->place);
    d[i] = abbe_vector_dot(&c->place->turn[3 * i], ray->way);
  }
  if (!meet(c, o, d, &which, uv)) return;
  if (!make_room(c)) {
    c->full = true;
    return;
  }
  const sheet *s = &c->sheet[which];
  const bool back = abbe_vector_dot(d, s->normal) > 0;
  c->landing[c->count++] =
      (landing){.u = (float)uv[0],
                .v = (float)uv[1],
                .wide = {(float)(widening * c->spacing * abbe_vector_length(s->du)),
                         (float)(widening * c->spacing * abbe_vector_length(s->dv))},
                .xyz = {(float)xyz[0], (float)xyz[1], (float)xyz[2]},
                .page = (uint32_t)(2 * which + back)};
}

/* ---- windows ---- */

/* Where all but a little of the light of each end lies. */
static void cut_ends(const double *flux, double sum, double *low, double *high) {
  double before = 0;
  size_t first = 0, last = BINS - 1;
  while (first < last && before + flux[first] <= left_out * sum) before += flux[first++];
  before = 0;
  while (last > first && before + flux[last] <= left_out * sum) before += flux[last--];
  *low = fmax(((double)first - 1) / BINS, 0);
  *high = fmin(((double)last + 2) / BINS, 1);
}

static abbe_result fit_windows(const catching *c, abbe_exit_pages *p, abbe_error *error) {
  double(*flux)[2][BINS] = calloc(p->count, sizeof *flux);
  if (flux == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  for (size_t part = 0; part < PARTS; part++)
    for (size_t i = 0; i < c[part].count; i++) {
      const landing *l = &c[part].landing[i];
      const float at[2] = {l->u, l->v};
      for (int a = 0; a < 2; a++)
        flux[l->page][a][(size_t)fminf(at[a] * BINS, BINS - 1)] += (double)l->xyz[1];
      p->flux += (double)l->xyz[1];
    }
  for (size_t i = 0; i < p->count; i++)
    for (int a = 0; a < 2; a++) {
      double sum = 0, low, high;
      for (size_t k = 0; k < BINS; k++) sum += flux[i][a][k];
      if (!(sum > 0)) continue;
      cut_ends(flux[i][a], sum, &low, &high);
      p->window[i][a] = (float)low;
      p->window[i][2 + a] = (float)(1 / (high - low));
    }
  free(flux);
  return ABBE_OK;
}

/* ---- texels ---- */

static float *texel(const abbe_exit_pages *p, size_t page, size_t fine, size_t x, size_t y) {
  return p->value[((2 * page + fine) * p->side + y) * p->side + x];
}

/* Shares of texels from *first on of a tent of that half width around x, in texels; they sum to 1.
 */
static int make_tent(float x, float half, int side, int *first, float *share) {
  const float wide = fminf(fmaxf(half, 1), 0.4f * MOST_TEXELS);
  const int from = (int)floorf(x - 0.5f - wide) + 1, to = (int)ceilf(x - 0.5f + wide) - 1;
  const int low = from > 0 ? from : 0, high = to < side - 1 ? to : side - 1;
  float sum = 0;
  int count = 0;
  *first = low;
  for (int i = low; i <= high; i++) {
    const float part = 1 - fabsf((float)i + 0.5f - x) / wide;
    share[count] = part > 0 ? part : 0;
    sum += share[count++];
  }
  for (int i = 0; i < count; i++) share[i] /= sum;
  return sum > 0 ? count : 0;
}

/* Onto the rows of a band alone. */
static void splat(const abbe_exit_pages *p, const landing *l, float area, int band) {
  const float *w = p->window[l->page];
  const int side = (int)p->side, low = side * band / BANDS, high = side * (band + 1) / BANDS;
  const float u = (l->u - w[0]) * w[2], v = (l->v - w[1]) * w[3];
  const bool fine = u >= 0 && u <= 1 && v >= 0 && v <= 1;
  const float n = (float)side, du = fine ? w[2] : 1, dv = fine ? w[3] : 1;
  const float y = (fine ? v : l->v) * n, tall = fmaxf(l->wide[1] * n * dv, 1) + 1;
  if (y + tall < (float)low || y - tall > (float)high) return;
  float across[MOST_TEXELS + 2], along[MOST_TEXELS + 2];
  int first_x, first_y;
  const int columns = make_tent((fine ? u : l->u) * n, l->wide[0] * n * du, side, &first_x, across);
  const int rows = make_tent(y, l->wide[1] * n * dv, side, &first_y, along);
  const float scale = n * n * du * dv / area;
  for (int j = 0; j < rows; j++) {
    if (first_y + j < low || first_y + j >= high) continue;
    float *to = texel(p, l->page, fine, (size_t)first_x, (size_t)(first_y + j));
    for (int i = 0; i < columns; i++, to += 4) {
      const float part = across[i] * along[j] * scale;
      for (int k = 0; k < 3; k++) to[k] += part * l->xyz[k];
    }
  }
}

static abbe_result make_texels(const catching *c, abbe_exit_pages *p, abbe_error *error) {
  abbe_result result = fit_windows(c, p, error);
  if (result != ABBE_OK) return result;
#pragma omp parallel for schedule(dynamic)
  for (int band = 0; band < BANDS; band++)
    for (size_t part = 0; part < PARTS; part++)
      for (size_t i = 0; i < c[part].count; i++) {
        const landing *l = &c[part].landing[i];
        splat(p, l, (float)c[part].sheet[l->page / 2].area, band);
      }
  return ABBE_OK;
}

/* What each part's rays meet. */
static abbe_result catch_all(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                             catching *c, abbe_error *error) {
  abbe_result result[PARTS];
#pragma omp parallel for schedule(dynamic)
  for (size_t part = 0; part < PARTS; part++)
    result[part] = abbe_exit_light_part(v, desc, part, PARTS, catch_ray, &c[part], NULL);
  for (size_t part = 0; part < PARTS; part++)
    if (result[part] != ABBE_OK || c[part].full)
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for rays");
  return ABBE_OK;
}

abbe_result abbe_exit_pages_make(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                                 const double (*parallelogram)[9], size_t parallelograms,
                                 size_t side, abbe_exit_pages *out, abbe_error *error) {
  ABBE_REQUIRE(v && desc && desc->place && parallelogram && out, error);
  *out = (abbe_exit_pages){.side = side, .count = 2 * parallelograms};
  if (side < 1 || side > ABBE_EXIT_PAGES_MOST_SIDE || v->exits.points == 0)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "pages of %zu texels a side of %zu points: 1 to %d, of a volume with exits", side,
        v->exits.points, ABBE_EXIT_PAGES_MOST_SIDE);
  sheet *sheets = calloc(parallelograms + 1, sizeof *sheets);
  out->window = calloc(out->count + 1, sizeof *out->window);
  out->value = calloc(out->count * 2 * side * side + 1, sizeof *out->value);
  abbe_exit_light_desc seen = *desc;
  seen.sheet = parallelogram;
  seen.sheets = parallelograms;
  const double points = (double)(v->exits.points * v->exits.symmetry.count);
  catching c[PARTS];
  for (size_t part = 0; part < PARTS; part++)
    c[part] = (catching){.place = desc->place,
                         .sheet = sheets,
                         .sheets = parallelograms,
                         .spacing = sqrt(v->exits.area / points)};
  abbe_result result = ABBE_OK;
  if (sheets == NULL || out->window == NULL || out->value == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pages", out->count);
  for (size_t i = 0; result == ABBE_OK && i < parallelograms; i++)
    make_sheet(parallelogram[i], &sheets[i]);
  if (result == ABBE_OK) result = catch_all(v, &seen, c, error);
  if (result == ABBE_OK) result = make_texels(c, out, error);
  for (size_t part = 0; part < PARTS; part++) free(c[part].landing);
  free(sheets);
  if (result != ABBE_OK) abbe_exit_pages_free(out);
  return result;
}

void abbe_exit_pages_free(abbe_exit_pages *pages) {
  if (pages == NULL) return;
  free(pages->window);
  free(pages->value);
  *pages = (abbe_exit_pages){0};
}

void abbe_exit_pages_at(const abbe_exit_pages *p, size_t page, double u, double v, double xyz[3]) {
  const float *w = p->window[page];
  const double at[2] = {(u - (double)w[0]) * (double)w[2], (v - (double)w[1]) * (double)w[3]};
  const bool fine = at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1 && w[2] > 0;
  const double most = (double)p->side - 1, place[2] = {fine ? at[0] : u, fine ? at[1] : v};
  size_t low[2], high[2];
  double part[2];
  for (int a = 0; a < 2; a++) {
    const double x = fmin(fmax(place[a] * (double)p->side - 0.5, 0), most);
    low[a] = (size_t)x;
    high[a] = low[a] + 1 < p->side ? low[a] + 1 : low[a];
    part[a] = x - (double)low[a];
  }
  for (int k = 0; k < 3; k++) {
    const double a = (double)texel(p, page, fine, low[0], low[1])[k],
                 b = (double)texel(p, page, fine, high[0], low[1])[k],
                 c = (double)texel(p, page, fine, low[0], high[1])[k],
                 d = (double)texel(p, page, fine, high[0], high[1])[k];
    const double near_v = a + part[0] * (b - a), far_v = c + part[0] * (d - c);
    xyz[k] = near_v + part[1] * (far_v - near_v);
  }
}
