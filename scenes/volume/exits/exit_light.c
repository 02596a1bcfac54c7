#include "scenes/volume/exits/exit_pages.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/volume/half.h"

#include <assert.h>
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

/* What a light and a table are asked with; in the object's own coordinates. */
typedef struct sight {
  const abbe_caustic_volume *volume;
  const abbe_exit_light_desc *desc;
  abbe_exit_light_take take;
  void *user;
  const double (*plane)[4];
  size_t planes;
  abbe_exit_sheet *sheet;
  bool far; /* the light is, and `light` the direction to it; else its place */
  double light[3];
  size_t first, step; /* for points: the first, and from one to the next */
} sight;

static void turn(const double map[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = abbe_vector_dot(&map[3 * i], v);
}

static void find_light(const abbe_exit_light_desc *d, sight *s) {
  double at[3];
  s->far = d->light->kind == ABBE_LIGHT_DIRECTIONAL;
  for (int k = 0; k < 3; k++)
    at[k] = s->far ? -d->light->direction[k] : d->light->position[k] - d->place->centre[k];
  turn_back(d->place->turn, at, s->light);
  if (s->far) abbe_vector_normalise(s->light);
}

/* From a place to the light, unit, and the irradiance across the beam there of a power of 1. */
static double look_at_light(const sight *s, const double from[3], double to_light[3]) {
  double square = 1;
  for (int k = 0; k < 3; k++) to_light[k] = s->far ? s->light[k] : s->light[k] - from[k];
  if (!s->far) square = abbe_vector_dot(to_light, to_light);
  if (!s->far && !abbe_vector_normalise(to_light)) return 0;
  if (abbe_exit_sheets_hide(s->sheet, s->desc->sheets, from, to_light,
                            s->far ? INFINITY : sqrt(square)))
    return 0;
  if (s->far) return 1;
  double away[3];
  turn(s->desc->place->turn, to_light, away);
  for (int k = 0; k < 3; k++) away[k] = -away[k];
  return abbe_light_profile(s->desc->light, away) / square;
}

/* The rays of the points that a map makes of the table's: for them the light stands where the map
 * brings it from, and their rays go where the map brings them. */
static void send_image(const sight *s, const double map[9]) {
  const abbe_light_exits *e = &s->volume->exits;
  const double part = e->area / (double)(e->points * e->symmetry.count);
  double there[3];
  abbe_exit_aim aim = {0};
  turn_back(map, s->light, there);
  if (s->far) abbe_light_exits_aim(&s->volume->nodes, there, &aim);
  for (size_t i = s->first; i < e->points; i += s->step) {
    double p[3], n[3], image[3], to_light[3];
    size_t bin;
    if (s->far && !abbe_light_exits_faces(e, i, there)) continue;
    abbe_light_exits_point(e, i, p, n, &bin);
    turn(map, p, image);
    const double strength = look_at_light(s, image, to_light);
    if (!s->far) turn_back(map, to_light, there);
    const double flux = part * strength * abbe_vector_dot(n, there);
    if (!(flux > 0)) continue;
    if (!s->far) abbe_light_exits_aim(&s->volume->nodes, there, &aim);
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
  assert(d->light && d->object && d->place);
  const abbe_light_exits *e = &v->exits;
  double(*plane)[4];
  size_t planes;
  if (part >= parts)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "part %zu of %zu", part, parts);
  if (e->points == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the volume holds no exits");
  abbe_result result = find_planes(d, &plane, &planes, error);
  if (result != ABBE_OK) return result;
  sight s = {.volume = v,
             .desc = d,
             .take = take,
             .user = user,
             .plane = (const double(*)[4])plane,
             .planes = planes,
             .sheet = malloc((d->sheets + 1) * sizeof *s.sheet),
             .first = part,
             .step = parts};
  if (s.sheet == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  for (size_t i = 0; result == ABBE_OK && i < d->sheets; i++)
    abbe_exit_sheet_make(d->sheet[i], d->place, &s.sheet[i]);
  find_light(d, &s);
  for (size_t i = 0; result == ABBE_OK && i < e->symmetry.count; i++)
    send_image(&s, e->symmetry.map[i]);
  free(s.sheet);
  free(plane);
  return result;
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
  float own[ABBE_LIGHT_EXITS_BINS][4]; /* XYZ of a watt of a bin's points */
  double upto[ABBE_LIGHT_EXITS_BINS + 1];
  double sum[ABBE_LIGHT_EXITS_BINS + 1][3]; /* XYZ of all bins before */
  double index[ABBE_LIGHT_EXITS_BINS];
  bool known;           /* the index, and it spreads them */
  double usual;         /* what a metal's rays carry, about; 0 of another object */
  double place[PLACES]; /* index by the place among points */
  float part[ABBE_EXIT_MOST_PARTS + 1][ABBE_EXIT_MOST_PARTS]
            [4];      /* XYZ of a watt of each of so many */
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
        s->part[parts][i][k] = (float)(after[k] - before[k]);
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
         !abbe_material_is_fluorescent(o->material) &&
         abbe_material_n(o->material, lambda_nm, n, NULL) == ABBE_OK;
}

/* The mean of some exits. */
static double usual_share(const abbe_light_exits *e) {
  enum { ASKED = 512 };
  const size_t step = e->count / ASKED + 1;
  double sum = 0;
  size_t lit = 0;
  for (size_t i = 0; i < e->count; i += step) {
    const double carried = abbe_half_value(e->exit[i][ABBE_EXIT_CARRIED]);
    sum += carried;
    lit += carried > 0;
  }
  return lit > 0 ? sum / (double)lit : 0;
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
      s->own[i][k] = (float)(xyz[k] / chance[i]);
      s->sum[i + 1][k] = s->sum[i][k] + xyz[k];
    }
    s->known = s->known && find_index(d->object, from + 0.5 * step, &s->index[i]);
    if (!s->known) continue;
    s->least = fmin(s->least, s->index[i]);
    s->most = fmax(s->most, s->index[i]);
  }
  if (s->known) make_places(s);
  if (d->object->mirror && d->object->conductor != NULL) s->usual = usual_share(&v->exits);
}

abbe_result abbe_exit_colours_make(const abbe_caustic_volume *v, const abbe_exit_light_desc *d,
                                   abbe_exit_colours **out, abbe_error *error) {
  assert(d->light && d->object);
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

/* Where a metal's rays go does not depend on their wavelength, so that of all rays of a path those
 * of one share together have the whole light's colour. What a ray has more or less than that share
 * has its own. */
static void mix_metal(const abbe_exit_colours *c, double carried, size_t bin, float xyz[4]) {
  const float usual = (float)(c->usual / carried);
  for (int k = 0; k < 3; k++)
    xyz[k] = (1 - usual) * c->own[bin][k] + usual * (float)c->sum[ABBE_LIGHT_EXITS_BINS][k];
  xyz[3] = 0;
}

size_t abbe_exit_colours_split(const abbe_exit_colours *c, const abbe_exit_ray *ray, size_t bin,
                               size_t parts, uint32_t turn, float step[ABBE_EXIT_MOST_PARTS],
                               float room[1][4], const float (**xyz)[4]) {
  if (!c->known) {
    step[0] = 0;
    *xyz = &c->own[bin];
    if (!(c->usual > 0)) return 1;
    mix_metal(c, ray->share / ray->weight, bin, room[0]);
    *xyz = (const float(*)[4])room;
    return 1;
  }
  if (parts < 1) parts = 1;
  if (parts > ABBE_EXIT_MOST_PARTS) parts = ABBE_EXIT_MOST_PARTS;
  const double within = parts > 1 ? (double)(turn * 2654435769u) * 0x1p-32 : 0.5;
  const double apart = PLACES / (double)parts;
  for (size_t i = 0; i < parts; i++)
    step[i] = (float)(c->place[(size_t)(((double)i + within) * apart)] - c->index[bin]);
  *xyz = c->part[parts];
  return parts;
}

/* ---- into cells ---- */

typedef struct deposit {
  const abbe_volume_region *region;
  abbe_region_piece *piece;
  double *weight; /* [cells] 1 / m3 of free space */
  float *value;
  abbe_exit_colours *colours;
  uint32_t turn; /* turn of rays, for the places within parts */
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
  float step[ABBE_EXIT_MOST_PARTS];
  float room[1][4];
  const float(*colour)[4];
  double end[2], xyz[3];
  abbe_exit_colours_ends(d->colours, bin, end);
  const double all = (end[1] - end[0]) * abbe_vector_length(ray->way_by);
  const size_t parts = abbe_exit_colours_split(
      d->colours, ray, bin, (size_t)fmin(ceil(all / apart), ABBE_EXIT_MOST_PARTS), d->turn++, step,
      room, &colour);
  for (size_t i = 0; i < parts; i++) {
    abbe_exit_ray out = *ray;
    for (int k = 0; k < 3; k++) {
      xyz[k] = flux * (double)colour[i][k];
      out.place[k] += (double)step[i] * ray->place_by[k];
      out.way[k] += (double)step[i] * ray->way_by[k];
    }
    abbe_vector_normalise(out.way);
    add_part(d, &out, xyz);
  }
}

abbe_result abbe_exit_light_fill(const abbe_caustic_volume *v, const abbe_exit_light_desc *desc,
                                 float *value, abbe_error *error) {
  assert(desc->light);
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

/* Into the object's own coordinates. */
static void exit_sheets_turn_back(const double turn[9], const double v[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = turn[k] * v[0] + turn[3 + k] * v[1] + turn[6 + k] * v[2];
}

void abbe_exit_sheet_make(const double p[9], const abbe_volume_place *place, abbe_exit_sheet *out) {
  double from[3], u[3], v[3], n[3];
  abbe_vector_subtract(p, place->centre, from);
  exit_sheets_turn_back(place->turn, from, out->corner);
  exit_sheets_turn_back(place->turn, p + 3, u);
  exit_sheets_turn_back(place->turn, p + 6, v);
  abbe_vector_cross(u, v, n);
  const double square = abbe_vector_dot(n, n);
  abbe_vector_cross(v, n, out->du);
  abbe_vector_cross(n, u, out->dv);
  for (int k = 0; k < 3; k++) {
    out->du[k] /= square;
    out->dv[k] /= square;
  }
  memcpy(out->normal, n, sizeof n);
  abbe_vector_normalise(out->normal);
  out->area = sqrt(square);
}

static void project(const double axis[3], const double at[3], const double by[3], float out[2]) {
  out[0] = (float)abbe_vector_dot(axis, at);
  out[1] = (float)abbe_vector_dot(axis, by);
}

void abbe_exit_sheets_track(const abbe_exit_sheet *sheet, size_t sheets, const abbe_exit_ray *ray,
                            abbe_exit_track *track) {
  for (size_t i = 0; i < sheets; i++) {
    const abbe_exit_sheet *s = &sheet[i];
    double from[3];
    abbe_vector_subtract(ray->place, s->corner, from);
    project(s->normal, from, ray->place_by, track[i].height);
    project(s->normal, ray->way, ray->way_by, track[i].fall);
    project(s->du, from, ray->place_by, track[i].u);
    project(s->dv, from, ray->place_by, track[i].v);
    project(s->du, ray->way, ray->way_by, track[i].u_along);
    project(s->dv, ray->way, ray->way_by, track[i].v_along);
  }
}

static float at_step(const float value[2], float step) {
  return value[0] + step * value[1];
}

/* Where four of the parts come to the plane: a processor does them at once. */
static void meet_plane(const abbe_exit_track *plane, const float *restrict step,
                       float *restrict fall, float *restrict far, float *restrict u,
                       float *restrict v) {
  const abbe_exit_track t = *plane;
  for (size_t i = 0; i < 4; i++) {
    fall[i] = at_step(t.fall, step[i]);
    far[i] = -at_step(t.height, step[i]) / fall[i];
    u[i] = at_step(t.u, step[i]) + far[i] * at_step(t.u_along, step[i]);
    v[i] = at_step(t.v, step[i]) + far[i] * at_step(t.v_along, step[i]);
  }
}

static void take_nearer(const abbe_exit_landing *from, const float *fall, int sheet, size_t parts,
                        abbe_exit_landing *to) {
  for (size_t i = 0; i < parts; i++) {
    const float far = from->far[i], u = from->u[i], v = from->v[i];
    if (!(far > 0 && far < to->far[i] && u >= 0 && u <= 1 && v >= 0 && v <= 1)) continue;
    to->far[i] = far;
    to->u[i] = u;
    to->v[i] = v;
    to->page[i] = 2 * sheet + (fall[i] > 0);
  }
}

void abbe_exit_sheets_meet(const abbe_exit_track *track, size_t sheets,
                           const float step[ABBE_EXIT_MOST_PARTS], size_t parts,
                           abbe_exit_landing *out) {
  for (size_t i = 0; i < parts; i++) {
    out->far[i] = INFINITY;
    out->page[i] = -1;
  }
  for (size_t i = 0; i < sheets; i++) {
    abbe_exit_landing at;
    float fall[ABBE_EXIT_MOST_PARTS];
    for (size_t k = 0; k < parts; k += 4)
      meet_plane(&track[i], step + k, fall + k, at.far + k, at.u + k, at.v + k);
    take_nearer(&at, fall, (int)i, parts, out);
  }
}

bool abbe_exit_sheets_hide(const abbe_exit_sheet *sheet, size_t sheets, const double place[3],
                           const double way[3], double limit) {
  for (const abbe_exit_sheet *s = sheet; s < sheet + sheets; s++) {
    double from[3], at[3];
    abbe_vector_subtract(place, s->corner, from);
    const double height = abbe_vector_dot(s->normal, from), fall = abbe_vector_dot(s->normal, way);
    if (height * fall >= 0) continue; /* it goes away from there */
    const double far = -height / fall;
    if (!(far > 1e-9 * abbe_vector_length(from)) || !(far < limit)) continue;
    for (int k = 0; k < 3; k++) at[k] = from[k] + far * way[k];
    const double u = abbe_vector_dot(at, s->du), v = abbe_vector_dot(at, s->dv);
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) return true;
  }
  return false;
}
