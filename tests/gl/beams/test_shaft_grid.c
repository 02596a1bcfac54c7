/* Light in murky water that is seen from above, through its surface, and mirrored in it from below:
 * against the closed form of a flat slab. */
#include "tests/check.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/medium/medium.h"
#include "tests/gl/haze/haze_picture.h"

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

/* Beams of light that lands nowhere, and that goes from one surface to the next; in coloured haze
 * each band of the spectrum by Beer's law. */

/* The sun from above, on a mirror of 0.1 m beside the mist, which turns it along the mist; a roof
 * keeps it from the mist itself. The eye looks across what is 0.1 m wide, at 0.4 m from the mirror
 * and 0.2 m within the mist. */
#define BESIDE_MIST(medium, more)                                                                  \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0.4, -1, 0], target: [0.4, 0, 0], fov: 1}\n"                                     \
  "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1, illuminant: "     \
  "D65}]\n"                                                                                        \
  "medium: {" medium ", g: 0.4, box: [[0.2, -0.05, -0.2], [0.6, 0.05, 0.2]]}\n"                    \
  "objects:\n"                                                                                     \
  "- {name: roof, shape: rectangle, width: 0.6, height: 0.6, reflectance: 0, transform: "          \
  "[{translate: [0.4, 0, 1]}]}\n"                                                                  \
  "- {name: spot, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0, transform: "      \
  "[{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0.4, 1, 0]}]}\n"                          \
  "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.8, transform: "           \
  "[{rotate: {axis: [0, 1, 0], angle: 45}}]}\n" more

/* Across the beam, which it meets at a right angle. */
static double across(double scatters, double extinction) {
  const double before = extinction * 0.2;
  const double width = extinction > 0 ? -expm1(-extinction * 0.1) / extinction : 0.1;
  return 0.8 * exp(-before) * scatters * abbe_medium_phase(0.4, 0) * width;
}

TEST(a_beam_into_the_open) {
  const double drawn = green_of(BESIDE_MIST("scattering: 0.8, absorption: 0.3", ""), 96);
  print_message("into the open: %.4f of the known light\n", drawn / across(0.8, 1.1));
  assert_near(drawn / across(0.8, 1.1), 1, 0.01);
}

/* The other mirror sends it up, and away. */
TEST(a_beam_between_two_mirrors) {
  const double drawn = green_of(
      BESIDE_MIST(
          "scattering: 0.8, absorption: 0.3",
          "- {name: other, shape: rectangle, width: 0.2, height: 0.2, mirror: 0.5, transform: "
          "[{rotate: {axis: [0, 1, 0], angle: 45}}, {translate: [0.8, 0, 0]}]}\n"),
      96);
  print_message("between two mirrors: %.4f of the known light\n", drawn / across(0.8, 1.1));
  assert_near(drawn / across(0.8, 1.1), 1, 0.01);
}

/* Through a plate of glass, of its Fresnel loss, into the open. */
TEST(a_beam_behind_glass) {
  const double once = 0.5 / 2.5, lost = once * once, through = (1 - lost) / (1 + lost);
  const double drawn =
      green_of(BESIDE_MIST("scattering: 0.8, absorption: 0.3",
                           "- {name: plate, shape: box, size: [0.01, 0.4, 0.4], material: flat, "
                           "transform: [{translate: [0.12, 0, 0]}]}\n"),
               96);
  print_message("behind glass: %.4f of the known light\n", drawn / (through * across(0.8, 1.1)));
  assert_near(drawn / (through * across(0.8, 1.1)), 1, 0.02);
}

static const abbe_render_desc in_colour = {.photons = 96, .space = ABBE_RGB_SPACE_XYZ};

/* XYZ of what is known at each wavelength, under D65. */
static void known_colour(double (*at)(double nm), double xyz[3]) {
  enum { STEPS = 400 };
  abbe_illuminant d65;
  abbe_weights_range range;
  OK(abbe_illuminant_make("D65", &d65, &error));
  abbe_weights_range_make_by(in_colour.observer, &d65, 380, 780, &range);
  for (int k = 0; k < 3; k++) xyz[k] = 0;
  for (int i = 0; i < STEPS; i++) {
    double part[3];
    abbe_weights_range_xyz(&range, 380 + i, 381 + i, part);
    for (int k = 0; k < 3; k++) xyz[k] += part[k] * at(380.5 + i);
  }
}

