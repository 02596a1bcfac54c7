#include "tests/scenes/scene_text.h"

#include "colorimetry/upsampling.h"
#include "colorimetry/weights.h"
#include "validation/transport/reflectance.h"

#define CARD                                                                                       \
  "objects:\n- {name: card, shape: rectangle, width: 2, height: 2, reflectance: [0.8, 0.5, "       \
  "0.25]}\n"                                                                                       \
  "- {name: hill, shape: sphere, radius: 0.05, transform: [{translate: [0, 0, 0.3]}], "            \
  "reflectance: 0.5}\n"

static abbe_scene scene;
static abbe_geometry geometry;

static int setup(void **state) {
  (void)state;
  load_text(CAMERA POINT_LIGHT CARD, &scene);
  return abbe_geometry_make(&scene, &geometry, NULL) != ABBE_OK;
}

static int teardown(void **state) {
  (void)state;
  abbe_geometry_free(&geometry);
  abbe_scene_free(&scene);
  return 0;
}

/* The face and barycentric coordinates of the card at (x, y). */
static void at_place(double x, double y, abbe_hit *hit) {
  double from[3] = {x, y, 0.1};
  float o[3], d[3] = {0, 0, -1};
  abbe_geometry_to_frame(&geometry, from, o);
  assert_true(abbe_geometry_hit(&geometry, ABBE_GEOMETRY_RECEIVERS, o, d, INFINITY, hit));
  assert_int_equal(hit->surface - geometry.surface, 0);
}

static void colour_at(const abbe_reflectance *r, double x, double y, float out[3]) {
  abbe_hit hit;
  at_place(x, y, &hit);
  abbe_reflectance_rec709(r, 0, hit.face, hit.u, hit.v, out);
}

/* A texture that is red on the left, green to the right, and blue upwards, in steps of a texel. */
static void put_texture(size_t width, size_t height, const double repeat[2]) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_object *o = &scene.object[0];
  abbe_image_free(&o->texture);
  assert_int_equal(abbe_image_make(width, height, 3, names, &o->texture, NULL), ABBE_OK);
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x < width; x++) {
      float *texel = o->texture.data + 3 * (y * width + x);
      texel[0] = ((float)(width - x) - 0.5f) / (float)width;
      texel[1] = ((float)x + 0.5f) / (float)width;
      texel[2] = ((float)(height - y) - 0.5f) / (float)height;
    }
  for (int k = 0; k < 2; k++) o->texture_repeat[k] = repeat[k];
}

static void without_a_texture_it_is_the_objects(void **state) {
  (void)state;
  abbe_reflectance r;
  abbe_reflectance_make(&geometry, ABBE_RGB_SPACE_REC709, &r);
  float c[3], same[3];
  abbe_hit hit;
  at_place(0.3, -0.7, &hit);
  abbe_reflectance_rec709(&r, 0, hit.face, hit.u, hit.v, c);
  abbe_reflectance_at(&r, 0, hit.face, hit.u, hit.v, same);
  for (int k = 0; k < 3; k++) {
    assert_near((double)c[k], scene.object[0].reflectance[k], 1e-7);
    assert_near((double)same[k], scene.object[0].reflectance[k], 1e-6);
  }
}

/* x to the right is u, y up is v; the texture's row 0 is at the top. Between the middles of texels
 * a linear ramp stays linear. */
static void textures_stand_upright(void **state) {
  (void)state;
  put_texture(16, 8, (double[2]){1, 1});
  abbe_reflectance r;
  abbe_reflectance_make(&geometry, ABBE_RGB_SPACE_REC709, &r);
  for (int i = 0; i < 100; i++) {
    double u = 0.05 + 0.1 * (i % 10), v = 0.07 + 0.095 * (double)(i / 10);
    float c[3];
    colour_at(&r, 2 * u - 1, 2 * v - 1, c);
    assert_near((double)c[0], 0.8 * (1 - u), 1e-5);
    assert_near((double)c[1], 0.5 * u, 1e-5);
    assert_near((double)c[2], 0.25 * v, 1e-5);
  }
}

static void textures_repeat(void **state) {
  (void)state;
  put_texture(16, 8, (double[2]){4, 3});
  abbe_reflectance r;
  abbe_reflectance_make(&geometry, ABBE_RGB_SPACE_REC709, &r);
  float first[3], c[3];
  colour_at(&r, -1 + 2 * 0.3 / 4, -1 + 2 * 0.4 / 3, first);
  assert_near((double)first[1], 0.5 * 0.3, 1e-5);
  assert_near((double)first[2], 0.25 * 0.4, 1e-5);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 3; j++) {
      colour_at(&r, -1 + 2 * (0.3 + i) / 4, -1 + 2 * (0.4 + j) / 3, c);
      for (int k = 0; k < 3; k++) assert_near((double)c[k], (double)first[k], 2e-5);
    }
  /* across the seam the last texel and the first are mixed */
  colour_at(&r, -1 + 2 * 1.0 / 4, 0.1, c);
  assert_near((double)c[1], 0.5 * 0.5, 1e-4);
}

