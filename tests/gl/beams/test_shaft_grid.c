/* Light in murky water that is seen from above, through its surface, and mirrored in it from below:
 * against the closed form of a flat slab. */
#include "tests/gl/frame.h"

#include "scenes/medium/medium.h"

static const double pi = 3.14159265358979323846;
static const double index_of_water = 1.5, scattering = 0.8, g = 0.5, deep = 0.4;

/* The sun at 30 degrees; black walls keep it from the sides, and what is seen behind the haze is
 * black. */
#define BASIN(camera)                                                                              \
  "materials: glass.yaml\n"                                                                        \
  "camera: {" camera "}\n"                                                                         \
  "lights: [{name: sun, kind: directional, direction: [0, 0.5, -0.8660254], irradiance: 1}]\n"     \
  "objects:\n"                                                                                     \
  "- {name: water, shape: water, size: [0.8, 0.8, 0.41], cells: 8, material: flat,\n"              \
  "   medium: {scattering: 0.8, g: 0.5}}\n"                                                        \
  "- {name: bottom, shape: rectangle, width: 4, height: 4, reflectance: 0,\n"                      \
  "   transform: [{translate: [0, 0, -0.4]}]}\n"                                                   \
  "- {name: side, shape: rectangle, width: 2, height: 0.56, reflectance: 0,\n"                     \
  "   transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0, -0.41, -0.22]}]}\n"

static double green_of(const char *text) {
  abbe_scene scene;
  abbe_image picture;
  abbe_render_desc desc = {.width = 16,
                           .height = 16,
                           .photons = 96,
                           .map_size = 64,
                           .wavelengths = 3,
                           .supersample = 1,
                           .space = ABBE_RGB_SPACE_REC709};
  load_text(text, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  draw_frame(renderer);
  read_picture(renderer, false, &picture);
  double sum = 0;
  for (size_t i = 0; i < 256; i++) sum += (double)picture.data[i * picture.channels + 1] / 256;
  abbe_image_free(&picture);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
  return sum;
}

static double inside_of(double angle) {
  return asin(sin(angle) / index_of_water);
}

static double passes(double outside) {
  const double c = cos(outside), t = index_of_water * cos(inside_of(outside));
  const double c_p = index_of_water * c, t_p = cos(inside_of(outside));
  const double rs = (c - t) / (c + t), rp = (c_p - t_p) / (c_p + t_p);
  return 1 - 0.5 * (rs * rs + rp * rp);
}

/* Radiance in the water on a way down from the surface, at that angle, in the plane of x: the sun's
 * light there, turned by the cosine. */
static double scattered_on_way(double view) {
  const double sun = pi / 6, way = inside_of(sun);
  const double e = passes(sun) * cos(sun) / cos(way), turned = -cos(way) * cos(view);
  const double slope = scattering * (1 + cos(view) / cos(way));
  return e * scattering * abbe_medium_phase(g, turned) * -expm1(-slope * deep / cos(view)) / slope;
}

/* By Snell's law and Fresnel's; radiance over the squared index stays. */
static void from_above_through_flat_water(void **state) {
  (void)state;
  const double view = 25 * pi / 180;
  const double exact = passes(view) * scattered_on_way(inside_of(view)) / pow(index_of_water, 2);
  const double drawn =
      green_of(BASIN("eye: [0.932615, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 2"));
  assert_near(drawn / exact, 1, 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(from_above_through_flat_water),
  };
  return cmocka_run_group_tests(tests, make_context, free_context);
}
