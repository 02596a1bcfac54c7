/* Layers with fewer faces: a coarse grid has the picture of all faces; for a fine one all are
 * drawn. */
#include "tests/gl/frame.h"

static abbe_scene ring;

static const char text[] = CAMERA POINT_LIGHT FLOOR
    "- {name: ring, shape: ring, major: 0.08, minor: 0.02, around: 128, across: 64,\n"
    "   transform: [{translate: [0, 0, 0.2]}], material: crown}\n";

static size_t all_faces(void) {
  return ring.object[1].mesh.face_count;
}

/* Everything switched on draws every face; else its picture is the same. */
static abbe_statistics draw(size_t photons, bool everything, abbe_image *picture) {
  const abbe_render_desc desc = {.width = 96,
                                 .height = 96,
                                 .photons = photons,
                                 .map_size = 128,
                                 .supersample = 1,
                                 .wavelengths = 3,
                                 .exits = 4,
                                 .model = ABBE_MODEL_LAYERS,
                                 .everything = everything};
  abbe_renderer *renderer = make_renderer(&ring, &desc);
  const abbe_statistics statistics = draw_frame(renderer);
  read_picture(renderer, false, picture);
  abbe_renderer_free(renderer);
  return statistics;
}

/* Mean difference over the mean. */
static double apart(const abbe_image *a, const abbe_image *b) {
  double difference = 0, sum = 0;
  for (size_t i = 0; i < a->width * a->height * a->channels; i++) {
    difference += fabs((double)(a->data[i] - b->data[i]));
    sum += fabs((double)b->data[i]);
  }
  return difference / sum;
}

static void few_faces_show_the_same(void **state) {
  (void)state;
  abbe_image few, all;
  const abbe_statistics drawn = draw(24, false, &few);
  assert_true(drawn.layer_faces > 0 && 2 * drawn.layer_faces < all_faces());
  const abbe_statistics whole = draw(24, true, &all);
  assert_int_equal(whole.layer_faces, all_faces());
  assert_finite(&few);
  const double off = apart(&few, &all);
  if (!(off > 0 && off < 0.01)) fail_msg("the pictures are %g apart", off);
  const double reached = drawn.energy.reached / whole.energy.reached;
  assert_true(fabs(reached - 1) < 2e-3);
  assert_true(abbe_ledger_imbalance(&drawn.energy) < 1e-4);
  abbe_image_free(&few);
  abbe_image_free(&all);
}

static void fine_grids_draw_every_face(void **state) {
  (void)state;
  abbe_image picture;
  assert_int_equal(draw(256, false, &picture).layer_faces, all_faces());
  abbe_image_free(&picture);
}

static int open_all(void **state) {
  load_text(text, &ring);
  return make_context(state);
}

static int close_all(void **state) {
  abbe_scene_free(&ring);
  return free_context(state);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(few_faces_show_the_same),
      cmocka_unit_test(fine_grids_draw_every_face),
  };
  return cmocka_run_group_tests(tests, open_all, close_all);
}
