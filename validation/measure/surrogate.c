#include "validation/measure/surrogate.h"

#include <math.h>

/* Over so much the process changes; and shares of what it does not explain. */
#define REACH 0.12
#define NOISE 0.1
#define GRADIENT_NOISE 0.5

/* Of what is known: number 3 i is value i, and the two that follow its gradient. */
static double covariance(const double x[2], size_t a, const double y[2], size_t b) {
  const double off[2] = {(x[0] - y[0]) / REACH, (x[1] - y[1]) / REACH};
  const double near = exp(-0.5 * (off[0] * off[0] + off[1] * off[1]));
  if (a == 0 && b == 0) return near;
  if (a == 0) return near * off[b - 1] / REACH;
  if (b == 0) return -near * off[a - 1] / REACH;
  return near * ((a == b) - off[a - 1] * off[b - 1]) / (REACH * REACH);
}

bool abbe_surrogate_fit(abbe_surrogate *s) {
  const size_t n = 3 * s->count;
  double square = 0;
  s->mean = 0;
  for (size_t i = 0; i < s->count; i++) s->mean += s->value[i] / (double)s->count;
  for (size_t i = 0; i < s->count; i++) square += pow(s->value[i] - s->mean, 2);
  s->scale = square > 0 ? sqrt(square / (double)s->count) : 1;
  for (size_t i = 0; i < n; i++) {
    s->weight[i] = (i % 3 == 0 ? s->value[i / 3] - s->mean : s->by[i / 3][i % 3 - 1]) / s->scale;
    for (size_t j = 0; j <= i; j++) {
      double sum = covariance(s->at[i / 3], i % 3, s->at[j / 3], j % 3);
      if (i == j) sum += i % 3 == 0 ? NOISE * NOISE : pow(GRADIENT_NOISE / REACH, 2);
      for (size_t k = 0; k < j; k++) sum -= s->root[i * n + k] * s->root[j * n + k];
      if (i == j && !(sum > 0)) return false;
      s->root[i * n + j] = i == j ? sqrt(sum) : sum / s->root[j * n + j];
    }
  }
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < i; k++) s->weight[i] -= s->root[i * n + k] * s->weight[k];
    s->weight[i] /= s->root[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; k++) s->weight[i] -= s->root[k * n + i] * s->weight[k];
    s->weight[i] /= s->root[i * n + i];
  }
  return true;
}

double abbe_surrogate_at(const abbe_surrogate *s, const double x[2], double *deviation) {
  double known[3 * ABBE_SURROGATE_MOST], mean = 0, sure = 0;
  const size_t n = 3 * s->count;
  for (size_t i = 0; i < n; i++) {
    const double like = covariance(x, 0, s->at[i / 3], i % 3);
    mean += like * s->weight[i];
    known[i] = like;
    for (size_t k = 0; k < i; k++) known[i] -= s->root[i * n + k] * known[k];
    known[i] /= s->root[i * n + i];
    sure += known[i] * known[i];
  }
  *deviation = s->scale * sqrt(fmax(1 - sure, 0));
  return s->mean + s->scale * mean;
}

void abbe_surrogate_best(const abbe_surrogate *s, double trust, double x[2]) {
  enum { SIDE = 41 };
  double most = -INFINITY;
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double at[2] = {i % SIDE / (SIDE - 1.0), i / SIDE / (SIDE - 1.0)};
    double deviation;
    const double value = abbe_surrogate_at(s, at, &deviation) + trust * deviation;
    if (!(value > most)) continue;
    most = value;
    x[0] = at[0];
    x[1] = at[1];
  }
}
