/* The colour of a coloured plate before a white background, straight on, against the integral of
 * Fresnel's and Beer and Lambert's laws over the spectrum: alone, and beside what makes the
 * renderer follow light from interface to interface; of cut stones in such company, traced; and
 * of glow. */
#include "tests/gl/frame.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/difference.h"
#include "colorimetry/observer.h"
#include "colorimetry/weights.h"

enum { FINE = 1000, SIDE = 8 };

static const char BESIDE_GLASS[] =
    "- {name: ball, shape: sphere, radius: 0.01, centre: [0.5, 0, 0], material: n-bk7}\n";
static const char BESIDE_GOLD[] =
    "- {name: ball, shape: sphere, radius: 0.01, centre: [0.5, 0, 0], mirror: gold}\n";

static void load_plate(const char *stone, double thickness_m, const char *beside,
                       abbe_scene *scene) {
  *scene = scene_of(
      printed("camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 1}\nbackground: 1\n"
              "lights:\n"
              "- {name: aside, kind: spot, position: [3, 3, 1], target: [4, 4, 0], cone: 5,\n"
              "   intensity: 1}\n"
              "objects:\n"
              "- {name: plate, shape: box, size: [0.2, 0.2, %g], material: %s}\n%s- {name: corner, "
              "shape: rectangle, width: 0.002, height: 0.002, reflectance: 0.5,\n"
              "   transform: [{translate: [0.016, 0.016, -1]}]}\n",
              thickness_m, stone, beside));
}

/* What of the light goes on to the background, through the plate or back off its faces: the mean of
 * fields along x and y, each along one of the stone's axes. */
static double seen_at(const abbe_object *plate, double thickness_m, double lambda_nm) {
  double sum = 0;
  for (int field = 0; field < 2; field++) {
    const bool along_z = fabs(plate->axis[field]) > 0.5, along_x = fabs(plate->axis_x[field]) > 0.5;
    const bool biaxial = abbe_material_is_biaxial(plate->material);
    const int axis = along_z ? 2 : along_x || !biaxial ? 0 : 1;
    double n;
    OK(abbe_material_n_along(plate->material, axis, lambda_nm, &n, &error));
    const double r = pow((n - 1) / (n + 1), 2);
    const double e =
        exp(-thickness_m * abbe_material_attenuation_along(plate->material, axis, lambda_nm));
    sum += 0.5 * (r + (1 - r) * (1 - r) * e * (1 + r * e) / (1 - r * r * e * e));
  }
  return sum;
}

/* X, Y and Z, each of 1 in the light. */
static void integrate(const abbe_scene *scene, double thickness_m, double out[3], double white[3]) {
  abbe_weights_range range;
  abbe_weights_range_make(abbe_scene_illuminant(scene), 380, 780, &range);
  double sum[3] = {0};
  for (int c = 0; c < 3; c++) white[c] = 0;
  for (int i = 0; i < FINE; i++) {
    const double from = 380 + 400.0 * i / FINE, to = 380 + 400.0 * (i + 1) / FINE;
    double xyz[3];
    abbe_weights_range_xyz(&range, from, to, xyz);
    for (int c = 0; c < 3; c++) {
      white[c] += xyz[c];
      sum[c] += xyz[c] * seen_at(&scene->object[0], thickness_m, 0.5 * (from + to));
    }
  }
  for (int c = 0; c < 3; c++) out[c] = sum[c] / white[c];
}

/* The dominant wavelength, or of a purple the one of what it lacks. */
static double dominant_of(const double xyz[3], const double white[3], bool purple) {
  double xy[2], white_xy[2];
  abbe_dominant dominant;
  assert_true(abbe_chromaticity_xy(xyz, xy) && abbe_chromaticity_xy(white, white_xy));
  assert_true(abbe_chromaticity_dominant(xy, white_xy, ABBE_OBSERVER_CIE_1931, &dominant));
  return purple ? dominant.complementary_nm : dominant.lambda_nm;
}

