#include "scenes/cuts/cut_measures.h"

#include <math.h>

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
