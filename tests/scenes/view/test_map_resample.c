/* Maps in other texels: light is kept, lands in the right place, and falls off the edges. */
#include "tests/check.h"

#include "scenes/view/map_layout.h"

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
