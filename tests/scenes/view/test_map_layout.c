/* Map layouts: places to texels and back, areas that add up, attributes that give back every bit.
 */
#include "tests/check.h"

#include "scenes/geometry/transform.h"
#include "scenes/view/map_layout.h"

#include <locale.h>

static const double tolerance = 1e-12;

/* A slanted view, its axes warped by known smooth curves: x squared-ish, y the other way. */
static abbe_map_layout slanted(bool orthographic) {
  static const double origin[3] = {1, 2, 3}, forward[3] = {0.3, -0.5, -0.8}, up[3] = {0.1, 0.2, 1};
  static const double window[4] = {-0.7, 0.4, -0.2, 0.9};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(origin, forward, up, orthographic, &view);
  memcpy(view.window, window, sizeof window);
  view.near = 0.5;
  view.far = 9;
  abbe_map_layout_make(&view, &layout);
  for (int k = 0; k <= ABBE_MAP_LAYOUT_STEPS; k++) {
    double s = (double)k / ABBE_MAP_LAYOUT_STEPS;
    layout.knot[0][k] = 0.3 * s + 0.7 * s * s;
    layout.knot[1][k] = 1.5 * s - 0.5 * s * s;
  }
  layout.knot[0][ABBE_MAP_LAYOUT_STEPS] = layout.knot[1][ABBE_MAP_LAYOUT_STEPS] = 1;
  return layout;
}

TEST(warp_and_unwarp_are_inverse) {
  abbe_map_layout layout = slanted(false);
  for (int i = 0; i <= 1000; i++)
    for (int axis = 0; axis < 2; axis++) {
      double window = i / 1000.0, texture = abbe_map_layout_warp(&layout, axis, window);
      assert_near(abbe_map_layout_unwarp(&layout, axis, texture), window, tolerance);
      /* Linear interpolation of a parabola misses it by h^2 / 8 times its curvature, at most. */
      double s = window, curve = axis == 0 ? 0.3 * s + 0.7 * s * s : 1.5 * s - 0.5 * s * s;
      assert_near(texture, curve, 1.4 / 8 / (128.0 * 128.0) + tolerance);
    }
  assert_near(abbe_map_layout_warp(&layout, 0, 2), 1, 0);
  assert_near(abbe_map_layout_warp(&layout, 0, -1), 0, 0);
  assert_near(abbe_map_layout_unwarp(&layout, 1, 2), 1, 0);
  assert_near(abbe_map_layout_unwarp(&layout, 1, -1), 0, 0);
}

/* Window coordinates by the matrix, then by hand through the knots: the same as the projection. */
TEST(a_place_projects_as_the_matrix_and_the_knots_say) {
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_map_layout layout = slanted(orthographic);
    double matrix[16], clip[3], uv[2];
    abbe_view_matrix(&layout.view, matrix);
    int held = 0;
    for (int i = 0; i < 8 * 8 * 8; i++) {
      double p[3] = {0.4 + 0.4 * (i % 8), -0.8 + 0.5 * (i / 8 % 8), -2.5 + 0.6 * (i / 64)};
      abbe_transform_point(matrix, p, clip);
      bool in = fabs(clip[0]) <= 1 && fabs(clip[1]) <= 1;
      assert_int_equal(abbe_map_layout_project(&layout, p, uv), in);
      if (!in) continue;
      held++;
      for (int axis = 0; axis < 2; axis++) {
        double s = (clip[axis] + 1) / 2 * ABBE_MAP_LAYOUT_STEPS;
        int k = (int)s;
        const double *knot = layout.knot[axis];
        assert_near(uv[axis], knot[k] + (s - k) * (knot[k + 1] - knot[k]), 1e-9);
      }
    }
    assert_true(held > 10);
  }
}

TEST(rays_land_where_they_came_from) {
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_map_layout layout = slanted(orthographic);
    for (int i = 0; i < 81; i++) {
      double uv[2] = {(i % 9 + 0.5) / 9, (i / 9 + 0.5) / 9}, back[2], o[3], d[3], p[3];
      abbe_map_layout_ray(&layout, uv, o, d);
      for (int k = 0; k < 3; k++) p[k] = o[k] + 1.7 * d[k];
      assert_true(abbe_map_layout_project(&layout, p, back));
      assert_near(back[0], uv[0], tolerance);
      assert_near(back[1], uv[1], tolerance);
      size_t column = 99, row = 99;
      assert_true(abbe_map_layout_texel(&layout, 9, 9, p, &column, &row));
      assert_int_equal(column, i % 9);
      assert_int_equal(row, 8 - i / 9); /* rows count from the top */
    }
  }
}

