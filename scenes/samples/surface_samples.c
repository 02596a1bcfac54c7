#include "scenes/samples/surface_samples.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Finaliser of splitmix64 [Steele2014]. */
static uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

static uint64_t hash_of(const int64_t cell[3]) {
  return mix((uint64_t)cell[0] ^ mix((uint64_t)cell[1] ^ mix((uint64_t)cell[2])));
}

static void cell_of(const abbe_point_grid *grid, const double at[3], int64_t cell[3]) {
  for (int k = 0; k < 3; k++)
    cell[k] = (int64_t)fmin(fmax(floor(at[k] / grid->cell), -0x1p60), 0x1p60);
}

abbe_result abbe_point_grid_make(double cell, size_t room, abbe_point_grid *out,
                                 abbe_error *error) {
  *out = (abbe_point_grid){0};
  if (!(cell > 0) || !isfinite(cell) || room >= UINT32_MAX)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a grid of cells of %g m for %zu points; cells are above 0 m wide", cell,
                          room);
  size_t size = 16;
  while (size < room) size *= 2;
  out->cell = cell;
  out->mask = size - 1;
  out->room = room;
  out->head = malloc(size * sizeof *out->head);
  out->next = malloc((room + 1) * sizeof *out->next);
  out->key = malloc((room + 1) * sizeof *out->key);
  if (out->head == NULL || out->next == NULL || out->key == NULL) {
    abbe_point_grid_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a grid of %zu points", room);
  }
  memset(out->head, 0xff, size * sizeof *out->head);
  return ABBE_OK;
}

void abbe_point_grid_free(abbe_point_grid *grid) {
  if (grid == NULL) return;
  free(grid->head);
  free(grid->next);
  free(grid->key);
  *grid = (abbe_point_grid){0};
}

void abbe_point_grid_add(abbe_point_grid *grid, const double at[3], size_t number) {
  int64_t cell[3];
  cell_of(grid, at, cell);
  const uint64_t hash = hash_of(cell);
  const size_t chain = hash & grid->mask;
  grid->key[number] = (uint32_t)(hash >> 32);
  grid->next[number] = grid->head[chain];
  grid->head[chain] = (uint32_t)number;
}

void abbe_point_grid_visit(const abbe_point_grid *grid, const double at[3], abbe_point_visit visit,
                           void *user) {
  /* Its own cell first, then those beside it, where most points that are near are. */
  static const int8_t order[27] = {13, 4,  10, 12, 14, 16, 22, 1, 3, 5,  7,  9,  11, 15,
                                   17, 19, 21, 23, 25, 0,  2,  6, 8, 18, 20, 24, 26};
  int64_t middle[3];
  cell_of(grid, at, middle);
  for (int k = 0; k < 27; k++) {
    const int i = order[k];
    const int64_t cell[3] = {middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1,
                             middle[2] + i / 9 - 1};
    const uint64_t hash = hash_of(cell);
    for (uint32_t n = grid->head[hash & grid->mask]; n != UINT32_MAX; n = grid->next[n])
      if (grid->key[n] == (uint32_t)(hash >> 32) && !visit(user, n)) return;
  }
}

/* For each sample that is asked for; in all at least, and at the most. */
enum { CANDIDATES = 48, LEAST_CANDIDATES = 4096, MOST_CANDIDATES = 1 << 18, HALVINGS = 24 };

/* ---- candidates ---- */

