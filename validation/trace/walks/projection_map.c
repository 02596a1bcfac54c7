#include "validation/trace/walks/projection_map.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "validation/trace/transport/lamp_place.h"
#include "validation/trace/transport/random.h"
#include "validation/trace/walks/ray_batch.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { TRIALS = 8, TOGETHER = ABBE_RAY_LANES / TRIALS /* cells of a packet */ };
/* Share of photons for a cell whose trials meet no refractor, against one whose trials all do. */
static const double least_share = 0.03;

/* ---- the plane ---- */

static void ray_at(const abbe_projection_map *a, float x, float y, float o[3], float d[3]) {
  if (a->parallel) {
    for (int k = 0; k < 3; k++) {
      o[k] = a->origin[k] + x * a->right[k] + y * a->up[k];
      d[k] = a->way[k];
    }
    return;
  }
  float square = x * x + y * y, left = 1 - 0.25f * square;
  float across = sqrtf(left > 0 ? left : 0), along = 1 - 0.5f * square;
  for (int k = 0; k < 3; k++) {
    o[k] = a->origin[k];
    d[k] = across * (x * a->right[k] + y * a->up[k]) + along * a->way[k];
  }
}

/* 1 - cos of the angle between d and the light's own direction, also where it is tiny. */
static float versine(const abbe_projection_map *a, const float d[3]) {
  float square = 0;
  for (int k = 0; k < 3; k++) square += (d[k] - a->facing[k]) * (d[k] - a->facing[k]);
  return 0.5f * square;
}

/* Intensity of the spot along d, relative to its middle. */
static float profile(const abbe_projection_map *a, const float d[3]) {
  float v = versine(a, d);
  if (!(v <= a->outer)) return 0;
  if (v <= a->inner) return 1;
  float x = (a->outer - v) / (a->outer - a->inner);
  return x * x * (3 - 2 * x);
}

/* A place on the disk or rectangle of the light, from its middle. */
static void disk_place(const abbe_projection_map *a, const float disk[2], float out[3]) {
  if (a->light->kind == ABBE_LIGHT_RECTANGLE) {
    const float x = 2 * disk[0] - 1, y = 2 * disk[1] - 1;
    for (int k = 0; k < 3; k++) out[k] = x * a->edge[0][k] + y * a->edge[1][k];
    return;
  }
  float r = a->radius * sqrtf(disk[0]), angle = 2 * (float)ABBE_PI * disk[1], s[3], t[3];
  abbe_geometry_across(a->facing, s, t);
  for (int k = 0; k < 3; k++) out[k] = r * (cosf(angle) * s[k] + sinf(angle) * t[k]);
}

float abbe_projection_map_ray(const abbe_projection_map *a, const abbe_projection_map_cell *cell,
                              const float uv[2], const float disk[2], float o[3], float d[3]) {
  float x = a->low + a->step * ((float)cell->x + uv[0]);
  float y = a->low + a->step * ((float)cell->y + uv[1]);
  ray_at(a, x, y, o, d);
  if (!a->parallel && x * x + y * y >= 4) return 0; /* beyond the sphere of directions */
  float flux = a->power * a->measure;
  if (a->light->kind == ABBE_LIGHT_SPOT) return flux * profile(a, d);
  if (a->radius > 0) {
    float off[3];
    disk_place(a, disk, off);
    for (int k = 0; k < 3; k++) o[k] += off[k];
    abbe_lamp_clear(a->light, o, o);
    flux *= fmaxf(d[0] * a->facing[0] + d[1] * a->facing[1] + d[2] * a->facing[2], 0);
  }
  return flux;
}

