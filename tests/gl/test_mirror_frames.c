/* Light off mirrors, and what the eye sees in them: laws of spheres, planes and closed rooms. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/upsampling.h"
#include "colorimetry/weights.h"
#include "spectral/optics.h"

#define EYE(eye, target) "materials: default\ncamera: {eye: " eye ", target: " target ", fov: 3}\n"
#define LAMP(at) "lights:\n- {name: lamp, kind: point, position: " at ", intensity: 1}\n"
#define WHITE_FLOOR                                                                                \
  "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1}\n"
#define SHINING(name, shape, at, what)                                                             \
  "- {name: " name ", " shape ", transform: [" at "], mirror: " what "}\n"
#define PANE(at, angle, what)                                                                      \
  SHINING("pane", "shape: rectangle, width: 0.8, height: 0.8",                                     \
          "{rotate: {axis: [0, 1, 0], angle: " angle "}}, {translate: " at "}", what)

static const abbe_render_desc tiny =
    FIELDS(.width = 16, .height = 16, .photons = 128, .map_size = 128, .space = ABBE_RGB_SPACE_XYZ,
           .aovs = true);

typedef struct frame {
  abbe_ledger energy;
  abbe_image picture, aovs;
} frame;

static void draw(const char *text, const abbe_render_desc *desc, frame *f) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, desc);
  f->energy = draw_frame(renderer).energy;
  f->picture = picture_of(renderer);
  f->aovs = aovs_of(renderer);
}

static void frame_free(frame *f) {
  abbe_image_free(&f->picture);
  abbe_image_free(&f->aovs);
}

/* Irradiance of a source of intensity 1 at (0, 0, 1) on a square of the floor about (x, 0, 0), its
 * mean. */
static double mean_irradiance(double x, double half) {
  enum { STEPS = 100 };
  double sum = 0;
  for (int i = 0; i < STEPS * STEPS; i++) {
    const double a = x + half * (2 * (i % STEPS + 0.5) / STEPS - 1);
    const double b = half * (2 * (i / STEPS + 0.5) / STEPS - 1);
    sum += pow(1 + a * a + b * b, -1.5);
  }
  return sum / (STEPS * STEPS);
}

GROUP(make_context, free_context);

/* A ball of radius R in an irradiance E sends rho E R^2 / 4 into every direction, from afar. The
 * eye looks down at the floor beside the ball, which is 1 m above; not where the light goes on
 * nearly straight, for there a cell of photons spreads widely. */
TEST(a_ball_shines_evenly) {
  OWNED(frame, f) = {0};
  abbe_render_desc desc = tiny;
  desc.photons = 256;
  desc.map_size = 512;
  draw("materials: default\ncamera: {eye: [-0.7, 0, 0.6], target: [-0.7, 0, 0], up: [0, 1, 0], "
       "fov: 40}\n"
       "lights:\n- {name: sun, kind: directional, direction: [0.5, 0, -1], irradiance: "
       "1}\n" WHITE_FLOOR SHINING("ball", "shape: sphere, radius: 0.005, levels: 4",
                                  "{translate: [0, 0, 1]}", "0.8"),
       &desc, &f);
  const double intensity = 0.8 * 0.005 * 0.005 / 4;
  const double known = intensity * mean_irradiance(-0.7, 0.6 * tan(20 * ABBE_PI / 180)) / ABBE_PI;
  const double seen = channel_mean(&f.aovs, "caustic.Y");
  print_message("%.4f of the ball's light\n", seen / known);
  assert_near(seen / known, 1, 0.02);
  assert_near(f.energy.absorbed / f.energy.reached, 0.2, 1e-4);
  assert_true(abbe_ledger_imbalance(&f.energy) < 1e-4);
}

