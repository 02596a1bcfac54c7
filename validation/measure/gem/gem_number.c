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

void abbe_gem_sums_add(abbe_gem_sums *s, const double *value, const float *weight, size_t count) {
  const double n = (double)count, unbiased = n / (n - 1);
  double v = 0, w = 0;
  for (size_t r = 0; r < count; r++) {
    v += value[r];
    w += (double)weight[r];
  }
  s->value += v;
  s->weight += w;
  for (size_t r = 0; r < count; r++) {
    const double dv = value[r] - v / n, dw = (double)weight[r] - w / n;
    s->value_square += unbiased * dv * dv;
    s->product += unbiased * dv * dw;
    s->weight_square += unbiased * dw * dw;
  }
}

void abbe_gem_sums_join(abbe_gem_sums *to, const abbe_gem_sums *other) {
  to->value += other->value;
  to->weight += other->weight;
  to->value_square += other->value_square;
  to->product += other->product;
  to->weight_square += other->weight_square;
}

abbe_gem_number abbe_gem_sums_ratio(const abbe_gem_sums *s) {
  const double is = ratio(s->value, s->weight);
  const double square = s->value_square - 2 * is * s->product + is * is * s->weight_square;
  return (abbe_gem_number){is, ratio(sqrt(fmax(square, 0)), s->weight)};
}
