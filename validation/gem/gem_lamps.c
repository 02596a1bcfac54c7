#include "validation/gem/gem_lamps.h"

#include "validation/transport/side_by_side.h"

#include <math.h>

#define PI 3.14159265358979323846
#define GOLDEN_RAD (PI * (3 - sqrt(5.0))) /* of the spiral [Vogel1979] */

enum { LANES = 64 };

abbe_gem_lamps abbe_gem_lamps_make(const abbe_gem_eye *eye, size_t repeat, double head_rad) {
  abbe_gem_lamps out;
  /* the room's own turn: the golden section of a whole one */
  const double turn = 2 * PI * fmod((double)repeat * 0.6180339887498949, 1);
  for (int i = 0; i < LANES; i++) {
    const double height = (i + 0.5) / ABBE_GEM_LAMPS, across = sqrt(fmax(1 - height * height, 0));
    const double azimuth = turn + i * GOLDEN_RAD;
    /* sizes are spread evenly over all heights: by another irrational step */
    const double share = fmod(i * 0.7548776662466927, 1);
    const double radius =
        0.5 * (ABBE_GEM_LAMP_MIN_DEG + share * (ABBE_GEM_LAMP_MAX_DEG - ABBE_GEM_LAMP_MIN_DEG));
    const bool dark = i >= ABBE_GEM_LAMPS || height >= cos(head_rad);
    double d[3];
    for (int k = 0; k < 3; k++)
      d[k] = across * (cos(azimuth) * eye->right[k] + sin(azimuth) * eye->up[k]) +
             height * eye->to_eye[k];
    out.x[i] = (float)d[0];
    out.y[i] = (float)d[1];
    out.z[i] = (float)d[2];
    out.cos_radius[i] = dark ? 2 : (float)cos(radius * PI / 180);
  }
  return out;
}

SIDE_BY_SIDE static int lamps_at(const abbe_gem_lamps *l, const float d[3]) {
  const float x = d[0], y = d[1], z = d[2];
  int met = 0;
  for (int i = 0; i < LANES; i++) met += l->x[i] * x + l->y[i] * y + l->z[i] * z > l->cos_radius[i];
  return met;
}

/* Where two lamps overlap there is one. */
float abbe_gem_lamps_light(const abbe_gem_lamps *lamps, const abbe_gem_path *path) {
  float sum = 0;
  for (size_t i = 0; i < path->count; i++)
    if (lamps_at(lamps, path->exit[i].d) > 0) sum += path->exit[i].share;
  return sum;
}
