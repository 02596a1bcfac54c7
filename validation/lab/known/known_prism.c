/* Prisms: least deviation, and the spectrum of a slit. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"

#include <stdio.h>

#define SIDE 0.04 /* m */
#define APEX_RAD (60 / ABBE_KNOWN_DEGREES)
#define APEX_Z (SIDE * 0.86602540378443864676 * 2 / 3) /* the shape's centroid is the origin */

static const char prism_text[] =
    "- {name: prism, shape: prism, apex: 60, side: 0.04, length: 0.06, material: %s}\n";

/* The closed form's plane is x to the right and up from the apex. */
static void to_world(const double plane[2], double z, double world[3]) {
  world[0] = plane[0];
  world[1] = 0;
  world[2] = z + plane[1];
}

typedef struct search {
  abbe_known_stage *stage;
  double lambda_nm;
  abbe_result result;
  abbe_error *error;
} search;

/* Follows the ray that meets the left face at half its length under the incidence. */
static bool aim(search *s, double incidence, double came[3]) {
  double before = incidence - APEX_RAD / 2, half = SIDE / 2;
  double face[2] = {-half * sin(APEX_RAD / 2), -half * cos(APEX_RAD / 2)}, from[3];
  came[0] = cos(before);
  came[1] = 0;
  came[2] = sin(before);
  to_world(face, APEX_Z, from);
  for (int k = 0; k < 3; k++) from[k] -= 0.03 * came[k];
  s->result = abbe_known_follow(s->stage, from, came, s->lambda_nm, "tt", s->error);
  return s->result == ABBE_OK;
}

/* Whether the ray came to the right face, and whether it left the prism there. */
static bool at_right_face(const abbe_known_stage *stage, bool *left) {
  const abbe_route_vertex *v = stage->vertex;
  *left = false;
  if (stage->count < 2 || v[0].event != ABBE_ROUTE_TRANSMITTED || v[1].normal[0] < 0.5)
    return false;
  *left = v[1].event == ABBE_ROUTE_TRANSMITTED;
  return true;
}

/* Deviation at an incidence; where no ray passes (small incidences), more than any, falling. */
static double deviation(double incidence, void *user) {
  search *s = user;
  double came[3];
  bool left;
  if (!aim(s, incidence, came)) return NAN;
  if (!at_right_face(s->stage, &left) || !left) return 10 - incidence;
  return abbe_known_angle(came, s->stage->vertex[1].direction);
}

static abbe_result add_least(abbe_known_run *run, abbe_known_stage *stage, const char *glass,
                             const char *line, double lambda_nm, abbe_error *error) {
  search s = {.stage = stage, .lambda_nm = lambda_nm, .error = error};
  double n = 0, exact = NAN;
  abbe_result result = abbe_known_stage_n(stage, lambda_nm, &n, error);
  if (result != ABBE_OK) return result;
  if (!abbe_closed_form_prism_least(APEX_RAD, n, &exact)) exact = NAN;
  double traced = abbe_known_least(deviation, &s, 0.1, 89 / ABBE_KNOWN_DEGREES);
  if (s.result != ABBE_OK) return s.result;
  abbe_known_answer row = {
      .unit = "degrees",
      .exact = exact * ABBE_KNOWN_DEGREES,
      .traced = traced * ABBE_KNOWN_DEGREES,
      .tolerance = 6e-5,
      .reason = "1e-6 rad: two refractions of single-precision directions; the index itself is "
                "known to some 1e-5, ten times as much"};
  snprintf(row.quantity, sizeof row.quantity, "%s at %s, least deviation", glass, line);
  return abbe_known_add(run, row, error);
}

