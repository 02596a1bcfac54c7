/* What a view of a stone amounts to: means, areas, contrast. */
#include "validation/gem/gem_view.h"

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

static int greatest(const double amount[AMOUNTS]) {
  const double back = amount[ABBE_GEM_RETURN], leak = amount[ABBE_GEM_DOWN];
  const double dark = amount[ABBE_GEM_HEAD] + amount[ABBE_GEM_ABSORBED] + amount[ABBE_GEM_LEFT];
  return back >= leak && back >= dark ? BRILLIANT : leak >= dark ? WINDOW : EXTINCT;
}

/* Areas and silhouette, without one repeat (or with all, without == repeats). */
static void add_areas(const abbe_gem_view *v, size_t pixel, size_t without, double area[AREAS]) {
  double sum[AMOUNTS] = {0}, hit = 0;
  for (size_t r = 0; r < v->repeats; r++) {
    const size_t at = pixel * v->repeats + r;
    if (r == without) continue;
    hit += (double)v->hit[at];
    for (int a = 0; a < AMOUNTS; a++) sum[a] += (double)v->amount[at * AMOUNTS + (size_t)a];
  }
  if (hit > 0) area[greatest(sum)] += hit;
}

abbe_result abbe_gem_view_areas(const abbe_gem_view *v, abbe_gem_areas *out, abbe_error *error) {
  ABBE_REQUIRE(v && out, error);
  const size_t kinds = v->repeats + 1;
  double area[ABBE_GEM_MOST_REPEATS + 1][AREAS] = {{0}}, share[AREAS][ABBE_GEM_MOST_REPEATS + 1];
  if (v->side == 0 || v->repeats < 2 || v->repeats > ABBE_GEM_MOST_REPEATS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a view without repeats has no areas");
  for (size_t i = 0; i < v->side * v->side; i++)
    for (size_t r = 0; r < kinds && v->cover[i] > 0; r++) add_areas(v, i, r, area[r]);
  for (size_t r = 0; r < kinds; r++) {
    const double total = area[r][0] + area[r][1] + area[r][2];
    for (int k = 0; k < AREAS; k++) share[k][r] = total > 0 ? area[r][k] / total : 0;
  }
  abbe_gem_number *number[AREAS] = {&out->brilliant, &out->window, &out->extinct};
  for (int k = 0; k < AREAS; k++)
    *number[k] = abbe_gem_number_jackknife(share[k][v->repeats], share[k], v->repeats);
  return ABBE_OK;
}

/* ---- contrast ---- */

/* Sums over pixels that all repeats met; pairs: products of two different repeats. */
static double contrast(const abbe_gem_view *v, size_t without) {
  const double count = (double)(without < v->repeats ? v->repeats - 1 : v->repeats);
  double pixels = 0, mean = 0, pairs = 0;
  for (size_t i = 0; i < v->side * v->side; i++) {
    double sum = 0, square = 0;
    if (v->cover[i] < 1) continue;
    for (size_t r = 0; r < v->repeats; r++) {
      const double x = (double)v->amount[(i * v->repeats + r) * AMOUNTS + ABBE_GEM_RETURN];
      if (r == without) continue;
      sum += x;
      square += x * x;
    }
    pixels++;
    mean += sum / count;
    pairs += (sum * sum - square) / (count * (count - 1));
  }
  if (!(mean > 0)) return 0;
  mean /= pixels;
  return sqrt(fmax(pairs / pixels - mean * mean, 0)) / mean;
}

abbe_gem_number abbe_gem_view_contrast(const abbe_gem_view *v) {
  double without[ABBE_GEM_MOST_REPEATS];
  if (v->repeats < 3) return (abbe_gem_number){contrast(v, v->repeats), NAN};
  for (size_t r = 0; r < v->repeats; r++) without[r] = contrast(v, r);
  return abbe_gem_number_jackknife(contrast(v, v->repeats), without, v->repeats);
}