/* Pixel by pixel: what pattern the grid of photons and the texels leave in light that diverges. */
TEST(a_balls_light_is_smooth) {
  enum { SIDE = 64 };
  OWNED(frame, f) = {0};
  abbe_render_desc desc = tiny;
  desc.width = desc.height = SIDE;
  desc.photons = 0; /* as by default */
  desc.map_size = 0;
  draw("materials: default\ncamera: {eye: [-0.7, 0, 0.6], target: [-0.7, 0, 0], up: [0, 1, 0], "
       "fov: 40}\n"
       "lights:\n- {name: sun, kind: directional, direction: [0.5, 0, -1], irradiance: "
       "1}\n" WHITE_FLOOR SHINING("ball", "shape: sphere, radius: 0.001, levels: 6",
                                  "{translate: [0, 0, 1]}", "0.8"),
       &desc, &f);
  const size_t channel = abbe_image_find_channel(&f.aovs, "caustic.Y");
  const double half = 0.6 * tan(20 * ABBE_PI / 180), intensity = 0.8 * 0.001 * 0.001 / 4;
  double mean = 0, square = 0, worst = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    const double x = -0.7 + half * (2 * ((double)(i % SIDE) + 0.5) / SIDE - 1);
    const double y = half * (2 * ((double)(i / SIDE) + 0.5) / SIDE - 1);
    const double known = intensity * pow(1 + x * x + y * y, -1.5) / ABBE_PI;
    const double ratio = (double)f.aovs.data[i * f.aovs.channels + channel] / known;
    mean += ratio / (SIDE * SIDE);
    square += ratio * ratio / (SIDE * SIDE);
    worst = fmax(worst, fabs(ratio - 1));
  }
  const double ripple = sqrt(fmax(square - mean * mean, 0));
  print_message("%.4f of the ball's light, %.4f off it, %.4f at the most\n", mean, ripple, worst);
  assert_near(mean, 1, 0.01);
  assert_true(ripple < 0.01 && worst < 0.035);
}

/* The pane stands at x = 0.5: light comes from the lamp, and from its image at x = 1.1. On either
 * side of the pane, for both mirror. */
static void check_pane(const char *angle) {
  FILLED(frame, f,
         draw(printed(EYE("[0.2, -0.5, 0.6]", "[0.2, 0, 0]") LAMP("[-0.1, 0.1, 0.7]")
                          WHITE_FLOOR PANE("[0.5, 0, 0.42]", "%s", "0.9"),
                      angle),
              &tiny, &f));
  double known[2];
  for (int i = 0; i < 2; i++) {
    const double x = i == 0 ? -0.1 : 1.1, r2 = (0.2 - x) * (0.2 - x) + 0.01 + 0.49;
    known[i] = (i == 0 ? 1 : 0.9) * 0.7 / (r2 * sqrt(r2)) / ABBE_PI;
  }
  const double image = channel_mean(&f.aovs, "caustic.Y"), lamp = channel_mean(&f.aovs, "direct.Y");
  print_message("%.4f of the image's light, %.4f of the lamp's\n", image / known[1],
                lamp / known[0]);
  assert_near(image / known[1], 1, 0.015);
  assert_near(lamp / known[0], 1, 2e-3);
  assert_near(f.energy.absorbed / f.energy.reached, 0.1, 1e-4);
  assert_true(abbe_ledger_imbalance(&f.energy) < 1e-4);
}

TEST(a_pane_shines_like_the_lamps_image) {
  check_pane("90");
  check_pane("-90");
}

/* Behind the pane no light comes through: neither the lamp's nor any photon's. */
TEST(a_mirrors_shadow_is_dark) {
  OWNED(frame, f) = {0};
  draw(EYE("[0.9, -0.5, 0.6]", "[0.7, 0, 0]") LAMP("[-0.1, 0.1, 0.7]")
           WHITE_FLOOR PANE("[0.5, 0, 0.42]", "90", "0.9"),
       &tiny, &f);
  assert_near(image_max(&f.picture, 1), 0, 1e-6);
}

/* But another mirror may light that shadow: two upright panes in a sun that stands at 45 degrees.
 * The left one hides the floor from 1 to 21 cm behind it, and the right one throws its light from 9
 * to 29 cm. */
