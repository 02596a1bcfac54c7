#include "scenes/volume/exits/exit_pages.h"

#include "base/maths.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_REACH = 26 }; /* texels */

/* The sum of a tent of that half width, whose middle is 0, up to x. */
static double tent_upto(double x, double wide) {
  const double at = fmin(fmax(x / wide, -1), 1);
  return 0.5 + at - 0.5 * at * fabs(at);
}

/* Shares of texels at 0, 1 ... from the middle; returns the last. Places among four texels have a
 * variance of 1/6 already, and texels one of a twelfth. */
static size_t make_shares(float wide, size_t side, float share[MOST_REACH + 1]) {
  const double square = (double)wide * (double)wide - 1.5;
  const double most = side < MOST_REACH ? (double)side : MOST_REACH;
  share[0] = 1;
  if (!(square > 0.25)) return 0;
  const double own = fmin(sqrt(square), most - 0.5);
  const size_t reach = (size_t)ceil(own - 0.5);
  for (size_t i = 0; i <= reach; i++)
    share[i] = (float)(tent_upto((double)i + 0.5, own) - tent_upto((double)i - 0.5, own));
  return reach;
}

/* Folds a place before the first texel or after the last; at: counted from `reach` before the
 * first. */
static size_t fold(size_t at, size_t reach, size_t side) {
  const size_t i = at < reach ? reach - at - 1 : at - reach;
  return i < side ? i : 2 * side - i - 1;
}

static void add_row(const float *from, size_t count, float share, float *to) {
  for (size_t i = 0; i < count; i++) to[i] += share * from[i];
}

/* The share in a row of texels around the i-th of those by whose shares they are summed up. */
static float share_at(const float *share, size_t reach, size_t i) {
  return share[i < reach ? reach - i : i - reach];
}

void abbe_exit_map_smooth(const float (*from)[4], size_t side, const float wide[2],
                          float (*to)[4]) {
  float across[MOST_REACH + 1], up[MOST_REACH + 1];
  const size_t columns = make_shares(wide[0], side, across), rows = make_shares(wide[1], side, up);
#pragma omp parallel for
  for (size_t y = 0; y < side; y++) {
    float row[ABBE_EXIT_MAP_MOST_SIDE + 2 * MOST_REACH][4]; /* with what is folded back */
    memset(row[columns], 0, side * sizeof *row);
    for (size_t i = 0; i < 2 * rows + 1; i++)
      add_row(from[fold(y + i, rows, side) * side], 4 * side, share_at(up, rows, i), row[columns]);
    for (size_t i = 0; i < columns; i++) {
      memcpy(row[i], row[columns + fold(i, columns, side)], sizeof *row);
      memcpy(row[columns + side + i], row[columns + fold(columns + side + i, columns, side)],
             sizeof *row);
    }
    memset(to[y * side], 0, side * sizeof *to);
    for (size_t i = 0; i < 2 * columns + 1; i++)
      add_row(row[i], 4 * side, share_at(across, columns, i), to[y * side]);
  }
}

enum { BINS = 512 };
/* PARTS of the points, which threads do side by side, each with maps of its own; no result depends
 * on who does which. One in FEWER points shows where the light falls. */
enum { PARTS = 4, FEWER = 13 };

/* A window leaves so much of a side's light out on each of its ends. */
static const double left_out = 0.0025;
/* The width of a ray on a receiver: so many times the distance between rays as they come in. */
static const double widening = 4;
/* Parts of a ray are at most so many of half that width, or of a texel, apart. */
static const float part_width = 1;

/* What all parts of the points share. */
typedef struct landing {
  const abbe_exit_colours *colours;
  const abbe_exit_sheet *sheet;
  size_t sheets;
  float (*wide)[2];       /* [sheets] half the width of a ray, in parts of the edges */
  float (*apart)[2];      /* [sheets] how far parts of a ray may be, in those */
  abbe_exit_track *track; /* [PARTS][sheets] space for a ray's */
  abbe_exit_pages *pages;
} landing;

