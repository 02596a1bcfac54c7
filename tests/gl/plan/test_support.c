/* What the renderer does not model is refused by name. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/examine.h"

TEST(the_thesis_refuses_disks) {
  const abbe_render_desc thesis = {.profile = ABBE_PROFILE_THESIS};
  abbe_plan plan;
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA "lights:\n- {name: panel, kind: disk, position: [0, 0, 0.6], target: [0, 0, "
                      "0], radius: 0.1, radiance: 100}\n" FLOOR BALL("flat"));
  assert_int_equal(scene.light[0].kind, ABBE_LIGHT_DISK);
  assert_near(scene.light[0].radius, 0.1, 0);
  assert_near(scene.light[0].power, 100, 0);
  assert_near(scene.light[0].direction[2], -1, 0);
  REFUSED(ABBE_UNSUPPORTED, "'panel' is a disk", abbe_plan_make(&scene, &thesis, &plan, &error));
  assert_contains(last_error.text, "trace the scene");
  assert_contains(last_error.text, "of 3.14159 W/sr"); /* 100 pi 0.1^2 */
}

#define LOOKING_GLASS                                                                              \
  "- {name: looking glass, shape: rectangle, width: 1, height: 1, mirror: 0.9, "                   \
  "transform: [{translate: [0, 0, -1]}]}\n"

TEST(mirrors_are_refused_by_name_where_none_are_followed) {
  static const char text[] = CAMERA POINT_LIGHT FLOOR BALL("flat") LOOKING_GLASS;
  abbe_render_desc desc = {.profile = ABBE_PROFILE_THESIS};
  refuse_plan(text, &desc, ABBE_UNSUPPORTED, "'looking glass' (line 8) is a mirror");
  desc.profile = ABBE_PROFILE_THESIS_CIE;
  refuse_plan(text, &desc, ABBE_UNSUPPORTED, "the thesis-cie profile follows no light off mirrors");
  desc = (abbe_render_desc){.model = ABBE_MODEL_LAYERS};
  refuse_plan(text, &desc, ABBE_UNSUPPORTED, "the model 'layers' follows no light off mirrors");
}

#define DROP(name, radius, z)                                                                      \
  "- {name: " name ", shape: sphere, radius: " radius ", levels: 2, "                              \
  "transform: [{translate: [0.09, 0.09, " z "]}], material: flat}\n"
#define CASE(name, z)                                                                              \
  "- {name: " name ", shape: box, size: [0.1, 0.1, 0.1], material: flat, "                         \
  "transform: [{translate: [0.09, 0.09, " z "]}]}\n"

/* In part, and in whatever order the scene has them; not what touches it, or is near. */
TEST(layers_refuse_by_name_what_lies_in_a_refractor) {
  static const char *const in[][2] = {
      {CAMERA POINT_LIGHT FLOOR CASE("case", "0.2") DROP("drop", "0.02", "0.2"),
       "'drop' (line 8) lies in 'case' (line 7), and the model 'layers'"},
      {CAMERA POINT_LIGHT FLOOR DROP("drop", "0.04", "0.26") CASE("case", "0.2"),
       "'drop' (line 7) lies in 'case' (line 8)"},
      {CAMERA POINT_LIGHT FLOOR BALL("flat") DROP("drop", "0.08", "0.26"), "takes each refractor"},
  };
  static const char *const beside[] = {
      CAMERA POINT_LIGHT FLOOR CASE("case", "0.2") CASE("on it", "0.3"),
      CAMERA POINT_LIGHT FLOOR BALL("flat") DROP("drop", "0.04", "0.26")};
  const abbe_render_desc desc = {.model = ABBE_MODEL_LAYERS};
  for (size_t i = 0; i < sizeof in / sizeof *in; i++)
    refuse_plan(in[i][0], &desc, ABBE_UNSUPPORTED, in[i][1]);
  for (size_t i = 0; i < sizeof beside / sizeof *beside; i++) {
    OWNED(abbe_scene, scene) = scene_of(beside[i]);
    MADE(abbe_plan, plan, abbe_plan_make(&scene, &desc, &plan, &error));
  }
}

/* By pinholes where nothing else is asked for, and not at all by others. */
TEST(rough_mirrors_go_by_pinholes) {
  static const char text[] =
      CAMERA "environment: {size: 64, uniform: 1}\n" FLOOR
             "- {name: dull plate, shape: rectangle, width: 1, height: 1, mirror: 0.9, roughness: "
             "0.2, transform: [{translate: [0, 0, -1]}]}\n";
  abbe_scene scene = scene_of(text);
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(plan.rough);
  assert_int_equal(plan.desc.transport, ABBE_TRANSPORT_PINHOLE);
  assert_int_equal(plan.desc.pinholes, ABBE_PLAN_PINHOLES);
  assert_int_equal(plan.note_count, 0);
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  /* What a lamp sends there by a smooth surface is left out, which the plan says. */
  scene = scene_of(CAMERA POINT_LIGHT FLOOR LOOKING_GLASS
                   "- {name: dull plate, shape: rectangle, width: 1, height: 1, mirror: 0.9, "
                   "roughness: 0.2, transform: [{translate: [0, 0, -1]}]}\n");
  OK(abbe_plan_make(&scene, NULL, &plan, &error));
  assert_contains(plan.note[0], "comes to a rough mirror through glass");
  abbe_scene_free(&scene);
  abbe_render_desc desc = {.transport = ABBE_TRANSPORT_PHOTONS};
  refuse_plan(text, &desc, ABBE_UNSUPPORTED, "'dull plate' (line 6) is a rough mirror");
  desc = (abbe_render_desc){.profile = ABBE_PROFILE_WAND2003};
  refuse_plan(text, &desc, ABBE_UNSUPPORTED, "the wand2003 profile knows smooth ones alone");
}