SIDE_BY_SIDE void abbe_projection_map_aim(const abbe_projection_map *a,
                                          abbe_projection_map_rays *r) {
  enum { LANES = ABBE_PROJECTION_MAP_LANES };
  const float whole = a->power * a->measure, low = a->low, step = a->step;
  float x[LANES], y[LANES], along[LANES], square[LANES];
  for (int k = 0; k < LANES; k++) {
    x[k] = low + step * r->x[k];
    y[k] = low + step * r->y[k];
    square[k] = x[k] * x[k] + y[k] * y[k];
  }
  if (a->parallel) {
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < LANES; k++) {
        r->o[i][k] = a->origin[i] + x[k] * a->right[i] + y[k] * a->up[i];
        r->d[i][k] = a->way[i];
      }
    for (int k = 0; k < LANES; k++) r->flux[k] = whole;
    return;
  }
  for (int k = 0; k < LANES; k++) {
    float left = 1 - 0.25f * square[k], across = sqrtf(left > 0 ? left : 0);
    x[k] *= across;
    y[k] *= across;
    along[k] = 1 - 0.5f * square[k];
    r->flux[k] = square[k] < 4 ? whole : 0;
  }
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < LANES; k++) {
      r->o[i][k] = a->origin[i];
      r->d[i][k] = x[k] * a->right[i] + y[k] * a->up[i] + along[k] * a->way[i];
    }
  if (a->light->kind != ABBE_LIGHT_SPOT) return;
  const float fx = a->facing[0], fy = a->facing[1], fz = a->facing[2], outer = a->outer;
  const float inner = a->inner, fade = outer > inner ? 1 / (outer - inner) : 0;
  for (int k = 0; k < LANES; k++) {
    float u = r->d[0][k] - fx, v = r->d[1][k] - fy, w = r->d[2][k] - fz;
    float versine = 0.5f * (u * u + v * v + w * w), part = (outer - versine) * fade;
    part = part * part * (3 - 2 * part);
    part = versine <= inner ? 1 : part;
    r->flux[k] *= versine <= outer ? part : 0;
  }
}

/* ---- what of the plane a ball covers ---- */

typedef struct patch {
  double x, y, radius; /* a disc of the plane that holds the ball's image; radius < 0: everything */
  double own;          /* the part of radius that is the ball's, not the light's */
} patch;

static patch cover(const abbe_projection_map *a, const double centre[3], double radius) {
  double to[3], x = 0, y = 0, z = 0;
  for (int k = 0; k < 3; k++) {
    to[k] = centre[k] - (double)a->origin[k];
    x += to[k] * (double)a->right[k];
    y += to[k] * (double)a->up[k];
    z += to[k] * (double)a->way[k];
  }
  if (a->parallel) return (patch){x, y, radius, radius};
  double distance = abbe_vector_length(to), grown = radius + (double)a->radius;
  if (distance <= grown * 1.0001) return (patch){.radius = -1};
  double cap = asin(grown / distance), off = acos(fmin(fmax(z / distance, -1), 1));
  double across = hypot(x, y), r = 2 * sin(0.5 * off);
  /* the map stretches angles by 1 / cos(half the angle off its axis), at the most */
  if (off + cap > 0.95 * ABBE_PI) return (patch){.radius = -1};
  double scale = across > 0 ? r / across : 0;
  double stretch = 1 / cos(0.5 * (off + cap));
  return (patch){x * scale, y * scale, stretch * cap, stretch * asin(radius / distance)};
}

/* Images of every piece of the refractors, largest first halved until it is small. */
typedef struct cover_list {
  const abbe_projection_map *map;
  void (*take)(void *user, patch p);
  void *user;
  double fine; /* pieces below this radius are not split, nor small ones before a large lamp */
} cover_list;

/* Halves the longest edge, so that a thin triangle becomes a row of pieces as wide as it is. */
static void cover_triangle(const cover_list *list, const double *const corner[3], int splits) {
  double centre[3], radius = 0, longest = -1;
  int from = 0;
  for (int k = 0; k < 3; k++) centre[k] = (corner[0][k] + corner[1][k] + corner[2][k]) / 3;
  for (int i = 0; i < 3; i++) {
    double out[3], edge[3];
    abbe_vector_subtract(corner[i], centre, out);
    abbe_vector_subtract(corner[(i + 1) % 3], corner[i], edge);
    radius = fmax(radius, abbe_vector_length(out));
    double length = abbe_vector_length(edge);
    if (length > longest) longest = length, from = i;
  }
  patch p = cover(list->map, centre, radius * 1.000001);
  if (splits == 0 || (p.radius >= 0 && p.own <= fmax(list->fine, 0.1 * p.radius))) {
    list->take(list->user, p);
    return;
  }
  const double *a = corner[from], *b = corner[(from + 1) % 3], *c = corner[(from + 2) % 3];
  double middle[3];
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (a[k] + b[k]);
  cover_triangle(list, (const double *const[3]){a, middle, c}, splits - 1);
  cover_triangle(list, (const double *const[3]){middle, b, c}, splits - 1);
}

enum { ASKED = 256 }; /* faces or cells between two questions whether they are wanted */