TEST(what_the_map_does_not_hold) {
  abbe_map_layout layout = slanted(false);
  const abbe_view *v = &layout.view;
  double p[3], uv[2] = {7, 7};
  for (int k = 0; k < 3; k++) p[k] = v->origin[k] - v->forward[k];
  assert_false(abbe_map_layout_project(&layout, p, uv)); /* behind */
  for (int k = 0; k < 3; k++) p[k] = v->origin[k] + v->forward[k] + 0.41 * v->right[k];
  assert_false(abbe_map_layout_project(&layout, p, uv)); /* right of the window */
  assert_false(abbe_map_layout_project(&layout, v->origin, uv));
  p[0] = NAN;
  assert_false(abbe_map_layout_project(&layout, p, uv));
  assert_near(uv[0], 7, 0);
  /* The very corner is the last texel's. */
  size_t column, row;
  for (int k = 0; k < 3; k++)
    p[k] = v->origin[k] + v->forward[k] + (0.4 - 1e-15) * v->right[k] + (0.9 - 1e-15) * v->up[k];
  assert_true(abbe_map_layout_texel(&layout, 16, 8, p, &column, &row));
  assert_int_equal(column, 15);
  assert_int_equal(row, 0);
}

TEST(texel_sizes_add_up_to_the_window) {
  const abbe_map_layout layout = slanted(true);
  static const size_t sides[] = {1, 3, 37, 64, 512};
  for (int i = 0; i < 5; i++)
    for (int axis = 0; axis < 2; axis++) {
      double sum = 0;
      for (size_t k = 0; k < sides[i]; k++) {
        const double size = abbe_map_layout_texel_size(&layout, axis, sides[i], k);
        assert_true(size > 0);
        sum += size;
      }
      assert_near(sum, 1.1, tolerance);
    }
  /* The x axis is finer to the right, the y axis to the bottom. */
  assert_true(abbe_map_layout_texel_size(&layout, 0, 64, 0) >
              abbe_map_layout_texel_size(&layout, 0, 64, 63));
  assert_true(abbe_map_layout_texel_size(&layout, 1, 64, 63) >
              abbe_map_layout_texel_size(&layout, 1, 64, 0));
}

static void make_image(abbe_image *out) {
  static const char *const names[] = {"X", "Y", "Z"};
  OK(abbe_image_make(4, 4, 3, names, out, &error));
}

/* Every bit comes back, whatever the host program's language writes for a decimal point. */
TEST(attributes_give_back_every_bit) {
  const char *host = setlocale(LC_ALL, "de_DE.UTF-8");
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_map_layout layout = slanted(orthographic), back;
    FILLED(abbe_image, image, make_image(&image));
    layout.view.origin[0] = -1.0 / 3e-300;
    OK(abbe_map_layout_write(&layout, "lamp", &image, &error));
    assert_string_equal(abbe_image_attribute_text(&image, "abbe:map_light"), "lamp");
    OK(abbe_map_layout_read(&image, "map.exr", &back, &error));
    assert_int_equal(back.view.orthographic, orthographic);
    assert_memory_equal(back.view.origin, layout.view.origin, sizeof back.view.origin);
    assert_memory_equal(back.view.right, layout.view.right, sizeof back.view.right);
    assert_memory_equal(back.view.up, layout.view.up, sizeof back.view.up);
    assert_memory_equal(back.view.forward, layout.view.forward, sizeof back.view.forward);
    assert_memory_equal(back.view.window, layout.view.window, sizeof back.view.window);
    assert_true(back.view.near == 0.5 && back.view.far == 9);
    assert_memory_equal(back.knot, layout.knot, sizeof back.knot);
  }
  if (host != NULL) setlocale(LC_ALL, "C");
}

TEST(sameness_is_of_texels) {
  abbe_map_layout a = slanted(false), b = a;
  assert_true(abbe_map_layout_same(&a, &b));
  b.view.far *= 2; /* moves no texel */
  assert_true(abbe_map_layout_same(&a, &b));
  b.view.window[1] += 1e-12;
  assert_true(abbe_map_layout_same(&a, &b));
  b.view.window[1] += 1e-6;
  assert_false(abbe_map_layout_same(&a, &b));
  b = a;
  b.knot[1][64] += 1e-6;
  assert_false(abbe_map_layout_same(&a, &b));
  b = a;
  b.view.origin[2] += 1e-6;
  assert_false(abbe_map_layout_same(&a, &b));
  b = slanted(true);
  assert_false(abbe_map_layout_same(&a, &b));
}

