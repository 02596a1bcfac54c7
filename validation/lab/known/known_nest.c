/* Balls within balls: where refractors overlap the later one is there. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_group.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"

#include <stdio.h>

typedef struct nest {
  const char *what, *core; /* material of the core; the shell is n-bk7 */
  double share;            /* radius of the core, in radii of the shell */
} nest;

/* Heights are shares of the outer radius; choices leave total reflections out. */
static abbe_result add_turn(abbe_known_run *run, const nest *it, abbe_known_stage *stage,
                            double height, abbe_error *error) {
  const double from[3] = {height, 0, 3}, down[3] = {0, 0, -1};
  double n = 0, core_n = 0, traced = NAN;
  abbe_result result = abbe_known_stage_n(stage, ABBE_LINE_D_NM, &n, error);
  if (result == ABBE_OK)
    result = abbe_material_n(stage->scene.object[1].material, ABBE_LINE_D_NM, &core_n, error);
  if (result == ABBE_OK)
    result = abbe_known_follow(stage, from, down, ABBE_LINE_D_NM, "tttt", error);
  if (result != ABBE_OK) return result;
  /* The way out of the ball is the vertex before the last; towards the axis is towards -x. */
  if (stage->count >= 3) {
    const double *d = stage->vertex[stage->count - 2].direction;
    traced = atan2(-d[0], -d[2]);
  }
  abbe_known_answer row = {
      .unit = "degrees",
      .exact = abbe_closed_form_shell_turn(1, n, it->share, core_n, height) * ABBE_KNOWN_DEGREES,
      .traced = traced * ABBE_KNOWN_DEGREES,
      .tolerance = 1.2e-3,
      .reason =
          "2e-5 rad: at each of four surfaces a ray starts up to 4e-6 of the ball's size off, "
          "which the steep curve of the core turns into an angle"};
  abbe_number_format(row.quantity, sizeof row.quantity, "%s, ray at %g R, turned", it->what,
                     height);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_nest(abbe_known_run *run, abbe_error *error) {
  static const nest nests[] = {{"n-bk7 with a bubble of R/2", "air", 0.5},
                               {"n-bk7 around water of 0.8 R", "water", 0.8}};
  static const double heights[2][4] = {{0.1, 0.3, 0.6, 0.9}, {0.2, 0.6, 0.9, 0}};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    abbe_known_stage stage;
    result = abbe_known_stage_make(&stage, error,
                                   "- {name: ball, shape: sphere, radius: 1, material: n-bk7}\n"
                                   "- {name: core, shape: sphere, radius: %g, material: %s}\n",
                                   nests[i].share, nests[i].core);
    if (result != ABBE_OK) return result;
    for (int k = 0; k < 4 && heights[i][k] > 0 && result == ABBE_OK; k++)
      result = add_turn(run, &nests[i], &stage, heights[i][k], error);
    abbe_known_stage_free(&stage);
  }
  return result;
}
