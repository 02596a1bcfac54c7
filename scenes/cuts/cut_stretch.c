#include "scenes/cuts/cut_stretch.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>

#define DEGREES (180 / ABBE_PI)

/* Flat facets have no angle to be changed. */
static const double flat_deg = 1;

void abbe_cut_stretch_window(double n, double *low_deg, double *high_deg) {
  *low_deg = asin(1 / n) * DEGREES;
  *high_deg = (180 - *low_deg) / 3;
}

bool abbe_cut_stretch_is_flat(const abbe_cut_tier *tier, double n) {
  double low, high;
  if (!(n > 1) || !(tier->angle_deg < 0)) return false;
  abbe_cut_stretch_window(n, &low, &high);
  return -tier->angle_deg < low;
}

double abbe_cut_stretch_angle(double main_deg, double from, double to) {
  double low[2], high[2];
  abbe_cut_stretch_window(from, &low[0], &high[0]);
  abbe_cut_stretch_window(to, &low[1], &high[1]);
  return main_deg + (low[1] + high[1] - low[0] - high[0]) / 2;
}

/* Whether the face reaches down to the stone's lowest corners. */
static bool reaches_down(const abbe_cut_polyhedron *p, const abbe_cut_face *face) {
  const double near = 1e-6 * (p->max[2] - p->min[2]);
  for (size_t i = 0; i < face->count; i++)
    if (p->vertex[p->corner[face->first + i]][2] <= p->min[2] + near) return true;
  return false;
}

/* The mean area of a tier's faces of that side; 0 where it has none. */
static double mean_area(const abbe_cut *cut, const abbe_cut_polyhedron *p, size_t tier,
                        abbe_cut_side side) {
  double area = 0, count = 0;
  for (size_t f = 0; f < p->face_count; f++) {
    const abbe_cut_face *face = &p->face[f];
    const abbe_cut_facet *facet = &cut->facet[face->facet];
    if (facet->tier != tier || abbe_cut_side_of(facet) != side ||
        fabs(abbe_cut_angle(facet->n)) <= flat_deg ||
        (side == ABBE_CUT_PAVILION && !reaches_down(p, face)))
      continue;
    area += face->area;
    count++;
  }
  return count > 0 ? area / count : 0;
}

size_t abbe_cut_stretch_main(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                             abbe_cut_side side) {
  size_t best = cut->tier_count;
  double most = 0;
  for (size_t t = 0; t < cut->tier_count; t++) {
    const double area = mean_area(cut, p, t, side);
    if (area > most * (1 + 1e-9)) {
      most = area;
      best = t;
    }
  }
  return best;
}

double abbe_cut_stretch_main_deg(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                                 abbe_cut_side side) {
  const size_t tier = abbe_cut_stretch_main(cut, p, side);
  return tier < cut->tier_count ? fabs(cut->tier[tier].angle_deg) : 0;
}

double abbe_cut_stretch_factor(double from_deg, double to_deg) {
  return tan(fabs(to_deg) / DEGREES) / tan(fabs(from_deg) / DEGREES);
}

/* The plane after z became z0 + k (z - z0). */
static void stretch(abbe_cut_facet *f, double z0, double k) {
  const double up = f->n[2] / k, d = f->d - z0 * (f->n[2] - up);
  const double length = sqrt(f->n[0] * f->n[0] + f->n[1] * f->n[1] + up * up);
  f->n[0] /= length;
  f->n[1] /= length;
  f->n[2] = up / length;
  f->d = d / length;
}

static abbe_result stretch_all(abbe_cut *cut, const double z0[ABBE_CUT_SIDE_COUNT],
                               const double k[ABBE_CUT_SIDE_COUNT], abbe_error *error) {
  for (size_t i = 0; i < cut->facet_count; i++) {
    abbe_cut_facet *f = &cut->facet[i];
    const abbe_cut_side side = abbe_cut_side_of(f);
    if (side != ABBE_CUT_GIRDLE) stretch(f, z0[side], k[side]);
    if (!(f->d >= 1 / ABBE_CUT_FAR))
      return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                            "at these angles facet %zu would come to the other side of the "
                            "stone's centre; change the angles less",
                            i + 1);
  }
  for (size_t t = 0; t < cut->tier_count; t++) {
    abbe_cut_tier *tier = &cut->tier[t];
    if (tier->count == 0) continue;
    const abbe_cut_facet *first = &cut->facet[tier->first];
    if (abbe_cut_side_of(first) != ABBE_CUT_GIRDLE) tier->angle_deg = abbe_cut_angle(first->n);
    tier->distance = first->d;
  }
  return ABBE_OK;
}

static bool is_a_factor(double k) {
  return k >= 1 / ABBE_CUT_STRETCH_MOST && k <= ABBE_CUT_STRETCH_MOST;
}

