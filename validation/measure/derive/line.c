#include "validation/measure/derive/line.h"

#include <math.h>
#include <string.h>

/* Of a line: within so much a jump is found, and from so far its slopes are taken. */
#define CLOSE 1e-9
#define NEAR 1e-7
/* Looks between points for each point: of more jumps those are followed at all that are bright, and
 * others as often as they are bright. */
#define LOOKS 0.5
/* Of the light: below that paths end, and a tree's `faint` is that of its own. */
#define FAINT 1e-4

/* The trees of a line to work on: two of points, then of what is looked at between them. */
enum { MOVED = 2, AT = 2, BACK = 3, OTHER = 4, SPANS = 5 };

/* Between two places, whose trees it has. */
typedef struct span {
  double low, high;
  abbe_specular_tree *below, *above;
  double chance; /* that it is looked at */
  size_t depth;
} span;

static void look(const abbe_line *l, size_t scene, double t, const abbe_specular_tree *known,
                 abbe_specular_tree *out) {
  double at[2] = {l->at[0], l->at[1]};
  at[l->axis] = t;
  l->look(l, scene, at, known, out);
}

static const abbe_specular *scene_of(const abbe_line *l, size_t scene) {
  return scene == 0 ? l->base : l->moved[scene - 1];
}

/* ---- between jumps ---- */

/* But for rounding, which a key's step is far above. */
static bool is_same(const abbe_line *l, const abbe_specular_tree *a, const abbe_specular_tree *b) {
  for (int c = 0; c < 3; c++)
    if (fabs(a->shown[c] - b->shown[c]) > 1e-12 * fabs(a->shown[c])) return false;
  if (l->film) return true;
  for (size_t i = 0; i < a->count; i++) {
    const abbe_specular_hit *of = &a->hit[i], *to = &b->hit[i];
    if (fabs(of->flux - to->flux) > 1e-12 * of->flux) return false;
    for (int k = 0; k < 3; k++)
      if (fabs(of->p[k] - to->p[k]) > 1e-12 * l->base->far ||
          fabs(of->film[k] - to->film[k]) > 1e-11 * fabs(of->film[k]))
        return false;
  }
  return true;
}

/* The same paths in a moved scene; false where they are no more. */
static bool follow_moved(const abbe_line *l, size_t scene, double t, const abbe_specular_tree *base,
                         abbe_specular_tree *out) {
  look(l, scene, t, base->whole ? base : NULL, out);
  return base->whole ? !out->failed && out->count == base->count
                     : out->signature == base->signature;
}

static void change_smoothly(const abbe_line *l, double t, const abbe_specular_tree *base) {
  abbe_specular_tree *moved = &l->tree[MOVED];
  for (size_t k = 0; k < l->keys; k++) {
    double by = 1 / (l->step[k] * (double)l->points);
    bool found = follow_moved(l, 2 + 2 * k, t, base, moved);
    if (!found) {
      found = follow_moved(l, 1 + 2 * k, t, base, moved);
      by = -by;
    }
    if (!found || is_same(l, base, moved)) continue;
    l->to->felt[k] = true;
    l->deposit(l, 1 + k, moved, by);
    l->deposit(l, 1 + k, base, -by);
  }
}

/* ---- jumps ---- */

/* An edge's function in a scene, on paths over the surfaces of known. */
static double value_at(const abbe_line *l, size_t scene, const double at[2], const abbe_edge *e,
                       abbe_specular_tree *known) {
  abbe_specular_tree *tree = &l->tree[AT];
  known->until = e->shadow ? SIZE_MAX : e->index;
  l->look(l, scene, at, known, tree);
  known->until = SIZE_MAX;
  return abbe_edge_value(scene_of(l, scene), e, tree);
}

static double value_on(const abbe_line *l, double t, const abbe_edge *e,
                       abbe_specular_tree *known) {
  double at[2] = {l->at[0], l->at[1]};
  at[l->axis] = t;
  return value_at(l, 0, at, e, known);
}