/* No ray leaves the second face of a 60-degree prism of diamond, from whatever side it came. */
static abbe_result add_diamond(abbe_known_run *run, abbe_error *error) {
  enum { RAYS = 1000 };
  abbe_known_stage stage;
  double n = 0, least = 0, reached = 0, passed = 0;
  ABBE_TRY(abbe_known_stage_make(&stage, error, prism_text, "diamond"));
  search s = {.stage = &stage, .lambda_nm = ABBE_LINE_D_NM, .error = error};
  abbe_result result = abbe_known_stage_n(&stage, s.lambda_nm, &n, error);
  for (int i = 0; i < RAYS && result == ABBE_OK; i++) {
    double came[3];
    bool left;
    aim(&s, (-89.9 + 179.8 * (i + 0.5) / RAYS) / ABBE_KNOWN_DEGREES, came);
    result = s.result;
    if (result != ABBE_OK || !at_right_face(&stage, &left)) continue;
    reached++;
    passed += left ? 1 : 0;
  }
  abbe_known_stage_free(&stage);
  if (result != ABBE_OK) return result;
  abbe_known_answer row = {
      .unit = "share",
      .exact = abbe_closed_form_prism_least(APEX_RAD, n, &least) ? NAN : 0,
      .traced = reached > RAYS / 10 ? passed / reached : NAN,
      .reason = "none: n sin(30 deg) is above 1, so diamond has no deviation through 60 degrees"};
  snprintf(row.quantity, sizeof row.quantity, "diamond at d, rays that leave the second face");
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_prism(abbe_known_run *run, abbe_error *error) {
  static const char *const glasses[] = {"fused-silica", "n-bk7", "f2", "sf10"};
  static const struct {
    const char *name;
    double lambda_nm;
  } lines[] = {{"F", ABBE_LINE_F_NM}, {"d", ABBE_LINE_D_NM}, {"C", ABBE_LINE_C_NM}};
  abbe_result result = ABBE_OK;
  for (int g = 0; g < 4 && result == ABBE_OK; g++) {
    abbe_known_stage stage;
    ABBE_TRY(abbe_known_stage_make(&stage, error, prism_text, glasses[g]));
    for (int l = 0; l < 3 && result == ABBE_OK; l++)
      result = add_least(run, &stage, glasses[g], lines[l].name, lines[l].lambda_nm, error);
    abbe_known_stage_free(&stage);
  }
  return result == ABBE_OK ? add_diamond(run, error) : result;
}

/* ---- the slit ---- */

/* The wall stands 1 m from where the d line leaves the prism, square to it. */
typedef struct wall {
  double along; /* on the left face from the apex, m */
  double incidence;
  abbe_prism_ray d;
} wall;

/* Position on the wall, towards the base, of the point that a ray from `from` along `direction`
 * reaches; closed form's plane, m. */
static double on_wall(const wall *w, const double from[2], const double direction[2]) {
  const double *n = w->d.direction, side[2] = {n[1], -n[0]};
  double off[2] = {w->d.exit[0] + n[0] - from[0], w->d.exit[1] + n[1] - from[1]};
  double t = (off[0] * n[0] + off[1] * n[1]) / (direction[0] * n[0] + direction[1] * n[1]);
  double at[2] = {t * direction[0] - off[0], t * direction[1] - off[1]};
  return at[0] * side[0] + at[1] * side[1];
}

static abbe_result add_position(abbe_known_run *run, abbe_known_stage *stage, const wall *w,
                                double lambda_nm, abbe_error *error) {
  double n = 0, from[3], came[3], landed[2];
  abbe_prism_ray ray;
  ABBE_TRY(abbe_known_stage_n(stage, lambda_nm, &n, error));
  bool passes = abbe_closed_form_prism_ray(APEX_RAD, n, w->incidence, w->along, &ray);
  to_world(w->d.from, APEX_Z, from);
  to_world(w->d.came, 0, came);
  for (int k = 0; k < 3; k++) from[k] -= 0.1 * came[k];
  ABBE_TRY(abbe_known_follow(stage, from, came, lambda_nm, "tt", error));
  const abbe_route_vertex *end = &stage->vertex[stage->count - 1];
  bool lands = stage->count == 3 && end->event == ABBE_ROUTE_LANDED && end->object == 1;
  landed[0] = end->position[0];
  landed[1] = end->position[2] - APEX_Z;
  abbe_known_answer row = {
      .unit = "mm",
      .exact = passes ? 1e3 * on_wall(w, ray.exit, ray.direction) + 0.0 : NAN,
      .traced = lands ? 1e3 * on_wall(w, landed, w->d.direction) : NAN,
      .tolerance = 2e-3,
      .reason = "2 um: 1e-6 rad over the metre to the wall, and single-precision positions on it"};
  abbe_number_format(row.quantity, sizeof row.quantity, "sf10 at %g nm, from the place of d",
                     lambda_nm);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_slit(abbe_known_run *run, abbe_error *error) {
  wall w = {.along = SIDE / 2};
  double n = 0, least = 0, from[3], to[3];
  abbe_known_stage stage;
  ABBE_TRY(abbe_known_stage_make(&stage, error, prism_text, "sf10"));
  abbe_result result = abbe_known_stage_n(&stage, ABBE_LINE_D_NM, &n, error);
  abbe_known_stage_free(&stage);
  if (result != ABBE_OK) return result;
  abbe_closed_form_prism_least(APEX_RAD, n, &least);
  w.incidence = (least + APEX_RAD) / 2;
  abbe_closed_form_prism_ray(APEX_RAD, n, w.incidence, w.along, &w.d);
  const double *d = w.d.direction, at[2] = {w.d.exit[0] + d[0], w.d.exit[1] + d[1]};
  to_world(at, APEX_Z, from);
  to_world(w.d.exit, APEX_Z, to);
  ABBE_TRY(abbe_known_stage_make(
      &stage, error,
      "- {name: prism, shape: prism, apex: 60, side: 0.04, length: 0.06, material: sf10}\n"
      "- {name: wall, shape: rectangle, width: 1, height: 1, reflectance: 0.5,\n"
      "   transform: [{look: {from: [%.17g, %.17g, %.17g], to: [%.17g, %.17g, %.17g]}}]}\n",
      from[0], from[1], from[2], to[0], to[1], to[2]));
  for (int nm = 400; nm <= 700 && result == ABBE_OK; nm += 50)
    result = add_position(run, &stage, &w, nm, error);
  if (result == ABBE_OK) result = add_position(run, &stage, &w, ABBE_LINE_D_NM, error);
  abbe_known_stage_free(&stage);
  return result;
}
