#include "scenes/import/mesh/mesh_reading.h"

#include "base/maths.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

/* What it takes to try a corner, and to try an edge near it, in looks. */
#define TRY_CORNER 32
#define TRY_EDGE 32

/* ---- the turn at three points ---- */

typedef const double *point; /* two coordinates, of 1 at the most */

/* Adds value to the sum of parts that do not overlap, exactly; their number. [Shewchuk1997] */
static int grow(double *part, int count, double value) {
  int kept = 0;
  for (int i = 0; i < count; i++) {
    const double sum = value + part[i], other = sum - value;
    const double lost = (value - (sum - other)) + (part[i] - other);
    if (lost != 0) part[kept++] = lost;
    value = sum;
  }
  if (value != 0 || kept == 0) part[kept++] = value;
  return kept;
}

static int grow_product(double *part, int count, double x, double y) {
  const double product = x * y;
  return grow(part, grow(part, count, fma(x, y, -product)), product);
}

/* Twice the signed area, of which the sign is exact: a product of two numbers is the sum of two,
 * as long as it is not so small that its lower half is lost. */
static double turn(point a, point b, point c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  const double area = left - right;
  if (fabs(area) > 4 * DBL_EPSILON * (fabs(left) + fabs(right))) return area;
  const point p[4] = {a, b, c, a};
  double part[12];
  int count = 0;
  for (int i = 0; i < 3; i++) {
    count = grow_product(part, count, p[i][0], p[i + 1][1]);
    count = grow_product(part, count, -p[i][1], p[i + 1][0]);
  }
  return part[count - 1];
}

static bool same(point a, point b) {
  return a[0] == b[0] && a[1] == b[1];
}

/* ---- ears ---- */

/* The corners that are left are a ring. Of each: whether it may be concave (none becomes so), and
 * the triangle behind the edge to the next. */
typedef struct placed {
  double x, y;
  uint32_t corner;
} placed;

typedef struct cutting {
  double (*at)[2];
  uint32_t *next, *previous, *behind;
  placed *concave; /* those that may be, by their x */
  size_t concave_count, left;
  uint32_t (*triangle)[3], (*beside)[3]; /* beside[t][k]: across the edge from corner k */
  size_t triangles;
  double work; /* that is left */
} cutting;

/* The longest component of twice the area, whose axis is left out; the rest goes into at, largest
 * 1, so that the polygon runs counter-clockwise. */
static void flatten(const double (*corner)[3], size_t count, double (*at)[2]) {
  double normal[3] = {0}, part[3], most = 0;
  for (size_t i = 1; i + 1 < count; i++) {
    abbe_vector_triangle(corner[0], corner[i], corner[i + 1], part);
    for (int k = 0; k < 3; k++) normal[k] += part[k];
  }
  int axis = 0, exponent = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(normal[k]) > fabs(normal[axis])) axis = k;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double side = normal[axis] < 0 ? -1 : 1;
  for (size_t i = 0; i < count; i++)
    most = fmax(most, fmax(fabs(corner[i][u]), fabs(corner[i][v])));
  frexp(most, &exponent);
  for (size_t i = 0; i < count; i++) {
    at[i][0] = ldexp(side * corner[i][u], -exponent);
    at[i][1] = ldexp(corner[i][v], -exponent);
  }
}

static bool is_convex(const cutting *c, uint32_t i) {
  return turn(c->at[c->previous[i]], c->at[i], c->at[c->next[i]]) > 0;
}

/* Strictly between the ends. */
static bool lies_within(point a, point b, point p) {
  const int k = fabs(b[0] - a[0]) > fabs(b[1] - a[1]) ? 0 : 1;
  return turn(a, b, p) == 0 && (a[k] < p[k]) != (b[k] < p[k]) && p[k] != a[k] && p[k] != b[k];
}

static bool is_left_of(point a, point b, point p, point q) {
  return turn(a, b, p) >= 0 && turn(a, b, q) >= 0;
}

/* Whether the edge from p to q comes into the triangle's inside or onto its side from a to c. */
static bool enters(point a, point b, point c, point p, point q) {
  if (lies_within(a, c, p) || lies_within(a, c, q)) return true;
  if ((same(p, a) && same(q, c)) || (same(p, c) && same(q, a))) return true;
  if (is_left_of(b, a, p, q) || is_left_of(c, b, p, q) || is_left_of(a, c, p, q)) return false;
  return !(is_left_of(p, q, a, b) && turn(p, q, c) >= 0) &&
         !(is_left_of(q, p, a, b) && turn(q, p, c) >= 0);
}

