/* Texels of places side by side: those of abbe_map_layout_texel one by one. */
#include "tests/check.h"
#include "tests/random.h"

#include "validation/trace/tracer/light_pass.h"

enum { LANES = ABBE_MAP_TEXELS_LANES, WIDTH = 37, HEIGHT = 1000 };

static void make_layout(bool parallel, abbe_map_layout *out) {
  const double origin[3] = {0.3, -2, 1}, way[3] = {0.1, 1, -0.4}, up[3] = {0, 0, 1};
  abbe_view view;
  abbe_view_look(origin, way, up, parallel, &view);
  const double window[4] = {-0.4, 0.7, -0.5, 0.25};
  for (int i = 0; i < 4; i++) view.window[i] = window[i];
  view.near = 0.1;
  view.far = 10;
  abbe_map_layout_make(&view, out);
  for (int axis = 0; axis < 2; axis++)
    for (int k = 0; k <= ABBE_MAP_LAYOUT_STEPS; k++)
      out->knot[axis][k] = pow((double)k / ABBE_MAP_LAYOUT_STEPS, axis == 0 ? 2 : 0.5);
}

static void check(const abbe_map_layout *layout, abbe_map_texels *t, size_t *held) {
  abbe_map_texels_find(layout, WIDTH, HEIGHT, t);
  for (int k = 0; k < LANES; k++) {
    const double p[3] = {t->p[0][k], t->p[1][k], t->p[2][k]};
    size_t column, row;
    const bool holds = abbe_map_layout_texel(layout, WIDTH, HEIGHT, p, &column, &row);
    const size_t own = holds ? row * WIDTH + column : ABBE_MAP_TEXELS_NONE;
    if (t->at[k] != own) fail_msg("%g, %g, %g: %zu, not %zu", p[0], p[1], p[2], t->at[k], own);
    *held += holds;
  }
}

TEST(places_at_random) {
  for (int parallel = 0; parallel < 2; parallel++) {
    abbe_map_layout layout;
    abbe_map_texels t;
    uint64_t state64 = 5;
    size_t held = 0;
    make_layout(parallel, &layout);
    for (int i = 0; i < 20000; i++) {
      for (int k = 0; k < LANES; k++)
        for (int j = 0; j < 3; j++) t.p[j][k] = random_between(&state64, -3, 3);
      check(&layout, &t, &held);
    }
    assert_true(held > 1000);
  }
}

/* The window's edges and corners, places beside and behind the light, and what is no number. */
TEST(awkward_places) {
  static const double share[] = {0, 1, 0.5, 1 - 0x1p-53, -0x1p-60, 1 + 0x1p-52, NAN, INFINITY};
  static const double depths[] = {1, 1e-300, 0, -1, 1e300, NAN};
  for (int parallel = 0; parallel < 2; parallel++) {
    abbe_map_layout layout;
    abbe_map_texels t;
    size_t held = 0;
    make_layout(parallel, &layout);
    const abbe_view *v = &layout.view;
    for (int i = 0; i < 8; i++)
      for (int j = 0; j < 8; j++) {
        for (int k = 0; k < LANES; k++) {
          const double depth = depths[k % 6], scale = parallel ? 1 : depth;
          const double x = (v->window[0] + share[i] * (v->window[1] - v->window[0])) * scale;
          const double y = (v->window[2] + share[j] * (v->window[3] - v->window[2])) * scale;
          for (int m = 0; m < 3; m++)
            t.p[m][k] = v->origin[m] + x * v->right[m] + y * v->up[m] + depth * v->forward[m];
        }
        check(&layout, &t, &held);
      }
    assert_true(held > 0);
  }
}