static bool is_bound(const abbe_cut_measures *m) {
  const double level = 1e-6;
  return m->shared > 0 && m->shared_high - m->shared_low > level * m->width;
}

bool abbe_cut_stretch_bound(const abbe_cut *cut, const abbe_cut_polyhedron *p) {
  abbe_cut_measures m;
  abbe_cut_measures_make(cut, p, &m);
  return is_bound(&m);
}

static abbe_result check(const abbe_cut_measures *m, double crown, double pavilion,
                         abbe_error *error) {
  const double same = 1e-9;
  if (!is_a_factor(crown) || !is_a_factor(pavilion))
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "tangents can become %g to %g times what they were, and not %g and %g",
                          1 / ABBE_CUT_STRETCH_MOST, ABBE_CUT_STRETCH_MOST, crown, pavilion);
  if (is_bound(m) && fabs(crown - pavilion) > same * crown)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "crown and pavilion meet where there is no girdle, and not at one height: "
        "both need the same tangent ratio, and not %g and %g",
        crown, pavilion);
  return ABBE_OK;
}

abbe_result abbe_cut_stretch_apply(abbe_cut *cut, const abbe_cut_polyhedron *p, double crown,
                                   double pavilion, abbe_error *error) {
  abbe_cut_measures m;
  abbe_cut_measures_make(cut, p, &m);
  abbe_result result = check(&m, crown, pavilion, error);
  if (result != ABBE_OK) return result;
  abbe_cut_facet *facet = malloc(cut->facet_count * sizeof *facet);
  abbe_cut_tier *tier = malloc(cut->tier_count * sizeof *tier);
  const bool share = m.shared > 0; /* what they share moves with both */
  const double z0[] = {share ? m.shared_low : m.crown_edge, 0,
                       share ? m.shared_low : m.pavilion_edge};
  const double k[] = {crown, 1, pavilion};
  if (facet == NULL || tier == NULL) {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design");
  } else {
    for (size_t i = 0; i < cut->facet_count; i++) facet[i] = cut->facet[i];
    for (size_t i = 0; i < cut->tier_count; i++) tier[i] = cut->tier[i];
    result = stretch_all(cut, z0, k, error);
    for (size_t i = 0; result != ABBE_OK && i < cut->facet_count; i++) cut->facet[i] = facet[i];
    for (size_t i = 0; result != ABBE_OK && i < cut->tier_count; i++) cut->tier[i] = tier[i];
  }
  free(facet);
  free(tier);
  return result;
}

/* The factor for a side whose main angle becomes that; 0: it stays. */
static abbe_result factor_of(const abbe_cut *cut, const abbe_cut_polyhedron *p, abbe_cut_side side,
                             double to_deg, double *out, abbe_error *error) {
  *out = 1;
  if (to_deg == 0) return ABBE_OK;
  if (!(to_deg > 0 && to_deg < 90))
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "the %s's main angle is between 0 and 90 degrees, and not %g",
                          abbe_cut_side_name(side), to_deg);
  const double from_deg = abbe_cut_stretch_main_deg(cut, p, side);
  if (!(from_deg > 0))
    return abbe_error_set(error, ABBE_NOT_FOUND, "the %s has no slanted facet",
                          abbe_cut_side_name(side));
  *out = abbe_cut_stretch_factor(from_deg, to_deg);
  return ABBE_OK;
}

abbe_result abbe_cut_stretch_to(abbe_cut *cut, const abbe_cut_polyhedron *p, double crown_deg,
                                double pavilion_deg, abbe_error *error) {
  double crown, pavilion;
  ABBE_TRY(factor_of(cut, p, ABBE_CUT_CROWN, crown_deg, &crown, error));
  ABBE_TRY(factor_of(cut, p, ABBE_CUT_PAVILION, pavilion_deg, &pavilion, error));
  if ((crown_deg == 0) != (pavilion_deg == 0) && abbe_cut_stretch_bound(cut, p))
    crown = pavilion = crown_deg == 0 ? pavilion : crown;
  return abbe_cut_stretch_apply(cut, p, crown, pavilion, error);
}

#define ABBE_SIDE_NAME(code, name) name,
static const char *const names[] = {ABBE_CUT_SIDES(ABBE_SIDE_NAME)};

static const double carats_per_gram = 5;
/* A table is within so much of level, the sine of an angle. */
static const double flat = 1e-3;

const char *abbe_cut_side_name(abbe_cut_side side) {
  return names[side];
}

abbe_cut_side abbe_cut_side_of(const abbe_cut_facet *facet) {
  return abbe_cut_facet_is_girdle(facet) ? ABBE_CUT_GIRDLE
         : facet->n[2] > 0               ? ABBE_CUT_CROWN
                                         : ABBE_CUT_PAVILION;
}

