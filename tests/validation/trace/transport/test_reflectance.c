#include "tests/scenes/scene_text.h"

#include "validation/trace/transport/reflectance.h"

#define CARD                                                                                       \
  "objects:\n- {name: card, shape: rectangle, width: 2, height: 2, reflectance: [0.8, 0.5, "       \
  "0.25]}\n"                                                                                       \
  "- {name: hill, shape: sphere, radius: 0.05, transform: [{translate: [0, 0, 0.3]}], "            \
  "reflectance: 0.5}\n"

static abbe_scene scene;
static abbe_geometry geometry;
static abbe_spectral_sampling sampling;
static abbe_bands bands;
static const abbe_environment_light dark;

static void setup(void) {
  const abbe_spectral_sampling_desc desc = {.min_nm = 380, .max_nm = 780, .uniform = 0.1};
  scene = scene_of(CAMERA POINT_LIGHT CARD);
  OK(abbe_geometry_make(&scene, &geometry, &error));
  OK(abbe_spectral_sampling_make(&scene, &desc, &sampling, &error));
  OK(abbe_bands_make(&sampling, 40, &bands, &error));
}

static void teardown(void) {
  abbe_bands_free(&bands);
  abbe_spectral_sampling_free(&sampling);
  abbe_geometry_free(&geometry);
  abbe_scene_free(&scene);
}

/* The face and barycentric coordinates of the card at (x, y). */
static void at_place(double x, double y, abbe_hit *hit) {
  double from[3] = {x, y, 0.1};
  float o[3], d[3] = {0, 0, -1};
  abbe_geometry_to_frame(&geometry, from, o);
  assert_true(abbe_geometry_hit(&geometry, ABBE_GEOMETRY_RECEIVERS, o, d, INFINITY, hit));
  assert_int_equal(hit->surface - geometry.surface, 0);
}

static abbe_reflectance make(abbe_rgb_space space) {
  abbe_reflectance r;
  OK(abbe_reflectance_make(&geometry, &sampling, &bands, &dark, space, &r, &error));
  return r;
}

static void colour_at(const abbe_reflectance *r, double x, double y, float out[3]) {
  abbe_hit hit;
  at_place(x, y, &hit);
  abbe_reflected of;
  abbe_reflectance_find(r, 0, hit.face, hit.u, hit.v, &of);
  memcpy(out, of.share, sizeof of.share);
}

/* A texture that is red on the left, green to the right, and blue upwards, in steps of a texel. */
static void put_texture(size_t width, size_t height, const double repeat[2]) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_object *o = &scene.object[0];
  abbe_image_free(&o->texture);
  OK(abbe_image_make(width, height, 3, names, &o->texture, &error));
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x < width; x++) {
      float *texel = o->texture.data + 3 * (y * width + x);
      texel[0] = ((float)(width - x) - 0.5f) / (float)width;
      texel[1] = ((float)x + 0.5f) / (float)width;
      texel[2] = ((float)(height - y) - 0.5f) / (float)height;
    }
  for (int k = 0; k < 2; k++) o->texture_repeat[k] = repeat[k];
}

GROUP(setup, teardown);

TEST(without_a_texture_it_is_the_objects) {
  OWNED(abbe_reflectance, r) = make(ABBE_RGB_SPACE_REC709);
  float c[3];
  colour_at(&r, 0.3, -0.7, c);
  for (int k = 0; k < 3; k++) assert_near((double)c[k], scene.object[0].reflectance[k], 1e-7);
}

/* x to the right is u, y up is v; the texture's row 0 is at the top. Between the middles of texels
 * a linear ramp stays linear. */
TEST(textures_stand_upright) {
  put_texture(16, 8, (double[2]){1, 1});
  OWNED(abbe_reflectance, r) = make(ABBE_RGB_SPACE_REC709);
  for (int i = 0; i < 100; i++) {
    double u = 0.05 + 0.1 * (i % 10), v = 0.07 + 0.095 * (double)(i / 10);
    float c[3];
    colour_at(&r, 2 * u - 1, 2 * v - 1, c);
    assert_near((double)c[0], 0.8 * (1 - u), 1e-5);
    assert_near((double)c[1], 0.5 * u, 1e-5);
    assert_near((double)c[2], 0.25 * v, 1e-5);
  }
}

