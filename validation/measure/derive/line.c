#include "validation/measure/derive/line.h"

#include <math.h>
#include <string.h>

enum { MOST_JUMPS = 64 };
/* Of a line: within so much a jump is found, and from so far its slopes are taken. */
#define CLOSE 1e-9
#define NEAR 1e-7

typedef struct jump {
  double low, high;
  uint64_t below, above; /* signatures */
} jump;

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
  abbe_specular_tree *moved = &l->tree[1];
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
  abbe_specular_tree *tree = &l->tree[3];
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

/* Whether nothing jumps between both ends of a span but what is too faint. Leaves the tree of the
 * first end, and of the other what has met the same up to where it meets something else. Paths that
 * are too faint at the first end alone are followed from the other one. */
static bool is_smooth(const abbe_line *l, double low, double high) {
  abbe_specular_tree *below = &l->tree[1], *above = &l->tree[2], *back = &l->tree[3];
  look(l, 0, low, NULL, below);
  if (!below->whole) {
    look(l, 0, high, NULL, above);
    return false;
  }
  if (!meets_same(l, high, below, above)) return false;
  look(l, 0, high, NULL, back);
  return back->whole && meets_same(l, low, back, &l->tree[4]);
}

/* Where the jump of a span that is not smooth is likely to be; else NAN. */
static double guess(const abbe_line *l, const jump *j) {
  const abbe_edge e = abbe_edge_between(l->base, &l->tree[1], &l->tree[2]);
  return e.kind == ABBE_EDGE_NONE ? NAN : find_zero(l, j->low, j->high, &e, &l->tree[1]);
}

static uint64_t signature_at(const abbe_line *l, double t) {
  look(l, 0, t, NULL, &l->tree[3]);
  return l->tree[3].signature;
}

/* All places between two points where what paths meet changes, in any order. */
static size_t find_jumps(const abbe_line *l, const jump *first, jump *out) {
  jump stack[MOST_JUMPS] = {*first};
  size_t waiting = 1, found = 0;
  while (waiting > 0 && found < MOST_JUMPS) {
    const jump j = stack[--waiting];
    if (j.below == j.above || is_smooth(l, j.low, j.high)) continue;
    if (j.high - j.low < CLOSE) {
      out[found++] = j;
      continue;
    }
    if (waiting + 3 > MOST_JUMPS) return found;
    const double t = guess(l, &j);
    const double cut[4] = {j.low, fmax(j.low, t - 0.25 * CLOSE), fmin(j.high, t + 0.25 * CLOSE),
                           j.high};
    if (isfinite(t)) {
      const uint64_t sign[4] = {j.below, signature_at(l, cut[1]), signature_at(l, cut[2]), j.above};
      for (int i = 0; i < 3; i++)
        stack[waiting++] = (jump){cut[i], cut[i + 1], sign[i], sign[i + 1]};
    } else {
      const double middle = 0.5 * (j.low + j.high);
      const uint64_t sign = signature_at(l, middle);
      stack[waiting++] = (jump){j.low, middle, j.below, sign};
      stack[waiting++] = (jump){middle, j.high, sign, j.above};
    }
  }
  return found;
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
static void change_by_jump(const abbe_line *l, const jump *j) {
  abbe_specular_tree *below = &l->tree[1], *above = &l->tree[2];
  const double t = 0.5 * (j->low + j->high);
  double at[2] = {l->at[0], l->at[1]};
  at[l->axis] = t;
  is_smooth(l, j->low, j->high);
  const abbe_edge e = abbe_edge_between(l->base, below, above);
  look(l, 0, j->high, NULL, above);
  if (e.kind == ABBE_EDGE_FAINT || (below->count == 0 && above->count == 0)) return;
  const double size = l->weight * (l->only_in(l, below, above) + l->only_in(l, above, below));
  double slope[2] = {NAN, NAN}, here = NAN, square = NAN;
  if (e.kind != ABBE_EDGE_NONE) {
    for (int axis = 0; axis < 2; axis++) slope[axis] = slope_along(l, axis, t, &e, below);
    here = value_at(l, 0, at, &e, below);
    square = slope[0] * slope[0] + slope[1] * slope[1];
  }
  l->to->jumps += size;
  if (!(square > 0)) {
    l->to->lost += size;
    return;
  }
  for (size_t k = 0; k < l->keys; k++) {
    double by = value_at(l, 2 + 2 * k, at, &e, below) - here;
    if (!isfinite(by)) by = here - value_at(l, 1 + 2 * k, at, &e, below);
    if (!isfinite(by)) l->to->lost += size / (double)l->keys;
    if (!(fabs(by) > 1e-12 * sqrt(square))) continue;
    const double speed = -2 * by * slope[l->axis] / (square * l->step[k]);
    l->to->felt[k] = true;
    l->deposit(l, 1 + k, below, speed);
    l->deposit(l, 1 + k, above, -speed);
  }
}

static void change_between(const abbe_line *l, const jump *span) {
  jump here[MOST_JUMPS];
  if (l->keys == 0 || span->below == span->above) return;
  const size_t count = find_jumps(l, span, here);
  for (size_t i = 0; i < count; i++) change_by_jump(l, &here[i]);
}

void abbe_line_run(const abbe_line *l, double first) {
  abbe_specular_tree *tree = &l->tree[0];
  look(l, 0, 0, NULL, tree);
  jump span = {.below = tree->signature};
  for (size_t i = 0; i <= l->points; i++) {
    const bool last = i == l->points;
    span.high = last ? 1 : ((double)i + first) / (double)l->points;
    look(l, 0, span.high, NULL, tree);
    span.above = tree->signature;
    change_between(l, &span);
    span.low = span.high;
    span.below = span.above;
    if (last) continue;
    l->deposit(l, 0, tree, 1 / (double)l->points);
    l->to->left += l->weight * tree->left / (double)l->points;
    for (size_t k = 0; k < tree->count; k++)
      if (tree->hit[k].root == 0) l->to->light += l->weight * tree->hit[k].flux / (double)l->points;
    if (tree->count > 0) change_smoothly(l, span.high, tree);
  }
}
