/* Balls: the focus of a ball lens, and the rainbows of a drop. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"

#include <stdio.h>

enum { AZIMUTHS = 16 };

static const char ball_text[] = "- {name: ball, shape: sphere, radius: %g, material: %s}\n";

/* ---- the lens ---- */

typedef struct mean {
  double value, standard_error;
} mean;

static mean mean_of(const double *value, int count) {
  double sum = 0, square = 0;
  for (int i = 0; i < count; i++) sum += value[i] / count;
  for (int i = 0; i < count; i++) square += (value[i] - sum) * (value[i] - sum);
  return (mean){sum, sqrt(square / (count - 1) / count)};
}

/* Distance below the centre at which rays that come down at `height` from the axis cross it, a
 * mean over azimuths; NaN where one does not pass. */
static abbe_result crossing(abbe_known_stage *stage, double radius, double height, double lambda_nm,
                            mean *out, abbe_error *error) {
  double value[AZIMUTHS];
  for (int i = 0; i < AZIMUTHS; i++) {
    double around = 2 / ABBE_KNOWN_DEGREES * 180 * (i + 0.3) / AZIMUTHS;
    double u[2] = {cos(around), sin(around)};
    double from[3] = {height * u[0], height * u[1], 3 * radius};
    const double down[3] = {0, 0, -1};
    ABBE_TRY(abbe_known_follow(stage, from, down, lambda_nm, "tt", error));
    const abbe_route_vertex *v = &stage->vertex[1];
    bool passed = stage->count == 3 && v->event == ABBE_ROUTE_TRANSMITTED;
    double off = v->position[0] * u[0] + v->position[1] * u[1];
    double towards = v->direction[0] * u[0] + v->direction[1] * u[1];
    value[i] = passed ? -(v->position[2] - v->direction[2] * off / towards) : NAN;
  }
  *out = mean_of(value, AZIMUTHS);
  return ABBE_OK;
}

/* The crossing depends on the squared height; through three heights to none at all. */
static abbe_result focus(abbe_known_stage *stage, double radius, double lambda_nm, mean *out,
                         abbe_error *error) {
  static const double share[3] = {0.06, 0.12, 0.18}, factor[3] = {1.5, -0.6, 0.1};
  *out = (mean){0, 0};
  double variance = 0;
  for (int i = 0; i < 3; i++) {
    mean one;
    ABBE_TRY(crossing(stage, radius, share[i] * radius, lambda_nm, &one, error));
    out->value += factor[i] * one.value;
    variance += pow(factor[i] * one.standard_error, 2);
  }
  out->standard_error = sqrt(variance);
  return ABBE_OK;
}

static const char focus_reason[] =
    "1e-5 of the focal length: 1e-7 rad on a ray that converges by 0.04 rad, and what is left "
    "of the aberration at three heights below R/5; four standard errors over azimuths are less";

static abbe_result add_focus(abbe_known_run *run, abbe_known_stage *stage, double radius,
                             abbe_error *error) {
  static const struct {
    const char *name;
    double lambda_nm;
  } lines[] = {{"F", ABBE_LINE_F_NM}, {"d", ABBE_LINE_D_NM}, {"C", ABBE_LINE_C_NM}};
  double exact[3];
  mean traced[3];
  for (int l = 0; l < 3; l++) {
    double n = 0;
    ABBE_TRY(abbe_known_stage_n(stage, lines[l].lambda_nm, &n, error));
    ABBE_TRY(focus(stage, radius, lines[l].lambda_nm, &traced[l], error));
    exact[l] = abbe_closed_form_ball_focus(radius, n);
    abbe_known_answer row = {.unit = "mm",
                             .exact = 1e3 * exact[l],
                             .traced = 1e3 * traced[l].value,
                             .standard_error = 1e3 * traced[l].standard_error,
                             .tolerance = 1e3 * 1e-5 * exact[l],
                             .reason = focus_reason};
    snprintf(row.quantity, sizeof row.quantity, "n-bk7, R = 5 mm, focal length at %s",
             lines[l].name);
    ABBE_TRY(abbe_known_add(run, row, error));
  }
  abbe_known_answer row = {.unit = "mm",
                           .exact = 1e3 * (exact[2] - exact[0]),
                           .traced = 1e3 * (traced[2].value - traced[0].value),
                           .standard_error =
                               1e3 * hypot(traced[0].standard_error, traced[2].standard_error),
                           .tolerance = 1e3 * 2e-5 * exact[1],
                           .reason = "that of the two focal lengths together, 0.2 % of the shift"};
  snprintf(row.quantity, sizeof row.quantity, "n-bk7, R = 5 mm, chromatic shift from F to C");
  return abbe_known_add(run, row, error);
}

