/* Changes that leave light's way to receivers alone: photons and maps are kept, and the picture is
 * that of a renderer made anew. */
#include "tests/gl/frame.h"

static const abbe_render_desc tiny = {.width = 24, .height = 20, .photons = 32, .map_size = 64};

/* Draws what was changed; its photons are kept, and it draws what another one draws. */
static void assert_light_kept(abbe_renderer *renderer, const abbe_scene *scene, double before,
                              abbe_image *picture) {
  OK(abbe_renderer_change(renderer, scene, &tiny, &error));
  const abbe_statistics s = draw_frame(renderer);
  assert_true(s.kept[ABBE_PASS_PHOTONS] && s.kept[ABBE_PASS_SPECTRAL_MAP]);
  assert_false(s.kept[ABBE_PASS_EYE_RECEIVERS]);
  assert_true(s.energy.deposited == before);
  *picture = picture_of(renderer);
  HELD(abbe_renderer, other) = drawn_renderer(scene, &tiny);
  OWNED(abbe_image, anew) = picture_of(other);
  assert_same_pixels(picture, &anew);
}

GROUP(make_context, free_context);

TEST(the_first_texture_keeps_photons) {
  static float texel[2][3] = {{0.5f, 0.25f, 0.75f}, {1, 0.5f, 0.25f}};
  abbe_image picture[3] = {{0}, {0}, {0}};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BRICK("crown"));
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &tiny);
  const double deposited = draw_frame(renderer).energy.deposited;
  picture[0] = picture_of(renderer);
  abbe_image *texture = &scene.object[0].texture;
  texture->width = 2;
  texture->height = 1;
  texture->channels = 3;
  texture->data = &texel[0][0];
  assert_light_kept(renderer, &scene, deposited, &picture[1]);
  assert_true(image_sum(&picture[1], 0) < 0.9 * image_sum(&picture[0], 0));
  memset(texture, 0, sizeof *texture); /* and none again */
  assert_light_kept(renderer, &scene, deposited, &picture[2]);
  assert_same_pixels(&picture[0], &picture[2]);
  for (int i = 0; i < 3; i++) abbe_image_free(&picture[i]);
}

/* A spot's shadows are those of its place, whatever its cone is. */
TEST(another_cone_is_followed_anew) {
  abbe_image kept = {0}, anew = {0};
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA "lights:\n- {name: spot, kind: spot, position: [0.1, 0, 0.7], target: [0.2, "
                      "0, 0.2], intensity: 2, cone: 30, soft: 5}\n" FLOOR BRICK("crown"));
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &tiny);
  for (int turn = 0; turn < 3; turn++) {
    if (turn == 0) scene.light[0].cone_rad *= 0.8;
    if (turn == 1) scene.light[0].soft_rad *= 2;
    if (turn == 2) scene.light[0].direction[0] = 0, scene.light[0].direction[2] = -1;
    OK(abbe_renderer_change(renderer, &scene, &tiny, &error));
    const abbe_statistics s = draw_frame(renderer);
    assert_false(s.kept[ABBE_PASS_PHOTONS]);
    kept = picture_of(renderer);
    HELD(abbe_renderer, other) = drawn_renderer(&scene, &tiny);
    anew = picture_of(other);
    assert_same_pixels(&kept, &anew);
    abbe_image_free(&kept);
    abbe_image_free(&anew);
  }
}

#define LARGE_RING                                                                                 \
  "- {name: ring, shape: ring, major: 0.12, minor: 0.04, around: 256, across: 128, material: "     \
  "crown, transform: [{translate: [0, 0, 0.1]}]}\n"

static double sum_apart(const abbe_image *a, const abbe_image *b) {
  double sum = 0;
  for (size_t i = 0; i < a->width * a->height * a->channels; i++)
    sum += fabs((double)a->data[i] - (b != NULL ? (double)b->data[i] : 0));
  return sum;
}

/* Views of fewer triangles: the camera's alone leave the light as it is, and what they show is
 * nearly the same; without them all is as before. */
TEST(coarse_views_show_nearly_the_same) {
  enum { NONE, EYE, ALL, AGAIN, COUNT };
  static const abbe_coarse coarse[COUNT] = {ABBE_COARSE_NONE, ABBE_COARSE_EYE, ABBE_COARSE_ALL,
                                            ABBE_COARSE_NONE};
  abbe_image picture[COUNT] = {{0}};
  abbe_render_desc desc = tiny;
  desc.model = ABBE_MODEL_LAYERS;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR LARGE_RING);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  for (int i = 0; i < COUNT; i++) {
    desc.coarse = coarse[i];
    OK(abbe_renderer_change(renderer, &scene, &desc, &error));
    const abbe_statistics s = draw_frame(renderer);
    assert_true(s.kept[ABBE_PASS_PHOTONS] == (i == EYE));
    assert_false(s.kept[ABBE_PASS_EYE_RECEIVERS]);
    picture[i] = picture_of(renderer);
  }
  assert_same_pixels(&picture[AGAIN], &picture[NONE]);
  for (int i = EYE; i <= ALL; i++) {
    assert_true(sum_apart(&picture[i], &picture[NONE]) > 0);
    assert_true(sum_apart(&picture[i], &picture[NONE]) < 0.03 * sum_apart(&picture[NONE], NULL));
  }
  for (int i = 0; i < COUNT; i++) abbe_image_free(&picture[i]);
}

#define RING_IN_COLOUR                                                                             \
  "- {name: ring, shape: ring, major: 0.12, minor: 0.04, around: 128, across: 64, reflectance: "   \
  "[0.8, 0.5, 0.3], transform: [{translate: [0, 0, 0.1]}]}\n"

/* Of receivers of many triangles, too, which rays meet then that are drawn else: but for edges. */
TEST(rays_show_receivers_as_they_are_drawn) {
  abbe_image picture[2] = {{0}};
  abbe_render_desc desc = tiny;
  desc.supersample = desc.adaptive = 1;
  desc.aovs = true;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BRICK("crown") RING_IN_COLOUR);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  for (int i = 0; i < 2; i++) {
    desc.coarse = i == 0 ? ABBE_COARSE_NONE : ABBE_COARSE_EYE;
    OK(abbe_renderer_change(renderer, &scene, &desc, &error));
    draw_frame(renderer);
    picture[i] = aovs_of(renderer);
  }
  print_message("apart by %.5f\n",
                sum_apart(&picture[1], &picture[0]) / sum_apart(&picture[0], NULL));
  assert_true(sum_apart(&picture[1], &picture[0]) < 0.01 * sum_apart(&picture[0], NULL));
  for (int i = 0; i < 2; i++) abbe_image_free(&picture[i]);
}