/* coarse: as while something moves; paths then end below a twentieth of their light, or a tenth. */
static void hold(const char *stone, double thickness_m, const char *beside, size_t wavelengths,
                 size_t samples, abbe_coarse coarse) {
  abbe_render_desc desc =
      FIELDS(.width = SIDE, .height = SIDE, .wavelengths = wavelengths, .supersample = samples,
             .coarse = coarse, .space = ABBE_RGB_SPACE_XYZ);
  double wanted[3], white[3], got[3] = {0}, lab[2][3];
  FILLED(abbe_scene, scene, load_plate(stone, thickness_m, beside, &scene));
  integrate(&scene, thickness_m, wanted, white);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, image) = picture_of(renderer);
  for (size_t y = 2; y < SIDE - 2; y++) /* a receiver is in a corner */
    for (size_t x = 2; x < SIDE - 2; x++)
      for (size_t c = 0; c < 3; c++)
        got[c] +=
            (double)image.data[(y * SIDE + x) * image.channels + c] / ((SIDE - 4) * (SIDE - 4));
  for (int c = 0; c < 3; c++) wanted[c] *= white[c];
  abbe_difference_lab(got, white, lab[0]);
  abbe_difference_lab(wanted, white, lab[1]);
  const bool purple = isnan(dominant_of(wanted, white, false));
  const double hue = dominant_of(got, white, purple), right = dominant_of(wanted, white, purple);
  print_message("%s, %g mm: %.1f nm, %.1f by the closed form; %.2f CIEDE2000\n", stone,
                1e3 * thickness_m, hue, right, abbe_difference_ciede2000(lab[0], lab[1]));
  assert_near(hue, right, 0.6);
  assert_true(abbe_difference_ciede2000(lab[0], lab[1]) < 0.15);
}

GROUP(make_context, free_context);

TEST(a_plate_alone_has_its_colour) {
  hold("ruby", 0.006, "", 4, 2, ABBE_COARSE_NONE);
  hold("emerald", 0.02, "", 4, 2, ABBE_COARSE_NONE);
}

TEST(a_plate_beside_glass_has_its_colour) {
  hold("ruby", 0.006, BESIDE_GLASS, 4, 2, ABBE_COARSE_NONE);
  hold("ruby", 0.003, BESIDE_GLASS, 7, 2, ABBE_COARSE_NONE);
  hold("emerald", 0.006, BESIDE_GLASS, 7, 2, ABBE_COARSE_NONE);
}

TEST(a_plate_beside_a_mirror_has_its_colour) {
  hold("ruby", 0.006, BESIDE_GOLD, 4, 2, ABBE_COARSE_NONE);
}

/* Looked at along an axis and across it: the colours are up to tens of CIELAB units apart. */
TEST(a_pleochroic_plate_has_the_colour_of_each_direction) {
  hold("ruby, axis: [1, 0, 0]", 0.006, "", 4, 2, ABBE_COARSE_NONE);
  hold("emerald, axis: [0, 1, 0]", 0.006, "", 4, 2, ABBE_COARSE_NONE);
  hold("tourmaline-green, axis: [0, 0, 1]", 0.003, "", 4, 2, ABBE_COARSE_NONE);
  hold("tourmaline-green, axis: [1, 0, 0]", 0.003, BESIDE_GLASS, 7, 2, ABBE_COARSE_NONE);
  hold("tanzanite, axes: {x: [1, 0, 0], z: [0, 0, 1]}", 0.006, "", 7, 2, ABBE_COARSE_NONE);
  hold("tanzanite, axes: {x: [0, 0, 1], z: [0, 1, 0]}", 0.006, "", 4, 2, ABBE_COARSE_NONE);
  hold("tanzanite, axes: {x: [0, 1, 0], z: [1, 0, 0]}", 0.006, BESIDE_GOLD, 4, 2, ABBE_COARSE_NONE);
}