/* Where it is 0 between two places, by false position [DowellJarratt1971]; NAN: nowhere. */
static double find_zero(const abbe_line *l, double low, double high, const abbe_edge *e,
                        abbe_specular_tree *known) {
  double a = value_on(l, low, e, known), b = value_on(l, high, e, known);
  int side = 0;
  if (!(a * b < 0)) return NAN;
  for (int i = 0; i < 40 && high - low > 0.1 * CLOSE; i++) {
    double t = low + (high - low) * a / (a - b);
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    const double c = value_on(l, t, e, known);
    if (!isfinite(c)) return NAN;
    if (fabs(c) < 1e-15 * l->base->far) return t;
    if (c * a > 0) {
      low = t;
      a = c;
      if (side == -1) b *= 0.5;
      side = -1;
    } else {
      high = t;
      b = c;
      if (side == 1) a *= 0.5;
      side = 1;
    }
  }
  return low + (high - low) * 0.5;
}

/* Whether what `known` has met is met at that place, and nothing else. */
static bool meets_same(const abbe_line *l, double t, abbe_specular_tree *known,
                       abbe_specular_tree *out) {
  known->checks = true;
  look(l, 0, t, known, out);
  known->checks = false;
  return !out->failed && out->steps == known->steps && out->shadows == known->shadows;
}

/* Whether nothing jumps on paths of which some are too faint at one end: they are followed all the
 * same from the end where they are not. Else the edge is on the paths of *known. */
static bool is_smooth(const abbe_line *l, const span *j, abbe_edge *e, abbe_specular_tree **known) {
  abbe_specular_tree *ends[2] = {j->below, j->above};
  for (int i = 0; i < 2; i++) {
    abbe_specular_tree *other = &l->tree[i == 0 ? BACK : OTHER];
    if (meets_same(l, i == 0 ? j->high : j->low, ends[i], other)) continue;
    *e = abbe_edge_between(l->base, ends[i], other);
    *known = ends[i];
    return false;
  }
  return true;
}

static uint64_t bits_of(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/* By the span's place alone, from 0 to 1. */
static double draw(const abbe_line *l, const span *j) {
  uint64_t x = 0;
  const uint64_t what[] = {bits_of(j->low), bits_of(j->high), bits_of(l->at[1 - l->axis])};
  for (int i = 0; i < 3; i++) {
    x = (x ^ what[i]) * 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 32)) * 0xd6e8feb86659fd93u;
    x ^= x >> 29;
  }
  return (double)(x >> 11) * 0x1p-53;
}

/* How often a span is followed whose paths differ so: by the light that they have, and by what is
 * seen to change. */
static double chance_of(const abbe_line *l, const span *j, const abbe_edge *e) {
  const double bright = l->to->bright;
  double share = e->flux * FAINT / (bright * fmax(j->below->faint, j->above->faint));
  if (!(share < 1)) return j->chance;
  if (l->film) {
    const double change = l->only_in(l, j->below, j->above) + l->only_in(l, j->above, j->below);
    share = fmax(share, change * l->to->places / (bright * l->to->shown));
  }
  return share < j->chance ? share : j->chance;
}

static void change_by_jump(const abbe_line *l, const span *j, const abbe_edge *e);

static void find_jumps(const abbe_line *l, const span *all) {
  span j = *all;
  if (j.below->signature == j.above->signature) return;
  abbe_specular_tree *known = j.below;
  abbe_edge e = abbe_edge_between(l->base, j.below, j.above);
  j.chance = chance_of(l, &j, &e);
  if (!(draw(l, &j) * all->chance < j.chance)) return;
  if (j.high - j.low < CLOSE) {
    change_by_jump(l, &j, &e);
    return;
  }
  if ((e.kind == ABBE_EDGE_FAINT && is_smooth(l, &j, &e, &known)) || j.depth == ABBE_LINE_DEPTH)
    return;
  const double t = e.kind == ABBE_EDGE_NONE || e.kind == ABBE_EDGE_FAINT
                       ? NAN
                       : find_zero(l, j.low, j.high, &e, known);
  const bool found = isfinite(t);
  const double cut[4] = {j.low, found ? fmax(j.low, t - 0.25 * CLOSE) : 0.5 * (j.low + j.high),
                         fmin(j.high, t + 0.25 * CLOSE), j.high};
  abbe_specular_tree *tree[4] = {j.below, &l->tree[SPANS + 2 * j.depth],
                                 &l->tree[SPANS + 2 * j.depth + 1], j.above};
  look(l, 0, cut[1], NULL, tree[1]);
  if (found) look(l, 0, cut[2], NULL, tree[2]);
  l->to->looks += found ? 2 : 1;
  for (int i = 0; i < 3; i++) {
    if (!found && i == 1) continue;
    const int from = !found && i == 2 ? 1 : i;
    find_jumps(l, &(span){cut[from], cut[i + 1], tree[from], tree[i + 1], j.chance, j.depth + 1});
  }
}

