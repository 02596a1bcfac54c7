#include "scenes/volume/exit_pages.h"

#include "scenes/geometry/vector.h"

#include <stdlib.h>
#include <string.h>

enum { BINS = 512, MOST_TEXELS = 64 };
/* Of the points, that threads do side by side, each with maps of its own; no result depends on who
 * does which. FEWER: of them one in so many tells where the light falls. */
enum { PARTS = 4, FEWER = 13 };

/* A window leaves so much of a side's light out on each of its ends. */
static const double left_out = 0.0025;
/* The width of a ray on a receiver: so many times the distance between rays as they come in. */
static const double widening = 2.5;
/* Parts of a ray are at most so many of half that width apart. */
static const double part_width = 1;

/* A parallelogram as rays ask for it. */
typedef struct sheet {
  double corner[3], normal[3], du[3], dv[3];
  double area;
  float wide[2]; /* half the width of a ray, in parts of the edges */
} sheet;

/* What a part of the points catches. */
typedef struct catching {
  const abbe_volume_place *place;
  const abbe_exit_colours *colours;
  const sheet *sheet;
  size_t sheets;
  uint32_t turn; /* of rays */
  const abbe_exit_pages *pages;
  double (
      *flux)[2][BINS]; /* [pages] of Y, by place along each edge: while windows are looked for */
  float (**value)[4];  /* [pages][2] maps as the pages have them, NULL: nothing has landed there */
  double landed;       /* Y, W */
  bool full;           /* no memory was left */
} catching;

static void make_sheet(const double p[9], double spacing, sheet *out) {
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
  out->wide[0] = (float)(widening * spacing * abbe_vector_length(out->du));
  out->wide[1] = (float)(widening * spacing * abbe_vector_length(out->dv));
  abbe_vector_normalise(out->normal);
}

/* The first sheet on the way, and where on it; false for none. d is of any length. */
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

/* A ray in the world, and how it changes with the index. */
typedef struct line {
  double o[3], d[3], o_by[3], d_by[3];
} line;

static bool meet_at(const catching *c, const line *l, double step, bool *back, size_t *which,
                    double uv[2]) {
  double o[3], d[3];
  for (int k = 0; k < 3; k++) {
    o[k] = l->o[k] + step * l->o_by[k];
    d[k] = l->d[k] + step * l->d_by[k];
  }
  if (!meet(c, o, d, which, uv)) return false;
  *back = abbe_vector_dot(d, c->sheet[*which].normal) > 0;
  return true;
}

/* As many as leave no gap between them: parts of one ray lie where those of its neighbours do not.
 */
static size_t count_parts(const catching *c, const line *l, size_t bin) {
  double end[2], uv[2][2];
  size_t which[2];
  bool back;
  abbe_exit_colours_ends(c->colours, bin, end);
  if (!(end[1] > end[0])) return 1;
  for (int k = 0; k < 2; k++)
    if (!meet_at(c, l, end[k], &back, &which[k], uv[k])) return ABBE_EXIT_MOST_PARTS;
  if (which[0] != which[1]) return ABBE_EXIT_MOST_PARTS;
  const float *wide = c->sheet[which[0]].wide;
  const double apart =
      hypot((uv[1][0] - uv[0][0]) / (double)wide[0], (uv[1][1] - uv[0][1]) / (double)wide[1]);
  return (size_t)fmin(ceil(apart / part_width), ABBE_EXIT_MOST_PARTS);
}

/* ---- windows ---- */

/* Where all but a little of the light of each end lies, and so much more, which the other rays may
 * be off. */
static void cut_ends(const double *flux, double sum, double more, double *low, double *high) {
  double before = 0;
  size_t first = 0, last = BINS - 1;
  while (first < last && before + flux[first] <= left_out * sum) before += flux[first++];
  before = 0;
  while (last > first && before + flux[last] <= left_out * sum) before += flux[last--];
  *low = fmax(((double)first - 1) / BINS - more, 0);
  *high = fmin(((double)last + 2) / BINS + more, 1);
}

static void fit_windows(const catching *c, abbe_exit_pages *p) {
  for (size_t i = 0; i < p->count; i++)
    for (int a = 0; a < 2; a++) {
      double sum = 0, low, high;
      for (size_t k = 0; k < BINS; k++) sum += c->flux[i][a][k];
      if (!(sum > 0)) continue;
      cut_ends(c->flux[i][a], sum, 2 * (double)c->sheet[i / 2].wide[a], &low, &high);
      p->window[i][a] = (float)low;
      p->window[i][2 + a] = (float)(1 / (high - low));
    }
}

/* ---- texels ---- */

