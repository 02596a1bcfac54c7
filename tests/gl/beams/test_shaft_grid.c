/* Light in murky water that is seen from above, through its surface, and mirrored in it from below:
 * against the closed form of a flat slab. */
#include "tests/gl/haze/haze_picture.h"

#include "base/maths.h"
#include "scenes/medium/medium.h"

static const double index_of_water = 1.5, scattering = 0.8, g = 0.5, deep = 0.4;

/* The sun at 30 degrees; black walls keep it from the sides, and what is seen behind the haze is
 * black. */
#define BASIN(camera) BASIN_AMONG(camera, "")
#define BASIN_AMONG(camera, others)                                                                \
  "materials: glass.yaml\n"                                                                        \
  "camera: {" camera "}\n"                                                                         \
  "lights: [{name: sun, kind: directional, direction: [0, 0.5, -0.8660254], irradiance: 1}]\n"     \
  "objects:\n" others                                                                              \
  "- {name: water, shape: water, size: [1.6, 1.6, 0.41], cells: 8, material: flat,\n"              \
  "   medium: {scattering: 0.8, g: 0.5}}\n"                                                        \
  "- {name: bottom, shape: rectangle, width: 4, height: 4, reflectance: 0,\n"                      \
  "   transform: [{translate: [0, 0, -0.4]}]}\n"                                                   \
  "- {name: side, shape: rectangle, width: 2, height: 0.56, reflectance: 0,\n"                     \
  "   transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0, -0.81, -0.22]}]}\n"

static double inside_of(double angle) {
  return asin(sin(angle) / index_of_water);
}

static double passes(double outside) {
  const double c = cos(outside), t = index_of_water * cos(inside_of(outside));
  const double c_p = index_of_water * c, t_p = cos(inside_of(outside));
  const double rs = (c - t) / (c + t), rp = (c_p - t_p) / (c_p + t_p);
  return 1 - 0.5 * (rs * rs + rp * rp);
}

/* Radiance in the water that is scattered along a unit way that runs from a depth for so many
 * metres, its third component upwards. */
static double scattered_along(const double d[3], double depth, double metres) {
  const double sun = ABBE_PI / 6, way = inside_of(sun);
  const double e = passes(sun) * cos(sun) / cos(way), turned = cos(way) * d[2] - sin(way) * d[1];
  const double slope = scattering * (1 - d[2] / cos(way));
  return e * scattering * abbe_medium_phase(g, turned) * exp(-scattering * depth / cos(way)) *
         -expm1(-slope * metres) / slope;
}

GROUP(make_context, free_context);

/* By Snell's law and Fresnel's; radiance over the squared index stays. */
TEST(from_above_through_flat_water) {
  const double view = 25 * ABBE_PI / 180;
  const double in = inside_of(view), d[3] = {-sin(in), 0, -cos(in)};
  const double exact =
      passes(view) * scattered_along(d, 0, deep / cos(in)) / pow(index_of_water, 2);
  const double drawn =
      green_of(BASIN("eye: [0.932615, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 2"), 96);
  print_message("from above: %.4f of the known light\n", drawn / exact);
  assert_near(drawn / exact, 1, 0.02);
  /* beside another medium, which comes first */
  const double beside =
      green_of(BASIN_AMONG("eye: [0.932615, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 2",
                           "- {name: jade, shape: box, size: [0.1, 0.1, 0.1], material: flat, "
                           "medium: {scattering: 9}, transform: [{translate: [0.9, 0, 0]}]}\n"),
               96);
  print_message("beside another medium: %.4f of the known light\n", beside / exact);
  assert_near(beside / exact, 1, 0.03);
}

/* Beyond the critical angle: what is scattered on the way up, and of what is mirrored that of the
 * way down. The first is drawn as beams, the other told by the grid. In pictures of what moves
 * the grid tells both. */
TEST(mirrored_in_its_surface) {
  enum { SIDE = 40 };
  const double view = 54 * ABBE_PI / 180, half = tan(6 * ABBE_PI / 180), high = 0.2;
  double first = 0, second = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double a = half * ((2 * (i % SIDE) + 1) / (double)SIDE - 1);
    const double b = half * ((2 * (i / SIDE) + 1) / (double)SIDE - 1), l = sqrt(1 + a * a + b * b);
    const double up[3] = {(sin(view) - a * cos(view)) / l, b / l, (cos(view) + a * sin(view)) / l};
    const double down[3] = {up[0], up[1], -up[2]};
    first += scattered_along(up, high, high / up[2]) / (SIDE * SIDE);
    second +=
        exp(-scattering * high / up[2]) * scattered_along(down, 0, deep / up[2]) / (SIDE * SIDE);
  }
  static const char basin[] = BASIN(
      "eye: [-0.4, 0, -0.2], target: [-0.1247236, 0, 0], up: [0, 1, 0], fov: 12, inside: true");
  const double drawn = green_of(basin, 96), coarse = green_as(basin, 96, ABBE_COARSE_EYE);
  print_message("mirrored: %.4f of the known light, of which %.3f on the way up\n",
                drawn / (first + second), first / (first + second));
  assert_near(drawn / (first + second), 1, 0.02);
  print_message("of what moves: %.4f\n", coarse / (first + second));
  assert_near(coarse / (first + second), 1, 0.03);
}