TEST(impossible_layouts_are_refused) {
  for (int fault = 0; fault < 8; fault++) {
    abbe_map_layout l = slanted(false);
    const char *part = NULL;
    switch (fault) {
    case 0:
      l.view.origin[1] = NAN;
      part = "not finite";
      break;
    case 1:
      l.view.up[0] += 0.1;
      part = "right-angled";
      break;
    case 2:
      for (int k = 0; k < 3; k++) l.view.right[k] *= -1;
      part = "right-handed";
      break;
    case 3:
      l.view.window[0] = l.view.window[1];
      part = "empty window";
      break;
    case 4:
      l.view.near = 0;
      part = "empty range";
      break;
    case 5:
      l.knot[0][5] = l.knot[0][6];
      part = "along x";
      break;
    case 6:
      l.knot[1][128] = 0.999999;
      part = "along y";
      break;
    default:
      l.knot[1][7] = NAN;
      part = "along y";
      break;
    }
    REFUSED(ABBE_INVALID_ARGUMENT, part, abbe_map_layout_check(&l, &error));
    FILLED(abbe_image, image, make_image(&image));
    assert_int_equal(abbe_map_layout_write(&l, NULL, &image, NULL), ABBE_INVALID_ARGUMENT);
    assert_int_equal(image.attribute_count, 0);
  }
}

static void refuse(const char *name, const char *text, abbe_result code, const char *part) {
  abbe_map_layout layout = slanted(false), none = {0};
  FILLED(abbe_image, image, make_image(&image));
  OK(abbe_map_layout_write(&layout, NULL, &image, &error));
  OK(abbe_image_set_attribute(&image, name, text, &error));
  REFUSED(code, part, abbe_map_layout_read(&image, "that.exr", &layout, &error));
  assert_contains(last_error.text, "that.exr");
  assert_memory_equal(&layout, &none, sizeof none);
}

TEST(broken_attributes_are_refused) {
  static const char *const views[] = {
      "",
      "perspective",
      "oblique origin 0 0 0",
      "perspective origin 0 0 zero",
      "perspective origin 0 0 0 right 1 0 0 up 0 1 0 forward 0 0 -1 window 0 1 0 1",
      "perspective origin 0 0 0 right 1 0 0 up 0 1 0 forward 0 0 -1 window 0 1 0 1 range 1 2 3",
      "perspective origin 0 0 0 right 1 0 0 up 0 1 0 forward 0 0 -1 window 1 0 0 1 range 1 2",
      "perspective origin 0 0 inf right 1 0 0 up 0 1 0 forward 0 0 -1 window 0 1 0 1 range 1 2"};
  for (size_t i = 0; i < sizeof views / sizeof *views; i++)
    refuse("abbe:map_view", views[i], ABBE_PARSE, "view");
  refuse("abbe:map_warp_x", "0 1", ABBE_PARSE, "abbe:map_warp_x");
  refuse("abbe:map_warp_y", "", ABBE_PARSE, "abbe:map_warp_y");
  abbe_map_layout layout;
  FILLED(abbe_image, image, make_image(&image));
  REFUSED(ABBE_NOT_FOUND, "no receiver map",
          abbe_map_layout_read(&image, "picture.exr", &layout, &error));
}

/* Maps in other texels: light is kept, lands in the right place, and falls off the edges. */

/* Looks down from 2 m up, turned by `tilt`, with axes bent by `bend` (0: straight). */
static abbe_map_layout layout_of(bool orthographic, double tilt, double bend, double window) {
  const double origin[3] = {0, 0, 2}, forward[3] = {orthographic ? 0 : sin(tilt), 0, -cos(tilt)};
  const double up[3] = {0, 1, 0};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(origin, forward, up, orthographic, &view);
  view.window[0] = view.window[2] = -window;
  view.window[1] = view.window[3] = window;
  view.near = 1;
  view.far = 3;
  abbe_map_layout_make(&view, &layout);
  for (int k = 0; k <= ABBE_MAP_LAYOUT_STEPS; k++) {
    double s = (double)k / ABBE_MAP_LAYOUT_STEPS;
    layout.knot[0][k] = (1 - bend) * s + bend * s * s;
  }
  layout.knot[0][ABBE_MAP_LAYOUT_STEPS] = 1;
  return layout;
}

static abbe_image map_of(const abbe_map_layout *layout, size_t side) {
  static const char *const names[] = {"X", "Y", "Z"};
  abbe_image image = {0};
  OK(abbe_image_make(side, side, 3, names, &image, &error));
  OK(abbe_map_layout_write(layout, "lamp", &image, &error));
  return image;
}

static double sum_of(const abbe_image *image, size_t channel) {
  double sum = 0;
  for (size_t i = 0; i < image->width * image->height; i++)
    sum += (double)image->data[i * image->channels + channel];
  return sum;
}

