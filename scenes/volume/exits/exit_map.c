#include "scenes/volume/exits/exit_map.h"

#include <math.h>
#include <string.h>

enum { MOST_REACH = 26 }; /* texels */

/* The sum of a tent of that half width, whose middle is 0, up to x. */
static double tent_upto(double x, double wide) {
  const double at = fmin(fmax(x / wide, -1), 1);
  return 0.5 + at - 0.5 * at * fabs(at);
}

/* Shares of texels at 0, 1 ... from the middle; returns the last. Places among four texels have a
 * variance of 1/6 already, and texels one of a twelfth. */
static size_t make_shares(float wide, size_t side, float share[MOST_REACH + 1]) {
  const double square = (double)wide * (double)wide - 1.5;
  const double most = side < MOST_REACH ? (double)side : MOST_REACH;
  share[0] = 1;
  if (!(square > 0.25)) return 0;
  const double own = fmin(sqrt(square), most - 0.5);
  const size_t reach = (size_t)ceil(own - 0.5);
  for (size_t i = 0; i <= reach; i++)
    share[i] = (float)(tent_upto((double)i + 0.5, own) - tent_upto((double)i - 0.5, own));
  return reach;
}

/* Of a place before the first texel or after the last; at: from `reach` before the first on. */
static size_t fold(size_t at, size_t reach, size_t side) {
  const size_t i = at < reach ? reach - at - 1 : at - reach;
  return i < side ? i : 2 * side - i - 1;
}

static void add_row(const float *from, size_t count, float share, float *to) {
  for (size_t i = 0; i < count; i++) to[i] += share * from[i];
}

/* Of a row of texels around the i-th of those by whose shares they are summed up. */
static float share_at(const float *share, size_t reach, size_t i) {
  return share[i < reach ? reach - i : i - reach];
}

void abbe_exit_map_smooth(const float (*from)[4], size_t side, const float wide[2],
                          float (*to)[4]) {
  float across[MOST_REACH + 1], up[MOST_REACH + 1];
  const size_t columns = make_shares(wide[0], side, across), rows = make_shares(wide[1], side, up);
#pragma omp parallel for
  for (size_t y = 0; y < side; y++) {
    float row[ABBE_EXIT_MAP_MOST_SIDE + 2 * MOST_REACH][4]; /* with what is folded back */
    memset(row[columns], 0, side * sizeof *row);
    for (size_t i = 0; i < 2 * rows + 1; i++)
      add_row(from[fold(y + i, rows, side) * side], 4 * side, share_at(up, rows, i), row[columns]);
    for (size_t i = 0; i < columns; i++) {
      memcpy(row[i], row[columns + fold(i, columns, side)], sizeof *row);
      memcpy(row[columns + side + i], row[columns + fold(columns + side + i, columns, side)],
             sizeof *row);
    }
    memset(to[y * side], 0, side * sizeof *to);
    for (size_t i = 0; i < 2 * columns + 1; i++)
      add_row(row[i], 4 * side, share_at(across, columns, i), to[y * side]);
  }
}