static void cover_surface(const abbe_geometry *g, const abbe_surface *s, const cover_list *list) {
  if (s->sphere) {
    double centre[3] = {(double)s->centre[0], (double)s->centre[1], (double)s->centre[2]};
    list->take(list->user, cover(list->map, centre, (double)s->radius * 1.000001));
    return;
  }
  size_t faces = g->scene->object[s->object].mesh.face_count;
  for (size_t i = 0; i < faces && (i % ASKED != 0 || abbe_watch_goes_on()); i++) {
    double corner[3][3];
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) corner[c][k] = (double)s->position[s->face[i][c]][k];
    /* large faces are worth splitting, the many small ones of a mesh are not */
    cover_triangle(list, (const double *const[3]){corner[0], corner[1], corner[2]},
                   faces > 4096 ? 4 : 12);
  }
}

static void cover_all(const abbe_geometry *g, const cover_list *list) {
  for (size_t i = 0; i < g->surface_count; i++)
    if (g->surface[i].kind & ABBE_GEOMETRY_SPECULAR) cover_surface(g, &g->surface[i], list);
}

static void take_extent(void *user, patch p) {
  double *extent = user;
  double reach = p.radius < 0 ? 2 : fmax(fabs(p.x), fabs(p.y)) + p.radius;
  *extent = fmax(*extent, reach);
}

typedef struct marks {
  unsigned char at[ABBE_PROJECTION_MAP_SIDE][ABBE_PROJECTION_MAP_SIDE]; /* [y][x] */
  unsigned short done[ABBE_PROJECTION_MAP_SIDE]
                     [ABBE_PROJECTION_MAP_SIDE]; /* radius in steps of a disc around a cell */
  double low, step;
} marks;

static int cell_of(const marks *m, double at) {
  double cell = floor((at - m->low) / m->step);
  return (int)fmin(fmax(cell, 0), ABBE_PROJECTION_MAP_SIDE - 1);
}

/* The many patches of a fine mesh before a large lamp are much larger than their distances: those
 * around one cell are taken as one, a little wider. False where that was marked before. */
static bool widen(marks *m, patch *p) {
  double size = p->radius / m->step;
  if (size < 4 || p->own > 0.5 * p->radius) return true;
  int q = 1 + (int)fmin(size / 12, ABBE_PROJECTION_MAP_SIDE - 1);
  int x = cell_of(m, p->x) / q * q + q / 2, y = cell_of(m, p->y) / q * q + q / 2;
  if (x >= ABBE_PROJECTION_MAP_SIDE) x = ABBE_PROJECTION_MAP_SIDE - 1;
  if (y >= ABBE_PROJECTION_MAP_SIDE) y = ABBE_PROJECTION_MAP_SIDE - 1;
  double middle[2] = {m->low + (x + 0.5) * m->step, m->low + (y + 0.5) * m->step};
  double away = fmax(fabs(p->x - middle[0]), fabs(p->y - middle[1])) / m->step;
  double most = 0.5 * (q + (q > 1)) * 1.001;
  if (away > most) return true; /* beyond the plane's cells */
  double steps = fmin(ceil(size + sqrt(2) * most), 60000);
  if (m->done[y][x] >= steps) return false;
  m->done[y][x] = (unsigned short)steps;
  *p = (patch){middle[0], middle[1], steps * m->step, p->own};
  return true;
}

static void take_marks(void *user, patch p) {
  marks *m = user;
  if (p.radius < 0) {
    memset(m->at, 1, sizeof m->at);
    return;
  }
  if (!widen(m, &p)) return;
  double reach = p.radius + 0.05 * m->step;
  int x0 = cell_of(m, p.x - reach), x1 = cell_of(m, p.x + reach);
  int y0 = cell_of(m, p.y - reach), y1 = cell_of(m, p.y + reach);
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++) {
      double left = m->low + x * m->step, down = m->low + y * m->step;
      double dx = fmax(fmax(left - p.x, p.x - left - m->step), 0);
      double dy = fmax(fmax(down - p.y, p.y - down - m->step), 0);
      if (dx * dx + dy * dy <= reach * reach) m->at[y][x] = 1;
    }
}

/* ---- shares ---- */

/* What `count` cells, of which the first is number `index`, are worth to photons, and the flux of
 * each. */
