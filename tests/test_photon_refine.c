/* Photons that take more wavelengths only where their landings ask for them. */
#include "tests/frame.h"

#include "gl/renderer_state.h"

static void coarse_nodes_reach_both_ends_in_order(void **state) {
  (void)state;
  for (size_t n = 5; n <= ABBE_RENDER_MAX_WAVELENGTHS; n++) {
    assert_int_equal(abbe_renderer_coarse_node(n, 5, 0), 0);
    assert_int_equal(abbe_renderer_coarse_node(n, 5, 4), n - 1);
    for (size_t k = 0; k < 4; k++)
      assert_true(abbe_renderer_coarse_node(n, 5, k) < abbe_renderer_coarse_node(n, 5, k + 1));
  }
}

static abbe_ledger draw(const char *name, size_t wavelengths, abbe_fill fill, abbe_image *map) {
  abbe_scene scene = {0};
  load_shipped(name, &scene);
  const abbe_render_desc desc = {.width = 16,
                                 .height = 16,
                                 .photons = 64,
                                 .map_size = 64,
                                 .fill = fill,
                                 .wavelengths = wavelengths};
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  const abbe_statistics statistics = draw_frame(renderer);
  if (map != NULL) read_map(renderer, 0, map);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
  return statistics.energy;
}

/* All of the light is entered once, by the set that it was laid with. */
static void every_photon_is_entered_once(void **state) {
  (void)state;
  static const char *const names[] = {"gem", "prism", "sphere"};
  for (size_t i = 0; i < 3; i++) {
    const abbe_ledger l = draw(names[i], 23, ABBE_FILL_BRIDGE, NULL);
    const double ends = l.reflected + l.absorbed + l.trapped + l.missed + l.deposited;
    assert_true(l.reached > 0);
    assert_true(fabs(ends / l.reached - 1) < 1e-4);
  }
}

/* N-SF11 absorbs violet by tens in a metre and green by ones: what 21 wavelengths leave of it is
 * what 200 do, to a part in a thousand of the light. */
static void absorption_is_that_of_all_wavelengths(void **state) {
  (void)state;
  const abbe_ledger all = draw("gem", 61, ABBE_FILL_NONE, NULL);
  const abbe_ledger some = draw("gem", 21, ABBE_FILL_BRIDGE, NULL);
  print_message("absorbed: %.4f %% of 61, %.4f %% of 21\n", 100 * all.absorbed / all.reached,
                100 * some.absorbed / some.reached);
  assert_true(all.absorbed > 0.05 * all.reached);
  assert_near(some.absorbed / some.reached, all.absorbed / all.reached, 0.001);
}

static double difference(const abbe_image *a, const abbe_image *b) {
  double sum = 0, square = 0;
  for (size_t i = 0; i < a->width * a->height * a->channels; i++) {
    sum += pow((double)a->data[i] - (double)b->data[i], 2);
    square += pow((double)b->data[i], 2);
  }
  return sqrt(sum / square);
}

/* 200 wavelengths, each on its own, are as good as all. The prism's spectrum is some forty texels
 * long: five wavelengths bend it off by a few of them, which those between set right. */
static void refined_maps_are_those_of_all_wavelengths(void **state) {
  (void)state;
  static const char *const names[] = {"gem", "prism"};
  for (size_t i = 0; i < 2; i++) {
    abbe_image all = {0}, few = {0}, refined = {0}, again = {0};
    draw(names[i], 200, ABBE_FILL_NONE, &all);
    draw(names[i], 5, ABBE_FILL_BRIDGE, &few);
    draw(names[i], 25, ABBE_FILL_BRIDGE, &refined);
    draw(names[i], 25, ABBE_FILL_BRIDGE, &again);
    print_message("%s: %g with five, %g refined\n", names[i], difference(&few, &all),
                  difference(&refined, &all));
    assert_true(difference(&refined, &all) < 0.6 * difference(&few, &all));
    assert_memory_equal(refined.data, again.data,
                        refined.width * refined.height * refined.channels * sizeof *refined.data);
    abbe_image_free(&all);
    abbe_image_free(&few);
    abbe_image_free(&refined);
    abbe_image_free(&again);
  }
}

/* More wavelengths in an interval than in the coarse set, and paths that few of them take: what is
 * read of the coarse landings is the photon's own, in whatever order photons stand. */
static void a_mesh_is_refined_alike_every_time(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_image map[2] = {{0}, {0}};
  abbe_render_desc desc = small_frame;
  desc.width = desc.height = 16;
  desc.photons = 128;
  desc.wavelengths = 28;
  load_shipped("bunny", &scene);
  for (int i = 0; i < 2; i++) make_map(&scene, &desc, &map[i]);
  assert_same_pixels(&map[0], &map[1]);
  for (int i = 0; i < 2; i++) abbe_image_free(&map[i]);
  abbe_scene_free(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(coarse_nodes_reach_both_ends_in_order),
      cmocka_unit_test(every_photon_is_entered_once),
      cmocka_unit_test(absorption_is_that_of_all_wavelengths),
      cmocka_unit_test(refined_maps_are_those_of_all_wavelengths),
      cmocka_unit_test(a_mesh_is_refined_alike_every_time),
  };
  return cmocka_run_group_tests(tests, make_context, free_context);
}