TEST(a_plate_has_its_colour_while_it_moves) {
  hold("ruby", 0.006, "", 4, 1, ABBE_COARSE_ALL);
  hold("ruby", 0.003, "", 4, 1, ABBE_COARSE_ALL);
  hold("emerald", 0.006, "", 4, 1, ABBE_COARSE_ALL);
  hold("ruby", 0.006, BESIDE_GLASS, 4, 1, ABBE_COARSE_ALL);
  hold("emerald", 0.006, BESIDE_GOLD, 4, 1, ABBE_COARSE_ALL);
}

/* Means of the pixels 22,14 to 42,34 as abbe trace has them after 2,800 passes of 64 photons
 * (emerald 3,600, sapphire 1,600), which know the dominant wavelengths to 0.4 nm. */
static const struct {
  const char *stone;
  double traced[3];
} cut[] = {{"ruby", {0.204146, 0.174133, 0.157598}},
           {"emerald", {0.229602, 0.316950, 0.257664}},
           {"sapphire-blue", {0.305415, 0.308923, 0.654459}}};

TEST(a_cut_stone_beside_a_ball_has_its_hue) {
  static const double white[3] = {0.9505, 1, 1.089};
  for (size_t i = 0; i < sizeof cut / sizeof *cut; i++) {
    abbe_image image;
    double got[3] = {0};
    draw_text(printed("camera: {eye: [0, -0.03, 0.03], target: [0, 0, 0.003], fov: 14}\n"
                      "environment: {uniform: 1}\nobjects:\n"
                      "- {name: stone, shape: brilliant, diameter: 0.006, centre: [0, 0, 0.004], "
                      "material: %s}\n"
                      "- {name: ball, shape: sphere, radius: 0.001, centre: [0.03, 0.03, 0.02], "
                      "material: n-bk7}\n"
                      "- {name: paper, shape: rectangle, width: 0.3, height: 0.3, reflectance: "
                      "0.5}\n",
                      cut[i].stone),
              &(abbe_render_desc){.width = 64, .height = 64, .space = ABBE_RGB_SPACE_XYZ}, &image);
    for (size_t y = 14; y <= 34; y++)
      for (size_t x = 22; x <= 42; x++)
        for (size_t c = 0; c < 3; c++)
          got[c] += (double)image.data[(y * 64 + x) * image.channels + c] / (21 * 21);
    abbe_image_free(&image);
    const double hue = dominant_of(got, white, false);
    const double right = dominant_of(cut[i].traced, white, false);
    print_message("%s: %.1f nm, %.1f traced; %.3f of the light\n", cut[i].stone, hue, right,
                  got[1] / cut[i].traced[1]);
    assert_near(hue, right, 1.4);
    assert_near(got[1], cut[i].traced[1], 0.02 * got[1]);
  }
}

/* ---- glow ---- */

enum { GLOW_SIDE = 8, GLOW_N = 3 }; /* an index of 3 / 2 */

/* Excited alike at all wavelengths up to 500 nm, it emits a triangle from 600 to 620. */
static void glow_by(double per_m, abbe_material *m) {
  static const double nm[3] = {600, 610, 620}, photons[3] = {0, 1, 0}, below[2] = {400, 500};
  static char name[] = "glowing";
  const double taken[2] = {per_m, per_m};
  *m = (abbe_material){.name = name,
                       .min_nm = 300,
                       .max_nm = 900,
                       .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1}};
  m->dispersion.c[0] = GLOW_N / 2.0;
  m->fluorescence.yield = 0.8;
  OK(abbe_spectrum_make(below, taken, 2, ABBE_INTERPOLATION_LINEAR, &m->fluorescence.excitation,
                        &error));
  OK(abbe_spectrum_make(nm, photons, 3, ABBE_INTERPOLATION_LINEAR, &m->fluorescence.emission,
                        &error));
}

