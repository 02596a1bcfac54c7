/* Rough faces and haze in refractors: every watt is in the ledger, what scatters nothing away
 * cannot be seen in even surroundings, and photons and paths of the camera agree. */
#include "tests/validation/trace/walks/light_walks.h"

#include "tests/validation/trace_scene.h"

#define SCENE "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR

static const char *const bodies[] = {
    "n-bk7, roughness: 0.3",
    "calcite, axis: [1, 0.3, 0.5], roughness: [{alpha: 1, faces: table}]",
    "n-bk7, coating: {layers: [[1.38, 99.6]]}, roughness: 0.5",
    "n-bk7, medium: {scattering: 12, g: 0.5}",
    "calcite, axis: [1, 0.3, 0.5], medium: {scattering: [[400, 20], [700, 10]], g: -0.4}",
    "n-bk7, roughness: 0.2, medium: {scattering: 5}, clouds: [{centre: [0, 0, 0], radius: 0.03, "
    "medium: {scattering: 40, g: 0.9}}, {centre: [0.08, 0.05, 0], size: [0.05, 0.1, 0.04]}]",
};
enum { BODIES = sizeof bodies / sizeof *bodies };

TEST(every_watt_is_in_the_ledger) {
  for (int i = 0; i < BODIES; i++) {
    FREED fixture *f = malloc(sizeof *f);
    make(printed(SCENE SLAB("%s"), bodies[i]), NULL, f);
    flood(f, 8);
    const abbe_light_ledger *l = &f->ledger;
    assert_near(l->deposited + l->absorbed + l->missed + l->lost, l->reached, 1e-5 * l->reached);
    assert_true(l->lost <= 1e-3 * l->reached);
    assert_true(l->scattered == 0);
    if (i < 3) assert_near(l->frosted, i == 1 ? l->frosted : l->reached, 1e-6 * l->reached);
    assert_true(i < 3 ? l->turned == 0 : l->turned > 0.2 * l->reached);
    assert_true(l->turned <= l->reached && l->frosted <= l->reached);
    fixture_free(f);
  }
}

/* Mean Y of a small picture, and its standard error, over passes. */
static double mean_of(const char *text, size_t passes, double *standard_error) {
  OWNED(abbe_scene, scene) = scene_of(text);
  abbe_tracer *tracer = make_tracer(&scene, &(abbe_trace_desc){.width = 8,
                                                               .height = 8,
                                                               .no_map = true,
                                                               .threads = 1,
                                                               .photons = 4096,
                                                               .space = ABBE_RGB_SPACE_XYZ});
  double sum = 0, square = 0, before = 0;
  for (size_t p = 1; p <= passes; p++) {
    run_passes(tracer, 1);
    MADE(abbe_image, picture, abbe_tracer_picture(tracer, &picture, &error));
    const double total = channel_sum(&picture, "Y") / 64 * (double)p, own = total - before;
    sum += own;
    square += own * own;
    before = total;
  }
  abbe_tracer_free(tracer);
  const double n = (double)passes, mean = sum / n;
  *standard_error = sqrt(fmax(square / n - mean * mean, 0) / (n - 1));
  return mean;
}

TEST(even_surroundings_hide_it) {
  for (int i = 0; i < BODIES; i++)
    for (int sky = 0; sky < 2; sky++) {
      double spread = 0;
      const double y = mean_of(
          printed("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.3], fov: 6}\n%s\nlights: [{name: "
                  "far, kind: point, position: [3, 3, 3], intensity: 1e-9}]\nobjects:\n" SLAB(
                      "%s") "- {name: floor, shape: rectangle, width: 0.001, height: 0.001, "
                            "reflectance: 0}\n",
                  sky == 0 ? "background: 1" : "environment: {size: 64, uniform: 1}", bodies[i]),
          16, &spread);
      assert_true(spread < 0.02);
      assert_near(y, 1, 4.6 * spread + 2e-3);
    }
}

/* A beam on the top of a slab that scatters, into a floor below: what the camera sees of the floor
 * and what photons bring there are one light. */
TEST(a_lamp_lights_frost_and_haze_as_a_wide_one_does) {
  static const char *const lit[] = {"n-bk7, roughness: {alpha: 0.4, faces: table}",
                                    "n-bk7, medium: {scattering: 8}"};
  /* a point without size is found by looks and photons, a small disk of the same light by paths */
  static const char *const lamps[] = {
      "kind: point, position: [0, 0, 1.3], intensity: 1",
      "kind: disk, position: [0, 0, 1.3], direction: [0, 0, -1], radius: 0.2, radiance: 7.9577"};
  for (int i = 0; i < 2; i++) {
    double y[2], spread[2];
    for (int lamp = 0; lamp < 2; lamp++)
      y[lamp] = mean_of(
          printed("camera: {eye: [0.05, 0, 2.3], target: [0, 0, 0.3], up: [0, 1, 0], fov: 2}\n"
                  "lights: [{name: lamp, %s}]\nobjects:\n" SLAB(
                      "%s") "- {name: floor, shape: rectangle, width: 9, height: 9, reflectance: "
                            "0}\n",
                  lamps[lamp], lit[i]),
          64, &spread[lamp]);
    assert_true(y[0] > 0 && spread[0] + spread[1] < 0.1 * y[0]);
    assert_near(y[0], y[1], 4.2 * hypot(spread[0], spread[1]) + 0.06 * y[0]);
  }
}
