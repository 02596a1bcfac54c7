#include "validation/lab/known/known_light.h"

#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

enum { AZIMUTHS = 2048 };

/* Where the ray of light through texture coordinates meets the plane, from the centre. */
static bool on_plane(const abbe_rings *r, const double uv[2], double at[2]) {
  double origin[3], d[3];
  abbe_map_layout_ray(&r->layout, uv, origin, d);
  double t = (r->centre[2] - origin[2]) / d[2];
  if (!(t > 0) || !isfinite(t)) return false;
  for (int k = 0; k < 2; k++) at[k] = origin[k] + t * d[k] - r->centre[k];
  return true;
}

static uint8_t ring_of(const abbe_rings *r, double radius) {
  if (radius < r->edge[0] || radius >= r->edge[r->count]) return (uint8_t)r->count;
  size_t ring = 0;
  while (radius >= r->edge[ring + 1]) ring++;
  return (uint8_t)ring;
}

static void place_texel(abbe_rings *r, size_t column, size_t row) {
  double middle[2], corner[2];
  const double u = 1.0 / (double)r->width, v = 1.0 / (double)r->height;
  const double uv[2] = {((double)column + 0.5) * u, 1 - ((double)row + 0.5) * v};
  uint8_t *ring = &r->ring[row * r->width + column];
  *ring = (uint8_t)r->count;
  if (!on_plane(r, uv, middle)) return;
  *ring = ring_of(r, hypot(middle[0], middle[1]));
  /* Texels that no edge passes need no reach. */
  if (hypot(middle[0], middle[1]) > 2 * r->edge[r->count]) return;
  for (int k = 0; k < 4; k++) {
    const double at[2] = {uv[0] + (k & 1 ? u / 2 : -u / 2), uv[1] + (k & 2 ? v / 2 : -v / 2)};
    if (on_plane(r, at, corner))
      r->ragged = fmax(r->ragged, hypot(corner[0] - middle[0], corner[1] - middle[1]));
  }
}

abbe_result abbe_rings_make(const abbe_map_layout *layout, size_t width, size_t height,
                            const double centre[3], const double *edge, size_t count,
                            abbe_rings *out, abbe_error *error) {
  *out = (abbe_rings){.layout = *layout, .width = width, .height = height, .count = count};
  if (count < 1 || count > ABBE_RINGS_MAX || width < 1 || height < 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu rings on a map of %zu x %zu: 1 to %d rings, 1 texel or more", count,
                          width, height, ABBE_RINGS_MAX);
  for (size_t i = 0; i <= count; i++)
    if (!isfinite(edge[i]) || edge[i] < 0 || (i > 0 && edge[i] <= edge[i - 1]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "ring edge %zu is %g m; edges ascend from 0 or more", i, edge[i]);
  memcpy(out->centre, centre, sizeof out->centre);
  memcpy(out->edge, edge, (count + 1) * sizeof *edge);
  out->ring = height <= SIZE_MAX / width ? malloc(width * height) : NULL;
  if (out->ring == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for rings on %zu x %zu texels",
                          width, height);
  for (size_t row = 0; row < height; row++)
    for (size_t column = 0; column < width; column++) place_texel(out, column, row);
  return ABBE_OK;
}

void abbe_rings_free(abbe_rings *rings) {
  if (rings == NULL) return;
  free(rings->ring);
  *rings = (abbe_rings){0};
}

void abbe_rings_sum(const abbe_rings *rings, const float *sample, size_t stride, bool squared,
                    double *sum) {
  for (size_t i = 0; i < rings->count; i++) sum[i] = 0;
  for (size_t i = 0; i < rings->width * rings->height; i++) {
    double x = (double)sample[i * stride];
    if (rings->ring[i] < rings->count) sum[rings->ring[i]] += squared ? x * x : x;
  }
}

void abbe_rings_radii(const abbe_rings *rings, double *radius) {
  for (size_t e = 0; e <= rings->count; e++)
    for (int k = 0; k <= ABBE_RINGS_STEPS; k++) {
      double off = rings->ragged * (2.0 * k / ABBE_RINGS_STEPS - 1);
      *radius++ = fmax(0, rings->edge[e] + off);
    }
}

/* Share of a circle that lies in texels of the rings before the edge. */
static double share_before(const abbe_rings *r, double radius, size_t edge) {
  size_t inside = 0;
  for (int k = 0; k < AZIMUTHS; k++) {
    double around = 2 * ABBE_PI * (k + 0.5) / AZIMUTHS;
    const double at[3] = {r->centre[0] + radius * cos(around), r->centre[1] + radius * sin(around),
                          r->centre[2]};
    size_t column, row;
    if (!abbe_map_layout_texel(&r->layout, r->width, r->height, at, &column, &row)) continue;
    /* by the texel's middle: the innermost edge too has an inside */
    uint8_t ring = r->ring[row * r->width + column];
    if (ring < r->count)
      inside += ring < edge;
    else
      inside += radius < r->edge[r->count] / 2 + r->edge[0] / 2 ? 1 : 0;
  }
  return (double)inside / AZIMUTHS;
}

void abbe_rings_expect(const abbe_rings *rings, const double *enclosed, size_t stride,
                       double *flux) {
  double radius[(ABBE_RINGS_MAX + 1) * (ABBE_RINGS_STEPS + 1)], before = 0;
  abbe_rings_radii(rings, radius);
  for (size_t e = 0; e <= rings->count; e++) {
    size_t first = e * (ABBE_RINGS_STEPS + 1);
    double sum = enclosed[first * stride];
    for (size_t k = first; k < first + ABBE_RINGS_STEPS; k++) {
      double step = enclosed[(k + 1) * stride] - enclosed[k * stride];
      if (step > 0) sum += step * share_before(rings, (radius[k] + radius[k + 1]) / 2, e);
    }
    if (e > 0) flux[e - 1] = sum - before;
    before = sum;
  }
}
