/* What the eye sees through facets by more wavelengths than every pixel takes: joined bands come
 * back by all their samples where they show different things. */
#include "tests/gl/frame.h"

enum { BARS = 12 };

static const char STONE[] =
    "- {name: stone, shape: gem, sides: 6, girdle: 0.1, table: 0.06, crown: 0.03,\n"
    "   pavilion: 0.05, transform: [{translate: [0, 0, 0.1]}], material: crown}\n";
static const char BALL_OF_CROWN[] = "- {name: ball, shape: sphere, radius: 0.07,\n"
                                    "   transform: [{translate: [0, 0, 0.1]}], material: crown}\n";
static const char RING_OF[] = "- {name: ring, shape: ring, major: 0.07, minor: 0.03,\n"
                              "   transform: [{translate: [0, 0, 0.1]}], material: %s}\n";

/* A refractor high over black bars on white: their edges are drawn out into spectra. */
static void load_bars(const char *refractor, abbe_scene *scene) {
  char text[4096];
  int used = snprintf(
      text, sizeof text,
      "materials: glass.yaml\n"
      "camera: {eye: [0, -0.6, 0.5], target: [0, 0, 0.1], up: [0, 0, 1], fov: 16}\nambient: 1\n"
      "lights:\n"
      "- {name: aside, kind: spot, position: [3, 3, 1], target: [4, 4, 0], cone: 5, intensity: 1}\n"
      "objects:\n"
      "%s- {name: white, shape: rectangle, width: 9, height: 9, reflectance: 0.9,\n"
      "   transform: [{translate: [0, 1, -1]}]}\n",
      refractor);
  for (int i = 0; i < BARS; i++)
    used += snprintf(text + used, sizeof text - (size_t)used,
                     "- {name: bar %d, shape: rectangle, width: 0.2, height: 9, reflectance: 0.02, "
                     "transform: [{translate: [%g, 1, -0.99]}]}\n",
                     i, 0.4 * i - 2.3);
  *scene = scene_of(text);
}

/* everything: every sample takes all wavelengths. */
static abbe_image picture_by(abbe_model model, const abbe_scene *scene, size_t wavelengths,
                             size_t samples, bool everything) {
  abbe_render_desc desc = small_frame;
  desc.model = model;
  desc.wavelengths = wavelengths;
  desc.everything = everything;
  desc.exits = 8;
  desc.supersample = samples;
  desc.width = desc.height = 64;
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, &desc);
  return picture_of(renderer);
}

static abbe_image picture(const abbe_scene *scene, size_t wavelengths, size_t samples,
                          bool everything) {
  return picture_by(ABBE_MODEL_AUTO, scene, wavelengths, samples, everything);
}

/* Sum of absolute differences of R, G and B, over that of the second. */
static double apart(const abbe_image *a, const abbe_image *b) {
  double sum = 0, whole = 0;
  for (size_t i = 0; i < a->width * a->height; i++)
    for (size_t k = 0; k < 3; k++) {
      double x = (double)a->data[i * a->channels + k], y = (double)b->data[i * b->channels + k];
      sum += fabs(x - y);
      whole += fabs(y);
    }
  return sum / whole;
}

GROUP(make_context, free_context);

TEST(joined_bands_come_back) {
  FILLED(abbe_scene, scene, load_bars(STONE, &scene));
  OWNED(abbe_image, seven) = picture(&scene, 7, 1, true), all = picture(&scene, 21, 1, true);
  OWNED(abbe_image, asked) = picture(&scene, 21, 1, false);
  double from_seven = apart(&seven, &all), from_asked = apart(&asked, &all);
  print_message("7 wavelengths are %.5f off all of 21, those that are asked for %.5f\n", from_seven,
                from_asked);
  assert_true(from_seven > 1e-3);
  assert_true(from_asked < 0.25 * from_seven);
}

/* Up to eight wavelengths every pixel takes all of them. */
TEST(few_wavelengths_are_all_taken) {
  FILLED(abbe_scene, scene, load_bars(STONE, &scene));
  OWNED(abbe_image, planned) = picture(&scene, 8, 1, false), all = picture(&scene, 8, 1, true);
  assert_true(apart(&planned, &all) < 1e-6);
}

static void load_ring(const char *material, abbe_scene *scene) {
  load_bars(printed(RING_OF, material), scene);
}

/* Where all that is seen is alike, so is every pixel, whichever bands its samples take. */
static void assert_shared_bands_add_up(const char *refractor, abbe_model model) {
  static const char alike[] =
      "materials: glass.yaml\n"
      "camera: {eye: [0, -0.6, 0.5], target: [0, 0, 0.1], up: [0, 0, 1], fov: 16}\n"
      "ambient: 1\nbackground: 0.28647889756541\nlights:\n" /* 0.9 / pi */
      "- {name: aside, kind: spot, position: [3, 3, 1], target: [4, 4, 0], cone: 5, intensity: 1}\n"
      "objects:\n"
      "- {name: behind, shape: rectangle, width: 1, height: 1, reflectance: 0.9,\n"
      "   transform: [{translate: [0, 1, -1]}]}\n";
  static const size_t wavelengths[] = {3, 4, 7, 8};
  OWNED(abbe_scene, scene) = scene_of(printed("%s%s", alike, refractor));
  for (size_t k = 0; k < sizeof wavelengths / sizeof *wavelengths; k += all_cases() ? 1 : 3) {
    OWNED(abbe_image, shown) = picture_by(model, &scene, wavelengths[k], 2, false);
    for (size_t i = 0; i < shown.width * shown.height; i++)
      for (size_t c = 0; c < 3; c++)
        assert_near(shown.data[i * shown.channels + c] / shown.data[c], 1, 1e-5);
  }
}

TEST(shared_bands_add_up) {
  assert_shared_bands_add_up(printed(RING_OF, "crown"), ABBE_MODEL_AUTO);
  /* Two layers tell of a ball where every ray leaves; in a ring some rays find no way out. */
  assert_shared_bands_add_up(BALL_OF_CROWN, ABBE_MODEL_LAYERS);
}

/* The samples of a pixel take every second band each, and lie no farther from many samples that
 * take all of many wavelengths than if each took all seven. */
TEST(shared_bands_show_the_spectrum) {
  FILLED(abbe_scene, scene, load_ring("crown", &scene));
  OWNED(abbe_image, true_to) = picture(&scene, 28, 4, true);
  OWNED(abbe_image, shared) = picture(&scene, 7, 2, false), all = picture(&scene, 7, 2, true);
  double from_shared = apart(&shared, &true_to), from_all = apart(&all, &true_to);
  print_message("shared bands are %.5f off, all bands %.5f, each other %.5f\n", from_shared,
                from_all, apart(&shared, &all));
  assert_true(apart(&shared, &all) > 1e-5);
  assert_true(from_shared < 1.1 * from_all);
}