TEST(a_mirrors_shadow_may_be_lit_by_another) {
  OWNED(frame, f) = {0};
  abbe_render_desc desc = tiny;
  desc.photons = 512; /* of the light's layers too: they tell where panes end, to a texel */
  draw(EYE("[0.15, -0.5, 0.6]",
           "[0.15, 0, 0]") "lights:\n- {name: sun, kind: directional, direction: [1, 0, -1], "
                           "irradiance: 1}\n" WHITE_FLOOR SHINING(
                               "left", "shape: rectangle, width: 0.2, height: 0.4",
                               "{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [0, 0, "
                               "0.11]}",
                               "0.8") SHINING("right", "shape: rectangle, width: 0.2, height: 0.4",
                                              "{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: "
                                              "[0.3, 0, 0.11]}",
                                              "0.8"),
       &desc, &f);
  const double known = 0.8 * sqrt(0.5) / ABBE_PI;
  print_message("%.4f of the light\n", channel_mean(&f.aovs, "caustic.Y") / known);
  assert_near(channel_mean(&f.aovs, "caustic.Y") / known, 1, 0.01);
  assert_near(channel_mean(&f.aovs, "direct.Y"), 0, 1e-6);
  assert_near(f.energy.deposited / (2 * 0.8 * 0.2 * 0.4 * sqrt(0.5)), 1, 5e-3);
}

/* In surroundings that are alike all around, a whole mirror is not seen: a ball, and a ring, in
 * which light goes from wall to wall. */
TEST(a_whole_mirror_is_not_seen_in_uniform_light) {
  static const char *const shape[] = {
      "shape: sphere, radius: 0.1, levels: 4",
      "shape: ring, major: 0.1, minor: 0.03, around: 48, across: 24"};
  for (int i = 0; i < 2; i++) {
    const char *text = printed(
        "materials: default\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.1], fov: 20}\n"
        "background: 2\n" LAMP(
            "[0, 0, -1]") "objects:\n- {name: speck, shape: rectangle, width: 0.001, height: "
                          "0.001, reflectance: 0.5, transform: [{translate: [0, 3, "
                          "-1]}]}\n" SHINING("body", "%s", "{translate: [0, 0, 0.1]}", "1"),
        shape[i]);
    abbe_render_desc desc = tiny;
    desc.width = desc.height = 48;
    FILLED(frame, f, draw(text, &desc, &f));
    const size_t channels = f.picture.channels;
    for (size_t k = 0; k < 48 * 48; k++)
      assert_near((double)f.picture.data[k * channels + 1], 2, 2e-3);
  }
}

/* The eye looks straight into a pane of gold and sees the surroundings in gold's own colour. */
TEST(gold_has_its_colour) {
  static const char text[] =
      "materials: default\ncamera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 3}\n"
      "background: 1\nlights:\n- {name: lamp, kind: point, position: [0, 0, -1], intensity: 1, "
      "illuminant: E}\nobjects:\n- {name: speck, shape: rectangle, width: 0.001, height: 0.001, "
      "reflectance: 0.5, transform: [{translate: [0.9, 0, -1.5]}]}\n"
      "- {name: pane, shape: rectangle, width: 1, height: 1, mirror: gold}\n";
  abbe_weights_range range;
  double known[3] = {0}, to_xyz[9], from_xyz[9], behind[3] = {0}, rgb[3], xyz[3];
  abbe_upsampling lift;
  abbe_scene scene = scene_of(text);
  abbe_weights_range_make(&scene.light[0].illuminant, 380, 780, &range);
  /* The surroundings are the working space's white, lifted to all wavelengths under the lamp's. */
  OK(abbe_upsampling_make(&scene.light[0].illuminant, 380, 780, &lift, &error));
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, to_xyz);
  for (int i = 0; i < 9; i++) behind[i / 3] += to_xyz[i];
  abbe_matrix3_invert(lift.to_xyz, from_xyz);
  abbe_rgb_space_apply(from_xyz, behind, rgb);
  for (int i = 0; i < 4000; i++) {
    double n, k;
    abbe_weights_range_xyz(&range, 380 + 0.1 * i, 380 + 0.1 * (i + 1), xyz);
    OK(abbe_material_nk(scene.object[1].conductor, 380 + 0.1 * (i + 0.5), &n, &k, &error));
    const double share = abbe_upsampling_at(&lift, rgb, 380 + 0.1 * (i + 0.5));
    for (int c = 0; c < 3; c++) known[c] += share * xyz[c] * abbe_optics_fresnel_conductor(1, n, k);
  }
  abbe_scene_free(&scene);
  abbe_render_desc desc = tiny;
  desc.wavelengths = 21; /* a band's colour and its metal's are each a mean: of 7 bands, 5e-3 */
  FILLED(frame, f, draw(text, &desc, &f));
  static const char *const names[] = {"X", "Y", "Z"};
  for (int c = 0; c < 3; c++) assert_near(channel_mean(&f.picture, names[c]) / known[c], 1, 2e-3);
}

