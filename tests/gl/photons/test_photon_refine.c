/* Photons that take more wavelengths only where their hits ask for them. */
#include "tests/gl/frame.h"

#include "colorimetry/weights.h"
#include "spectral/optics.h"

/* layout: of the map, where it is not all zero; else it is set to the one that was fitted. May be
 * NULL. */
static abbe_ledger draw(const char *name, size_t wavelengths, abbe_fill fill,
                        abbe_map_layout *layout, abbe_image *map) {
  OWNED(abbe_scene, scene) = shipped_scene(name);
  look_aside(&scene);
  abbe_render_desc desc = FIELDS(.width = 16, .height = 16, .photons = 64, .map_size = 64,
                                 .fill = fill, .wavelengths = wavelengths);
  static const abbe_map_layout unknown;
  const bool given = layout != NULL && memcmp(layout, &unknown, sizeof unknown) != 0;
  if (given) desc.map_layout = layout;
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  const abbe_statistics statistics = draw_frame(renderer);
  if (map != NULL) *map = map_of(renderer, 0);
  if (layout != NULL && !given) abbe_renderer_map_layout(renderer, 0, layout);
  return statistics.energy;
}

GROUP(make_context, free_context);

/* All of the light is entered once, by the set that it was laid with. */
TEST(every_photon_is_entered_once) {
  static const char *const names[] = {"gem", "prism", "sphere"};
  for (size_t i = 0; i < 3; i++) {
    const abbe_ledger l = draw(names[i], 25, ABBE_FILL_BRIDGE, NULL, NULL);
    assert_true(l.reached > 0);
    assert_true(abbe_ledger_imbalance(&l) < 1e-4);
    assert_true(fabs(l.interpolated) < 1e-3 * l.reached);
  }
}

/* N-SF11 absorbs violet by tens in a metre and green by ones. What few wavelengths leave of it, and
 * 21 that are traced only where hits ask, is what 61 of all photons do, to one in a thousand of
 * the light: attenuation at the seven nodes alone would take three more. */
TEST(absorption_is_that_of_all_wavelengths) {
  static const size_t counts[] = {7, 21};
  abbe_map_layout layout = {0}; /* and with it the photons' grid: all trace the same */
  const abbe_ledger all = draw("gem", 61, ABBE_FILL_NONE, &layout, NULL);
  assert_true(all.absorbed > 0.05 * all.reached);
  for (size_t i = 0; i < 2; i++) {
    const abbe_ledger some = draw("gem", counts[i], ABBE_FILL_BRIDGE, &layout, NULL);
    print_message("absorbed: %.4f %% of 61, %.4f %% of %zu\n", 100 * all.absorbed / all.reached,
                  100 * some.absorbed / some.reached, counts[i]);
    assert_near(some.absorbed / some.reached, all.absorbed / all.reached, 0.001);
    /* So is what lies in the map: what the ledger keeps as interpolated corrects the few
     * wavelengths' own sum, and adds no light. Few follow long paths a little less far. */
    print_message(
        "deposited: %.4f %% of 61, %.4f %% of %zu, %.4f interpolated; trapped %.4f, %.4f\n",
        100 * all.deposited / all.reached, 100 * some.deposited / some.reached, counts[i],
        100 * some.interpolated / some.reached, 100 * all.trapped / all.reached,
        100 * some.trapped / some.reached);
    assert_near(some.deposited / some.reached, all.deposited / all.reached, 5e-4);
    assert_near(some.trapped / some.reached, all.trapped / all.reached, 1e-3);
  }
}

enum { BANDS = 16, FINE_STEPS = 64 };

/* What a pane passes of light that meets it straight, with all reflections inside. */
static double passed(const abbe_material *material, double lambda_nm, double thickness) {
  double n = 1;
  abbe_material_n(material, lambda_nm, &n, NULL);
  const double r = abbe_optics_fresnel(1, 1 / n);
  const double left = exp(-abbe_material_attenuation(material, lambda_nm) * thickness);
  return (1 - r) * (1 - r) * left / (1 - r * r * left * left);
}

/* Beer and Lambert's law in a pane that lets a third of the violet through, in XYZ and in bands. A
 * part of a wavelength's band, 12.5 nm at the most, has one attenuation for all its light, X + Y +
 * Z. What one of these or a band of even power would take for its own is that of a place some 3 nm
 * off, of 0.6 more or less a metre, which makes up to 2 % of a band's light where most is taken in
 * 0.06 m; in a colour's sum both signs are left, and a tenth of it. */