/* The first that may be concave from x on. */
static size_t first_concave(const cutting *c, double x) {
  size_t low = 0, high = c->concave_count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (c->concave[middle].x < x)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* What comes into an ear has a corner there that is concave, or lies along its third side. */
static bool is_free(cutting *c, uint32_t i) {
  const uint32_t before = c->previous[i], after = c->next[i];
  const point a = c->at[before], b = c->at[i], d = c->at[after];
  const double right = fmax(a[0], fmax(b[0], d[0]));
  const double low = fmin(a[1], fmin(b[1], d[1])), high = fmax(a[1], fmax(b[1], d[1]));
  if (same(c->at[c->next[after]], a) || same(c->at[c->previous[before]], d)) return false;
  for (size_t n = first_concave(c, fmin(a[0], fmin(b[0], d[0])));
       n < c->concave_count && c->concave[n].x <= right; n++) {
    const uint32_t at = c->concave[n].corner;
    c->work--;
    if (c->concave[n].y < low || c->concave[n].y > high || c->next[at] == at) continue;
    c->work -= 2 * TRY_EDGE;
    for (int end = 0; end < 2; end++) {
      const uint32_t from = end == 0 ? c->previous[at] : at, to = c->next[from];
      if (from != before && from != i && enters(a, b, d, c->at[from], c->at[to])) return false;
    }
  }
  return true;
}

static void set_beside(cutting *c, uint32_t triangle, uint32_t neighbour, uint32_t from) {
  if (triangle == NONE) return;
  for (int k = 0; k < 3; k++)
    if (c->triangle[triangle][k] == from) c->beside[triangle][(k + 2) % 3] = neighbour;
}

static void clip(cutting *c, uint32_t i) {
  const uint32_t before = c->previous[i], after = c->next[i], t = (uint32_t)c->triangles++;
  memcpy(c->triangle[t], (uint32_t[3]){before, i, after}, sizeof c->triangle[t]);
  memcpy(c->beside[t], (uint32_t[3]){c->behind[i], NONE, c->behind[before]}, sizeof c->beside[t]);
  /* those behind see the edges reversed */
  set_beside(c, c->behind[before], t, i);
  set_beside(c, c->behind[i], t, after);
  c->behind[before] = t;
  c->next[before] = after;
  c->previous[after] = before;
  c->next[i] = i;
  c->left--;
}

/* Drops corners that are gone or have become convex. */
static void list_concave(cutting *c) {
  size_t kept = 0;
  for (size_t n = 0; n < c->concave_count; n++) {
    const uint32_t i = c->concave[n].corner;
    if (c->next[i] != i && !is_convex(c, i)) c->concave[kept++] = c->concave[n];
  }
  c->concave_count = kept;
}

typedef enum demand { EAR, CONVEX, ANY } demand;

static bool may_go(cutting *c, uint32_t i, demand least) {
  const point a = c->at[c->previous[i]], b = c->at[i], d = c->at[c->next[i]];
  if (same(a, b) || same(b, d) || least == ANY || (least == CONVEX && same(a, d))) return true;
  return is_convex(c, i) && (least == CONVEX || is_free(c, i));
}

/* False where it takes too long. */
static bool clip_all(cutting *c) {
  uint32_t at = c->next[0];
  size_t waited = 0, listed = c->left;
  demand least = EAR;
  for (; c->left > 3; at = c->next[at]) {
    c->work -= TRY_CORNER;
    if (c->work < 0) return false;
    if (may_go(c, at, least)) {
      /* its neighbours are next */
      const uint32_t before = c->previous[at];
      clip(c, at);
      at = c->previous[before];
      waited = 0;
      least = EAR;
      if (c->left < listed - listed / 8) {
        list_concave(c);
        listed = c->left;
      }
    } else if (++waited > c->left) {
      /* it crosses itself, or has no area */
      if (least == EAR) list_concave(c);
      least = least == EAR ? CONVEX : ANY;
      waited = 0;
    }
  }
  const uint32_t before = c->previous[at], after = c->next[at];
  clip(c, at);
  c->beside[c->triangles - 1][1] = c->behind[after];
  set_beside(c, c->behind[after], (uint32_t)c->triangles - 1, before);
  return true;
}

/* ---- the triangles of Delaunay ---- */

/* Whether the angles at a and c, opposite the edge from b to d, are more than two right ones
 * together: the sine of their sum is negative. */
static bool is_obtuse(const double *a, const double *b, const double *c, const double *d) {
  double ab[3], ad[3], cb[3], cd[3], one[3], other[3];
  abbe_vector_subtract(b, a, ab);
  abbe_vector_subtract(d, a, ad);
  abbe_vector_subtract(b, c, cb);
  abbe_vector_subtract(d, c, cd);
  abbe_vector_cross(ab, ad, one);
  abbe_vector_cross(cd, cb, other);
  const double x = abbe_vector_length(one) * abbe_vector_dot(cb, cd);
  const double y = abbe_vector_length(other) * abbe_vector_dot(ab, ad);
  return x + y < -1e-9 * (fabs(x) + fabs(y));
}

static int place_of(const uint32_t list[3], uint32_t what) {
  return list[0] == what ? 0 : list[1] == what ? 1 : 2;
}

/* Turns the edge across from corner k where that makes better triangles. */
static bool flip(cutting *c, const double (*corner)[3], uint32_t t, int k) {
  const uint32_t u = c->beside[t][k];
  if (u == NONE) return false;
  const int m = place_of(c->beside[u], t);
  const uint32_t a = c->triangle[t][k], b = c->triangle[t][(k + 1) % 3],
                 d = c->triangle[t][(k + 2) % 3], e = c->triangle[u][m];
  if (!is_obtuse(corner[a], corner[b], corner[e], corner[d])) return false;
  if (!(turn(c->at[a], c->at[b], c->at[e]) > 0 && turn(c->at[a], c->at[e], c->at[d]) > 0))
    return false;
  const uint32_t ab = c->beside[t][(k + 2) % 3], da = c->beside[t][(k + 1) % 3];
  const uint32_t be = c->beside[u][(m + 1) % 3], ed = c->beside[u][(m + 2) % 3];
  memcpy(c->triangle[t], (uint32_t[3]){a, b, e}, sizeof c->triangle[t]);
  memcpy(c->beside[t], (uint32_t[3]){be, u, ab}, sizeof c->beside[t]);
  memcpy(c->triangle[u], (uint32_t[3]){a, e, d}, sizeof c->triangle[u]);
  memcpy(c->beside[u], (uint32_t[3]){ed, da, t}, sizeof c->beside[u]);
  set_beside(c, be, t, e);
  set_beside(c, da, u, a);
  return true;
}

/* Ends, since each turn makes the least angles larger, up to rounding. */
static void flip_all(cutting *c, const double (*corner)[3]) {
  enum { ROUNDS = 64 };
  bool turned = true;
  for (int round = 0; round < ROUNDS && turned; round++) {
    turned = false;
    for (uint32_t t = 0; t < c->triangles; t++)
      for (int k = 0; k < 3; k++) turned = flip(c, corner, t, k) || turned;
  }
}

/* ---- all of it ---- */

static int by_place(const void *a, const void *b) {
  const placed *p = a, *q = b;
  return p->x != q->x ? (p->x < q->x ? -1 : 1) : (p->corner > q->corner) - (p->corner < q->corner);
}

static bool begin(cutting *c, const double (*corner)[3], size_t count) {
  c->at = malloc(count * sizeof *c->at);
  c->next = malloc(3 * count * sizeof *c->next);
  c->concave = malloc(count * sizeof *c->concave);
  c->beside = malloc(count * sizeof *c->beside);
  if (!c->at || !c->next || !c->concave || !c->beside) return false;
  c->previous = c->next + count;
  c->behind = c->previous + count;
  c->left = count;
  flatten(corner, count, c->at);
  for (size_t i = 0; i < count; i++) {
    c->next[i] = (uint32_t)((i + 1) % count);
    c->previous[i] = (uint32_t)((i + count - 1) % count);
    c->behind[i] = NONE;
    c->concave[i] = (placed){c->at[i][0], c->at[i][1], (uint32_t)i};
  }
  c->concave_count = count;
  list_concave(c);
  qsort(c->concave, c->concave_count, sizeof *c->concave, by_place);
  return true;
}

abbe_result abbe_polygon_cut(const double (*corner)[3], size_t count, uint32_t (*triangle)[3],
                             double *work, abbe_error *error) {
  cutting c = {.triangle = triangle, .work = *work};
  if (count == 3) {
    memcpy(triangle[0], (uint32_t[3]){0, 1, 2}, sizeof triangle[0]);
    return ABBE_OK;
  }
  abbe_result result = ABBE_OK;
  if (!begin(&c, corner, count))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a polygon of %zu corners", count);
  else if (!clip_all(&c))
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "with it, of %zu corners, the polygons take too long to be cut into "
                            "triangles: too many corners are concave or in line; divide them where "
                            "the mesh was made",
                            count);
  else if (count > 4)
    flip_all(&c, corner);
  *work = c.work;
  free(c.at);
  free(c.next);
  free(c.concave);
  free(c.beside);
  return result;
}
