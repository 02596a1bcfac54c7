#include "scenes/volume/exit_light.h"

#include "colorimetry/weights.h"
#include "scenes/geometry/vector.h"
#include "scenes/volume/half.h"

#include <stdlib.h>
#include <string.h>

/* A cell with less of its space left than that holds nothing. */
static const double least_space = 0.02;

/* Into the object's own coordinates. */
static void turn_back(const double turn[9], const double v[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = turn[k] * v[0] + turn[3 + k] * v[1] + turn[6 + k] * v[2];
}

static abbe_result find_planes(const abbe_exit_light_desc *d, double (**out)[4], size_t *count,
                               abbe_error *error) {
  const abbe_exact *exact = &d->object->exact;
  *count = exact->kind == ABBE_EXACT_CONVEX ? exact->count : 0;
  *out = malloc((*count + 1) * sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for planes");
  for (size_t i = 0; i < *count; i++) {
    turn_back(d->place->turn, exact->plane[i], (*out)[i]);
    (*out)[i][3] = exact->plane[i][3] - abbe_vector_dot(exact->plane[i], d->place->centre);
  }
  return ABBE_OK;
}

/* Whether something stands on the way from p along the unit vector d, up to a distance. */
static bool is_hidden(const abbe_exit_light_desc *desc, const double p[3], const double d[3],
                      double limit) {
  for (size_t i = 0; i < desc->sheets; i++) {
    const double *u = desc->sheet[i] + 3, *v = desc->sheet[i] + 6;
    double n[3], from[3], at[3], du[3], dv[3];
    abbe_vector_cross(u, v, n);
    abbe_vector_subtract(desc->sheet[i], p, from);
    const double t = abbe_vector_dot(n, from) / abbe_vector_dot(n, d);
    if (!(t > 1e-9 * abbe_vector_length(from)) || !(t < limit)) continue;
    for (int k = 0; k < 3; k++) at[k] = t * d[k] - from[k];
    abbe_vector_cross(v, n, du);
    abbe_vector_cross(n, u, dv);
    const double square = abbe_vector_dot(n, n), x = abbe_vector_dot(at, du) / square,
                 y = abbe_vector_dot(at, dv) / square;
    if (x >= 0 && x <= 1 && y >= 0 && y <= 1) return true;
  }
  return false;
}

/* To a light that is far away, unit. */
static bool look_along(const abbe_exit_light_desc *desc, double to_light[3]) {
  for (int k = 0; k < 3; k++) to_light[k] = -desc->light->direction[k];
  return abbe_vector_normalise(to_light);
}

/* From a place of the world to the light, unit, and the irradiance across the beam there of a power
 * of 1. */
static double look_at_light(const abbe_exit_light_desc *desc, const double from[3],
                            double to_light[3]) {
  const abbe_light *light = desc->light;
  double square = 1;
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
    for (int k = 0; k < 3; k++) to_light[k] = -light->direction[k];
  } else {
    abbe_vector_subtract(light->position, from, to_light);
    square = abbe_vector_dot(to_light, to_light);
  }
  if (!abbe_vector_normalise(to_light)) return 0;
  const double away[3] = {-to_light[0], -to_light[1], -to_light[2]};
  const bool far = light->kind == ABBE_LIGHT_DIRECTIONAL;
  if (is_hidden(desc, from, to_light, far ? INFINITY : sqrt(square))) return 0;
  return abbe_light_profile(light, away) / square;
}

/* The point in the world. */
static void place_point(const abbe_volume_place *place, const double p[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = place->centre[i] + abbe_vector_dot(&place->turn[3 * i], p);
}

/* What a light and a table are asked with. */
typedef struct sight {
  const abbe_caustic_volume *volume;
  const abbe_exit_light_desc *desc;
  abbe_exit_light_take take;
  void *user;
  const double (*plane)[4];
  size_t planes;
  size_t first, step; /* of points: the first, and from one to the next */
} sight;

static void turn(const double map[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = abbe_vector_dot(&map[3 * i], v);
}

/* The rays of the points that a map makes of the table's: for them the light stands where the map
 * brings it from, and their rays go where the map brings them. */
static void send_image(const sight *s, const double map[9]) {
  const abbe_light_exits *e = &s->volume->exits;
  const abbe_exit_light_desc *d = s->desc;
  const double part = e->area / (double)(e->points * e->symmetry.count);
  const bool far = d->light->kind == ABBE_LIGHT_DIRECTIONAL;
  double to_light[3], own[3], there[3];
  abbe_exit_aim aim = {0};
  if (far) {
    if (!look_along(d, to_light)) return;
    turn_back(d->place->turn, to_light, own);
    turn_back(map, own, there);
    abbe_light_exits_aim(&s->volume->nodes, there, &aim);
  }
  for (size_t i = s->first; i < e->points; i += s->step) {
    double p[3], n[3], image[3], world[3];
    size_t bin;
    if (far && !abbe_light_exits_faces(e, i, there)) continue;
    abbe_light_exits_point(e, i, p, n, &bin);
    turn(map, p, image);
    place_point(d->place, image, world);
    const double strength = look_at_light(d, world, to_light);
    if (!far) {
      turn_back(d->place->turn, to_light, own);
      turn_back(map, own, there);
    }
    const double flux = part * strength * abbe_vector_dot(n, there);
    if (!(flux > 0)) continue;
    if (!far) abbe_light_exits_aim(&s->volume->nodes, there, &aim);
    abbe_exit_ray ray[3];
    const size_t count = abbe_light_exits_at(e, &aim, i, s->plane, s->planes, ray);
    for (size_t k = 0; k < count; k++) {
      abbe_exit_ray out = ray[k];
      turn(map, ray[k].place, out.place);
      turn(map, ray[k].way, out.way);
      turn(map, ray[k].place_by, out.place_by);
      turn(map, ray[k].way_by, out.way_by);
      s->take(s->user, &out, flux * ray[k].share, bin);
    }
  }
}

abbe_result abbe_exit_light_part(const abbe_caustic_volume *v, const abbe_exit_light_desc *d,
                                 size_t part, size_t parts, abbe_exit_light_take take, void *user,
                                 abbe_error *error) {
  ABBE_REQUIRE(v && d && d->light && d->object && d->place && take, error);
  const abbe_light_exits *e = &v->exits;
  double(*plane)[4];
  size_t planes;
  if (part >= parts)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "part %zu of %zu", part, parts);
  if (e->points == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the volume holds no exits");
  abbe_result result = find_planes(d, &plane, &planes, error);
  if (result != ABBE_OK) return result;
  const sight s = {v, d, take, user, (const double(*)[4])plane, planes, part, parts};
  for (size_t i = 0; i < e->symmetry.count; i++) send_image(&s, e->symmetry.map[i]);
  free(plane);
  return ABBE_OK;
}

abbe_result abbe_exit_light_rays(const abbe_caustic_volume *v, const abbe_exit_light_desc *d,
                                 abbe_exit_light_take take, void *user, abbe_error *error) {
  return abbe_exit_light_part(v, d, 0, 1, take, user, error);
}

/* ---- all its wavelengths ---- */

enum { PLACES = 1024 };

/* A ray that a clear object bends by its index stands for all wavelengths: it goes on as some, a
 * part of the light each. Others have their own alone. */
struct abbe_exit_colours {
  double own[ABBE_LIGHT_EXITS_BINS][3]; /* XYZ of a watt of a bin's points */
  double upto[ABBE_LIGHT_EXITS_BINS + 1];
  double sum[ABBE_LIGHT_EXITS_BINS + 1][3]; /* XYZ of all bins before */
  double index[ABBE_LIGHT_EXITS_BINS];
  bool known;           /* the index, and it spreads them */
  double place[PLACES]; /* index by the place among points */
  double part[ABBE_EXIT_MOST_PARTS + 1][ABBE_EXIT_MOST_PARTS]
             [3];     /* XYZ of a watt of each of so many */
  double least, most; /* index */
};

/* XYZ of wavelengths up to the place x of 0 to 1 among points by their chance. */
static void colour_upto(const abbe_exit_colours *s, double x, double xyz[3]) {
  size_t low = 0, high = ABBE_LIGHT_EXITS_BINS - 1;
  while (low < high) {
    const size_t middle = (low + high + 1) / 2;
    if (s->upto[middle] <= x)
      low = middle;
    else
      high = middle - 1;
  }
  const double part = fmin((x - s->upto[low]) / (s->upto[low + 1] - s->upto[low]), 1);
  for (int k = 0; k < 3; k++)
    xyz[k] = s->sum[low][k] + part * (s->sum[low + 1][k] - s->sum[low][k]);
}

/* By the place x of 0 to 1 among points. */
static double index_at(const abbe_exit_colours *s, double x) {
  return s->place[(size_t)fmin(x * PLACES, PLACES - 1)];
}

static void make_places(abbe_exit_colours *s) {
  size_t bin = 0;
  for (size_t i = 0; i < PLACES; i++) {
    while (bin + 1 < ABBE_LIGHT_EXITS_BINS && s->upto[bin + 1] <= ((double)i + 0.5) / PLACES) bin++;
    s->place[i] = s->index[bin];
  }
  for (size_t parts = 1; parts <= ABBE_EXIT_MOST_PARTS; parts++) {
    double before[3] = {0}, after[3];
    for (size_t i = 0; i < parts; i++) {
      colour_upto(s, ((double)i + 1) / (double)parts, after);
      for (int k = 0; k < 3; k++) {
        s->part[parts][i][k] = after[k] - before[k];
        before[k] = after[k];
      }
    }
  }
}

/* Its index where all wavelengths lose alike: of a clear object; of a grey mirror one that bends
 * nothing. */
static bool find_index(const abbe_object *o, double lambda_nm, double *n) {
  *n = 1;
  if (o->mirror) return o->conductor == NULL;
  return o->material != NULL && o->material->attenuation == NULL &&
         abbe_material_n(o->material, lambda_nm, n, NULL) == ABBE_OK;
}

/* A point stands for its bin with the bin's chance. */
static void fill_colours(const abbe_caustic_volume *v, const abbe_exit_light_desc *d,
                         abbe_exit_colours *s) {
  double chance[ABBE_LIGHT_EXITS_BINS];
  abbe_weights_range range;
  abbe_light_exits_chances(v->min_nm, v->max_nm, chance);
  abbe_weights_range_make_by(d->observer, &d->light->illuminant, d->min_nm, d->max_nm, &range);
  const double step = (v->max_nm - v->min_nm) / ABBE_LIGHT_EXITS_BINS;
  s->known = true;
  s->least = INFINITY;
  s->most = -INFINITY;
  for (size_t i = 0; i < ABBE_LIGHT_EXITS_BINS; i++) {
    const double from = v->min_nm + (double)i * step;
    double xyz[3];
    abbe_weights_range_xyz(&range, from, from + step, xyz);
    s->upto[i + 1] = s->upto[i] + chance[i];
    for (int k = 0; k < 3; k++) {
      s->own[i][k] = xyz[k] / chance[i];
      s->sum[i + 1][k] = s->sum[i][k] + xyz[k];
    }
    s->known = s->known && find_index(d->object, from + 0.5 * step, &s->index[i]);
    if (!s->known) continue;
    s->least = fmin(s->least, s->index[i]);
    s->most = fmax(s->most, s->index[i]);
  }
  if (s->known) make_places(s);
}

abbe_result abbe_exit_colours_make(const abbe_caustic_volume *v, const abbe_exit_light_desc *d,
                                   abbe_exit_colours **out, abbe_error *error) {
  ABBE_REQUIRE(v && d && d->light && d->object && out, error);
  *out = calloc(1, sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  fill_colours(v, d, *out);
  return ABBE_OK;
}

void abbe_exit_colours_free(abbe_exit_colours *colours) {
  free(colours);
}

void abbe_exit_colours_ends(const abbe_exit_colours *c, size_t bin, double end[2]) {
  end[0] = c->known ? c->least - c->index[bin] : 0;
  end[1] = c->known ? c->most - c->index[bin] : 0;
}

size_t abbe_exit_colours_split(const abbe_exit_colours *c, size_t bin, size_t parts, uint32_t turn,
                               abbe_exit_part out[ABBE_EXIT_MOST_PARTS]) {
  if (!c->known) {
    out[0].step = 0;
    memcpy(out[0].xyz, c->own[bin], sizeof out[0].xyz);
    return 1;
  }
  if (parts < 1) parts = 1;
  if (parts > ABBE_EXIT_MOST_PARTS) parts = ABBE_EXIT_MOST_PARTS;
  const double within = parts > 1 ? (double)(turn * 2654435769u) * 0x1p-32 : 0.5;
  for (size_t i = 0; i < parts; i++) {
    out[i].step = index_at(c, ((double)i + within) / (double)parts) - c->index[bin];
    memcpy(out[i].xyz, c->part[parts][i], sizeof out[i].xyz);
  }
  return parts;
}

/* ---- into cells ---- */

typedef struct deposit {
  const abbe_volume_region *region;
  abbe_region_piece *piece;
  double *weight; /* [cells] 1 / m3 of free space */
  float *value;
  abbe_exit_colours *colours;
  uint32_t turn; /* of rays, for the places within parts */
} deposit;

static void add_part(const deposit *d, const abbe_exit_ray *ray, const double xyz[3]) {
  const size_t count = abbe_volume_region_walk(d->region, ray->place, ray->way, INFINITY, d->piece);
  float f[9];
  for (size_t c = 0; c < 9; c++) f[c] = (float)(xyz[c / 3] * ray->way[c % 3]);
  for (size_t i = 0; i < count; i++) {
    const float share = (float)(d->piece[i].length * d->weight[d->piece[i].cell]);
    float *to = d->value + 9 * d->piece[i].cell;
    for (size_t c = 0; c < 9; c++) to[c] += share * f[c];
  }
}

/* The more parts the further its wavelengths go apart. */
static void add_ray(void *user, const abbe_exit_ray *ray, double flux, size_t bin) {
  static const double apart = 0.004; /* about rad */
  deposit *d = user;
  abbe_exit_part part[ABBE_EXIT_MOST_PARTS];
  double end[2], xyz[3];
  abbe_exit_colours_ends(d->colours, bin, end);
  const double all = (end[1] - end[0]) * abbe_vector_length(ray->way_by);
  const size_t parts = abbe_exit_colours_split(
      d->colours, bin, (size_t)fmin(ceil(all / apart), ABBE_EXIT_MOST_PARTS), d->turn++, part);
  for (size_t i = 0; i < parts; i++) {
    abbe_exit_ray out = *ray;
    for (int k = 0; k < 3; k++) {
      xyz[k] = flux * part[i].xyz[k];
      out.place[k] += part[i].step * ray->place_by[k];
      out.way[k] += part[i].step * ray->way_by[k];
    }
    abbe_vector_normalise(out.way);
    add_part(d, &out, xyz);
  }
}

abbe_result abbe_exit_light_fill(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                                 float *value, abbe_error *error) {
  ABBE_REQUIRE(v && desc && desc->light && value, error);
  const size_t cells = v->region.cells;
  if (v->exits.cells != cells)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the volume holds no exits");
  deposit d = {.region = &v->region, .value = value};
  d.piece = malloc(ABBE_REGION_MOST_PIECES * sizeof *d.piece);
  d.weight = malloc((cells + 1) * sizeof *d.weight);
  abbe_result result = d.piece != NULL && d.weight != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light's rays");
  if (result == ABBE_OK) {
    for (size_t i = 0; i < cells; i++) {
      const double space = abbe_half_value(v->exits.space[i]);
      d.weight[i] =
          space < least_space ? 0 : 1 / (space * abbe_volume_region_volume(&v->region, i));
    }
    memset(value, 0, 9 * cells * sizeof *value);
    result = abbe_exit_colours_make(v, desc, &d.colours, error);
  }
  if (result == ABBE_OK) result = abbe_exit_light_rays(v, desc, add_ray, &d, error);
  abbe_exit_colours_free(d.colours);
  free(d.piece);
  free(d.weight);
  return result;
}
