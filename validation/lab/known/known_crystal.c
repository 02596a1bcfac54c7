/* A block of calcite under rays at the line d: where its two rays go, and what each of them has. */
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"

#include <math.h>

#define THICK 0.01 /* m */

static const char rounding[] =
    "2e-6: directions and positions in single precision, a few roundings";

/* Follows a ray of that incidence, in the plane of x and z, into the block; the indices. */
static abbe_result enter(abbe_known_stage *stage, const double axis[3], double incidence,
                         const char *choices, double *n_o, double *n_e, abbe_error *error) {
  const double d[3] = {sin(incidence), 0, -cos(incidence)};
  const double from[3] = {-THICK * d[0], 0, THICK / 2 - THICK * d[2]};
  ABBE_TRY(abbe_known_stage_make(
      stage, error,
      "- {name: block, shape: box, size: [%g, %g, %g], material: calcite, axis: [%.17g, %.17g, "
      "%.17g]}\n",
      4 * THICK, 4 * THICK, THICK, axis[0], axis[1], axis[2]));
  const abbe_material *calcite = stage->scene.object[0].material;
  abbe_result result = abbe_material_n(calcite, ABBE_LINE_D_NM, n_o, error);
  if (result == ABBE_OK)
    result = abbe_material_n_extraordinary(calcite, ABBE_LINE_D_NM, n_e, error);
  if (result == ABBE_OK) result = abbe_known_follow(stage, from, d, ABBE_LINE_D_NM, choices, error);
  if (result != ABBE_OK) abbe_known_stage_free(stage);
  return result;
}

/* Straight onto the face: tan = (n_o^2 - n_e^2) tan(a) / (n_e^2 + n_o^2 tan^2(a)) for the axis at a
 * to the normal [BornWolf1999, 15.3]. */
static abbe_result add_angle(abbe_known_run *run, double degrees, abbe_error *error) {
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  const double a = degrees / ABBE_KNOWN_DEGREES, axis[3] = {sin(a), 0, cos(a)};
  const double down[3] = {0, 0, -1};
  double n_o, n_e;
  ABBE_TRY(enter(&stage, axis, 0, "TT", &n_o, &n_e, error));
  const double o = n_o * n_o, e = n_e * n_e, s = sin(a), c = cos(a);
  const double tangent = (o - e) * s * c / (e * c * c + o * s * s);
  abbe_known_answer row = {.unit = "degrees",
                           .exact = atan(tangent) * ABBE_KNOWN_DEGREES,
                           .traced = abbe_known_angle(stage.vertex[0].direction, down) *
                                     ABBE_KNOWN_DEGREES,
                           .tolerance = 2e-6 * ABBE_KNOWN_DEGREES,
                           .reason = rounding};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "calcite, axis at %g degrees, between its rays", degrees);
  ABBE_TRY(abbe_known_add(run, row, error));
  if (stage.count == 3) {
    const double *out = stage.vertex[1].position;
    row = (abbe_known_answer){.unit = "thickness",
                              .exact = tangent,
                              .traced = out[0] / THICK,
                              .tolerance = 2e-5,
                              .reason = "a ray starts 2^-18 of the block's width off the face that "
                                        "it leaves, and the block is four times as wide as thick"};
    abbe_number_format(row.quantity, sizeof row.quantity,
                       "calcite, axis at %g degrees, image moved by", degrees);
    ABBE_TRY(abbe_known_add(run, row, error));
  }
  return ABBE_OK;
}

/* Rows of an index across the plane of incidence: both waves obey Snell, the extraordinary one has
 * its field across that plane (s) and the ordinary one in it (p). */
static abbe_result add_across(abbe_known_run *run, double degrees, bool extraordinary,
                              abbe_error *error) {
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  const double axis[3] = {0, 1, 0}, up[3] = {0, 0, 1}, i = degrees / ABBE_KNOWN_DEGREES;
  double n_o, n_e, back[3];
  ABBE_TRY(enter(&stage, axis, i, extraordinary ? "TT" : "tt", &n_o, &n_e, error));
  const double t = asin(sin(i) / (extraordinary ? n_e : n_o));
  const double r = extraordinary ? sin(i - t) / sin(i + t) : tan(i - t) / tan(i + t);
  for (int k = 0; k < 3; k++) back[k] = -stage.vertex[0].direction[k];
  const char *name = extraordinary ? "extraordinary" : "ordinary";
  abbe_known_answer row = {.unit = "degrees",
                           .exact = t * ABBE_KNOWN_DEGREES,
                           .traced = abbe_known_angle(back, up) * ABBE_KNOWN_DEGREES,
                           .tolerance = 2e-6 * ABBE_KNOWN_DEGREES,
                           .reason = rounding};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "calcite, axis across, %s ray from %g degrees", name, degrees);
  ABBE_TRY(abbe_known_add(run, row, error));
  row = (abbe_known_answer){.unit = "share",
                            .exact = (1 - r * r) / 2,
                            .traced = stage.vertex[0].share,
                            .tolerance = 2e-6,
                            .reason = rounding};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "calcite, axis across, what the %s ray has from %g degrees", name, degrees);
  return abbe_known_add(run, row, error);
}

/* One wave alone is inside, polarised along its own field. At a face whose plane of incidence holds
 * the axis or lies across it the other wave is at right angles to that: it gets nothing, as behind
 * crossed polarisers. The face takes the way that is requested, or else the strongest. */
static abbe_result add_extinction(abbe_known_run *run, const double axis[3], const char *what,
                                  bool extraordinary, abbe_error *error) {
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  double n_o, n_e;
  ABBE_TRY(
      enter(&stage, axis, 40 / ABBE_KNOWN_DEGREES, extraordinary ? "Tr" : "tR", &n_o, &n_e, error));
  const abbe_route_vertex *v = &stage.vertex[1];
  const bool other = v->event == ABBE_ROUTE_REFLECTED && v->extraordinary != extraordinary;
  abbe_known_answer row = {.unit = "share",
                           .exact = 0,
                           .traced = other ? v->share : 0,
                           .tolerance = 1e-12,
                           .reason =
                               "double precision: the square of an amplitude of 1e-7, that of "
                               "a direction in single precision"};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "calcite, axis %s, %s ray that becomes the other", what,
                     extraordinary ? "extraordinary" : "ordinary");
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_crystal(abbe_known_run *run, abbe_error *error) {
  static const double angles[] = {0, 30, 45, 60, 90}, incidences[] = {30, 60};
  static const double across[3] = {0, 1, 0}, within[3] = {0.6, 0, 0.8};
  for (int i = 0; i < 5; i++) ABBE_TRY(add_angle(run, angles[i], error));
  for (int i = 0; i < 4; i++) ABBE_TRY(add_across(run, incidences[i / 2], i % 2 != 0, error));
  for (int i = 0; i < 4; i++)
    ABBE_TRY(add_extinction(run, i / 2 ? within : across, i / 2 ? "in the plane" : "across",
                            i % 2 != 0, error));
  return ABBE_OK;
}