static void try_cells(const abbe_geometry *g, const abbe_projection_map *a,
                      const abbe_projection_map_cell *cell, size_t count, uint32_t index,
                      double share[TOGETHER], double flux[TOGETHER]) {
  RTC_ALIGN(64) struct RTCRayHit16 packet;
  size_t rays = 0, of[ABBE_RAY_LANES];
  double watts[ABBE_RAY_LANES];
  memset(&packet, 0, sizeof packet);
  for (size_t c = 0; c < count; c++) {
    share[c] = flux[c] = 0;
    for (uint32_t i = 0; i < TRIALS; i++) {
      float r[4], o[3], d[3];
      abbe_random4(index + (uint32_t)c, i, 0x61696d, 0, r);
      r[0] = ((float)(i % 4) + r[0]) / 4;
      r[1] = ((float)(i / 4) + r[1]) / 2;
      const double f = (double)abbe_projection_map_ray(a, &cell[c], r, r + 2, o, d) / TRIALS;
      if (!(f > 0)) continue;
      abbe_ray_put(&packet, rays, o, d);
      watts[rays] = f;
      of[rays++] = c;
      flux[c] += f;
    }
  }
  abbe_ray_prepare(&packet, 1);
  abbe_ray_reset(&packet);
  if (rays > 0) abbe_embree_intersect_16(g->embree, &packet, rays, true);
  for (size_t k = 0; k < rays; k++) {
    const unsigned id = packet.hit.geomID[k];
    if (id != RTC_INVALID_GEOMETRY_ID && (g->surface[id].kind & ABBE_GEOMETRY_SPECULAR) != 0)
      share[of[k]] += watts[k];
  }
  const double whole = (double)a->power * (double)a->measure;
  for (size_t c = 0; c < count; c++) share[c] = fmax(share[c], least_share * whole);
}

/* Every second bit of x. */
static uint32_t gather_bits(uint32_t x) {
  x &= 0x55555555;
  x = (x | x >> 1) & 0x33333333;
  x = (x | x >> 2) & 0x0f0f0f0f;
  x = (x | x >> 4) & 0x00ff00ff;
  return (x | x >> 8) & 0x0000ffff;
}

static float angle_of(float versine) {
  return 2 * asinf(fminf(sqrtf(0.5f * versine), 1));
}

/* Whether all of the cell lies outside the spot's cone, or beyond the sphere of directions. */
static bool dark(const abbe_projection_map *a, const abbe_projection_map_cell *cell) {
  if (a->parallel) return false;
  float nearest = 1e30f, v = 2;
  for (int i = 0; i < 9; i++) {
    float x = a->low + a->step * ((float)cell->x + 0.5f * (float)(i % 3));
    float y = a->low + a->step * ((float)cell->y + 0.5f * (float)(i / 3)), o[3], d[3];
    nearest = fminf(nearest, x * x + y * y);
    ray_at(a, x, y, o, d);
    v = fminf(v, versine(a, d));
  }
  if (nearest >= 4) return true;
  /* between the nine places the angle grows by less than half a cell, stretched */
  float slack = a->step / sqrtf(fmaxf(1 - nearest / 4, 0.01f));
  return a->light->kind == ABBE_LIGHT_SPOT && angle_of(v) > angle_of(a->outer) + slack;
}

