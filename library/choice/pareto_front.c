#include "library/choice/picture_choice.h"

#include <math.h>
#include <stdbool.h>

static bool counts(double cost, double error) {
  return isfinite(cost) && cost > 0 && isfinite(error);
}

/* Whether j beats i, or is equal and came first. */
static bool beats(const double *cost, const double *error, size_t j, size_t i) {
  if (!counts(cost[j], error[j]) || cost[j] > cost[i] || error[j] > error[i]) return false;
  return cost[j] < cost[i] || error[j] < error[i] || j < i;
}

size_t abbe_pareto_front_order(const double *cost, const double *error, size_t count,
                               size_t *order) {
  size_t found = 0;
  for (size_t i = 0; i < count; i++) {
    bool on_front = counts(cost[i], error[i]);
    for (size_t j = 0; j < count && on_front; j++) on_front = j == i || !beats(cost, error, j, i);
    if (!on_front) continue;
    size_t at = found++;
    for (; at > 0 && cost[order[at - 1]] > cost[i]; at--) order[at] = order[at - 1];
    order[at] = i;
  }
  return found;
}

static double height(double error) {
  return log(fmax(error, 1e-12));
}

size_t abbe_pareto_front_knee(const double *cost, const double *error, size_t count) {
  if (count < 3) return count / 2;
  double x0 = log(cost[0]), x1 = log(cost[count - 1]);
  double y0 = height(error[0]), y1 = height(error[count - 1]);
  size_t best = count / 2;
  double most = 1e-9;
  for (size_t i = 1; i + 1 < count; i++) {
    double line = y0 + (y1 - y0) * (log(cost[i]) - x0) / (x1 - x0);
    double below = line - height(error[i]);
    if (below > most) best = i;
    most = fmax(most, below);
  }
  return best;
}

size_t abbe_pareto_front_accurate(const double *error, size_t count, double slack) {
  double least = INFINITY;
  for (size_t i = 0; i < count; i++) least = fmin(least, error[i]);
  for (size_t i = 0; i < count; i++)
    if (error[i] <= least * (1 + slack)) return i;
  return 0;
}