/* Glass on silver: light goes through the glass, off the mirror, and back through the glass. */
TEST(light_goes_through_glass_off_a_mirror_and_back) {
  OWNED(frame, f) = {0};
  abbe_render_desc desc = tiny;
  desc.energy_share = 1e-4;
  desc.exits = ABBE_RENDER_MAX_EXITS;
  draw("materials: glass.yaml\ncamera: {eye: [1, -1, 0.8], target: [1, 0, 0], fov: 3}\n"
       "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n"
       "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1, "
       "transform: [{translate: [0, 0, -0.1]}]}\n"
       "- {name: foil, shape: rectangle, width: 0.4, height: 0.4, mirror: 0.9}\n"
       "- {name: slab, shape: box, size: [0.4, 0.4, 0.05], transform: [{translate: [0, 0, 0.1]}], "
       "material: flat}\n",
       &desc, &f);
  /* all of it goes up again: R of a slab, over a mirror of 0.9 */
  const double face = 0.04, slab = 2 * face / (1 + face), pass = 1 - slab;
  const double back = slab + pass * pass * 0.9 / (1 - 0.9 * slab);
  const double up = (f.energy.reflected + f.energy.missed) / f.energy.reached;
  print_message("%.5f goes back, %.5f by the closed form, %.5f trapped\n", up, back,
                f.energy.trapped / f.energy.reached);
  assert_near(up + f.energy.trapped / f.energy.reached, back, 3e-3);
  assert_true(f.energy.trapped < 3e-3 * f.energy.reached);
  assert_true(f.energy.deposited < 1e-4 * f.energy.reached);
  assert_true(abbe_ledger_imbalance(&f.energy) < 1e-4);
}

/* Dispersed and coloured light, off gold, through glass, on meshes that are open. */
TEST(the_ledger_closes) {
  OWNED(frame, f) = {0};
  draw(EYE("[0.2, -0.5, 0.6]", "[0.2, 0, 0]") LAMP("[-0.1, 0.1, 0.7]")
           WHITE_FLOOR PANE("[0.5, 0, 0.42]", "80", "gold")
               SHINING("ring", "shape: ring, major: 0.1, minor: 0.02, around: 48, across: 24",
                       "{translate: [-0.3, 0, 0.1]}",
                       "copper") "- {name: ball, shape: sphere, radius: 0.08, transform: "
                                 "[{translate: [0.2, 0, 0.2]}], material: n-sf11}\n",
       &tiny, &f);
  print_message("imbalance %.2g\n", abbe_ledger_imbalance(&f.energy));
  assert_true(abbe_ledger_imbalance(&f.energy) < 1e-4);
  assert_true(f.energy.absorbed > 0.05 * f.energy.reached);
  assert_true(f.energy.deposited > 0.1 * f.energy.reached);
}
