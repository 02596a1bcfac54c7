/* Haze in the air that is seen in a mirror or through glass: as it is seen straight, by what these
 * leave. */
#include "tests/gl/haze/haze_picture.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/medium/medium.h"

static const double plate =
    (1 - 0.04) / (1 + 0.04); /* of glass, by Fresnel's law, straight through */

/* A lamp that shines across what the eye sees, which enters the mist at x = -1 and leaves it at 1.
 */
#define LAMP(camera, more)                                                                         \
  "materials: glass.yaml\n"                                                                        \
  "camera: {" camera ", fov: 0.5}\n"                                                               \
  "lights: [{name: lamp, kind: spot, position: [0, 0.2, 0], direction: [0, -1, 0], cone: 40, "     \
  "intensity: 1, illuminant: D65}]\n"                                                              \
  "medium: {scattering: [[380, 1], [780, 0.2]], absorption: [[380, 0], [780, 0.8]], g: 0.7, box: " \
  "[[-1, -1, -1], [1, 1, 1]]}\n"                                                                   \
  "objects:\n"                                                                                     \
  "- {name: far off, shape: rectangle, width: 9, height: 9, reflectance: 0, transform: [{rotate: " \
  "{axis: [0, 1, 0], angle: 90}}, {translate: [5, 0, 0]}]}\n" more

static const abbe_render_desc asked = {.photons = 64, .space = ABBE_RGB_SPACE_XYZ};

/* By the whole way from the lamp to the eye; the lamp is 0.2 m off the middle. */
static double lamp_at(double nm) {
  enum { PARTS = 400 };
  const double scattering = 1 - 0.8 * (nm - 380) / 400, takes = scattering + 0.8 * (nm - 380) / 400;
  const double half = 0.2 * tan(40 * ABBE_PI / 180);
  double sum = 0;
  for (int k = 0; k < PARTS; k++) {
    const double along = half * (1 - 2 * (k + 0.5) / PARTS), distance = hypot(0.2, along);
    sum += 2 * half / PARTS * scattering * abbe_medium_phase(0.7, along / distance) *
           exp(-takes * (1 - along + distance)) / (distance * distance);
  }
  return sum;
}

static void assert_lamp(const char *what, const char *text, double share) {
  double drawn[3], known[3] = {0};
  abbe_illuminant d65;
  abbe_weights_range range;
  OK(abbe_illuminant_make("D65", &d65, &error));
  abbe_weights_range_make_by(asked.observer, &d65, 380, 780, &range);
  for (int i = 0; i < 100; i++) {
    double part[3];
    abbe_weights_range_xyz(&range, 380 + 4 * i, 384 + 4 * i, part);
    for (int k = 0; k < 3; k++) known[k] += share * part[k] * lamp_at(382 + 4 * i);
  }
  mean_of(text, &asked, drawn);
  print_message("%s: %.4f, %.4f, %.4f of the known X, Y, Z\n", what, drawn[0] / known[0],
                drawn[1] / known[1], drawn[2] / known[2]);
  for (int k = 0; k < 3; k++) assert_near(drawn[k] / known[k], 1, 0.01);
}

GROUP(make_context, free_context);

TEST(a_lamp_seen_straight) {
  assert_lamp("straight", LAMP("eye: [-1.5, 0, 0], target: [0, 0, 0]", ""), 1);
}

TEST(a_lamp_behind_glass) {
  assert_lamp("behind glass",
              LAMP("eye: [-1.5, 0, 0], target: [0, 0, 0]",
                   "- {name: pane, shape: box, size: [0.02, 0.2, 0.2], material: flat, transform: "
                   "[{translate: [-1.2, 0, 0]}]}\n"),
              plate);
}

/* The pane is within the mist, so a part of it is on the eye's own way. */
TEST(a_lamp_behind_glass_in_the_mist) {
  assert_lamp("behind glass in the mist",
              LAMP("eye: [-1.5, 0, 0], target: [0, 0, 0]",
                   "- {name: pane, shape: box, size: [0.001, 0.2, 0.2], material: flat, transform: "
                   "[{translate: [-0.7, 0, 0]}]}\n"),
              plate);
}

