#include "validation/volume/volume_space.h"

#include "base/maths.h"
#include "validation/transport/random.h"

#include <stdlib.h>

enum { SALT = 0x737063, MOST_FACES_OF_LINE = 256 };

typedef struct tally {
  const abbe_geometry *g;
  const abbe_volume_region *region;
  const double *centre;
  abbe_region_piece *piece;
  double *whole, *inner; /* [cells] lengths of lines */
} tally;

static void add(tally *t, const double o[3], const double d[3], double from, double to,
                double *sum) {
  double p[3], q[3];
  for (int k = 0; k < 3; k++) {
    p[k] = o[k] + from * d[k];
    q[k] = p[k] - t->centre[k];
  }
  const size_t count = abbe_volume_region_walk(t->region, q, d, to - from, t->piece);
  for (size_t i = 0; i < count; i++) sum[t->piece[i].cell] += t->piece[i].length;
}

/* The parts of a line inside the surface. */
static void cut_line(tally *t, const double o[3], const double d[3]) {
  float at[3], way[3];
  double entered = 0, done = 0;
  int depth = 0;
  abbe_geometry_to_frame(t->g, o, at);
  for (int k = 0; k < 3; k++) way[k] = (float)d[k];
  for (int i = 0; i < MOST_FACES_OF_LINE; i++) {
    abbe_hit hit;
    double world[3], along[3];
    if (!abbe_geometry_hit(t->g, ABBE_GEOMETRY_OBJECTS, at, way, INFINITY, &hit)) return;
    abbe_geometry_to_world(t->g, hit.p, world);
    abbe_vector_subtract(world, o, along);
    done = abbe_vector_dot(along, d);
    const bool enters = way[0] * hit.ng[0] + way[1] * hit.ng[1] + way[2] * hit.ng[2] < 0;
    if (enters && depth++ == 0) entered = done;
    if (!enters && depth > 0 && --depth == 0) add(t, o, d, entered, done, t->inner);
    abbe_geometry_leave(&hit, way, at);
  }
}

static void make_line(uint32_t i, const double centre[3], double radius, double o[3], double d[3]) {
  float random[4];
  double x[3], y[3];
  abbe_random4(i, 0, 0, SALT, random);
  d[2] = 2 * (double)random[0] - 1;
  const double across = sqrt(fmax(1 - d[2] * d[2], 0)), turn = 2 * ABBE_PI * (double)random[1];
  d[0] = across * cos(turn);
  d[1] = across * sin(turn);
  const double other[3] = {fabs(d[0]) < 0.6, fabs(d[0]) >= 0.6, 0};
  abbe_vector_cross(d, other, x);
  abbe_vector_normalise(x);
  abbe_vector_cross(d, x, y);
  const double r = radius * sqrt((double)random[2]), a = 2 * ABBE_PI * (double)random[3];
  for (int k = 0; k < 3; k++)
    o[k] = centre[k] + r * (cos(a) * x[k] + sin(a) * y[k]) - 4 * radius * d[k];
}

abbe_result abbe_volume_space_measure(const abbe_geometry *g, const abbe_volume_region *region,
                                      const double centre[3], double radius, size_t lines,
                                      float *share, abbe_error *error) {
  tally t = {.g = g, .region = region, .centre = centre};
  t.piece = malloc(ABBE_REGION_MOST_PIECES * sizeof *t.piece);
  t.whole = calloc(region->cells, sizeof *t.whole);
  t.inner = calloc(region->cells, sizeof *t.inner);
  const bool room = t.piece != NULL && t.whole != NULL && t.inner != NULL;
  for (uint32_t i = 0; room && i < lines; i++) {
    double o[3], d[3];
    make_line(i, centre, 1.2 * radius, o, d);
    add(&t, o, d, 0, INFINITY, t.whole);
    cut_line(&t, o, d);
  }
  for (size_t i = 0; room && i < region->cells; i++)
    share[i] = t.whole[i] > 0 ? (float)fmin(fmax(1 - t.inner[i] / t.whole[i], 0), 1) : 1;
  free(t.piece);
  free(t.whole);
  free(t.inner);
  return room ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a region's space");
}
