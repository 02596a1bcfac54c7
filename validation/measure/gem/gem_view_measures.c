/* What a view of a stone amounts to: means, areas, contrast. */
#include "validation/measure/gem/gem_view.h"

#include <math.h>
#include <stdlib.h>

enum { AMOUNTS = ABBE_GEM_AMOUNT_COUNT };

abbe_gem_number abbe_gem_view_at(const abbe_gem_view *v, abbe_gem_amount amount, size_t k) {
  double sum[ABBE_GEM_MOST_REPEATS];
  for (size_t r = 0; r < v->repeats; r++) sum[r] = v->spectrum[r * v->wavelengths + k][amount];
  return abbe_gem_number_ratio(sum, v->met, v->repeats);
}

abbe_gem_number abbe_gem_view_amount(const abbe_gem_view *v, abbe_gem_amount amount) {
  double sum[ABBE_GEM_MOST_REPEATS] = {0};
  for (size_t i = 0; i < v->side * v->side; i++)
    for (size_t r = 0; r < v->repeats; r++)
      sum[r] += (double)v->amount[(i * v->repeats + r) * AMOUNTS + amount];
  return abbe_gem_number_ratio(sum, v->met, v->repeats);
}

/* ---- areas ---- */

enum { BRILLIANT, WINDOW, EXTINCT, AREAS };

static int greatest(const float amount[AMOUNTS]) {
  const float back = amount[ABBE_GEM_RETURN], leak = amount[ABBE_GEM_DOWN];
  const float dark = amount[ABBE_GEM_HEAD] + amount[ABBE_GEM_ABSORBED] + amount[ABBE_GEM_LEFT];
  return back >= leak && back >= dark ? BRILLIANT : leak >= dark ? WINDOW : EXTINCT;
}

abbe_result abbe_gem_view_areas(const abbe_gem_view *v, abbe_gem_areas *out, abbe_error *error) {
  double area[AREAS][ABBE_GEM_MOST_REPEATS] = {{0}};
  if (v->side == 0 || v->repeats < 2 || v->repeats > ABBE_GEM_MOST_REPEATS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a view without repeats has no areas");
  for (size_t i = 0; i < v->side * v->side * v->repeats; i++)
    if (v->hit[i] > 0) area[greatest(&v->amount[i * AMOUNTS])][i % v->repeats]++;
  abbe_gem_number *number[AREAS] = {&out->brilliant, &out->window, &out->extinct};
  for (int k = 0; k < AREAS; k++) *number[k] = abbe_gem_number_ratio(area[k], v->met, v->repeats);
  return ABBE_OK;
}

/* ---- contrast ---- */

static double contrast(const abbe_gem_view *v, size_t without) {
  double count = 0, sum = 0, square = 0;
  for (size_t i = 0; i < v->side * v->side * v->repeats; i++) {
    const double x = (double)v->amount[i * AMOUNTS + ABBE_GEM_RETURN];
    if (!(v->hit[i] > 0) || i % v->repeats == without) continue;
    count++;
    sum += x;
    square += x * x;
  }
  return sum > 0 ? sqrt(fmax(count * square / (sum * sum) - 1, 0)) : 0;
}

abbe_gem_number abbe_gem_view_contrast(const abbe_gem_view *v) {
  double without[ABBE_GEM_MOST_REPEATS];
  if (v->repeats < 3) return (abbe_gem_number){contrast(v, v->repeats), NAN};
  for (size_t r = 0; r < v->repeats; r++) without[r] = contrast(v, r);
  return abbe_gem_number_jackknife(contrast(v, v->repeats), without, v->repeats);
}
