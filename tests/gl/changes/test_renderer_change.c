/* A renderer that is changed draws, bit for bit, what one that is made anew draws, and runs no more
 * passes than the change asks for. */
#include "tests/gl/changes/changed_frame.h"

#include "gl/renderer_state.h"
#include "scenes/geometry/transform.h"
#include "scenes/object_motion.h"

static void shift_object(abbe_object *object, double x, double y, double z) {
  const double offset[3] = {x, y, z};
  double matrix[16];
  abbe_transform_translate(offset, matrix);
  OK(abbe_object_move(object, matrix, &error));
}

GROUP(make_context, free_context);

/* What each kind of change runs. */
TEST(a_change_runs_what_depends_on_it) {
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  abbe_render_desc desc = tiny;
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, true, true);
  s = draw_frame(renderer);
  assert_ran(&s, false, false);
  abbe_renderer_redraw(renderer);
  s = draw_frame(renderer);
  assert_ran(&s, true, true);
  const struct {
    const char *what;
    bool light, eye;
  } cases[] = {{"nothing", false, false},         {"the camera", false, true},
               {"a light's power", false, true},  {"the picture's size", false, true},
               {"ambient light", false, true},    {"a reflectance", false, true},
               {"a material", true, true},        {"a light's place", true, true},
               {"an object's place", true, true}, {"a receiver's place", true, true},
               {"photons", true, true},           {"the map", true, true}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const double energy = s.energy.reached;
    if (i == 1) scene.camera.eye[0] += 0.1;
    if (i == 2) scene.light[0].power *= 0.5;
    if (i == 3) desc.width = 32;
    if (i == 4) scene.ambient += 0.25;
    if (i == 5) scene.object[0].reflectance[1] = 0.125;
    if (i == 6) ((abbe_material *)scene.object[1].material)->dispersion.c[0] = 1.625;
    if (i == 7) scene.light[0].position[1] += 0.05;
    if (i == 8) shift_object(&scene.object[1], 0.01, -0.02, 0.03);
    if (i == 9) shift_object(&scene.object[2], 0, 0, 0.02);
    if (i == 10) desc.photons = 48;
    if (i == 11) desc.map_size = 128;
    OK(change(renderer, &scene, &desc));
    s = draw_frame(renderer);
    assert_ran(&s, cases[i].light, cases[i].eye);
    if (i == 2) assert_near(s.energy.reached, 0.5 * energy, 1e-12 * energy);
    assert_as_made_anew(renderer, &scene, &desc, cases[i].what);
  }
}

/* Glow stays as it is for another camera alone. */
TEST(glow_goes_by_what_lights_it) {
  OWNED(abbe_scene, scene) =
      scene_of("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR BRICK(
          "diamond-fluorescent"));
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &tiny);
  static const char *const whats[] = {"the camera", "a power", "ambient light", "a reflectance"};
  for (int i = 0; i < 4; i++) {
    if (i == 0) scene.camera.eye[0] += 0.1;
    if (i == 1) scene.light[0].power *= 0.5;
    if (i == 2) scene.ambient += 0.25;
    if (i == 3) scene.object[0].reflectance[1] = 0.125;
    OK(change(renderer, &scene, &tiny));
    const abbe_statistics s = draw_frame(renderer);
    assert_true(abbe_statistics_ran(&s, ABBE_PASS_EYE_GLOW) == (i > 0));
    assert_as_made_anew(renderer, &scene, &tiny, whats[i]);
  }
}

/* A camera that looks away sees no refractor: its pass, and its buffers, come and go. */
TEST(what_the_camera_sees_comes_and_goes) {
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &tiny);
  for (int turn = 0; turn < 3; turn++) {
    scene.camera.target[0] = turn == 1 ? -3 : 0;
    scene.camera.target[1] = turn == 1 ? -0.5 : 0;
    OK(change(renderer, &scene, &tiny));
    assert_true(abbe_renderer_plan(renderer)->camera_sees_refractor == (turn != 1));
    assert_as_made_anew(renderer, &scene, &tiny, "a turn of the camera");
  }
}

/* What all powers are measured by goes by the greatest of lights, ambient light and background. */
TEST(the_unit_of_power_comes_and_goes) {
  static const double powers[] = {1e-20, 1e-20, 1e-20, 1, 1}, background[] = {0, 0.1, 0, 0, 1e30};
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  scene.ambient = scene.background = 0;
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &tiny);
  for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
    scene.light[0].power = powers[i];
    scene.background = background[i];
    OK(change(renderer, &scene, &tiny));
    assert_as_made_anew(renderer, &scene, &tiny, "another unit of power");
  }
  abbe_render_desc other = tiny;
  other.space = ABBE_RGB_SPACE_REC709;
  OK(change(renderer, &scene, &other));
  const abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, false, true);
  assert_as_made_anew(renderer, &scene, &other, "another space");
}

/* Watched and not, with more wavelengths than a pixel's coarse bands. */
TEST(a_watched_frame_is_the_same) {
  OWNED(abbe_image, watched) = {0};
  int left = 1 << 30;
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  abbe_render_desc desc = tiny;
  desc.wavelengths = 12;
  desc.width = 200; /* some tiles of the rasteriser's */
  desc.height = 140;
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, alone) = picture_of(renderer);
  for (int turn = 0; turn < 2; turn++) { /* then of a camera that sees no refractor */
    if (turn == 1) scene.camera.target[0] = -3, scene.camera.target[1] = -0.5;
    OK(change(renderer, &scene, &desc));
    abbe_renderer_redraw(renderer);
    OK(abbe_renderer_frame(renderer, stop_at, &left, NULL, &error));
    assert_as_made_anew(renderer, &scene, &desc, "a watched frame");
    if (turn == 1) continue;
    watched = picture_of(renderer);
    assert_same_pixels(&alone, &watched);
  }
}