/* SplitMix64 [Steele2014] by number: number k of a seed, in [0, 1). */
static double random_of(uint64_t seed, uint64_t k) {
  uint64_t z = (seed + 1) * 0xd1342543de82ef95u + k * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* Area of all faces up to and with each, of all meshes numbered through. */
static double sum_areas(const abbe_mesh *const *mesh, size_t mesh_count, double *sum) {
  double area = 0;
  size_t face = 0;
  for (size_t m = 0; m < mesh_count; m++)
    for (size_t i = 0; i < mesh[m]->face_count; i++) {
      const uint32_t *f = mesh[m]->face[i];
      double across[3];
      abbe_vector_triangle(mesh[m]->position[f[0]], mesh[m]->position[f[1]],
                           mesh[m]->position[f[2]], across);
      area += 0.5 * abbe_vector_length(across);
      sum[face++] = area;
    }
  return area;
}

/* The first face whose sum is above. */
static size_t find_face(const double *sum, size_t count, double at) {
  size_t low = 0, high = count - 1;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (sum[middle] > at)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

static void set_point(const abbe_mesh *const *mesh, size_t face, const double u[2],
                      abbe_surface_point *out) {
  size_t m = 0;
  for (; face >= mesh[m]->face_count; m++) face -= mesh[m]->face_count;
  const uint32_t *f = mesh[m]->face[face];
  const double root = sqrt(u[0]), weight[3] = {1 - root, root * (1 - u[1]), root * u[1]};
  *out = (abbe_surface_point){.mesh = (uint32_t)m};
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) {
      out->position[k] += weight[c] * mesh[m]->position[f[c]][k];
      out->normal[k] += weight[c] * mesh[m]->normal[f[c]][k];
    }
  if (abbe_vector_normalise(out->normal)) return;
  abbe_vector_triangle(mesh[m]->position[f[0]], mesh[m]->position[f[1]], mesh[m]->position[f[2]],
                       out->normal);
  abbe_vector_normalise(out->normal);
}

/* Which face candidate i lies on, and where on it, in [0, 1): by three random numbers; or evenly,
 * by two of a recurrence of the powers of the root of x^3 = x + 1 [Roberts2018] from a place that
 * the seed chooses: what the first leaves within its face is the place along it. */
static size_t draw(const abbe_surface_sampling *sampling, const double *sum, size_t faces, size_t i,
                   double u[2]) {
  static const double step[2] = {0.75487766624669276, 0.56984029099805327};
  const double area = sum[faces - 1];
  if (!sampling->even) {
    for (uint64_t k = 0; k < 2; k++) u[k] = random_of(sampling->seed, 3 * i + 1 + k);
    return find_face(sum, faces, area * random_of(sampling->seed, 3 * i));
  }
  for (uint64_t k = 0; k < 2; k++) {
    u[k] = random_of(sampling->seed, k) + (double)(i + 1) * step[k];
    u[k] -= floor(u[k]);
  }
  const double at = area * u[0];
  const size_t face = find_face(sum, faces, at);
  const double before = face > 0 ? sum[face - 1] : 0, own = sum[face] - before;
  u[0] = own > 0 ? fmin(fmax((at - before) / own, 0), 1) : 0;
  return face;
}

static abbe_result draw_candidates(const abbe_mesh *const *mesh, size_t mesh_count,
                                   const abbe_surface_sampling *sampling, abbe_surface_samples *s,
                                   abbe_error *error) {
  size_t faces = 0;
  for (size_t m = 0; m < mesh_count; m++) faces += mesh[m]->face_count;
  double *sum = malloc((faces + 1) * sizeof *sum);
  if (sum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu faces", faces);
  s->area = sum_areas(mesh, mesh_count, sum);
  const bool any = s->area > 0 && isfinite(s->area);
  for (size_t i = 0; any && i < s->candidate_count; i++) {
    double u[2];
    const size_t face = draw(sampling, sum, faces, i, u);
    set_point(mesh, face, u, &s->candidate[i]);
  }
  free(sum);
  return any ? ABBE_OK
             : abbe_error_set(error, ABBE_GEOMETRY,
                              "the surfaces to be sampled have an area of %g m2", s->area);
}

static bool face_alike(const abbe_surface_point *a, const abbe_surface_point *b, bool sided) {
  return !sided || abbe_vector_dot(a->normal, b->normal) > 0;
}

/* ---- neighbour ---- */

typedef struct cover {
  const abbe_surface_samples *s;
  const abbe_surface_point *at;
  double radius;
  bool sided, covered;
} cover;

static bool look_for_cover(void *user, size_t number) {
  cover *c = user;
  const abbe_surface_point *kept = &c->s->candidate[number];
  double apart[3];
  abbe_vector_subtract(kept->position, c->at->position, apart);
  c->covered = abbe_vector_length(apart) < c->radius && face_alike(kept, c->at, c->sided);
  return !c->covered;
}

/* Numbers of those that are kept, into `kept`; more than `most` are given up. SIZE_MAX: no memory.
 */
static size_t remove_neighbours(const abbe_surface_samples *s, double radius, bool sided,
                                size_t most, uint32_t *kept) {
  abbe_point_grid grid;
  size_t count = 0;
  if (abbe_point_grid_make(radius, s->candidate_count, &grid, NULL) != ABBE_OK) return SIZE_MAX;
  for (size_t i = 0; i < s->candidate_count && count <= most; i++) {
    cover c = {s, &s->candidate[i], radius, sided, false};
    abbe_point_grid_visit(&grid, c.at->position, look_for_cover, &c);
    if (c.covered) continue;
    abbe_point_grid_add(&grid, c.at->position, i);
    if (count < most) kept[count] = (uint32_t)i;
    count++;
  }
  abbe_point_grid_free(&grid);
  return count;
}

/* ---- which are kept ---- */

/* The smallest reach that keeps no more than are asked for. */
static size_t keep_by_reach(abbe_surface_samples *s, const abbe_surface_sampling *sampling,
                            size_t most, uint32_t *kept) {
  double low = 0, high = 2 * sqrt(s->area / (double)most);
  size_t count = remove_neighbours(s, high, sampling->sided, most, kept);
  for (int i = 0; i < 64 && count > most && count != SIZE_MAX; i++) {
    low = high;
    high *= 2;
    count = remove_neighbours(s, high, sampling->sided, most, kept);
  }
  for (int i = 0; i < HALVINGS && count != SIZE_MAX; i++) {
    const double middle = 0.5 * (low + high);
    const size_t there = remove_neighbours(s, middle, sampling->sided, most, kept);
    if (there == SIZE_MAX) return there;
    if (there > most)
      low = middle;
    else
      high = middle;
    if (there == most) break;
  }
  s->reach = high;
  return count == SIZE_MAX ? count : remove_neighbours(s, high, sampling->sided, most, kept);
}

static abbe_result keep(abbe_surface_samples *s, const abbe_surface_sampling *sampling, size_t most,
                        abbe_error *error) {
  uint32_t *kept = malloc(most * sizeof *kept);
  size_t count = kept != NULL ? keep_by_reach(s, sampling, most, kept) : SIZE_MAX;
  if (count == SIZE_MAX) {
    free(kept);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu samples of surfaces", most);
  }
  /* the sides of a body are at least two, however far neighbours reach */
  if (count > most) count = most;
  s->count = count;
  for (size_t i = 0; i < count; i++) s->sample[i] = s->candidate[kept[i]];
  free(kept);
  s->spacing = sqrt(s->area / (double)count);
  return ABBE_OK;
}

/* ---- shares ---- */

typedef struct search {
  const abbe_surface_samples *s;
  const abbe_surface_point *at;
  double least;
  size_t found;
} search;

/* Looks for the nearest samples that face as the candidate does, if there are any near. */
static bool look_for_nearest(void *user, size_t number) {
  search *w = user;
  const abbe_surface_point *sample = &w->s->sample[number];
  double apart[3];
  abbe_vector_subtract(sample->position, w->at->position, apart);
  const double far = abbe_vector_length(apart) + (face_alike(sample, w->at, true) ? 0 : 1e30);
  if (far >= w->least) return true;
  w->least = far;
  w->found = number;
  return true;
}

static abbe_result share_out(abbe_surface_samples *s, abbe_error *error) {
  abbe_point_grid grid;
  const double cell = 2 * fmax(s->spacing, s->reach);
  ABBE_TRY(abbe_point_grid_make(cell, s->count, &grid, error));
  for (size_t i = 0; i < s->count; i++) abbe_point_grid_add(&grid, s->sample[i].position, i);
  for (size_t i = 0; i < s->candidate_count; i++) {
    search w = {s, &s->candidate[i], INFINITY, 0};
    abbe_point_grid_visit(&grid, w.at->position, look_for_nearest, &w);
    for (size_t k = 0; w.least > cell && k < s->count; k++) look_for_nearest(&w, k);
    s->owner[i] = (uint32_t)w.found;
    s->share[w.found] += s->area / (double)s->candidate_count;
  }
  abbe_point_grid_free(&grid);
  return ABBE_OK;
}

abbe_result abbe_surface_samples_make(const abbe_mesh *const *mesh, size_t mesh_count,
                                      const abbe_surface_sampling *sampling,
                                      abbe_surface_samples *out, abbe_error *error) {
  *out = (abbe_surface_samples){0};
  const size_t most = sampling->count > 0 ? sampling->count : 1;
  if (most > ABBE_SURFACE_MAX_SAMPLES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu samples of surfaces; there may be 1 to %d", most,
                          ABBE_SURFACE_MAX_SAMPLES);
  size_t count = CANDIDATES * most;
  if (count < LEAST_CANDIDATES) count = LEAST_CANDIDATES;
  if (count > MOST_CANDIDATES) count = MOST_CANDIDATES;
  out->candidate_count = count;
  out->candidate = calloc(count, sizeof *out->candidate);
  out->owner = calloc(count, sizeof *out->owner);
  out->sample = calloc(most, sizeof *out->sample);
  out->share = calloc(most, sizeof *out->share);
  abbe_result result =
      out->candidate == NULL || out->owner == NULL || out->sample == NULL || out->share == NULL
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu samples of surfaces", most)
          : draw_candidates(mesh, mesh_count, sampling, out, error);
  if (result == ABBE_OK) result = keep(out, sampling, most, error);
  if (result == ABBE_OK) result = share_out(out, error);
  if (result != ABBE_OK) abbe_surface_samples_free(out);
  return result;
}

void abbe_surface_samples_free(abbe_surface_samples *samples) {
  if (samples == NULL) return;
  free(samples->sample);
  free(samples->share);
  free(samples->candidate);
  free(samples->owner);
  *samples = (abbe_surface_samples){0};
}

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
  ABBE_TRY(abbe_point_grid_make(samples->spacing, samples->candidate_count, &grid, error));
  for (size_t i = 0; i < samples->candidate_count; i++)
    abbe_point_grid_add(&grid, samples->candidate[i].position, i);
  for (size_t i = 0; i < samples->count; i++) fit(&grid, samples, i, &out[i]);
  abbe_point_grid_free(&grid);
  return ABBE_OK;
}