TEST(a_lamp_in_a_mirror) {
  assert_lamp(
      "in a mirror",
      LAMP("eye: [-1.5, -0.5, 0], target: [-1.5, 0, 0]",
           "- {name: spot, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0, "
           "transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [-1.5, 1, 0]}]}\n"
           "- {name: mirror, shape: rectangle, width: 0.2, height: 0.2, mirror: 0.8, transform: "
           "[{rotate: {axis: [0, 1, 0], angle: 90}}, {rotate: {axis: [0, 0, 1], angle: -45}}, "
           "{translate: [-1.5, 0, 0]}]}\n"),
      0.8);
}

/* The sun from above, off a mirror along the mist, as in tests/gl/beams/test_beam_list.c; the eye
 * sees that in another mirror, and through a pane, from the grid. */
#define BEAM(more)                                                                                 \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0.9, -0.6, 0], target: [0.4, -0.6, 0], fov: 1}\n"                                \
  "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1, illuminant: "     \
  "D65}]\n"                                                                                        \
  "medium: {scattering: 0.8, absorption: 0.3, g: 0.4, box: [[0.2, -0.05, -0.2], [0.6, 0.05, "      \
  "0.2]]}\n"                                                                                       \
  "objects:\n"                                                                                     \
  "- {name: roof, shape: rectangle, width: 1.6, height: 2, reflectance: 0, transform: "            \
  "[{translate: [0.9, 0, 1]}]}\n"                                                                  \
  "- {name: spot, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0, transform: "      \
  "[{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [-1, -0.6, 0]}]}\n"                        \
  "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.8, transform: "           \
  "[{rotate: {axis: [0, 1, 0], angle: 45}}]}\n"                                                    \
  "- {name: other, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.5, transform: [{rotate: "  \
  "{axis: [0, 1, 0], angle: 90}}, {rotate: {axis: [0, 0, 1], angle: 45}}, {translate: [0.4, "      \
  "-0.6, 0]}]}\n" more

TEST(a_beam_in_a_mirror) {
  static const char *const panes[] = {
      BEAM(""), BEAM("- {name: pane, shape: box, size: [0.2, 0.02, 0.2], material: flat, "
                     "transform: [{translate: [0.4, -0.3, 0]}]}\n")};
  const double known =
      0.5 * 0.8 * exp(-1.1 * 0.2) * 0.8 * abbe_medium_phase(0.4, 0) * -expm1(-1.1 * 0.1) / 1.1;
  for (int i = 0; i < 2; i++) {
    const double drawn = green_of(panes[i], 96) / (i == 0 ? 1 : plate);
    print_message("a beam in a mirror%s: %.4f of the known light\n", i == 0 ? "" : ", behind glass",
                  drawn / known);
    assert_near(drawn / known, 1, 0.03);
  }
}

/* Haze between the sun and a solid lies in no shadow, however the solid is known: seen straight,
 * and mirrored on the solid's top and through it. */
TEST(haze_before_a_solid) {
  static const char text[] =
      "materials: glass.yaml\n"
      "camera: {eye: [0.4, -2.6, 2.6], target: [0.1, 0.1, 0.4], fov: 8}\n"
      "lights: [{name: sun, kind: directional, direction: [0, -1, -1.618034], irradiance: 3}]\n"
      "medium: {scattering: 0.04, g: 0.5, box: [[-1.2, -1.2, 0.63], [1.2, 1.2, 1.2]]}\n"
      "objects:\n"
      "- {name: slab, shape: box, size: [1.6, 1.6, 0.1], material: dense,\n"
      "   transform: [{translate: [0, 0, 0.5]}]}\n"
      "- {name: paper, shape: rectangle, width: 10, height: 10, reflectance: 0}\n";
  double light[2][3];
  for (int i = 0; i < 2; i++)
    mean_of(text,
            &(abbe_render_desc){.photons = 64,
                                .wavelengths = 3,
                                .space = ABBE_RGB_SPACE_REC709,
                                .model = i == 0 ? ABBE_MODEL_AUTO : ABBE_MODEL_BVH},
            light[i]);
  assert_near(light[0][1] / light[1][1], 1, 1e-2);
}
