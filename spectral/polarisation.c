#include "spectral/polarisation.h"

#include <math.h>

abbe_jones abbe_jones_of_face(const abbe_film_light *light, bool reflected) {
  const double(*a)[2] = reflected ? light->r : light->t;
  return (abbe_jones){{{a[0][0] + I * a[0][1], 0}, {0, a[1][0] + I * a[1][1]}}};
}

/* By the coherences <E E*>, which J C J* are behind it. */
void abbe_jones_apply(const abbe_jones *jones, const double in[4], double out[4]) {
  const double complex(*m)[2] = jones->m, shared = (in[2] + I * in[3]) / 2;
  const double complex c[2][2] = {{(in[0] + in[1]) / 2, shared},
                                  {conj(shared), (in[0] - in[1]) / 2}};
  double complex made[2][2] = {{0}};
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++)
      for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) made[a][b] += m[a][i] * c[i][j] * conj(m[b][j]);
  out[0] = creal(made[0][0] + made[1][1]);
  out[1] = creal(made[0][0] - made[1][1]);
  out[2] = 2 * creal(made[0][1]);
  out[3] = 2 * cimag(made[0][1]);
}

void abbe_stokes_turn(const double in[4], double cosine, double sine, double out[4]) {
  const double c = (cosine - sine) * (cosine + sine), s = 2 * cosine * sine, q = in[1], u = in[2];
  out[0] = in[0];
  out[1] = c * q + s * u;
  out[2] = c * u - s * q;
  out[3] = in[3];
}

double abbe_stokes_degree(const double s[4]) {
  return s[0] > 0 ? sqrt(s[1] * s[1] + s[2] * s[2] + s[3] * s[3]) / s[0] : 0;
}