static abbe_result keep_cells(const abbe_geometry *g, const marks *m, abbe_projection_map *a,
                              abbe_error *error) {
  size_t marked = 0;
  for (int y = 0; y < ABBE_PROJECTION_MAP_SIDE; y++)
    for (int x = 0; x < ABBE_PROJECTION_MAP_SIDE; x++) marked += m->at[y][x];
  a->cell = calloc(marked + 1, sizeof *a->cell);
  if (a->cell == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu cells of light", marked);
  /* along a Z-order curve, so that photons that follow one another are neighbours */
  for (uint32_t i = 0; i < ABBE_PROJECTION_MAP_SIDE * ABBE_PROJECTION_MAP_SIDE; i++) {
    const uint16_t x = (uint16_t)gather_bits(i), y = (uint16_t)gather_bits(i >> 1);
    const abbe_projection_map_cell cell = {.x = x, .y = y};
    if (m->at[y][x] && !dark(a, &cell)) a->cell[a->count++] = cell;
  }
  double total = 0, share[TOGETHER], flux[TOGETHER];
  for (size_t i = 0; i < a->count && (i % ASKED != 0 || abbe_watch_goes_on()); i += TOGETHER) {
    const size_t count = a->count - i < TOGETHER ? a->count - i : TOGETHER;
    try_cells(g, a, &a->cell[i], count, (uint32_t)i, share, flux);
    for (size_t c = 0; c < count; c++) {
      a->cell[i + c].share = (float)share[c];
      a->reach += flux[c];
      total += share[c];
    }
  }
  for (size_t i = 0; i < a->count; i++)
    a->cell[i].share = (float)((double)a->cell[i].share / total);
  return ABBE_OK;
}

/* ---- make ---- */

/* The plane's axes around a way. */
static void turn(abbe_projection_map *a, const double way[3]) {
  double right[3], up[3];
  double hint[3] = {fabs(way[0]) < 0.6, fabs(way[0]) >= 0.6, 0};
  abbe_vector_cross(hint, way, right);
  abbe_vector_normalise(right);
  abbe_vector_cross(way, right, up);
  for (int k = 0; k < 3; k++) {
    a->way[k] = (float)way[k];
    a->right[k] = (float)right[k];
    a->up[k] = (float)up[k];
  }
}

static void look(const abbe_geometry *g, abbe_projection_map *a) {
  const abbe_light *light = a->light;
  double middle[3], way[3], min[3], max[3], far = 0;
  for (int k = 0; k < 3; k++) middle[k] = -(double)a->origin[k];
  if (a->parallel) {
    /* the plane stands before everything that may be in the light's way */
    abbe_scene_bounds(g->scene, true, true, min, max);
    abbe_scene_hold_lights(g->scene, min, max);
    for (int k = 0; k < 3; k++) {
      middle[k] = light->direction[k];
      far += pow(fmax(fabs(min[k] - g->origin[k]), fabs(max[k] - g->origin[k])) / g->unit, 2);
    }
    for (int k = 0; k < 3; k++) a->origin[k] = (float)(-light->direction[k] * 1.01 * sqrt(far));
  }
  memcpy(way, middle, sizeof way);
  if (!abbe_vector_normalise(way)) memcpy(way, (double[3]){0, 0, -1}, sizeof way);
  for (int k = 0; k < 3; k++) a->facing[k] = (float)light->direction[k];
  turn(a, way);
}

static double versine_of(double angle) {
  return 2 * pow(sin(0.5 * angle), 2);
}

abbe_result abbe_projection_map_make(const abbe_geometry *geometry, size_t light,
                                     abbe_projection_map *out, abbe_error *error) {
  assert(geometry->scene && light < geometry->scene->light_count);
  const abbe_light *l = &geometry->scene->light[light];
  abbe_projection_map a = {
      .light = l, .parallel = l->kind == ABBE_LIGHT_DIRECTIONAL, .power = (float)l->power};
  *out = a;
  if (!a.parallel) abbe_geometry_to_frame(geometry, l->position, a.origin);
  if (abbe_light_has_size(l)) {
    a.radius = (float)(l->radius / geometry->unit);
    a.power = (float)(l->power * abbe_light_area(l));
    for (int i = 0; i < 2; i++)
      for (int k = 0; k < 3; k++) a.edge[i][k] = (float)(l->edge[i][k] / geometry->unit);
  }
  a.outer = (float)versine_of(l->cone_rad);
  a.inner = (float)versine_of(fmax(l->cone_rad - l->soft_rad, 0));
  look(geometry, &a);
  double extent = 0;
  cover_list list = {.map = &a, .take = take_extent, .user = &extent, .fine = 0.02};
  cover_all(geometry, &list);
  *out = a;
  const abbe_result wanted = abbe_watch_check(error);
  if (wanted != ABBE_OK || !(extent > 0)) return wanted;
  if (!a.parallel) extent = fmin(extent, 2);
  /* a cone that is narrower than the refractors makes the smaller plane */
  double cone = 2 * sin(0.5 * l->cone_rad) * 1.0001;
  if (l->kind == ABBE_LIGHT_SPOT && cone < extent) {
    extent = cone;
    turn(&a, l->direction);
  }
  marks *m = calloc(1, sizeof *m);
  if (m == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for cells of light");
  m->low = -extent;
  m->step = 2 * extent / ABBE_PROJECTION_MAP_SIDE;
  a.low = (float)m->low;
  a.step = (float)m->step;
  double side = m->step * (a.parallel ? geometry->unit : 1);
  a.measure = (float)(side * side);
  list = (cover_list){.map = &a, .take = take_marks, .user = m, .fine = 2 * m->step};
  cover_all(geometry, &list);
  abbe_result result = keep_cells(geometry, m, &a, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  free(m);
  if (result != ABBE_OK) abbe_projection_map_free(&a);
  *out = a;
  return result;
}

void abbe_projection_map_free(abbe_projection_map *map) {
  if (map == NULL) return;
  free(map->cell);
  *map = (abbe_projection_map){0};
}
