#include "spectral/film.h"

#include "base/maths.h"

#include <complex.h>
#include <math.h>

/* A medium by N^2 and q = N cos, of light whose N sin is kappa; q decays away from where it comes
 * from. */
typedef struct medium {
  double complex square, q;
} medium;

static medium medium_of(double n, double k, double kappa) {
  medium out = {(n + I * k) * (n + I * k), n};
  if (k > 0)
    out.q = csqrt(out.square - kappa * kappa);
  else if (kappa <= n)
    out.q = sqrt((n - kappa) * (n + kappa));
  else
    out.q = I * sqrt((kappa - n) * (kappa + n));
  return out;
}

/* cos of a layer's phase, and its sine over q, both times exp(-Im phase), which is put on `decay`:
 * thick metal would overflow. Finite where q is 0. */
static void phase_of(const medium *m, double length, double complex *cosine, double complex *sine,
                     double *decay) {
  const double complex phase = m->q * length;
  const double a = creal(phase), b = cimag(phase), rest = exp(-2 * b);
  const double complex s = sin(a) * (1 + rest) / 2 + I * cos(a) * (1 - rest) / 2;
  *cosine = cos(a) * (1 + rest) / 2 - I * sin(a) * (1 - rest) / 2;
  *sine = cabs(phase) < 1e-4 ? length * (1 - phase * phase / 6) * exp(-b) : s / m->q;
  *decay += b;
}

/* Tangential fields E and H of s (Y = q) and p (Y = N^2 / q), taken from behind a layer to its
 * front. p's H is multiplied out, so that no Y is infinite. */
static void pass(const medium *m, double length, double complex field[2][2], double *decay) {
  double complex cosine, sine;
  phase_of(m, length, &cosine, &sine, decay);
  const double complex along = m->q * m->q * sine;
  const double complex over[2] = {sine, along / m->square}, times[2] = {along, m->square * sine};
  for (int p = 0; p < 2; p++) {
    const double complex e = field[p][0], h = field[p][1];
    field[p][0] = cosine * e - I * over[p] * h;
    field[p][1] = cosine * h - I * times[p] * e;
  }
}

void abbe_film_fields(const abbe_film_layer *layer, size_t count, bool reversed, double kappa,
                      double lambda_nm, double complex field[2][2], double *decay) {
  *decay = 0;
  for (size_t i = 0; i < count; i++) {
    const abbe_film_layer *l = &layer[reversed ? i : count - 1 - i];
    const medium m = medium_of(l->n, l->k, kappa);
    pass(&m, 2 * ABBE_PI * l->nm / lambda_nm, field, decay);
  }
}

/* Which of the rising points is below, and how far the next is. */
static size_t place(const double *x, size_t count, double at, double *part) {
  size_t i = 0, last = count < 2 ? 0 : count - 2;
  while (i < last) {
    const size_t middle = (i + last + 1) / 2;
    if (x[middle] <= at)
      i = middle;
    else
      last = middle - 1;
  }
  *part = count < 2 ? 0 : fmin(fmax((at - x[i]) / (x[i + 1] - x[i]), 0), 1);
  return i;
}

static void look_up(const abbe_film_table *t, double n_from, double n_to, double cosine,
                    double lambda_nm, abbe_film_light *out) {
  const double *share = t->number + t->angles + t->wavelengths;
  const double ratio = fmax(n_from / n_to, 1),
               beyond = 1 - (1 - cosine) * (1 + cosine) * ratio * ratio;
  double part[2];
  *out = (abbe_film_light){.reflected = {1, 1}};
  if (beyond < 0) return;
  const size_t i = place(t->number, t->angles, 1 - (ratio > 1 ? sqrt(beyond) : cosine), &part[0]),
               k = place(t->number + t->angles, t->wavelengths, lambda_nm, &part[1]);
  for (int p = 0; p < 2; p++) {
    double sum[2] = {0};
    for (size_t corner = 0; corner < 4; corner++) {
      const size_t a = corner & 1, b = corner >> 1;
      const double weight = (a ? part[0] : 1 - part[0]) * (b ? part[1] : 1 - part[1]);
      if (!(weight > 0)) continue; /* there may be no such point */
      const double *at = share + 4 * ((i + a) * t->wavelengths + k + b) + 2 * p;
      for (int s = 0; s < 2; s++) sum[s] += weight * at[s];
    }
    out->reflected[p] = sum[0];
    out->transmitted[p] = sum[1];
  }
}

void abbe_film_light_at(const abbe_film_layer *layer, size_t count, bool reversed, double n_from,
                        const double to[2], double cos_i, double lambda_nm, abbe_film_light *out) {
  const double c = fmin(fmax(cos_i, 0), 1), kappa = n_from * sqrt((1 - c) * (1 + c));
  if (count > 0 && layer->table != NULL) {
    look_up(layer->table, n_from, to[0], c, lambda_nm, out);
    return;
  }
  const medium first = {n_from * n_from, n_from * c}, last = medium_of(to[0], to[1], kappa);
  /* E and H where the light leaves, of a wave whose magnetic field is 1 in p */
  double complex field[2][2] = {{1, last.q}, {last.q / last.square, 1}};
  double decay;
  abbe_film_fields(layer, count, reversed, kappa, lambda_nm, field, &decay);
  /* r = (Y E - H) / (Y E + H), where p's Y = N^2 / q is multiplied by q and its r is of H; the wave
   * that comes brings 1 / arrives of the sum's square */
  const double complex in[2][2] = {{first.q, 1}, {first.square, first.q}};
  const double arrives[2] = {4 * n_from * c, 4 * n_from * c * n_from * n_from};
  const double leaves[2] = {creal(last.q), creal(last.q / last.square)};
  for (int p = 0; p < 2; p++) {
    const double complex e = in[p][0] * field[p][0], h = in[p][1] * field[p][1], sum = e + h;
    const double size = cabs(sum) * exp(decay);
    const bool grazing = !(c > 0) || !(size > 0);
    const double complex r = grazing ? -1 : (p == ABBE_FILM_S ? e - h : h - e) / sum;
    out->r[p][0] = creal(r);
    out->r[p][1] = cimag(r);
    out->reflected[p] = fmin(creal(r * conj(r)), 1);
    out->transmitted[p] = grazing ? 0 : arrives[p] * leaves[p] / (size * size);
    /* both amplitudes come by one phase from the wave that 1 is behind the films */
    const double complex t = grazing ? 0 : sqrt(out->transmitted[p]) * conj(sum) / cabs(sum);
    out->t[p][0] = creal(t);
    out->t[p][1] = cimag(t);
  }
}

void abbe_film_unpolarised(const abbe_film_light *light, double *reflected, double *transmitted) {
  *reflected = (light->reflected[0] + light->reflected[1]) / 2;
  *transmitted = (light->transmitted[0] + light->transmitted[1]) / 2;
}