static float *texel(const abbe_exit_pages *p, size_t page, size_t fine, size_t x, size_t y) {
  return p->value[((2 * page + fine) * p->side + y) * p->side + x];
}

static int below(float x) {
  const int i = (int)x;
  return (float)i > x ? i - 1 : i;
}

/* Shares of texels from *first on of a tent of that half width around x, in texels; they sum to 1.
 */
static int make_tent(float x, float wide, int side, int *first, float *share) {
  const float from = x - 0.5f;
  if (wide <= 1 && from >= 0 && from < (float)(side - 1)) { /* the nearest two */
    *first = (int)from;
    share[1] = from - (float)*first;
    share[0] = 1 - share[1];
    return 2;
  }
  const int least = below(from - wide) + 1, most = -below(-from - wide) - 1;
  const int low = least > 0 ? least : 0, high = most < side - 1 ? most : side - 1;
  const float slope = 1 / wide;
  float sum = 0;
  int count = 0;
  *first = low;
  for (int i = low; i <= high; i++) {
    const float part = 1 - fabsf((float)i - from) * slope;
    share[count] = part > 0 ? part : 0;
    sum += share[count++];
  }
  const float scale = 1 / sum;
  for (int i = 0; i < count; i++) share[i] *= scale;
  return sum > 0 ? count : 0;
}

/* Of a page and whether it is the finer map: one of the part's own. */
static float (*map_of(catching *c, size_t page, size_t fine))[4] {
  float(**map)[4] = &c->value[2 * page + fine];
  if (*map == NULL) *map = calloc(c->pages->side * c->pages->side, sizeof **map);
  c->full = c->full || *map == NULL;
  return *map;
}

/* xyz: W. */
static void splat(catching *c, size_t page, const double uv[2], const float xyz[4]) {
  const sheet *s = &c->sheet[page / 2];
  const float *w = c->pages->window[page], n = (float)c->pages->side;
  const float u = ((float)uv[0] - w[0]) * w[2], v = ((float)uv[1] - w[1]) * w[3];
  const bool fine = u >= 0 && u <= 1 && v >= 0 && v <= 1;
  const float texels[2] = {fine ? n * w[2] : n, fine ? n * w[3] : n}; /* of a whole edge */
  float across[MOST_TEXELS + 2], along[MOST_TEXELS + 2], wide[2];
  int first_x, first_y;
  for (int a = 0; a < 2; a++) {
    wide[a] = s->wide[a] * texels[a];
    wide[a] = wide[a] < 1 ? 1 : wide[a] > 0.4f * MOST_TEXELS ? 0.4f * MOST_TEXELS : wide[a];
  }
  float(*map)[4] = map_of(c, page, fine);
  if (map == NULL) return;
  const int side = (int)c->pages->side;
  const int columns = make_tent(fine ? u * n : (float)uv[0] * n, wide[0], side, &first_x, across);
  const int rows = make_tent(fine ? v * n : (float)uv[1] * n, wide[1], side, &first_y, along);
  const float scale = texels[0] * texels[1] / (float)s->area;
  for (int j = 0; j < rows; j++) {
    float(*to)[4] = map + (size_t)(first_y + j) * (size_t)side + first_x;
    for (int i = 0; i < columns; i++) {
      const float part = across[i] * along[j] * scale;
      for (int k = 0; k < 4; k++) to[i][k] += part * xyz[k];
    }
  }
}

/* A part of a ray has landed: counted while windows are looked for, else laid. */
static void land(catching *c, size_t page, const double uv[2], const float xyz[4]) {
  if (c->value != NULL) {
    c->landed += (double)xyz[1];
    splat(c, page, uv, xyz);
    return;
  }
  for (int a = 0; a < 2; a++)
    c->flux[page][a][(size_t)fmin(uv[a] * BINS, BINS - 1)] += (double)xyz[1];
}

static void catch_ray(void *user, const abbe_exit_ray *ray, double flux, size_t bin) {
  catching *c = user;
  abbe_exit_part part[ABBE_EXIT_MOST_PARTS];
  line l;
  for (int i = 0; i < 3; i++) {
    const double *row = &c->place->turn[3 * i];
    l.o[i] = c->place->centre[i] + abbe_vector_dot(row, ray->place);
    l.d[i] = abbe_vector_dot(row, ray->way);
    l.o_by[i] = abbe_vector_dot(row, ray->place_by);
    l.d_by[i] = abbe_vector_dot(row, ray->way_by);
  }
  const size_t parts =
      abbe_exit_colours_split(c->colours, bin, count_parts(c, &l, bin), c->turn++, part);
  for (size_t i = 0; i < parts; i++) {
    double uv[2];
    size_t which;
    bool back;
    if (!meet_at(c, &l, part[i].step, &back, &which, uv)) continue;
    const float xyz[4] = {(float)(flux * part[i].xyz[0]), (float)(flux * part[i].xyz[1]),
                          (float)(flux * part[i].xyz[2]), 0};
    land(c, 2 * which + back, uv, xyz);
  }
}

