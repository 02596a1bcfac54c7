/* Where the camera's rays through an object go is kept while lights move: the light of these places
 * is that which rays show, and of a renderer made anew. */
#include "tests/gl/frame.h"

#include "validation/lab/volume_fill.h"

static const char ball[] =
    CAMERA SUN FLOOR "- {name: orb, shape: sphere, radius: 0.1, levels: 4, material: crown, "
                     "transform: [{translate: [0, 0, 0.15]}]}\n";
static const char wedge[] =
    CAMERA SUN FLOOR "- {name: wedge, shape: prism, apex: 50, side: 0.2, length: 0.2, material: "
                     "crown, transform: [{translate: [0, 0, 0.2]}]}\n";

static const char plate[] =
    CAMERA SUN FLOOR "- {name: plate, shape: box, size: [0.2, 0.1, 0.2], mirror: 0.8, transform: "
                     "[{rotate: {axis: [0, 0, 1], angle: 20}}, {translate: [0, 0, 0.2]}]}\n";

static void make_volume(const abbe_scene *scene, abbe_volume_kind kind, size_t nodes,
                        abbe_caustic_volume *out) {
  abbe_volume_fill_statistics done;
  const bool exits = kind == ABBE_VOLUME_EXITS;
  const abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .kind = ABBE_VOLUME_VECTOR, .exits = exits ? 400 : 0, .nodes = nodes,
             .region = {.kind = ABBE_REGION_OCTAHEDRAL, .side = 16, .shells = 8}, .photons = 8192,
             .passes = 1, .threads = 2);
  OK(abbe_volume_fill(scene, &desc, out, &done, &error));
}

/* A light that moves under a renderer draws what a renderer of its own draws there, bit by bit, and
 * where the camera's rays through the object go is kept. */
static void check_kept_sights(const char *text, abbe_volume_kind kind) {
  abbe_image map = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  FILLED(abbe_caustic_volume, v, make_volume(&scene, kind, 42, &v));
  abbe_render_desc desc = small_frame;
  desc.volume = &v;
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  static const double there[2][3] = {{0.6, 0, -0.8}, {0, 0.28, -0.96}};
  for (int k = 0; k < 2; k++) {
    memcpy(scene.light[0].direction, there[k], sizeof there[k]);
    OK(abbe_renderer_change(renderer, &scene, &desc, &error));
    const abbe_statistics statistics = draw_frame(renderer);
    assert_true(statistics.kept[ABBE_PASS_EYE_FRONT]);
    assert_true(abbe_statistics_ran(&statistics, ABBE_PASS_EYE_REFRACTION));
  }
  OWNED(abbe_image, changed) = picture_of(renderer);
  scene.camera.eye[0] += 0.1;
  OK(abbe_renderer_change(renderer, &scene, &desc, &error));
  const abbe_statistics statistics = draw_frame(renderer);
  assert_false(statistics.kept[ABBE_PASS_EYE_FRONT]);
  scene.camera.eye[0] -= 0.1;
  abbe_renderer_free(renderer);
  renderer = make_renderer(&scene, &desc);
  draw_frame(renderer);
  OWNED(abbe_image, anew) = picture_of(renderer);
  assert_same_pixels(&changed, &anew);
  REFUSED(ABBE_UNSUPPORTED, "", abbe_renderer_read_map(renderer, 0, true, &map, &error));
}

GROUP(make_context, free_context);

TEST(a_changed_light_is_as_one_made_anew) {
  check_kept_sights(ball, ABBE_VOLUME_VECTOR);
  check_kept_sights(wedge, ABBE_VOLUME_EXITS);
  check_kept_sights(plate, ABBE_VOLUME_EXITS);
}

static void draw_once(const abbe_scene *scene, const abbe_render_desc *desc, abbe_image *out) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, desc);
  *out = picture_of(renderer);
}

/* What the camera sees through the object by places of receivers, kept, is what it sees by light
 * looked up on its way, which a sample a pixel is. */
TEST(kept_sights_show_what_rays_show) {
  const char *const text[] = {ball, wedge, plate};
  for (int k = 0; k < 3; k++) {
    enum { SIDE = 48 };
    OWNED(abbe_caustic_volume, v);
    OWNED(abbe_scene, scene) = scene_of(text[k]);
    make_volume(&scene, k == 0 ? ABBE_VOLUME_VECTOR : ABBE_VOLUME_EXITS, 12, &v);
    abbe_render_desc desc = FIELDS(.width = SIDE, .height = SIDE, .wavelengths = 1,
                                   .supersample = 2, .adaptive = 1, .map_size = 64, .volume = &v);
    FILLED(abbe_image, kept, draw_once(&scene, &desc, &kept));
    desc.width = desc.height = 2 * SIDE;
    desc.supersample = 1;
    FILLED(abbe_image, large, draw_once(&scene, &desc, &large));
    double off = 0, all = 0;
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 3; i++) {
      const size_t x = i / 3 % SIDE, y = i / 3 / SIDE;
      double mean = 0;
      for (size_t n = 0; n < 4; n++)
        mean += 0.25 * (double)large.data[((2 * y + n / 2) * 2 * SIDE + 2 * x + n % 2) * 3 + i % 3];
      off += fabs((double)kept.data[i] - mean);
      all += mean;
    }
    assert_near(off / all, 0, 1e-5);
  }
}