static const abbe_cut_facet *facet_of(const abbe_cut *cut, const abbe_cut_face *face) {
  return &cut->facet[face->facet];
}

/* Which sides have the corner, a bit each. */
static unsigned sides_at(const abbe_cut *cut, const abbe_cut_polyhedron *p, uint32_t vertex) {
  unsigned sides = 0;
  for (size_t f = 0; f < p->face_count; f++) {
    const abbe_cut_face *face = &p->face[f];
    for (size_t i = 0; i < face->count; i++)
      if (p->corner[face->first + i] == vertex)
        sides |= 1u << abbe_cut_side_of(facet_of(cut, face));
  }
  return sides;
}

static void find_girdle(const abbe_cut *cut, const abbe_cut_polyhedron *p, abbe_cut_measures *m) {
  const unsigned crown = 1u << ABBE_CUT_CROWN, girdle = 1u << ABBE_CUT_GIRDLE,
                 pavilion = 1u << ABBE_CUT_PAVILION;
  const bool upright = m->faces[ABBE_CUT_GIRDLE] > 0;
  m->girdle_low = m->crown_edge = m->shared_low = INFINITY;
  m->girdle_high = m->pavilion_edge = m->shared_high = -INFINITY;
  for (uint32_t v = 0; v < p->vertex_count; v++) {
    const unsigned sides = sides_at(cut, p, v);
    const double z = p->vertex[v][2];
    const bool both = (sides & crown) != 0 && (sides & pavilion) != 0;
    if (both) {
      m->shared++;
      m->shared_low = fmin(m->shared_low, z);
      m->shared_high = fmax(m->shared_high, z);
    }
    if (upright ? (sides & girdle) == 0 : !both) continue;
    m->girdle_low = fmin(m->girdle_low, z);
    m->girdle_high = fmax(m->girdle_high, z);
    if ((sides & crown) != 0) m->crown_edge = fmin(m->crown_edge, z);
    if ((sides & pavilion) != 0) m->pavilion_edge = fmax(m->pavilion_edge, z);
  }
}

static void find_table(const abbe_cut *cut, const abbe_cut_polyhedron *p, int across,
                       abbe_cut_measures *out) {
  for (size_t f = 0; f < p->face_count; f++) {
    const abbe_cut_face *face = &p->face[f];
    const double *n = facet_of(cut, face)->n;
    double low = INFINITY, high = -INFINITY;
    if (!(n[2] > 0 && hypot(n[0], n[1]) < flat)) continue;
    for (size_t i = 0; i < face->count; i++) {
      const double at = p->vertex[p->corner[face->first + i]][across];
      low = fmin(low, at);
      high = fmax(high, at);
    }
    out->table = fmax(out->table, high - low);
  }
}

void abbe_cut_measures_make(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                            abbe_cut_measures *out) {
  const double x = p->max[0] - p->min[0], y = p->max[1] - p->min[1];
  *out = (abbe_cut_measures){.length = fmax(x, y),
                             .width = fmin(x, y),
                             .height = p->max[2] - p->min[2],
                             .volume = p->volume};
  for (size_t f = 0; f < p->face_count; f++)
    out->faces[abbe_cut_side_of(facet_of(cut, &p->face[f]))]++;
  for (size_t i = 0; i < p->facet_count; i++) {
    out->dead += p->fate[i] == ABBE_CUT_DEAD;
    out->doubled += p->fate[i] == ABBE_CUT_DOUBLE;
  }
  find_girdle(cut, p, out);
  find_table(cut, p, x <= y ? 0 : 1, out);
  out->side[ABBE_CUT_CROWN] = p->max[2] - out->girdle_high;
  out->side[ABBE_CUT_GIRDLE] = out->girdle_high - out->girdle_low;
  out->side[ABBE_CUT_PAVILION] = out->girdle_low - p->min[2];
}

double abbe_cut_measures_carats(const abbe_cut_measures *m, double width_m, double density_g_cm3) {
  const double cm3 = m->volume * pow(100 * width_m / m->width, 3);
  return cm3 * density_g_cm3 * carats_per_gram;
}

double abbe_cut_measures_fit(const abbe_cut_measures *m, const double rough_m[3]) {
  const double size[3] = {m->length, m->width, m->height};
  double most = 0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      if (a == b) continue;
      const double unit =
          fmin(fmin(rough_m[a] / size[0], rough_m[b] / size[1]), rough_m[3 - a - b] / size[2]);
      most = fmax(most, unit);
    }
  return most;
}

double abbe_cut_measures_yield(const abbe_cut_measures *m, const double rough_m[3]) {
  return m->volume * pow(abbe_cut_measures_fit(m, rough_m), 3) /
         (rough_m[0] * rough_m[1] * rough_m[2]);
}
