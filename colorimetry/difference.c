#include "colorimetry/difference.h"

#include "base/maths.h"
#include "colorimetry/gamut.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

/* [CIE15]: the cube root, and below (6/29)^3 its tangent line, which also carries negatives. */
static double lab_f(double t) {
  const double delta = 6.0 / 29;
  return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

void abbe_difference_lab(const double xyz[3], const double white[3], double lab[3]) {
  double fx = lab_f(xyz[0] / white[0]);
  double fy = lab_f(xyz[1] / white[1]);
  double fz = lab_f(xyz[2] / white[2]);
  lab[0] = 116 * fy - 16;
  lab[1] = 500 * (fx - fy);
  lab[2] = 200 * (fy - fz);
}

static double degrees_cos(double degrees) {
  return cos(degrees * ABBE_PI / 180);
}

/* Hue angle in degrees, [0, 360); 0 for a grey. */
static double hue(double a, double b) {
  if (a == 0 && b == 0) return 0;
  double h = atan2(b, a) * 180 / ABBE_PI;
  return h < 0 ? h + 360 : h;
}

static double seventh_power_share(double c) {
  double c7 = pow(c, 7);
  return sqrt(c7 / (c7 + 6103515625.0 /* 25^7 */));
}

/* Difference of hue in degrees, (-180, 180] [Sharma2005, eq. 10]. */
static double hue_difference(double h1, double h2, double chroma_product) {
  if (chroma_product == 0) return 0;
  double d = h2 - h1;
  if (d > 180) return d - 360;
  return d < -180 ? d + 360 : d;
}

/* Mean hue in degrees [Sharma2005, eq. 14]. */
static double hue_mean(double h1, double h2, double chroma_product) {
  double sum = h1 + h2;
  if (chroma_product == 0) return sum;
  if (fabs(h1 - h2) <= 180) return sum / 2;
  return sum < 360 ? (sum + 360) / 2 : (sum - 360) / 2;
}

double abbe_difference_ciede2000(const double lab1[3], const double lab2[3]) {
  double c_mean = (hypot(lab1[1], lab1[2]) + hypot(lab2[1], lab2[2])) / 2;
  double stretch = 1 + 0.5 * (1 - seventh_power_share(c_mean));
  double a1 = stretch * lab1[1], a2 = stretch * lab2[1];
  double c1 = hypot(a1, lab1[2]), c2 = hypot(a2, lab2[2]);
  double h1 = hue(a1, lab1[2]), h2 = hue(a2, lab2[2]);

  double dl = lab2[0] - lab1[0];
  double dc = c2 - c1;
  double dh = 2 * sqrt(c1 * c2) * sin(hue_difference(h1, h2, c1 * c2) * ABBE_PI / 360);

  double l = (lab1[0] + lab2[0]) / 2, c = (c1 + c2) / 2, h = hue_mean(h1, h2, c1 * c2);
  double t = 1 - 0.17 * degrees_cos(h - 30) + 0.24 * degrees_cos(2 * h) +
             0.32 * degrees_cos(3 * h + 6) - 0.20 * degrees_cos(4 * h - 63);
  double l50 = (l - 50) * (l - 50);
  double sl = 1 + 0.015 * l50 / sqrt(20 + l50);
  double sc = 1 + 0.045 * c;
  double sh = 1 + 0.015 * c * t;
  double turn = (h - 275) / 25;
  double theta = 30 * exp(-turn * turn);
  double rt = -2 * seventh_power_share(c) * sin(2 * theta * ABBE_PI / 180);

  double tl = dl / sl, tc = dc / sc, th = dh / sh;
  return sqrt(fmax(0, tl * tl + tc * tc + th * th + rt * tc * th));
}

double abbe_difference_cie76(const double lab1[3], const double lab2[3]) {
  return hypot(hypot(lab1[0] - lab2[0], lab1[1] - lab2[1]), lab1[2] - lab2[2]);
}

double abbe_difference_cie94(const double standard[3], const double sample[3]) {
  const double c = hypot(standard[1], standard[2]);
  const double dl = standard[0] - sample[0], da = standard[1] - sample[1];
  const double db = standard[2] - sample[2], dc = c - hypot(sample[1], sample[2]);
  const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c;
  const double hue2 = fmax(0, da * da + db * db - dc * dc);
  return sqrt(dl * dl + dc * dc / (sc * sc) + hue2 / (sh * sh));
}

/* [BT2100, table 4] */
static const double pq_m1 = 2610.0 / 16384, pq_m2 = 2523.0 / 32, pq_c1 = 3424.0 / 4096,
                    pq_c2 = 2413.0 / 128, pq_c3 = 2392.0 / 128;

double abbe_difference_pq(double cd_m2) {
  const double y = pow(fmin(fmax(cd_m2 / 10000, 0), 1), pq_m1);
  return pow((pq_c1 + pq_c2 * y) / (1 + pq_c3 * y), pq_m2);
}

double abbe_difference_pq_light(double signal) {
  const double e = pow(fmin(fmax(signal, 0), 1), 1 / pq_m2);
  return 10000 * pow(fmax(e - pq_c1, 0) / (pq_c2 - pq_c3 * e), 1 / pq_m1);
}

/* [BT2100, table 6]: from linear Rec.2020 to cones, from their PQ signals to I, Ct, Cp. */
static const double cones[9] = {1688.0 / 4096, 2146.0 / 4096, 262.0 / 4096,
                                683.0 / 4096,  2951.0 / 4096, 462.0 / 4096,
                                99.0 / 4096,   309.0 / 4096,  3688.0 / 4096};
static const double opponents[9] = {2048.0 / 4096,  2048.0 / 4096,   0,
                                    6610.0 / 4096,  -13613.0 / 4096, 7003.0 / 4096,
                                    17933.0 / 4096, -17390.0 / 4096, -543.0 / 4096};

void abbe_difference_ictcp(const double xyz[3], double ictcp[3]) {
  double from[9], v[3];
  abbe_gamut_from_xyz(ABBE_GAMUT_REC2020, from);
  abbe_rgb_space_apply(from, xyz, v);
  abbe_rgb_space_apply(cones, v, v);
  for (int c = 0; c < 3; c++) v[c] = abbe_difference_pq(v[c]);
  abbe_rgb_space_apply(opponents, v, ictcp);
}

double abbe_difference_itp(const double a[3], const double b[3]) {
  return 720 * hypot(hypot(a[0] - b[0], (a[1] - b[1]) / 2), a[2] - b[2]);
}

bool abbe_difference_uv(const double xyz[3], double uv[2]) {
  double sum = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
  if (!(sum > 0 && xyz[1] > 0)) return false;
  uv[0] = 4 * xyz[0] / sum;
  uv[1] = 9 * xyz[1] / sum;
  return true;
}