static void assert_colour(const char *what, const double drawn[3], const double known[3],
                          double within) {
  print_message("%s: %.4f, %.4f, %.4f of the known X, Y, Z\n", what, drawn[0] / known[0],
                drawn[1] / known[1], drawn[2] / known[2]);
  for (int k = 0; k < 3; k++) assert_near(drawn[k] / known[k], 1, within);
}

#define COLOURED "scattering: [[380, 6], [780, 1]], absorption: [[380, 0], [780, 8]]"

static double blue(double nm) {
  return 6 - 5 * (nm - 380) / 400;
}

static double red(double nm) {
  return blue(nm) + 8 * (nm - 380) / 400;
}

static double beam_at(double nm) {
  return across(blue(nm), red(nm));
}

TEST(a_beam_in_coloured_mist) {
  double drawn[3], known[3];
  mean_of(BESIDE_MIST(COLOURED, ""), &in_colour, drawn);
  known_colour(beam_at, known);
  assert_colour("a beam in coloured mist", drawn, known, 0.006);
}

#define SLAB(more)                                                                                 \
  more "camera: {eye: [2.383508, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 1}\n"               \
       "medium: {scattering: [[380, 1.2], [780, 0.2]], absorption: [[380, 0], [780, 1.6]], g: "    \
       "0.4, box: [[-40, -40, -0.5], [40, 40, 0.5]]}\n"                                            \
       "objects: [{name: spot, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0,\n"   \
       "           transform: [{translate: [-7.150524, 0, -6]}]}]\n"

/* The sun 30 degrees off upright, the eye at 50 degrees, as in test_haze_pass.c. */
static double slab_at(double nm) {
  const double m0 = cos(30 * ABBE_PI / 180), m = cos(50 * ABBE_PI / 180), extinction = red(nm) / 5;
  const double turned = sin(30 * ABBE_PI / 180) * sin(50 * ABBE_PI / 180) - m0 * m;
  return blue(nm) / red(nm) * abbe_medium_phase(0.4, turned) * m0 / (m0 + m) *
         -expm1(-extinction * (1 / m0 + 1 / m));
}

static double left_at(double nm) {
  return exp(-red(nm) / 5 / cos(50 * ABBE_PI / 180));
}

TEST(coloured_mist_in_the_sun) {
  double drawn[3], known[3];
  mean_of(SLAB("lights: [{name: sun, kind: directional, direction: [0.5, 0, -0.8660254], "
               "irradiance: 1, illuminant: D65}]\n"),
          &in_colour, drawn);
  known_colour(slab_at, known);
  assert_colour("a slab in the sun", drawn, known, 0.006);
  mean_of(SLAB("background: 1\nlights: [{name: sun, kind: directional, direction: [0.5, 0, "
               "-0.8660254], irradiance: 1.0e-9, illuminant: D65}]\n"),
          &in_colour, drawn);
  known_colour(left_at, known);
  assert_colour("what is left behind it", drawn, known, 0.006);
}

/* A white floor under 0.5 m of it, close before the eye. */
static double floor_at(double nm) {
  return 0.6 / ABBE_PI * exp(-0.5 * red(nm));
}

TEST(a_floor_under_coloured_mist) {
  double drawn[3], known[3];
  mean_of("camera: {eye: [0, 0, -0.6], target: [0, 0, -2], up: [0, 1, 0], fov: 1}\n"
          "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1, "
          "illuminant: D65}]\n"
          "medium: {" COLOURED ", box: [[-9, -9, -0.5], [9, 9, 0]]}\n"
          "objects: [{name: floor, shape: rectangle, width: 9, height: 9, reflectance: 0.6, "
          "transform: [{translate: [0, 0, -1]}]}]\n",
          &in_colour, drawn);
  known_colour(floor_at, known);
  assert_colour("a floor under it", drawn, known, 0.006);
}