TEST(textures_repeat) {
  put_texture(16, 8, (double[2]){4, 3});
  OWNED(abbe_reflectance, r) = make(ABBE_RGB_SPACE_REC709);
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
TEST(awkward_textures) {
  put_texture(16, 8, (double[2]){-1, -1});
  abbe_reflectance r = make(ABBE_RGB_SPACE_REC709);
  float c[3];
  colour_at(&r, 2 * 0.3 - 1, 2 * 0.4 - 1, c);
  assert_near((double)c[1], 0.5 * 0.7, 1e-5);
  assert_near((double)c[2], 0.25 * 0.6, 1e-5);
  put_texture(1, 1, (double[2]){1e6, 1e6});
  colour_at(&r, 0.123, -0.456, c);
  assert_near((double)c[0], 0.8 * 0.5, 1e-6);
  /* a sphere has no texture coordinates: its colour stands */
  scene.object[1].texture = scene.object[0].texture;
  abbe_reflected of;
  abbe_reflectance_find(&r, 1, 0, 0, 0, &of);
  scene.object[1].texture = (abbe_image){0};
  for (int k = 0; k < 3; k++) assert_near((double)of.share[k], 0.5, 0);
  abbe_reflectance_free(&r);
  abbe_image_free(&scene.object[0].texture);
}

/* The mean of one wavelength's paths is what light of all wavelengths shows, and under D65 that is
 * the colour, in every space; a grey is grey at all wavelengths. */
TEST(wavelengths_add_up_to_the_colour) {
  const abbe_reflected card = {.share = {0.8f, 0.5f, 0.25f}}, grey = {.share = {0.5f, 0.5f, 0.5f}};
  for (int space = 0; space < ABBE_RGB_SPACE_COUNT; space++) {
    OWNED(abbe_reflectance, r) = make((abbe_rgb_space)space);
    double to_xyz[9], from_xyz[9], expected[3], sum[3] = {0};
    float c[3], white[3];
    abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
    abbe_rgb_space_from_xyz((abbe_rgb_space)space, from_xyz);
    abbe_rgb_space_apply(to_xyz, (double[3]){0.8, 0.5, 0.25}, expected);
    abbe_rgb_space_apply(from_xyz, expected, expected);
    for (uint32_t k = 0; k < sampling.steps; k++) {
      const double share = (double)abbe_reflectance_at_step(&r, &card, k);
      assert_true(share >= 0.25 - 1e-6 && share <= 0.8 + 1e-6);
      assert_near((double)abbe_reflectance_at_step(&r, &grey, k), 0.5, 1e-6);
      for (int j = 0; j < 3; j++) sum[j] += share * (double)sampling.xyz[k][j];
    }
    abbe_rgb_space_apply(from_xyz, sum, sum);
    abbe_reflectance_of_white(&r, &card, 0, c);
    abbe_reflectance_of_white(&r, &(abbe_reflected){.share = {1, 1, 1}}, 0, white);
    abbe_reflectance_whiten(&r, white, white);
    double one[3] = {1, 1, 1};
    for (int k = 0; k < 3; k++) {
      assert_near((double)c[k], sum[k] / (double)sampling.steps, 1e-6);
      assert_near((double)c[k], expected[k], 1e-3);
      assert_near((double)white[k], one[k], 1e-5);
    }
  }
}

/* Objects of a spectrum have it, at every step and as the mean over a band. */
TEST(a_spectrum_is_itself) {
  static const double nm[] = {380, 780}, value[] = {0.1, 0.9};
  abbe_object *o = &scene.object[0];
  OK(abbe_spectrum_make(nm, value, 2, ABBE_INTERPOLATION_LINEAR, &o->spectrum, &error));
  abbe_reflectance r = make(ABBE_RGB_SPACE_XYZ);
  abbe_reflected of;
  abbe_reflectance_find(&r, 0, 0, 0.2f, 0.3f, &of);
  for (uint32_t k = 0; k < sampling.steps; k++) {
    const double middle = 0.5 * (sampling.lambda_nm[k] + sampling.lambda_nm[k + 1]);
    assert_near((double)abbe_reflectance_at_step(&r, &of, k), 0.1 + 0.002 * (middle - 380), 1e-6);
  }
  for (size_t b = 0; b < bands.count; b++)
    assert_near((double)abbe_reflectance_in_band(&r, &of, 0, b),
                0.1 + 0.002 * (bands.middle_nm[b] - 380), 2e-3); /* a step is up to 1 nm */
  abbe_reflectance_free(&r);
  abbe_spectrum_free(o->spectrum);
  o->spectrum = NULL;
}
