#include "scenes/volume/exit_pages.h"

#include "scenes/geometry/vector.h"

#include <stdlib.h>
#include <string.h>

enum { BINS = 512, MOST_TEXELS = 64 };

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
  for (size_t i = 0; i < c->count; i++) {
    const landing *l = &c->landing[i];
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
static size_t make_tent(double x, double half, size_t side, size_t *first, double *share) {
  const double wide = fmin(fmax(half, 1), 0.4 * MOST_TEXELS);
  const long from = (long)floor(x - 0.5 - wide) + 1, to = (long)ceil(x - 0.5 + wide) - 1;
  const long low = from > 0 ? from : 0;
  const long high = to < (long)side - 1 ? to : (long)side - 1;
  double sum = 0;
  *first = (size_t)low;
  size_t count = 0;
  for (long i = low; i <= high; i++) {
    share[count] = fmax(1 - fabs((double)i + 0.5 - x) / wide, 0);
    sum += share[count++];
  }
  for (size_t i = 0; i < count; i++) share[i] /= sum;
  return sum > 0 ? count : 0;
}

static void splat(const abbe_exit_pages *p, const landing *l, const double area) {
  const float *w = p->window[l->page];
  const double side = (double)p->side;
  double at[2] = {(double)((l->u - w[0]) * w[2]), (double)((l->v - w[1]) * w[3])};
  const bool fine = at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1;
  double half[2] = {(double)l->wide[0] * side, (double)l->wide[1] * side};
  double texels = area / (side * side), share[2][MOST_TEXELS + 2];
  size_t first[2], count[2];
  for (int a = 0; a < 2; a++) {
    if (!fine) at[a] = (double)(a == 0 ? l->u : l->v);
    if (fine) half[a] *= (double)w[2 + a];
    if (fine) texels /= (double)w[2 + a];
    count[a] = make_tent(at[a] * side, half[a], p->side, &first[a], share[a]);
  }
  for (size_t y = 0; y < count[1]; y++)
    for (size_t x = 0; x < count[0]; x++) {
      const float part = (float)(share[0][x] * share[1][y] / texels);
      float *to = texel(p, l->page, fine, first[0] + x, first[1] + y);
      for (int k = 0; k < 3; k++) to[k] += part * l->xyz[k];
    }
}

static abbe_result make_texels(const catching *c, abbe_exit_pages *p, abbe_error *error) {
  abbe_result result = fit_windows(c, p, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < c->count; i++)
    splat(p, &c->landing[i], c->sheet[c->landing[i].page / 2].area);
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
  catching c = {.place = desc->place, .sheet = sheets, .sheets = parallelograms};
  c.spacing = sqrt(v->exits.area / (double)(v->exits.points * v->exits.symmetry.count));
  abbe_result result = ABBE_OK;
  if (sheets == NULL || out->window == NULL || out->value == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pages", out->count);
  for (size_t i = 0; result == ABBE_OK && i < parallelograms; i++)
    make_sheet(parallelogram[i], &sheets[i]);
  if (result == ABBE_OK) result = abbe_exit_light_colours(v, desc, catch_ray, &c, error);
  if (result == ABBE_OK && c.full)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for rays");
  if (result == ABBE_OK) result = make_texels(&c, out, error);
  free(c.landing);
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