/* Where soft light is there and an exact solid stands near a receiver, alone or in company; else
 * photons alone. */
TEST(soft_light_near_a_solid_goes_by_pinholes) {
#define DOME "environment: {size: 64, dome: cos}\n"
#define EVEN "environment: {size: 64, uniform: 1}\n"
#define ALL_STANDS_OUT "environment: {softboxes: [{elevation: 90, radius: 3, radiance: 9}]}\n"
#define HIGH_BALL                                                                                  \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 2, transform: [{translate: [0, 0, 0.5]}], " \
  "material: flat}\n"
#define MIRROR_BALL                                                                                \
  "- {name: steel, shape: sphere, radius: 0.05, transform: [{translate: [0.3, 0, 0.05]}], "        \
  "mirror: 0.9}\n"
  static const struct {
    const char *text;
    abbe_transport asked, taken;
    bool in_turn;
  } cases[] = {
      {CAMERA DOME FLOOR BALL("flat"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PINHOLE, false},
      {CAMERA DOME FLOOR CASE("case", "0.2"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PINHOLE, false},
      {CAMERA DOME FLOOR BALL("flat"), ABBE_TRANSPORT_PHOTONS, ABBE_TRANSPORT_PHOTONS, false},
      {CAMERA EVEN FLOOR BALL("flat"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS, false},
      {CAMERA DOME FLOOR HIGH_BALL, ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS, false},
      {CAMERA DOME FLOOR BALL("flat") HIGH_BALL, ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PINHOLE, true},
      {CAMERA DOME FLOOR BALL("flat") MIRROR_BALL, ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PINHOLE,
       true},
      {CAMERA DOME FLOOR RING("flat"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS, true},
      {CAMERA DOME FLOOR BALL("flat") RING("flat"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS,
       true},
      {CAMERA DOME FLOOR, ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS, false},
      {CAMERA POINT_LIGHT FLOOR BALL("flat"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS, false},
      {CAMERA DOME "medium: {scattering: 0.1, box: [[-1, -1, 0], [1, 1, 2]]}\n" FLOOR BALL("flat"),
       ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS, false},
      {CAMERA ALL_STANDS_OUT FLOOR BALL("flat"), ABBE_TRANSPORT_AUTO, ABBE_TRANSPORT_PHOTONS,
       false},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const abbe_render_desc desc = {.transport = cases[i].asked};
    OWNED(abbe_scene, scene) = scene_of(cases[i].text);
    MADE(abbe_plan, plan, abbe_plan_make(&scene, &desc, &plan, &error));
    assert_int_equal(plan.desc.transport, cases[i].taken);
    assert_int_equal(plan.multi_refractor_paths, cases[i].in_turn);
  }
}

TEST(mirrors_are_followed_among_so_many) {
  char text[8192] = CAMERA POINT_LIGHT FLOOR LOOKING_GLASS;
  for (int i = 0; i < 32; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "- {name: b%d, shape: box, size: [0.1, 0.1, 0.1], material: flat, transform: "
             "[{translate: [%g, 0.3, 0.2]}]}\n",
             i, 0.2 * i - 3);
  refuse_plan(text, NULL, ABBE_UNSUPPORTED,
              "off mirrors among at most 32 refractors, mirrors and clouds; the scene has 33");
}

TEST(a_map_layout_belongs_to_its_light) {
  static const char ball[] = CAMERA POINT_LIGHT FLOOR BALL("flat");
  static const double at[3] = {0.05, 0.03, 0.6}, down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  static const double point[1][3] = {{0, 0, 0}};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(at, down, up, false, &view);
  abbe_view_fit(&view, point, 1);
  abbe_view_pad(&view, 0.1);
  abbe_map_layout_make(&view, &layout);
  abbe_render_desc desc = {.map_layout = &layout};
  abbe_scene scene = scene_of(ball);
  MADE(abbe_plan, plan, abbe_plan_make(&scene, &desc, &plan, &error));
  assert_contains(abbe_plan_find(&plan, ABBE_PASS_SPECTRAL_MAP, 0)->reason, "laid out as asked");
  abbe_scene_free(&scene);
  refuse_plan(CAMERA POINT_LIGHT FLOOR, &desc, ABBE_INVALID_ARGUMENT, "no refractor");
  refuse_plan(CAMERA SUN FLOOR BALL("flat"), &desc, ABBE_INVALID_ARGUMENT,
              "another place than 'sun'");
  desc.map_layout_light = 1;
  refuse_plan(ball, &desc, ABBE_INVALID_ARGUMENT, "for light 2; the scene has 1");
  desc.map_layout_light = 0;
  desc.profile = ABBE_PROFILE_THESIS;
  refuse_plan(ball, &desc, ABBE_INVALID_ARGUMENT, "thesis");
  desc.profile = ABBE_PROFILE_DEFAULT;
  layout.knot[0][3] = NAN;
  refuse_plan(ball, &desc, ABBE_INVALID_ARGUMENT, "along x");
  layout.view.origin[0] += 1e-3;
  refuse_plan(ball, &desc, ABBE_INVALID_ARGUMENT, "another place than 'lamp'");
}
