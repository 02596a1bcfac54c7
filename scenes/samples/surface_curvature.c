#include "scenes/samples/surface_samples.h"

#include "base/maths.h"
#include "scenes/samples/point_grid.h"

#include <math.h>
#include <string.h>

enum { LEAST_POINTS = 6 };

static const double least_cosine = 0.5; /* to the sample's own normal */

/* The points around a sample: first what gives the tangent plane, then sums over it. */
typedef struct around {
  const abbe_surface_samples *s;
  const abbe_surface_point *at;
  double frame[3][3]; /* u, v, n */
  double mean[3];
  size_t count;
  bool fits;
  double sum[2], product[2][2]; /* sums over places (u, v) */
  double turn[2], by[2][2];     /* sums over normals' u and v; over those times places */
} around;

static bool is_near(const around *a, size_t number, double from[3]) {
  const abbe_surface_point *p = &a->s->candidate[number];
  abbe_vector_subtract(p->position, a->at->position, from);
  return abbe_vector_length(from) <= a->s->spacing &&
         abbe_vector_dot(p->normal, a->at->normal) > least_cosine;
}

static bool visit(void *user, size_t number) {
  around *a = user;
  const abbe_surface_point *p = &a->s->candidate[number];
  double from[3];
  if (!is_near(a, number, from)) return true;
  if (!a->fits) {
    for (int k = 0; k < 3; k++) a->mean[k] += p->normal[k];
    a->count++;
    return true;
  }
  for (int i = 0; i < 2; i++) {
    const double x = abbe_vector_dot(from, a->frame[i]),
                 n = abbe_vector_dot(p->normal, a->frame[i]);
    a->sum[i] += x;
    a->turn[i] += n;
    for (int j = 0; j < 2; j++) {
      const double y = abbe_vector_dot(from, a->frame[j]);
      a->product[i][j] += x * y;
      a->by[i][j] += n * y;
    }
  }
  return true;
}

/* Two unit tangents to the third row. */
static void complete(double frame[3][3]) {
  const double *n = frame[2];
  const int least = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2)
                                            : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
  double axis[3] = {0, 0, 0};
  axis[least] = 1;
  abbe_vector_cross(axis, n, frame[0]);
  abbe_vector_normalise(frame[0]);
  abbe_vector_cross(n, frame[0], frame[1]);
}

/* The matrix of how the normal turns by place, made symmetric; false where places are on a line. */
static bool solve(const around *a, double m[2][2]) {
  const double count = (double)a->count;
  double p[2][2], q[2][2];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      p[i][j] = a->product[i][j] - a->sum[i] * a->sum[j] / count;
      q[i][j] = a->by[i][j] - a->turn[i] * a->sum[j] / count;
    }
  const double det = p[0][0] * p[1][1] - p[0][1] * p[1][0], size = p[0][0] + p[1][1];
  if (!(det > 1e-6 * size * size)) return false;
  for (int i = 0; i < 2; i++) {
    m[i][0] = (q[i][0] * p[1][1] - q[i][1] * p[1][0]) / det;
    m[i][1] = (q[i][1] * p[0][0] - q[i][0] * p[0][1]) / det;
  }
  m[0][1] = m[1][0] = 0.5 * (m[0][1] + m[1][0]);
  return true;
}

/* Eigenvectors of the symmetric matrix in the frame, the greater amount first. */
static void set_principal(double frame[3][3], double m[2][2], abbe_surface_curvature *out) {
  const double middle = 0.5 * (m[0][0] + m[1][1]), half = 0.5 * (m[0][0] - m[1][1]);
  const double away = hypot(half, m[0][1]), angle = 0.5 * atan2(m[0][1], half);
  double value[2] = {middle + away, middle - away}, c = cos(angle), s = sin(angle);
  if (fabs(value[1]) > fabs(value[0])) {
    const double other = value[0], turned = c;
    value[0] = value[1];
    value[1] = other;
    c = -s;
    s = turned;
  }
  for (int k = 0; k < 3; k++) {
    out->along[0][k] = c * frame[0][k] + s * frame[1][k];
    out->along[1][k] = -s * frame[0][k] + c * frame[1][k];
  }
  memcpy(out->curvature, value, sizeof value);
}

static void fit(const abbe_point_grid *grid, const abbe_surface_samples *s, size_t i,
                abbe_surface_curvature *out) {
  around a = {.s = s, .at = &s->sample[i]};
  double m[2][2] = {{0, 0}, {0, 0}};
  abbe_point_grid_visit(grid, a.at->position, visit, &a);
  memcpy(a.frame[2], a.count >= LEAST_POINTS ? a.mean : a.at->normal, sizeof a.mean);
  if (!abbe_vector_normalise(a.frame[2])) memcpy(a.frame[2], a.at->normal, sizeof a.mean);
  complete(a.frame);
  a.fits = true;
  abbe_point_grid_visit(grid, a.at->position, visit, &a);
  if (a.count < LEAST_POINTS || !solve(&a, m)) memset(m, 0, sizeof m);
  set_principal(a.frame, m, out);
}

abbe_result abbe_surface_curvature_fit(const abbe_surface_samples *samples,
                                       abbe_surface_curvature *out, abbe_error *error) {
  if (samples->count == 0) return ABBE_OK;
  abbe_point_grid grid;
  abbe_result result =
      abbe_point_grid_make(samples->spacing, samples->candidate_count, &grid, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < samples->candidate_count; i++)
    abbe_point_grid_add(&grid, samples->candidate[i].position, i);
  for (size_t i = 0; i < samples->count; i++) fit(&grid, samples, i, &out[i]);
  abbe_point_grid_free(&grid);
  return ABBE_OK;
}
