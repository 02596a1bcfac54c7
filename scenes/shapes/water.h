/* water.h: a basin of water at an instant: waves and rings of drops over a flat bottom, as a closed
 * mesh.
 *
 * Linear waves: each moves undisturbed by the others, by the walls (which reflect none) and by its
 * own height. Gravity, surface tension and the depth give its speed [Lamb1932]. Any instant is
 * computed by itself, so frames may be made in any order. Internal to scenes/. */
#ifndef ABBE_SCENES_SHAPES_WATER_H
#define ABBE_SCENES_SHAPES_WATER_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_WATER_MOST_WAVES 64u
#define ABBE_WATER_MOST_DROPS 64u /* whose rings are there at one time */
#define ABBE_WATER_MOST_CELLS 2048u
/* So many cells a wavelength, or across a drop's radius times two, are the least. */
#define ABBE_WATER_LEAST_CELLS 4

typedef struct abbe_water_wave {
  double amplitude, wavelength; /* m; the wavelength above 0 */
  double direction_rad;         /* in which crests go, from +x towards +y */
  double phase_rad;             /* at the origin at time 0: 0 is a crest */
} abbe_water_wave;

/* At its time the surface is a crater with a rim, -depth (1 - r^2 / radius^2) exp(-r^2 / radius^2),
 * at rest: no water comes or goes. */
typedef struct abbe_water_drop {
  double at[2], time, depth, radius; /* m, s */
} abbe_water_drop;

/* Drops at equal intervals, for ever, at random places. */
typedef struct abbe_water_rain {
  double every, depth, radius; /* s, m, m; every 0: none */
  uint32_t seed;
} abbe_water_rain;

typedef struct abbe_water {
  double size[3];  /* m: along x, along y, mean depth; all above 0 */
  size_t cells[2]; /* along x and y; 0: by the shortest wave, 1 where nothing moves */
  double time;     /* s */
  size_t wave_count, drop_count;
  const abbe_water_wave *wave;
  const abbe_water_drop *drop;
  abbe_water_rain rain;
} abbe_water;

/* Angular frequency, rad/s, of waves of that wavenumber, rad/m, over that depth, m (INFINITY: deep
 * water): the square is (g k + k^3 T / rho) tanh(k depth) [Lamb1932, 228, 266], with 9.80665 m/s2,
 * 0.0728 N/m and 998.2 kg/m3. */
double abbe_water_frequency(double wavenumber, double depth);

/* The body: its mean surface is z = 0, its bottom z = -size[2], the origin in the middle. The top
 * has the surface's own normals, sides and bottom flat ones. ABBE_INVALID_ARGUMENT for a number out
 * of range, fewer than ABBE_WATER_LEAST_CELLS cells a wavelength, or waves as high as the water is
 * deep; ABBE_NO_MEMORY. */
abbe_result abbe_water_make(const abbe_water *water, abbe_mesh *out, abbe_error *error);

#endif
