#include "validation/measure/gem/gem_number.h"

#include <math.h>

static double scatter(double square, size_t count) {
  return count < 2 ? NAN : sqrt(square * ((double)count - 1) / (double)count);
}

abbe_gem_number abbe_gem_number_jackknife(double whole, const double *without, size_t count) {
  double mean = 0, square = 0;
  for (size_t i = 0; i < count; i++) mean += without[i] / (double)count;
  for (size_t i = 0; i < count; i++) square += (without[i] - mean) * (without[i] - mean);
  return (abbe_gem_number){whole, scatter(square, count)};
}

static double ratio(double sum, double weight) {
  return weight > 0 ? sum / weight : 0;
}

abbe_gem_number abbe_gem_number_ratio(const double *sum, const double *weight, size_t count) {
  double s = 0, w = 0, mean = 0, square = 0;
  for (size_t i = 0; i < count; i++) {
    s += sum[i];
    w += weight[i];
  }
  for (size_t i = 0; i < count; i++) mean += ratio(s - sum[i], w - weight[i]) / (double)count;
  for (size_t i = 0; i < count; i++) square += pow(ratio(s - sum[i], w - weight[i]) - mean, 2);
  return (abbe_gem_number){ratio(s, w), scatter(square, count)};
}