TEST(a_pane_leaves_what_the_law_says) {
  static const size_t counts[] = {7, 21, 64};
  const double thickness = 0.06;
  OWNED(abbe_scene, scene) = scene_of(
      "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
      "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n" FLOOR
      "- {name: pane, shape: box, size: [0.2, 0.2, 0.06], material: murk,\n"
      "   transform: [{translate: [0, 0, 0.2]}]}\n");
  look_aside(&scene);
  const abbe_illuminant *light = &scene.light[0].illuminant;
  double sum[3] = {0}, white[3] = {0}, band[BANDS] = {0};
  for (size_t k = 0; k < BANDS * FINE_STEPS; k++) {
    const double width = 400.0 / (BANDS * FINE_STEPS), from = 380 + width * (double)k;
    const double left = passed(scene.object[1].material, from + 0.5 * width, thickness);
    double xyz[3];
    abbe_weights_band_xyz(light, 380, 780, from, from + width, xyz);
    band[k / FINE_STEPS] +=
        left * abbe_weights_band_power(light, 380, 780, from, from + width) / (400.0 / BANDS);
    for (int c = 0; c < 3; c++) white[c] += xyz[c];
    for (int c = 0; c < 3; c++) sum[c] += left * xyz[c];
  }
  for (size_t i = 0; i < 3; i++) {
    abbe_render_desc desc = small_frame;
    desc.wavelengths = counts[i];
    desc.energy_share = 1e-6;
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    const abbe_ledger l = draw_frame(renderer).energy;
    assert_near(l.deposited / l.reached, sum[1] / white[1], 1e-3);
    assert_true(abbe_ledger_imbalance(&l) < 1e-5);
    MADE(abbe_image, map, abbe_renderer_read_map_bands(renderer, 0, BANDS, &map, &error));
    const double reached = image_sum(&map, 1) / (l.deposited / l.reached);
    for (size_t c = 0; c < 3; c++)
      assert_near(image_sum(&map, c) / reached, sum[c] / white[1], 2e-3);
    for (size_t k = 0; k < BANDS; k++)
      assert_near(image_sum(&map, 3 + k) / reached, band[k] / white[1], 0.02 * band[k] / white[1]);
  }
}

static double difference(const abbe_image *a, const abbe_image *b) {
  double sum = 0, square = 0;
  for (size_t i = 0; i < a->width * a->height * a->channels; i++) {
    sum += pow((double)a->data[i] - (double)b->data[i], 2);
    square += pow((double)b->data[i], 2);
  }
  return sqrt(sum / square);
}

/* 200 wavelengths are as good as all. The prism's spectrum is some forty texels long: five
 * wavelengths bend it off by a few of them, which those between set right. (Maps that are not
 * bridged differ from all these by the gaps between photons, which are more.) */
TEST(refined_maps_are_those_of_all_wavelengths) {
  static const char *const names[] = {"gem", "prism"};
  for (size_t i = 0; i < 2; i++) {
    OWNED(abbe_image, all) = {0}, few = {0}, refined = {0}, again = {0};
    abbe_map_layout layout = {0}; /* all maps lie alike: what differs is their light */
    draw(names[i], 200, ABBE_FILL_BRIDGE, &layout, &all);
    draw(names[i], 5, ABBE_FILL_BRIDGE, &layout, &few);
    draw(names[i], 25, ABBE_FILL_BRIDGE, &layout, &refined);
    draw(names[i], 25, ABBE_FILL_BRIDGE, &layout, &again);
    print_message("%s: %g with five, %g refined\n", names[i], difference(&few, &all),
                  difference(&refined, &all));
    assert_true(difference(&refined, &all) < 0.15 * difference(&few, &all));
    assert_memory_equal(refined.data, again.data,
                        refined.width * refined.height * refined.channels * sizeof *refined.data);
  }
}

/* More wavelengths in an interval than in the coarse set, and paths that few of them take: what is
 * read of the coarse hits is the photon's own, in whatever order photons stand. */
TEST(a_mesh_is_refined_alike_every_time) {
  abbe_image map[2] = {{0}, {0}};
  abbe_render_desc desc = small_frame;
  desc.width = desc.height = 16;
  desc.photons = 64;
  desc.wavelengths = 28;
  OWNED(abbe_scene, scene) = shipped_scene("bunny");
  look_aside(&scene);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  for (int i = 0; i < 2; i++) {
    abbe_renderer_redraw(renderer);
    draw_frame(renderer);
    map[i] = map_of(renderer, 0);
  }
  abbe_renderer_free(renderer);
  assert_same_pixels(&map[0], &map[1]);
  for (int i = 0; i < 2; i++) abbe_image_free(&map[i]);
}