/* Y that a photon a second and area of 450 nm comes to, all of them emitted. */
static double emitted_y(void) {
  double sum = 0, xyz[3];
  for (int i = 0; i < FINE; i++) {
    const double share = (i + 0.5) / FINE, nm = 600 + 20 * share;
    abbe_observer_xyz_of(ABBE_OBSERVER_CIE_1931, nm, xyz);
    sum += (2 - fabs(4 * share - 2)) / FINE * xyz[1] / nm;
  }
  abbe_observer_xyz_of(ABBE_OBSERVER_CIE_1931, 450, xyz);
  return sum * 450 / xyz[1];
}

/* Mean Y that the camera sees in the middle of the first object, which glows. */
static double glow_seen(double per_m, const char *text) {
  const abbe_render_desc desc = {.width = GLOW_SIDE,
                                 .height = GLOW_SIDE,
                                 .wavelengths = 7,
                                 .min_nm = 440,
                                 .max_nm = 640,
                                 .supersample = 1,
                                 .space = ABBE_RGB_SPACE_XYZ};
  abbe_material material;
  double got = 0;
  OWNED(abbe_scene, scene) = scene_of(text);
  glow_by(per_m, &material);
  scene.object[0].material = &material;
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, image) = picture_of(renderer);
  for (size_t i = 0; i < GLOW_SIDE * GLOW_SIDE; i++)
    got += (double)image.data[i * image.channels + 1] / (GLOW_SIDE * GLOW_SIDE);
  abbe_spectrum_free(material.fluorescence.excitation);
  abbe_spectrum_free(material.fluorescence.emission);
  return got;
}

/* Light of 1 W/m2 meets the plate straight on, and so does the camera: its path goes to and fro,
 * as the light does, and comes to all of the glow. */
static void hold_glow(double depth, const char *beside) {
  const double thickness_m = 0.02, r = pow((GLOW_N - 2.0) / (GLOW_N + 2), 2), e = exp(-depth);
  const double taken = (1 - r) * (1 - e) / (1 - r * e);
  const double wanted = 0.8 * taken * emitted_y() / (4 * ABBE_PI) / (GLOW_N * GLOW_N / 4.0);
  const double got = glow_seen(
      depth / thickness_m,
      printed("camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 2}\n"
              "lights:\n"
              "- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1,\n"
              "   illuminant: 450nm}\n"
              "objects:\n"
              "- {name: plate, shape: box, size: [0.2, 0.2, %g], material: n-bk7}\n%s"
              "- {name: corner, shape: rectangle, width: 0.002, height: 0.002, reflectance: 0,\n"
              "   transform: [{translate: [0.03, 0.03, -1]}]}\n",
              thickness_m, beside));
  print_message("a depth of %g: Y of %.4f, %.4f by the closed form\n", depth, got, wanted);
  assert_near(got / wanted, 1, 0.02);
}

TEST(a_plate_glows) {
  hold_glow(0.2, "");
  hold_glow(4, "");
  hold_glow(0.2, BESIDE_GLASS);
  hold_glow(4, BESIDE_GOLD);
}

TEST(glow_keeps_to_light_of_any_power) {
  static const double radiance[] = {1, 1e-7, 1e7};
  double share[3];
  for (int i = 0; i < 3; i++) {
    share[i] =
        glow_seen(
            200,
            printed("camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 2}\n"
                    "environment: {uniform: %g}\nobjects:\n"
                    "- {name: plate, shape: box, size: [0.2, 0.2, 0.02], material: n-bk7}\n"
                    "- {name: black, shape: rectangle, width: 0.2, height: 0.2, reflectance: 0,\n"
                    "   transform: [{translate: [0, 0, -1]}]}\n",
                    radiance[i])) /
        radiance[i];
    print_message("a radiance of %g: Y of %.5f of it\n", radiance[i], share[i]);
    assert_near(share[i] / share[0], 1, 1e-4);
  }
}