/* The scene that cannot be planned leaves the renderer as it was. */
TEST(a_refused_change_changes_nothing) {
  OWNED(abbe_scene, scene) = scene_of(GLASS_SCENE);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &tiny);
  OWNED(abbe_image, before) = picture_of(renderer);
  abbe_render_desc wrong = tiny;
  wrong.photons = ABBE_RENDER_MAX_PHOTONS + 1;
  assert_int_equal(change(renderer, &scene, &wrong), ABBE_INVALID_ARGUMENT);
  const abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, false, false);
  OWNED(abbe_image, after) = picture_of(renderer);
  assert_same_pixels(&before, &after);
}

static unsigned dice_state;

static unsigned dice(unsigned sides) {
  dice_state = dice_state * 1664525u + 1013904223u;
  return (dice_state >> 8) % sides;
}

static double spread(double by) {
  return by * ((double)dice(2001) / 1000 - 1);
}

/* One random change, of numbers and sizes too where `sizes`; what it was. */
static const char *change_anything(abbe_scene *scene, abbe_render_desc *desc, bool sizes) {
  abbe_light *light = &scene->light[dice((unsigned)scene->light_count)];
  abbe_object *object = &scene->object[dice((unsigned)scene->object_count)];
  switch (sizes ? dice(12) : dice(8)) {
  case 0:
    for (int k = 0; k < 3; k++) scene->camera.target[k] += spread(0.2);
    return "a turn of the camera";
  case 1:
    for (int k = 0; k < 2; k++) scene->camera.eye[k] += spread(0.1);
    return "a move of the camera";
  case 2:
    light->power = dice(4) == 0 ? 1e-20 : light->power * (1.5 + spread(1));
    return "a light's power";
  case 3:
    for (int k = 0; k < 3; k++) light->position[k] += spread(0.05);
    return "a light's place";
  case 4:
    if (object->material != NULL) shift_object(object, spread(0.02), spread(0.02), spread(0.02));
    return "a refractor's place";
  case 5:
    shift_object(&scene->object[0], spread(0.1), spread(0.1), 0);
    return "the floor's place";
  case 6:
    for (size_t i = 0; i < scene->table.count; i++)
      if (strcmp(scene->table.material[i].name, "crown") == 0)
        scene->table.material[i].dispersion.c[0] = 1.5 + spread(0.2);
    return "a material's coefficient";
  case 7:
    scene->object[0].reflectance[dice(3)] = 0.5 + spread(0.4);
    return "a reflectance";
  case 8:
    desc->photons = dice(2) == 0 ? 32 : 40;
    return "photons";
  case 9:
    desc->map_size = dice(2) == 0 ? 64 : 96;
    return "the map";
  case 10:
    desc->width = 16 + dice(3) * 8;
    desc->supersample = 1 + dice(2);
    return "the picture";
  default:
    scene->background = 0.1 + spread(0.1);
    light->soft_rad *= 0.9;
    return "the background and a cone";
  }
}

static void walk_at_random(const char *text, unsigned seed, int steps, bool sizes) {
  abbe_render_desc desc = tiny;
  dice_state = seed;
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  for (int step = 0; step < steps; step++) {
    const char *what = change_anything(&scene, &desc, sizes);
    if (dice(3) == 0) what = change_anything(&scene, &desc, sizes); /* two at a time */
    abbe_plan plan;
    abbe_error error = {0};
    const abbe_result planned = abbe_plan_make(&scene, &desc, &plan, &error);
    if (planned == ABBE_OK) abbe_plan_free(&plan);
    assert_int_equal(change(renderer, &scene, &desc), planned);
    if (planned == ABBE_OK && dice(3) > 0) assert_as_made_anew(renderer, &scene, &desc, what);
  }
}

TEST(random_changes_of_a_solid) {
  walk_at_random(GLASS_SCENE, 1, all_cases() ? 20 : 12, true);
}

/* Fewer than a solid's: the shaders of meshes take llvmpipe seconds to compile. */
TEST(random_changes_of_meshes) {
  walk_at_random(MESH_SCENE, 2, all_cases() ? 8 : 5, false);
}

/* From one scene to another and back, and to the passes of published methods. */
TEST(another_scene_is_a_change_too) {
  OWNED(abbe_scene, solid) = scene_of(GLASS_SCENE);
  OWNED(abbe_scene, mesh) = scene_of(MESH_SCENE);
  HELD(abbe_renderer, renderer) = drawn_renderer(&solid, &tiny);
  OK(change(renderer, &mesh, &tiny));
  assert_as_made_anew(renderer, &mesh, &tiny, "another scene");
  static const abbe_profile published[] = {ABBE_PROFILE_THESIS, ABBE_PROFILE_SHAH2007};
  for (int i = 0; i < 2; i++) {
    abbe_render_desc desc = tiny;
    desc.profile = published[i];
    desc.wavelengths = 0;
    OK(change(renderer, &solid, &desc));
    abbe_statistics s = draw_frame(renderer);
    assert_true(s.pass_count > 0 && s.photons > 0);
  }
  OK(change(renderer, &solid, &tiny));
  assert_as_made_anew(renderer, &solid, &tiny, "published profiles");
}