static abbe_result add_crossing(abbe_known_run *run, double radius, double share,
                                abbe_error *error) {
  abbe_known_stage stage;
  double n = 0;
  mean traced = {0};
  ABBE_TRY(abbe_known_stage_make(&stage, error, ball_text, radius, "n-bk7"));
  abbe_result result = abbe_known_stage_n(&stage, ABBE_LINE_D_NM, &n, error);
  if (result == ABBE_OK)
    result = crossing(&stage, radius, share * radius, ABBE_LINE_D_NM, &traced, error);
  abbe_known_stage_free(&stage);
  if (result != ABBE_OK) return result;
  abbe_known_answer row = {
      .unit = "R",
      .exact = abbe_closed_form_ball_crossing(radius, n, share * radius) / radius,
      .traced = traced.value / radius,
      .standard_error = traced.standard_error / radius,
      .tolerance = 4e-6,
      .reason = "a ray starts 2^-18 of the ball's radius off the surface that it leaves, 4e-6, and "
                "may cross the axis so much earlier or later"};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "n-bk7, R = %g m, crossing of the ray at %g R, line d", radius, share);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_ball(abbe_known_run *run, abbe_error *error) {
  static const double radii[] = {1e-4, 5e-3, 1e4}, shares[] = {0.5, 0.9};
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  ABBE_TRY(abbe_known_stage_make(&stage, error, ball_text, 5e-3, "n-bk7"));
  ABBE_TRY(add_focus(run, &stage, 5e-3, error));
  for (int r = 0; r < 3; r++)
    for (int s = 0; s < 2; s++) ABBE_TRY(add_crossing(run, radii[r], shares[s], error));
  return ABBE_OK;
}

/* ---- the drop ---- */

typedef struct drop {
  abbe_known_stage *stage;
  const char *choices;
  size_t order;
  double lambda_nm;
  abbe_result result;
  abbe_error *error;
} drop;

/* The angle from the antisolar point of the ray that comes in at height sin(incidence), such that
 * the bow is its least: the primary's with the sign turned. */
static double bow(double incidence, void *user) {
  drop *d = user;
  const double from[3] = {sin(incidence), 0, 3}, down[3] = {0, 0, -1}, up[3] = {0, 0, 1};
  d->result = abbe_known_follow(d->stage, from, down, d->lambda_nm, d->choices, d->error);
  if (d->result != ABBE_OK || d->stage->count < d->order + 3) return NAN;
  const abbe_route_vertex *v = &d->stage->vertex[d->order + 1];
  double angle = abbe_known_angle(up, v->direction);
  return d->order == 1 ? -angle : angle;
}

static abbe_result add_bow(abbe_known_run *run, drop *d, abbe_error *error) {
  static const char *const names[] = {"primary", "secondary"};
  double n = 0, turn = NAN, incidence = 0;
  abbe_result result = abbe_known_stage_n(d->stage, d->lambda_nm, &n, error);
  if (result != ABBE_OK) return result;
  abbe_closed_form_rainbow(n, d->order, &turn, &incidence);
  double least = abbe_known_least(bow, d, incidence - 0.2, incidence + 0.2);
  if (d->result != ABBE_OK) return d->result;
  abbe_known_answer row = {
      .unit = "degrees",
      .exact = fabs(turn * ABBE_KNOWN_DEGREES - 180),
      .traced = fabs(least) * ABBE_KNOWN_DEGREES,
      .tolerance = 6e-5,
      .reason = "1e-6 rad: up to four turns of single-precision directions; the water's "
                "temperature matters a hundred times as much"};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "water, %s bow at %g nm, from the antisolar point", names[d->order - 1],
                     d->lambda_nm);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_rainbow(abbe_known_run *run, abbe_error *error) {
  static const double lambda_nm[] = {400, 550, 700};
  static const char *const choices[] = {"trt", "trrt"};
  abbe_known_stage stage;
  abbe_result result = abbe_known_stage_make(&stage, error, ball_text, 1.0, "water");
  if (result != ABBE_OK) return result;
  for (size_t order = 1; order <= 2; order++)
    for (int l = 0; l < 3 && result == ABBE_OK; l++) {
      drop d = {.stage = &stage,
                .choices = choices[order - 1],
                .order = order,
                .lambda_nm = lambda_nm[l],
                .error = error};
      result = add_bow(run, &d, error);
    }
  abbe_known_stage_free(&stage);
  return result;
}