/* Half the difference of a function over twice NEAR, along an axis. */
static double slope_along(const abbe_line *l, int axis, double t, const abbe_edge *e,
                          abbe_specular_tree *known) {
  double value[2];
  for (int i = 0; i < 2; i++) {
    double at[2] = {l->at[0], l->at[1]};
    at[l->axis] = t;
    at[axis] += i == 0 ? -NEAR : NEAR;
    value[i] = value_at(l, 0, at, e, known);
  }
  return (value[1] - value[0]) / (2 * NEAR);
}

/* Lines along both axes cross an edge, and each sees a share of its change: by the square of the
 * edge's normal along it, so that no line counts that an edge nearly lies along. */
static void change_by_jump(const abbe_line *l, const span *j, const abbe_edge *e) {
  abbe_specular_tree *below = j->below, *above = j->above;
  double at[2] = {l->at[0], l->at[1]};
  at[l->axis] = 0.5 * (j->low + j->high);
  if (e->kind == ABBE_EDGE_FAINT || (below->count == 0 && above->count == 0)) return;
  const double size =
      l->weight * (l->only_in(l, below, above) + l->only_in(l, above, below)) / j->chance;
  double slope[2] = {NAN, NAN}, here = NAN, square = NAN;
  if (e->kind != ABBE_EDGE_NONE) {
    for (int axis = 0; axis < 2; axis++) slope[axis] = slope_along(l, axis, at[l->axis], e, below);
    here = value_at(l, 0, at, e, below);
    square = slope[0] * slope[0] + slope[1] * slope[1];
  }
  l->to->jumps += size;
  /* An edge's function is 0 where light jumps at it; where it is not, something else jumps. */
  if (!(square > 0) || !(fabs(here) < 10 * CLOSE * sqrt(square) + 1e-13 * l->base->far)) {
    l->to->lost += size;
    return;
  }
  for (size_t k = 0; k < l->keys; k++) {
    double by = value_at(l, 2 + 2 * k, at, e, below) - here;
    if (!isfinite(by)) by = here - value_at(l, 1 + 2 * k, at, e, below);
    if (!isfinite(by)) l->to->lost += size / (double)l->keys;
    if (!(fabs(by) > 1e-12 * sqrt(square))) continue;
    const double speed = -2 * by * slope[l->axis] / (square * l->step[k] * j->chance);
    l->to->felt[k] = true;
    l->deposit(l, 1 + k, below, speed);
    l->deposit(l, 1 + k, above, -speed);
  }
}

void abbe_line_run(const abbe_line *l, double first) {
  span j = {.below = &l->tree[0], .above = &l->tree[1], .chance = 1};
  abbe_line_sums *to = l->to;
  to->bright =
      to->looks > LOOKS * to->places ? fmin(fmax(1.5 * to->bright, 1e-3), 1) : to->bright / 1.5;
  look(l, 0, 0, NULL, j.below);
  for (size_t i = 0; i <= l->points; i++) {
    const bool last = i == l->points;
    j.high = last ? 1 : ((double)i + first) / (double)l->points;
    look(l, 0, j.high, NULL, j.above);
    if (l->keys > 0) find_jumps(l, &j);
    abbe_specular_tree *tree = j.above;
    j.above = j.below;
    j.below = tree;
    j.low = j.high;
    if (last) continue;
    l->deposit(l, 0, tree, 1 / (double)l->points);
    to->left += l->weight * tree->left / (double)l->points;
    for (int c = 0; c < 3; c++) to->shown += fabs(tree->shown[c]);
    to->places++;
    for (size_t k = 0; k < tree->count; k++)
      if (tree->hit[k].root == 0) to->light += l->weight * tree->hit[k].flux / (double)l->points;
    if (tree->count > 0) change_smoothly(l, j.high, tree);
  }
}
