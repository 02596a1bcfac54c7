/* What receivers reflect, in renderer and tracer: of light of a known spectrum the integral, in
 * every working space. */
#include "tests/gl/frame.h"

#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "tests/validation/trace_scene.h"

/* Seen straight, and lit at right angles: the radiance is the irradiance times the reflectance over
 * pi. */
#define CARD(light, reflectance)                                                                   \
  "materials: glass.yaml\ncamera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 20}\n"   \
  "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 3.14159265, "      \
  "illuminant: " light "}\n"                                                                       \
  "objects:\n- {name: card, shape: rectangle, width: 2, height: 2, reflectance: " reflectance      \
  "}\n"

static void mean_xyz(const abbe_image *image, abbe_rgb_space space, double xyz[3]) {
  double to_xyz[9], rgb[3] = {0};
  for (size_t k = 0; k < 3; k++) {
    const char name[2] = {(space == ABBE_RGB_SPACE_XYZ ? "XYZ" : "RGB")[k], '\0'};
    const size_t channel = abbe_image_find_channel(image, name);
    assert_true(channel < image->channels);
    rgb[k] = image_sum(image, channel) / (double)(image->width * image->height);
  }
  abbe_rgb_space_to_xyz(space, to_xyz);
  abbe_rgb_space_apply(to_xyz, rgb, xyz);
}

static void render_xyz(const abbe_scene *scene, abbe_rgb_space space, double xyz[3]) {
  const abbe_render_desc desc = {.width = 16, .height = 16, .space = space, .adaptive = 1};
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, &desc);
  OWNED(abbe_image, image) = picture_of(renderer);
  mean_xyz(&image, space, xyz);
}

static void trace_xyz(const abbe_scene *scene, abbe_rgb_space space, size_t passes, double xyz[3]) {
  const abbe_trace_desc desc = {
      .width = 16, .height = 16, .no_map = true, .space = space, .photons = 4096, .threads = 1};
  OWNED(abbe_image, image) = traced_picture(scene, &desc, passes);
  mean_xyz(&image, space, xyz);
}

static void integrate(const abbe_scene *scene, double xyz[3]) {
  const abbe_illuminant *light = &scene->light[0].illuminant;
  double white = 0;
  for (int k = 0; k < 3; k++) xyz[k] = 0;
  for (double nm = 380.05; nm < 780; nm += 0.1) {
    double observer[3];
    abbe_observer_xyz(nm, observer);
    const double power = abbe_illuminant_power(light, nm);
    white += power * observer[1];
    for (int k = 0; k < 3; k++)
      xyz[k] += power * observer[k] * abbe_spectrum_at(scene->object[0].spectrum, nm);
  }
  for (int k = 0; k < 3; k++) xyz[k] /= white;
}

GROUP(make_context, free_context);

TEST(flat_patches_show_the_integral) {
  static const char *const texts[] = {
      CARD("D65", "{patch: red}"),     CARD("A", "{patch: red}"),
      CARD("F11", "{patch: red}"),     CARD("A", "{patch: cyan}"),
      CARD("F11", "{patch: foliage}"), CARD("LED-B3", "{patch: purple}")};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    double wanted[3], drawn[3], traced[3];
    OWNED(abbe_scene, scene) = scene_of(texts[i]);
    integrate(&scene, wanted);
    render_xyz(&scene, ABBE_RGB_SPACE_ACESCG, drawn);
    trace_xyz(&scene, ABBE_RGB_SPACE_ACESCG, 1, traced);
    for (int k = 0; k < 3; k++) {
      assert_near(drawn[k], wanted[k], 2e-5);
      assert_near(traced[k], wanted[k], 2e-5);
    }
  }
}

TEST(lifted_colours_are_the_same_in_both) {
  static const char *const lights[] = {CARD("A", "[0.7, 0.3, 0.1]"), CARD("F2", "[0.1, 0.6, 0.2]"),
                                       CARD("D65", "[0.1, 0.2, 0.8]")};
  for (size_t i = 0; i < 3; i++) {
    double drawn[3], traced[3];
    OWNED(abbe_scene, scene) = scene_of(lights[i]);
    render_xyz(&scene, ABBE_RGB_SPACE_REC709, drawn);
    trace_xyz(&scene, ABBE_RGB_SPACE_REC709, 1, traced);
    for (int k = 0; k < 3; k++) assert_near(drawn[k], traced[k], 3e-5);
  }
}

/* Straight down on a place of a floor with a texture of 2 x 2 texels. */
static void see_place(double x, double y, const char *repeat, double xyz[3]) {
  OWNED(abbe_scene, scene) = scene_of(printed(
      "materials: glass.yaml\ncamera: {eye: [%g, %g, 1], target: [%g, %g, 0], up: [0, 1, 0], fov: "
      "1}\n"
      "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 3.14159265}\n"
      "objects:\n- {name: card, shape: rectangle, width: 2, height: 2, reflectance: 1, "
      "texture: " ABBE_SOURCE_DIR "/tests/fuzz/parts/dot.png%s}\n",
      x, y, x, y, repeat));
  render_xyz(&scene, ABBE_RGB_SPACE_REC709, xyz);
}

/* Twice across and three times along: there is what the whole texture has at so many times the
 * place, a texel's middle in both. */
TEST(textures_are_repeated) {
  double repeated[3], once[3], there[3], differs = 0;
  see_place(-0.25, -0.5, ", repeat: [2, 3]", repeated);
  see_place(0.5, 0.5, "", once);
  see_place(-0.25, -0.5, "", there);
  for (int k = 0; k < 3; k++) {
    assert_near(repeated[k], once[k], 0.02);
    differs = fmax(differs, fabs(repeated[k] - there[k]));
  }
  assert_true(differs > 0.1);
}

#define ROOM                                                                                       \
  "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\nambient: 0.3\n"       \
  "background: 0.2\n"                                                                              \
  "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1, illuminant: "   \
  "A}\n"                                                                                           \
  "- {name: sun, kind: directional, direction: [0.1, 0.2, -1], irradiance: 1, illuminant: F2}\n"   \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: [0.8, 0.3, "      \
  "0.1], "                                                                                         \
  "texture: " ABBE_SOURCE_DIR "/scenes/wood.png}\n"                                                \
  "- {name: card, shape: rectangle, width: 0.3, height: 0.3, transform: [{translate: [0.4, 0, "    \
  "0.01]}], reflectance: {patch: blue sky}}\n" BALL("crown")

/* The XYZ of a whole scene, with caustics and what is seen through glass; where more rays are sent
 * is decided by colours of the space, so none are. */
TEST(the_space_does_not_change_the_light) {
  double xyz[ABBE_RGB_SPACE_COUNT][3], traced[ABBE_RGB_SPACE_COUNT][3];
  OWNED(abbe_scene, scene) = scene_of(ROOM);
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    render_xyz(&scene, (abbe_rgb_space)s, xyz[s]);
    trace_xyz(&scene, (abbe_rgb_space)s, 1, traced[s]);
  }
  for (int s = 1; s < ABBE_RGB_SPACE_COUNT; s++)
    for (int k = 0; k < 3; k++) {
      assert_near(xyz[s][k] / xyz[0][k], 1, 2e-5);
      assert_near(traced[s][k] / traced[0][k], 1, 2e-5);
    }
}