TEST(the_same_layout_gives_the_same_map) {
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_map_layout layout = layout_of(orthographic, 0.2, 0.3, 0.5);
    OWNED(abbe_image, from) = map_of(&layout, 16);
    for (size_t i = 0; i < 16 * 16 * 3; i++) from.data[i] = (float)(i % 37);
    MADE(abbe_image, to, abbe_map_resample(&from, "a", &layout, 16, 16, 3, &to, &error));
    for (size_t i = 0; i < 16 * 16 * 3; i++) assert_near(to.data[i], from.data[i], 1e-5);
    assert_string_equal(abbe_image_attribute_text(&to, "abbe:map_light"), "lamp");
  }
}

TEST(light_is_kept_in_a_wider_window_and_lost_outside_a_narrow_one) {
  abbe_map_layout own = layout_of(false, 0, 0, 0.4), wide = layout_of(false, 0.15, 0.4, 0.8);
  abbe_map_layout half = layout_of(false, 0, 0, 0.2);
  OWNED(abbe_image, from) = map_of(&own, 32);
  for (size_t i = 0; i < 32 * 32 * 3; i++) from.data[i] = (float)(1 + i % 3);
  MADE(abbe_image, to, abbe_map_resample(&from, "a", &wide, 20, 12, 4, &to, &error));
  for (size_t c = 0; c < 3; c++) assert_near(sum_of(&to, c), sum_of(&from, c), 1e-2);
  abbe_image_free(&to);
  /* Half as wide and half as high: a quarter of the light, spread evenly. */
  OK(abbe_map_resample(&from, "a", &half, 8, 8, 4, &to, &error));
  assert_near(sum_of(&to, 0), 0.25 * sum_of(&from, 0), 1e-3);
  for (size_t i = 0; i < 64; i++) assert_near(to.data[3 * i], 4, 1e-5);
}

/* A bright texel lands where its ray meets the other layout, worked out through the world. */
TEST(light_lands_where_it_belongs) {
  abbe_map_layout own = layout_of(false, 0.3, 0.5, 0.6), other = layout_of(false, 0.1, 0.2, 1.2);
  OWNED(abbe_image, from) = map_of(&own, 64);
  abbe_image to = {0};
  static const size_t places[][2] = {{3, 60}, {32, 32}, {50, 7}};
  for (size_t i = 0; i < 3; i++) {
    size_t x = places[i][0], y = places[i][1], column, row;
    memset(from.data, 0, 64 * 64 * 3 * sizeof *from.data);
    from.data[(y * 64 + x) * 3 + 1] = 5;
    OK(abbe_map_resample(&from, "a", &other, 40, 40, 1, &to, &error));
    double uv[2] = {(x + 0.5) / 64, 1 - (y + 0.5) / 64}, p[3], d[3];
    abbe_map_layout_ray(&own, uv, p, d);
    double t = p[2] / -d[2]; /* the floor, z = 0 */
    for (int k = 0; k < 3; k++) p[k] += t * d[k];
    assert_true(abbe_map_layout_texel(&other, 40, 40, p, &column, &row));
    assert_near(to.data[(row * 40 + column) * 3 + 1], 5, 1e-6);
    assert_near(sum_of(&to, 1), 5, 1e-6);
    abbe_image_free(&to);
  }
}

TEST(what_is_refused) {
  abbe_map_layout own = layout_of(false, 0, 0, 0.4), moved = own;
  OWNED(abbe_image, from) = map_of(&own, 8);
  abbe_image to = {0};
  static const char *const names[] = {"Y"};
  moved.view.origin[0] = 0.1;
  REFUSED(ABBE_INVALID_ARGUMENT, "a.exr",
          abbe_map_resample(&from, "a.exr", &moved, 8, 8, 2, &to, &error));
  abbe_map_layout parallel = layout_of(true, 0, 0, 0.4);
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_map_resample(&from, "a", &parallel, 8, 8, 2, &to, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a texel cannot be cut into",
          abbe_map_resample(&from, "a", &own, 8, 8, 0, &to, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a texel cannot be cut into",
          abbe_map_resample(&from, "a", &own, 8, 8, 65, &to, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "pixels cannot be made",
          abbe_map_resample(&from, "a", &own, 0, 8, 2, &to, &error));
  MADE(abbe_image, bare, abbe_image_make(8, 8, 1, names, &bare, &error));
  REFUSED(ABBE_NOT_FOUND, "view, so it is no receiver map",
          abbe_map_resample(&bare, "a", &own, 8, 8, 2, &to, &error));
  assert_null(to.data);
}
