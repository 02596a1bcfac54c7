#include "gl/scene/spectra/tint_nodes.h"

#include "colorimetry/weights.h"
#include "gl/plan/examine/tints.h"
#include "gl/scene/spectra/band_parts.h"

#include <math.h>

enum { HALF_STEPS = 32 };

/* A half of a band, in steps: attenuation of each and its brightness. */
typedef struct half {
  double per[HALF_STEPS], weight[HALF_STEPS], all;
} half;

static double range_of(const half *h) {
  double least = INFINITY, most = 0;
  for (int i = 0; i < HALF_STEPS; i++) {
    least = fmin(least, h->per[i]);
    most = fmax(most, h->per[i]);
  }
  return most - least;
}

/* Attenuation that leaves so much of an amount as the mean of the light from one part of its
 * brightness to another does. */
static double effective(const half *h, double amount, double from, double to) {
  double least = INFINITY, left = 0, all = 0, before = 0;
  for (int turn = 0; turn < 2; turn++, before = 0)
    for (int i = 0; i < HALF_STEPS; before += h->weight[i++]) {
      const double begins = fmax(before, from * h->all);
      const double w = fmin(before + h->weight[i], to * h->all) - begins;
      if (w <= 0) continue;
      if (turn == 0) least = fmin(least, h->per[i]);
      if (turn == 1) all += w;
      if (turn == 1) left += w * exp(-amount * (h->per[i] - least));
    }
  return least - log(left / all) / amount;
}

static void fill_half(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                      const abbe_weights_range *light, double from_nm, double to_nm, float *parts,
                      float *range) {
  const double amount =
      plan->mirror[r] ? 1 : abbe_usual_path(&scene->object[plan->refractor_object[r]]);
  const double step = (to_nm - from_nm) / HALF_STEPS;
  half h = {.all = 0};
  for (int i = 0; i < HALF_STEPS; i++) {
    double xyz[3];
    abbe_weights_range_xyz(light, from_nm + step * i, from_nm + step * (i + 1), xyz);
    h.all += h.weight[i] = xyz[1] + 1e-12;
    h.per[i] = abbe_tint_attenuation(scene, plan, r, from_nm + step * (i + 0.5));
  }
  parts[0] = (float)effective(&h, amount, 0, 0.5);
  parts[1] = (float)effective(&h, amount, 0.5, 1);
  *range = fmaxf(*range, (float)range_of(&h));
}

void abbe_tint_nodes_fill(const abbe_scene *scene, const abbe_plan *plan, const abbe_wavelengths *w,
                          float (*out)[ABBE_TINT_TEXELS][4]) {
  const bool one = w->count == 1;
  abbe_weights_range light;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), w->edge_nm[0],
                             w->edge_nm[w->count], &light);
  for (size_t r = 0; r < plan->refractor_count; r++) {
    const int tint = abbe_tint_of(scene, plan, r);
    for (size_t i = 0; i < w->count; i++) {
      float(*of)[4] = out[i * plan->refractor_count + r];
      const double end_nm = one ? w->edge_nm[1] : w->lambda_nm[i];
      const double begin_nm = one ? w->edge_nm[0] : w->lambda_nm[i];
      of[1][0] = 0;
      of[1][1] = (float)tint;
      fill_half(scene, plan, r, &light, w->edge_nm[i], end_nm, of[0], &of[1][0]);
      fill_half(scene, plan, r, &light, begin_nm, w->edge_nm[i + 1], of[0] + 2, &of[1][0]);
    }
  }
}