/* What a part of the points catches. */
typedef struct catching {
  const landing *all;
  abbe_exit_track *track; /* [sheets] of a ray */
  uint32_t turn;          /* turn of rays */
  double (
      *flux)[2][BINS]; /* [tiles] of Y, by place along each edge: while windows are looked for */
  float (**value)[4];  /* [tiles][2] maps as the tiles have them, of W; NULL: nothing has hit one */
  double landed;       /* Y, W */
  bool full;           /* no memory was left */
} catching;

/* As many as leave no gap between them: parts of one ray lie where those of its neighbours do not.
 */
static size_t count_parts(const landing *all, const abbe_exit_track *track, size_t bin) {
  double end[2];
  abbe_exit_landing at;
  abbe_exit_colours_ends(all->colours, bin, end);
  if (!(end[1] > end[0])) return 1;
  const float step[ABBE_EXIT_MOST_PARTS] = {(float)end[0], (float)end[1]};
  abbe_exit_sheets_meet(track, all->sheets, step, 2, &at);
  if (at.page[0] < 0 || at.page[0] != at.page[1]) return ABBE_EXIT_MOST_PARTS;
  const float *apart = all->apart[at.page[0] / 2];
  const float u = (at.u[1] - at.u[0]) / apart[0], v = (at.v[1] - at.v[0]) / apart[1];
  const float parts = ceilf(sqrtf(u * u + v * v));
  return parts < ABBE_EXIT_MOST_PARTS ? (size_t)parts : ABBE_EXIT_MOST_PARTS;
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

/* The sums of all parts. */
static void fit_windows(const landing *all, const catching c[PARTS]) {
  abbe_exit_pages *p = all->pages;
  for (size_t i = 0; i < p->count; i++)
    for (int a = 0; a < 2; a++) {
      double flux[BINS] = {0}, sum = 0, low, high;
      for (size_t part = 0; part < PARTS; part++)
        for (size_t k = 0; k < BINS; k++) flux[k] += c[part].flux[i][a][k];
      for (size_t k = 0; k < BINS; k++) sum += flux[k];
      if (!(sum > 0)) continue;
      cut_ends(flux, sum, 2 * (double)all->wide[i / 2][a], &low, &high);
      p->window[i][a] = (float)low;
      p->window[i][2 + a] = (float)(1 / (high - low));
    }
}

/* ---- texels ---- */

/* The map of a tile, or its finer map: one of the part's own. */
static float (*map_of(catching *c, size_t page, size_t fine))[4] {
  const size_t side = c->all->pages->side;
  float(**map)[4] = &c->value[2 * page + fine];
  if (*map == NULL) *map = calloc(side * side, sizeof **map);
  c->full = c->full || *map == NULL;
  return *map;
}

/* A part of a ray hits a sheet: counted while windows are looked for, else added. xyz: W. */
static void land(catching *c, size_t page, float u, float v, const float xyz[4]) {
  const abbe_exit_pages *p = c->all->pages;
  if (c->value == NULL) {
    c->flux[page][0][(size_t)(u * (BINS - 1e-3f))] += (double)xyz[1];
    c->flux[page][1][(size_t)(v * (BINS - 1e-3f))] += (double)xyz[1];
    return;
  }
  const float *w = p->window[page], n = (float)p->side;
  const float x = (u - w[0]) * w[2], y = (v - w[1]) * w[3];
  const bool fine = x >= 0 && x <= 1 && y >= 0 && y <= 1;
  float(*map)[4] = map_of(c, page, fine);
  c->landed += (double)xyz[1];
  if (map != NULL)
    abbe_exit_map_add(map, (int)p->side, n * (fine ? x : u), n * (fine ? y : v), xyz);
}

static void catch_ray(void *user, const abbe_exit_ray *ray, double flux, size_t bin) {
  catching *c = user;
  const landing *all = c->all;
  float step[ABBE_EXIT_MOST_PARTS] = {0};
  float room[1][4];
  const float(*colour)[4];
  abbe_exit_landing at;
  abbe_exit_sheets_track(all->sheet, all->sheets, ray, c->track);
  const size_t parts = abbe_exit_colours_split(
      all->colours, ray, bin, count_parts(all, c->track, bin), c->turn++, step, room, &colour);
  abbe_exit_sheets_meet(c->track, all->sheets, step, parts, &at);
  for (size_t i = 0; i < parts; i++) {
    if (at.page[i] < 0) continue;
    float xyz[4];
    for (int k = 0; k < 4; k++) xyz[k] = (float)flux * colour[i][k];
    land(c, (size_t)at.page[i], at.u[i], at.v[i], xyz);
  }
}

/* ---- all points ---- */

/* What each part's rays meet; of so many points one. */
static abbe_result catch_parts(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                               size_t fewer, catching c[PARTS], abbe_error *error) {
  abbe_result result[PARTS];
#pragma omp parallel for schedule(dynamic)
  for (size_t part = 0; part < PARTS; part++)
    result[part] =
        abbe_exit_light_part(v, desc, part * fewer, PARTS * fewer, catch_ray, &c[part], NULL);
  for (size_t part = 0; part < PARTS; part++)
    if (result[part] != ABBE_OK || c[part].full)
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for rays");
  return ABBE_OK;
}

/* Where the light falls, by a few of the points. */
static abbe_result find_windows(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                                const landing *all, abbe_error *error) {
  catching c[PARTS];
  double(*flux)[2][BINS] = calloc(PARTS * all->pages->count + 1, sizeof *flux);
  if (flux == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  for (size_t part = 0; part < PARTS; part++)
    c[part] = (catching){.all = all,
                         .track = all->track + part * all->sheets,
                         .flux = flux + part * all->pages->count};
  const size_t fewer = v->exits.points < PARTS * FEWER ? 1 : FEWER;
  const abbe_result result = catch_parts(v, desc, fewer, c, error);
  if (result == ABBE_OK) fit_windows(all, c);
  free(flux);
  return result;
}

/* A tile's map from those of all parts, in their order; sum: space for one. */
static void finish_map(const landing *all, const catching c[PARTS], size_t map, float (*sum)[4]) {
  abbe_exit_pages *p = all->pages;
  const size_t texels = p->side * p->side, page = map / 2;
  float wide[2], scale = 1 / (float)all->sheet[page / 2].area;
  size_t landed = 0;
  for (int a = 0; a < 2; a++) {
    const float edge = (float)p->side * (map % 2 == 1 ? p->window[page][2 + a] : 1);
    wide[a] = all->wide[page / 2][a] * edge;
    scale *= edge;
  }
  for (size_t part = 0; part < PARTS; part++) {
    const float *from = (const float *)c[part].value[map];
    if (from == NULL) continue;
    float *to = sum[0];
    const bool first = landed++ == 0;
    for (size_t i = 0; i < 4 * texels; i++) to[i] = (first ? 0 : to[i]) + scale * from[i];
  }
  if (landed > 0)
    abbe_exit_map_smooth((const float(*)[4])sum, p->side, wide, p->value + map * texels);
}

/* Light that a few points did not show has a tile without a window: the finer map of all of it. */
static void open_windows(const catching c[PARTS], abbe_exit_pages *p) {
  for (size_t page = 0; page < p->count; page++)
    for (size_t part = 0; part < PARTS; part++)
      for (size_t fine = 0; fine < 2; fine++)
        if (c[part].value[2 * page + fine] != NULL && !(p->window[page][2] > 0))
          p->window[page][2] = p->window[page][3] = 1;
}

static abbe_result make_texels(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                               const landing *all, abbe_error *error) {
  abbe_exit_pages *p = all->pages;
  catching c[PARTS];
  float(*sum)[4] = malloc((p->side * p->side + 1) * sizeof *sum);
  abbe_result result = sum != NULL ? ABBE_OK : ABBE_NO_MEMORY;
  for (size_t part = 0; part < PARTS; part++) {
    c[part] = (catching){
        .all = all, .track = all->track + part * all->sheets, .turn = (uint32_t)part << 24};
    c[part].value = calloc(2 * p->count + 1, sizeof *c[part].value);
    if (c[part].value == NULL) result = ABBE_NO_MEMORY;
  }
  if (result == ABBE_OK)
    result = catch_parts(v, desc, 1, c, error);
  else
    abbe_error_set(error, result, "no memory for pages");
  for (size_t map = 0; result == ABBE_OK && map < 2 * p->count; map++) finish_map(all, c, map, sum);
  if (result == ABBE_OK) open_windows(c, p);
  for (size_t part = 0; part < PARTS; part++) {
    p->flux += c[part].landed;
    for (size_t map = 0; c[part].value != NULL && map < 2 * p->count; map++)
      free(c[part].value[map]);
    free(c[part].value);
  }
  free(sum);
  return result;
}

/* How wide rays are on a sheet, and how far their parts may be from each other on the maps of the
 * windows, as far as there are any. */
static void set_widths(const landing *all, double spacing) {
  const abbe_exit_pages *p = all->pages;
  for (size_t i = 0; i < all->sheets; i++)
    for (int a = 0; a < 2; a++) {
      const double *by = a == 0 ? all->sheet[i].du : all->sheet[i].dv;
      const float edge = fmaxf(p->window[2 * i][2 + a], p->window[2 * i + 1][2 + a]);
      all->wide[i][a] = (float)(widening * spacing * abbe_vector_length(by));
      all->apart[i][a] =
          part_width * fmaxf(all->wide[i][a], edge > 0 ? 1 / (edge * (float)p->side) : 0);
    }
}

static abbe_result land_all(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                            const landing *all, abbe_error *error) {
  const size_t points = v->exits.points * v->exits.symmetry.count;
  const double spacing = sqrt(v->exits.area / (double)points);
  set_widths(all, spacing);
  abbe_result result = find_windows(v, desc, all, error);
  set_widths(all, spacing);
  return result == ABBE_OK ? make_texels(v, desc, all, error) : result;
}

abbe_result abbe_exit_pages_make(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                                 const double (*parallelogram)[9], size_t parallelograms,
                                 size_t side, abbe_exit_pages *out, abbe_error *error) {
  assert(desc->place);
  *out = (abbe_exit_pages){.side = side, .count = 2 * parallelograms};
  if (side < 1 || side > ABBE_EXIT_PAGES_MOST_SIDE || v->exits.points == 0)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "pages of %zu texels a side of %zu points: 1 to %d, of a volume with exits", side,
        v->exits.points, ABBE_EXIT_PAGES_MOST_SIDE);
  abbe_exit_colours *colours = NULL;
  abbe_exit_sheet *sheet = calloc(parallelograms + 1, sizeof *sheet);
  float(*wide)[2] = calloc(2 * parallelograms + 1, sizeof *wide);
  abbe_exit_track *track = malloc((PARTS * parallelograms + 1) * sizeof *track);
  out->window = calloc(out->count + 1, sizeof *out->window);
  out->value = calloc(out->count * 2 * side * side + 1, sizeof *out->value);
  abbe_exit_light_desc seen = *desc;
  seen.sheet = parallelogram;
  seen.sheets = parallelograms;
  abbe_result result = ABBE_OK;
  if (sheet == NULL || wide == NULL || track == NULL || out->window == NULL || out->value == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pages", out->count);
  for (size_t i = 0; result == ABBE_OK && i < parallelograms; i++)
    abbe_exit_sheet_make(parallelogram[i], desc->place, &sheet[i]);
  if (result == ABBE_OK) result = abbe_exit_colours_make(v, &seen, &colours, error);
  const landing all = {.colours = colours,
                       .sheet = sheet,
                       .sheets = parallelograms,
                       .wide = wide,
                       .apart = wide + parallelograms,
                       .track = track,
                       .pages = out};
  if (result == ABBE_OK) result = land_all(v, &seen, &all, error);
  abbe_exit_colours_free(colours);
  free(sheet);
  free(wide);
  free(track);
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