/* Where the light falls, by a few of the points. */
static abbe_result find_windows(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                                catching *c, abbe_exit_pages *p, abbe_error *error) {
  c->flux = calloc(p->count + 1, sizeof *c->flux);
  if (c->flux == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  const size_t few = v->exits.points < FEWER ? 1 : FEWER;
  const abbe_result result = abbe_exit_light_part(v, desc, 0, few, catch_ray, c, error);
  if (result == ABBE_OK) fit_windows(c, p);
  free(c->flux);
  c->flux = NULL;
  return result;
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

/* Of all parts, in their order. */
static void sum_up(const catching *c, abbe_exit_pages *p) {
  const size_t texels = p->side * p->side;
  for (size_t part = 0; part < PARTS; part++) p->flux += c[part].landed;
  for (size_t map = 0; map < 2 * p->count; map++)
    for (size_t part = 0; part < PARTS; part++) {
      const float(*from)[4] = (const float(*)[4])c[part].value[map];
      float(*to)[4] = p->value + map * texels;
      for (size_t i = 0; from != NULL && i < texels; i++)
        for (int k = 0; k < 4; k++) to[i][k] += from[i][k];
    }
}

/* Light that a few points did not show has a page without a window: the finer map of all of it. */
static void open_windows(const catching *c, abbe_exit_pages *p) {
  for (size_t page = 0; page < p->count; page++)
    for (size_t part = 0; part < PARTS; part++)
      for (size_t fine = 0; fine < 2; fine++)
        if (c[part].value[2 * page + fine] != NULL && !(p->window[page][2] > 0))
          p->window[page][2] = p->window[page][3] = 1;
}

static abbe_result make_texels(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                               const catching *like, abbe_exit_pages *p, abbe_error *error) {
  catching c[PARTS];
  abbe_result result = ABBE_OK;
  for (size_t part = 0; part < PARTS; part++) {
    c[part] = *like;
    c[part].turn = (uint32_t)part << 24;
    c[part].value = calloc(2 * p->count + 1, sizeof *c[part].value);
    if (c[part].value == NULL)
      result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  }
  if (result == ABBE_OK) result = catch_all(v, desc, c, error);
  if (result == ABBE_OK) sum_up(c, p);
  if (result == ABBE_OK) open_windows(c, p);
  for (size_t part = 0; part < PARTS; part++) {
    for (size_t map = 0; c[part].value != NULL && map < 2 * p->count; map++)
      free(c[part].value[map]);
    free(c[part].value);
  }
  return result;
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
  abbe_exit_colours *colours = NULL;
  sheet *sheets = calloc(parallelograms + 1, sizeof *sheets);
  out->window = calloc(out->count + 1, sizeof *out->window);
  out->value = calloc(out->count * 2 * side * side + 1, sizeof *out->value);
  abbe_exit_light_desc seen = *desc;
  seen.sheet = parallelogram;
  seen.sheets = parallelograms;
  const double spacing = sqrt(v->exits.area / (double)(v->exits.points * v->exits.symmetry.count));
  abbe_result result = ABBE_OK;
  if (sheets == NULL || out->window == NULL || out->value == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pages", out->count);
  for (size_t i = 0; result == ABBE_OK && i < parallelograms; i++)
    make_sheet(parallelogram[i], spacing, &sheets[i]);
  if (result == ABBE_OK) result = abbe_exit_colours_make(v, &seen, &colours, error);
  catching c = {.place = desc->place,
                .colours = colours,
                .sheet = sheets,
                .sheets = parallelograms,
                .pages = out};
  if (result == ABBE_OK) result = find_windows(v, &seen, &c, out, error);
  if (result == ABBE_OK) result = make_texels(v, &seen, &c, out, error);
  abbe_exit_colours_free(colours);
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

void abbe_exit_pages_halve(const float (*from)[4], size_t side, float (*to)[4]) {
  for (size_t y = 0; y + 1 < side; y += 2)
    for (size_t x = 0; x + 1 < side; x += 2, to++) {
      const float(*at)[4] = from + y * side + x;
      for (int k = 0; k < 4; k++)
        (*to)[k] = 0.25f * (at[0][k] + at[1][k] + at[side][k] + at[side + 1][k]);
    }
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