/* Repeats below 0 mirror; a texture of one texel is its colour everywhere. */
static void awkward_textures(void **state) {
  (void)state;
  put_texture(16, 8, (double[2]){-1, -1});
  abbe_reflectance r;
  abbe_reflectance_make(&geometry, ABBE_RGB_SPACE_REC709, &r);
  float c[3];
  colour_at(&r, 2 * 0.3 - 1, 2 * 0.4 - 1, c);
  assert_near((double)c[1], 0.5 * 0.7, 1e-5);
  assert_near((double)c[2], 0.25 * 0.6, 1e-5);
  put_texture(1, 1, (double[2]){1e6, 1e6});
  colour_at(&r, 0.123, -0.456, c);
  assert_near((double)c[0], 0.8 * 0.5, 1e-6);
  /* a sphere has no texture coordinates: its colour stands */
  scene.object[1].texture = scene.object[0].texture;
  abbe_reflectance_rec709(&r, 1, 0, 0, 0, c);
  scene.object[1].texture = (abbe_image){0};
  for (int k = 0; k < 3; k++) assert_near((double)c[k], 0.5, 0);
  abbe_image_free(&scene.object[0].texture);
}

/* A grey is the same number in every space, XYZ among them; a colour is the matrix's. */
static void greys_stay_grey(void **state) {
  (void)state;
  abbe_reflectance r;
  float c[3];
  for (int space = 0; space < ABBE_RGB_SPACE_COUNT; space++) {
    abbe_reflectance_make(&geometry, (abbe_rgb_space)space, &r);
    abbe_reflectance_at(&r, 1, 0, 0, 0, c);
    for (int k = 0; k < 3; k++) assert_near((double)c[k], 0.5, 1e-6);
  }
  abbe_reflectance_make(&geometry, ABBE_RGB_SPACE_ACESCG, &r);
  double to_xyz[9], from_xyz[9], expected[3];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, from_xyz);
  abbe_rgb_space_apply(to_xyz, scene.object[0].reflectance, expected);
  abbe_rgb_space_apply(from_xyz, expected, expected);
  abbe_reflectance_at(&r, 0, 0, 0.2f, 0.3f, c);
  for (int k = 0; k < 3; k++) assert_near((double)c[k], expected[k], 1e-5);
}

/* In bands over 380 to 780 nm, under D65, a reflectance has its colour: in XYZ, by Rec.709's own
 * matrix. Bands of 1 nm have nothing of the error of wide ones. */
static void bands_of_a_colour(void **state) {
  (void)state;
  enum { BANDS = 400 };
  static const double limit[2] = {0, 2e-3};
  const abbe_illuminant d65 = {0};
  const float grey[3] = {0.3f, 0.3f, 0.3f}, wood[3] = {0.6f, 0.32f, 0.13f};
  for (int wide = 0; wide < 2; wide++) {
    const int count = wide ? 20 : BANDS;
    const double width = 400.0 / count;
    double sum[3] = {0}, expected[3] = {(double)wood[0], (double)wood[1], (double)wood[2]}, m[9];
    for (int i = 0; i < count; i++) {
      double mean[3], xyz[3];
      const double from = 380 + width * i;
      abbe_upsampling_basis_mean(from, from + width, mean);
      const float basis[3] = {(float)mean[0], (float)mean[1], (float)mean[2]};
      assert_near((double)abbe_reflectance_band(grey, basis), 0.3, 1e-6);
      const double kept = (double)abbe_reflectance_band(wood, basis);
      assert_true(kept > 0.13 - 1e-6 && kept < 0.6 + 1e-6);
      abbe_weights_band_xyz(&d65, 380, 780, from, from + width, xyz);
      for (int k = 0; k < 3; k++) sum[k] += kept * xyz[k];
    }
    abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, m);
    abbe_rgb_space_apply(m, expected, expected);
    /* the nominal white is not the table's, by 5e-4 (rgb_space.h) */
    for (int k = 0; k < 3; k++) assert_near(sum[k], expected[k], 5e-4 + limit[wide]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_a_texture_it_is_the_objects),
      cmocka_unit_test(textures_stand_upright),
      cmocka_unit_test(textures_repeat),
      cmocka_unit_test(awkward_textures),
      cmocka_unit_test(greys_stay_grey),
      cmocka_unit_test(bands_of_a_colour),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
