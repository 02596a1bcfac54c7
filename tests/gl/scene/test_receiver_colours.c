/* Receivers in colours under a prism's spectrum: what they reflect of it, wavelength by wavelength
 * as the tracer has it. Without tables of bands the red ones below are off by 0.4 to 0.8. */
#include "tests/gl/frame.h"

#include "colorimetry/reflectance/reflected_light.h"
#include "gl/plan/plan.h"
#include "tests/validation/trace_scene.h"

enum { SIDE = 48, PASSES = 6 };

/* By a texture of two texels, both of that colour. */
static void paint(const double rgb[3], abbe_object *object) {
  static const char *const names[3] = {"R", "G", "B"};
  OK(abbe_image_make(2, 1, 3, names, &object->texture, &error));
  for (size_t i = 0; i < 6; i++) object->texture.data[i] = (float)rgb[i % 3];
  for (int k = 0; k < 3; k++) object->reflectance[k] = 1;
}

/* The shipped prism, whose floor and wall are painted: by a measured patch, or by Rec.709. */
static void load_prism(const char *patch, const double rgb[3], bool textured, abbe_scene *scene) {
  *scene = shipped_scene("prism");
  for (size_t i = 0; i < scene->object_count; i++) {
    abbe_object *o = &scene->object[i];
    if (o->material != NULL || o->reflectance[0] < 0.5) continue;
    const bool had = o->texture.data != NULL;
    abbe_image_free(&o->texture);
    for (int k = 0; k < 3; k++) o->reflectance[k] = rgb[k];
    if (textured && had) paint(rgb, o);
    if (patch != NULL) OK(abbe_colour_checker_make(patch, &o->spectrum, &error));
  }
}

static void render(const abbe_scene *scene, abbe_image *out) {
  const abbe_render_desc desc = {
      .width = SIDE, .height = SIDE, .wavelengths = 21, .space = ABBE_RGB_SPACE_XYZ};
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, &desc);
  *out = picture_of(renderer);
}

static void trace(const abbe_scene *scene, abbe_image *out) {
  const abbe_trace_desc desc =
      FIELDS(.width = SIDE, .height = SIDE, .no_map = true, .space = ABBE_RGB_SPACE_XYZ,
             .photons = 1 << 18, .threads = 2);
  *out = traced_picture(scene, &desc, PASSES);
}

/* Sum of |X| + |Y| + |Z| of the differences, over that of the caustic. */
static double off(const abbe_image *picture, const abbe_image *reference) {
  static const char *const names[3] = {"X", "Y", "Z"};
  double apart = 0, light = 0;
  for (int k = 0; k < 3; k++) {
    const char *caustic = printed("caustic.%s", names[k]);
    const size_t a = abbe_image_find_channel(picture, names[k]),
                 b = abbe_image_find_channel(reference, names[k]);
    for (size_t p = 0; p < SIDE * SIDE; p++)
      apart += fabs((double)picture->data[p * picture->channels + a] -
                    (double)reference->data[p * reference->channels + b]);
    light += image_sum(reference, abbe_image_find_channel(reference, caustic));
  }
  return apart / light;
}

GROUP(make_context, free_context);

TEST(a_spectrum_on_colours) {
  static const struct {
    const char *what, *patch;
    double rgb[3];
    bool textured;
  } of[] = {{"grey", NULL, {0.5, 0.5, 0.5}, false},
            {"patch red", "red", {1, 1, 1}, false},
            {"patch bluish green", "bluish green", {1, 1, 1}, false},
            {"Rec.709 red", NULL, {0.7, 0.2, 0.1}, false},
            {"a texture of the same", NULL, {0.7, 0.2, 0.1}, true}};
  double grey = 0;
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    FILLED(abbe_scene, scene, load_prism(of[i].patch, of[i].rgb, of[i].textured, &scene));
    FILLED(abbe_image, drawn, render(&scene, &drawn));
    FILLED(abbe_image, traced, trace(&scene, &traced));
    const double found = off(&drawn, &traced);
    print_message("%s: off by %.3f of the caustic\n", of[i].what, found);
    if (i == 0) grey = found;
    assert_true(found < grey + 0.06);
  }
}

/* Tables are there where light arrives dispersed, and receivers are in colours. */
TEST(tables_rest_on_facts) {
  static const struct {
    const char *text;
    bool has;
  } of[] = {{CAMERA POINT_LIGHT FLOOR BALL("crown"), false},
            {CAMERA POINT_LIGHT "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, "
                                "reflectance: [0.5, 0.4, 0.4]}\n" BALL("crown"),
             true},
            {CAMERA POINT_LIGHT "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, "
                                "reflectance: {patch: foliage}}\n" BALL("crown"),
             true},
            {CAMERA POINT_LIGHT "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, "
                                "reflectance: {patch: foliage}}\n" BALL("flat"),
             false}};
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    OWNED(abbe_scene, scene) = scene_of(of[i].text);
    MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
    assert_int_equal(plan.receiver_colours, of[i].has);
  }
}
