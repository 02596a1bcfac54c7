/* A renderer that is changed draws, bit for bit, what one that is made anew draws, and runs no more
 * passes than the change asks for. */
#include "tests/gl/frame.h"

#include "base/watch.h"
#include "gl/renderer_state.h"
#include "scenes/geometry/transform.h"
#include "scenes/object_motion.h"

static const abbe_render_desc tiny = {
    .width = 24, .height = 20, .photons = 32, .map_size = 64, .supersample = 1};

#define GLASS_SCENE                                                                                \
  CAMERA POINT_LIGHT FLOOR BRICK("crown") "- {name: card, shape: rectangle, width: 0.1, height: "  \
                                          "0.1, reflectance: 0.7, transform: "                     \
                                          "[{translate: [-0.2, 0, 0.1]}]}\n"

/* Two lights, a mesh that is traversed, and a receiver that is no rectangle. */
#define MESH_SCENE                                                                                 \
  CAMERA "lights:\n"                                                                               \
         "- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"                \
         "- {name: spot, kind: spot, position: [-0.4, 0, 0.7], target: [0, 0, 0.2], intensity: 2," \
         " cone: 40}\n" FLOOR RING("crown") HILL

static bool stop_at(void *user, double done) {
  int *left = user;
  (void)done;
  return --*left > 0;
}

static abbe_result change(abbe_renderer *renderer, const abbe_scene *scene,
                          const abbe_render_desc *desc) {
  abbe_error error = {0};
  return abbe_renderer_change(renderer, scene, desc, &error);
}

static void assert_as_made_anew(abbe_renderer *renderer, const abbe_scene *scene,
                                const abbe_render_desc *desc, const char *what) {
  abbe_image kept = {0}, anew = {0}, kept_map = {0}, anew_map = {0};
  abbe_renderer *other = make_renderer(scene, desc);
  const abbe_statistics a = draw_frame(renderer), b = draw_frame(other);
  read_picture(renderer, desc->aovs, &kept);
  read_picture(other, desc->aovs, &anew);
  assert_int_equal(kept.width * kept.height * kept.channels,
                   anew.width * anew.height * anew.channels);
  for (size_t i = 0; i < kept.width * kept.height * kept.channels; i++)
    if (memcmp(&kept.data[i], &anew.data[i], sizeof *kept.data) != 0) {
      print_error("after %s, value %zu: %.9g, and %.9g anew\n", what, i, (double)kept.data[i],
                  (double)anew.data[i]);
      fail();
    }
  if (abbe_renderer_plan(renderer)->caustics && abbe_renderer_plan(renderer)->reaches[0]) {
    read_map(renderer, 0, &kept_map);
    read_map(other, 0, &anew_map);
    assert_same_pixels(&kept_map, &anew_map);
  }
  assert_memory_equal(&a.energy, &b.energy, sizeof a.energy);
  assert_int_equal(a.photons, b.photons);
  abbe_image_free(&kept);
  abbe_image_free(&anew);
  abbe_image_free(&kept_map);
  abbe_image_free(&anew_map);
  abbe_renderer_free(other);
}

/* Of the frame after a change. */
static void assert_ran(const abbe_statistics *s, bool light, bool eye) {
  for (abbe_pass pass = 0; pass < ABBE_PASS_COUNT; pass++) {
    const bool is_light = abbe_pass_stage_of(pass) == ABBE_STAGE_LIGHT;
    const bool ran = abbe_statistics_ran(s, pass);
    if (ran && !(is_light ? light : eye)) print_error("'%s' ran\n", abbe_plan_item_text(pass));
    assert_true(!ran || (is_light ? light : eye));
    assert_false(ran && s->kept[pass]);
  }
  assert_true(abbe_statistics_ran(s, ABBE_PASS_PHOTONS) == light);
  assert_true(s->kept[ABBE_PASS_PHOTONS] == !light);
  assert_true(abbe_statistics_ran(s, ABBE_PASS_EYE_RECEIVERS) == eye);
  assert_true(s->kept[ABBE_PASS_EYE_RECEIVERS] == !eye);
}

static void shift_object(abbe_object *object, double x, double y, double z) {
  const double offset[3] = {x, y, z};
  double matrix[16];
  abbe_error error = {0};
  abbe_transform_translate(offset, matrix);
  assert_ok(abbe_object_move(object, matrix, &error), &error);
}

/* What each kind of change runs. */
static void a_change_runs_what_depends_on_it(void **state) {
  (void)state;
  abbe_scene scene = {0};
  load_text(GLASS_SCENE, &scene);
  abbe_render_desc desc = tiny;
  abbe_renderer *renderer = make_renderer(&scene, &desc);
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
    assert_int_equal(change(renderer, &scene, &desc), ABBE_OK);
    s = draw_frame(renderer);
    assert_ran(&s, cases[i].light, cases[i].eye);
    if (i == 2) assert_near(s.energy.reached, 0.5 * energy, 1e-12 * energy);
    assert_as_made_anew(renderer, &scene, &desc, cases[i].what);
  }
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* A camera that looks away sees no refractor: its pass, and its buffers, come and go. */
static void what_the_camera_sees_comes_and_goes(void **state) {
  (void)state;
  abbe_scene scene = {0};
  load_text(GLASS_SCENE, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  draw_frame(renderer);
  for (int turn = 0; turn < 3; turn++) {
    scene.camera.target[0] = turn == 1 ? -3 : 0;
    scene.camera.target[1] = turn == 1 ? -0.5 : 0;
    assert_int_equal(change(renderer, &scene, &tiny), ABBE_OK);
    assert_true(abbe_renderer_plan(renderer)->camera_sees_refractor == (turn != 1));
    assert_as_made_anew(renderer, &scene, &tiny, "a turn of the camera");
  }
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* What all powers are measured by goes by the greatest of lights, ambient light and background. */
static void the_unit_of_power_comes_and_goes(void **state) {
  (void)state;
  static const double powers[] = {1e-20, 1e-20, 1e-20, 1, 1}, background[] = {0, 0.1, 0, 0, 1e30};
  abbe_scene scene = {0};
  load_text(GLASS_SCENE, &scene);
  scene.ambient = scene.background = 0;
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
    scene.light[0].power = powers[i];
    scene.background = background[i];
    assert_int_equal(change(renderer, &scene, &tiny), ABBE_OK);
    assert_as_made_anew(renderer, &scene, &tiny, "another unit of power");
  }
  abbe_render_desc other = tiny;
  other.space = ABBE_RGB_SPACE_REC709;
  assert_int_equal(change(renderer, &scene, &other), ABBE_OK);
  const abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, false, true);
  assert_as_made_anew(renderer, &scene, &other, "another space");
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* Watched and not, with more wavelengths than a pixel's coarse bands. */
static void a_watched_frame_is_the_same(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_image alone = {0}, watched = {0};
  abbe_error error = {0};
  int left = 1 << 30;
  load_text(GLASS_SCENE, &scene);
  abbe_render_desc desc = tiny;
  desc.wavelengths = 12;
  desc.width = 200; /* some tiles of the rasteriser's */
  desc.height = 140;
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  draw_frame(renderer);
  read_picture(renderer, false, &alone);
  for (int turn = 0; turn < 2; turn++) { /* then of a camera that sees no refractor */
    if (turn == 1) scene.camera.target[0] = -3, scene.camera.target[1] = -0.5;
    assert_int_equal(change(renderer, &scene, &desc), ABBE_OK);
    abbe_renderer_redraw(renderer);
    assert_ok(abbe_renderer_frame(renderer, stop_at, &left, NULL, &error), &error);
    assert_as_made_anew(renderer, &scene, &desc, "a watched frame");
    if (turn == 1) continue;
    read_picture(renderer, false, &watched);
    assert_same_pixels(&alone, &watched);
  }
  abbe_image_free(&alone);
  abbe_image_free(&watched);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* The scene that cannot be planned leaves the renderer as it was. */
static void a_refused_change_changes_nothing(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_image before = {0}, after = {0};
  load_text(GLASS_SCENE, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  draw_frame(renderer);
  read_picture(renderer, false, &before);
  abbe_render_desc wrong = tiny;
  wrong.photons = ABBE_RENDER_MAX_PHOTONS + 1;
  assert_int_equal(change(renderer, &scene, &wrong), ABBE_INVALID_ARGUMENT);
  const abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, false, false);
  read_picture(renderer, false, &after);
  assert_same_pixels(&before, &after);
  assert_int_equal(abbe_renderer_change(renderer, NULL, &tiny, NULL), ABBE_INVALID_ARGUMENT);
  abbe_image_free(&before);
  abbe_image_free(&after);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* Wherever a frame or a change is cancelled, the renderer goes on. */
static void a_cancelled_renderer_goes_on(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_error error = {0};
  load_text(GLASS_SCENE, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  abbe_result result = ABBE_CANCELLED;
  int calls = 0;
  for (int most = 1; result == ABBE_CANCELLED && most < 10000; most += 1 + most / 4) {
    int left = most;
    abbe_renderer_redraw(renderer);
    result = abbe_renderer_frame(renderer, stop_at, &left, NULL, &error);
    calls = most - left;
  }
  assert_int_equal(result, ABBE_OK);
  assert_true(calls >= 3);
  assert_as_made_anew(renderer, &scene, &tiny, "cancelled frames");
  int left = 1;
  abbe_render_desc watched = tiny;
  watched.progress = stop_at;
  watched.progress_user = &left;
  scene.light[0].position[0] += 0.02;
  assert_int_equal(change(renderer, &scene, &watched), ABBE_CANCELLED);
  assert_false(abbe_renderer_is_lit(renderer));
  double ms;
  abbe_renderer_hits hits;
  assert_int_equal(abbe_renderer_frame(renderer, NULL, NULL, NULL, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_renderer_baseline(renderer, &ms, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_renderer_read_hits(renderer, 0, 0, NULL, NULL, &hits, &error),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(change(renderer, &scene, &tiny), ABBE_OK);
  assert_as_made_anew(renderer, &scene, &tiny, "a cancelled change");
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* Units of work, counted: what is dispatched, drawn and compiled. */
/* What the camera's passes alone ask for, cancelled, leaves the light as it is. */
static void a_cancelled_view_keeps_the_light(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_error error = {0};
  int left = 1;
  load_text(GLASS_SCENE, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  draw_frame(renderer);
  abbe_render_desc other = tiny;
  other.aovs = true;
  other.progress = stop_at;
  other.progress_user = &left;
  assert_int_equal(change(renderer, &scene, &other), ABBE_CANCELLED);
  assert_true(abbe_renderer_is_lit(renderer));
  assert_int_equal(abbe_renderer_frame(renderer, NULL, NULL, NULL, &error), ABBE_INVALID_ARGUMENT);
  other.progress = NULL;
  assert_int_equal(change(renderer, &scene, &other), ABBE_OK);
  const abbe_statistics s = draw_frame(renderer);
  assert_ran(&s, false, true);
  abbe_renderer_redraw(renderer);
  assert_as_made_anew(renderer, &scene, &other, "a cancelled view");
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* The thread's watch is heard by what comes before the first program: planning, and trees. */
static bool watch_at(void *user) {
  return stop_at(user, 0);
}

static void a_watch_ends_a_change(void **state) {
  (void)state;
  abbe_scene scene = {0};
  abbe_result result = ABBE_CANCELLED;
  int calls = 0;
  load_text(MESH_SCENE, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  draw_frame(renderer);
  scene.light[0].position[0] += 0.02;
  for (int most = 1; result == ABBE_CANCELLED; most++) {
    int left = most;
    abbe_watch watch = {watch_at, &left, false};
    abbe_watch_set(&watch);
    result = change(renderer, &scene, &tiny);
    abbe_watch_set(NULL);
    assert_true(result == ABBE_OK || left == 0); /* and asked no more */
    calls = most - left;
  }
  assert_int_equal(result, ABBE_OK);
  assert_true(calls >= 3);
  assert_as_made_anew(renderer, &scene, &tiny, "a watched change");
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

static struct {
  abbe_gl real;
  int units, most, left; /* since somebody was asked last; the most; calls until they stop it */
  bool stopped;
} counted;

static void count_dispatch(GLuint x, GLuint y, GLuint z) {
  counted.units++;
  counted.real.DispatchCompute(x, y, z);
}
static void count_indirect(GLintptr at) {
  counted.units++;
  counted.real.DispatchComputeIndirect(at);
}
static void count_elements(GLenum mode, GLsizei count, GLenum type, const void *at) {
  counted.units++;
  counted.real.DrawElements(mode, count, type, at);
}
static void count_arrays(GLenum mode, GLint first, GLsizei count) {
  counted.units++;
  counted.real.DrawArrays(mode, first, count);
}
static void count_program(GLuint program) {
  counted.units++;
  counted.real.LinkProgram(program);
}

static bool stop_counted(void *user, double done) {
  (void)user;
  (void)done;
  assert_false(counted.stopped); /* nobody is asked again */
  if (counted.units > counted.most) counted.most = counted.units;
  counted.units = 0;
  counted.stopped = --counted.left <= 0;
  return !counted.stopped;
}

static void begin_count(void) {
  abbe_gl *gl = (abbe_gl *)abbe_context_gl(context);
  counted.real = *gl;
  gl->DispatchCompute = count_dispatch;
  gl->DispatchComputeIndirect = count_indirect;
  gl->DrawElements = count_elements;
  gl->DrawArrays = count_arrays;
  gl->LinkProgram = count_program;
}

static void end_count(void) {
  *(abbe_gl *)abbe_context_gl(context) = counted.real;
}

/* Whoever watches is asked after every few units of work, and after their no there is next to none:
 * of a change and the frame after it, from another light on, of another size. */
static void a_cancel_is_heard_soon(void **state) {
  (void)state;
  enum { MOST_APART = 12, MOST_AFTER = 2 };
  abbe_scene scene = {0};
  abbe_error error = {0};
  load_text(GLASS_SCENE, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &tiny);
  abbe_render_desc watched = tiny;
  watched.progress = stop_counted;
  begin_count();
  for (int most = 1, done = 0; !done; most += 1 + most / 8) {
    counted.left = most;
    counted.units = counted.most = 0;
    counted.stopped = false;
    scene.light[0].position[0] += 0.001;
    watched.width = 16 + (size_t)(most % 16);
    abbe_result result = change(renderer, &scene, &watched);
    if (result == ABBE_OK) result = abbe_renderer_frame(renderer, stop_counted, NULL, NULL, &error);
    done = result == ABBE_OK;
    assert_true(done || result == ABBE_CANCELLED);
    if (!done && counted.units > MOST_AFTER) fail_msg("%d units after no %d", counted.units, most);
    if (counted.most > MOST_APART) fail_msg("%d units between two questions", counted.most);
  }
  end_count();
  watched.progress = NULL;
  assert_as_made_anew(renderer, &scene, &watched, "cancelled changes");
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
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
  abbe_scene scene = {0};
  abbe_render_desc desc = tiny;
  dice_state = seed;
  load_text(text, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
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
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

static void random_changes_of_a_solid(void **state) {
  (void)state;
  walk_at_random(GLASS_SCENE, 1, 20, true);
}

/* Each size of a buffer has llvmpipe compile the shaders of meshes again, for seconds; what depends
 * on sizes is the solid's walk. */
static void random_changes_of_meshes(void **state) {
  (void)state;
  walk_at_random(MESH_SCENE, 2, 8, false);
}

/* From one scene to another and back, and to the passes of published methods. */
static void another_scene_is_a_change_too(void **state) {
  (void)state;
  abbe_scene solid = {0}, mesh = {0};
  load_text(GLASS_SCENE, &solid);
  load_text(MESH_SCENE, &mesh);
  abbe_renderer *renderer = make_renderer(&solid, &tiny);
  draw_frame(renderer);
  assert_int_equal(change(renderer, &mesh, &tiny), ABBE_OK);
  assert_as_made_anew(renderer, &mesh, &tiny, "another scene");
  static const abbe_profile published[] = {ABBE_PROFILE_THESIS, ABBE_PROFILE_SHAH2007};
  for (int i = 0; i < 2; i++) {
    abbe_render_desc desc = tiny;
    desc.profile = published[i];
    desc.wavelengths = 0;
    assert_int_equal(change(renderer, &solid, &desc), ABBE_OK);
    abbe_statistics s = draw_frame(renderer);
    assert_true(s.pass_count > 0 && s.photons > 0);
  }
  assert_int_equal(change(renderer, &solid, &tiny), ABBE_OK);
  assert_as_made_anew(renderer, &solid, &tiny, "published profiles");
  abbe_renderer_free(renderer);
  abbe_scene_free(&solid);
  abbe_scene_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_change_runs_what_depends_on_it),
      cmocka_unit_test(what_the_camera_sees_comes_and_goes),
      cmocka_unit_test(the_unit_of_power_comes_and_goes),
      cmocka_unit_test(a_watched_frame_is_the_same),
      cmocka_unit_test(a_refused_change_changes_nothing),
      cmocka_unit_test(a_cancelled_renderer_goes_on),
      cmocka_unit_test(a_cancelled_view_keeps_the_light),
      cmocka_unit_test(a_watch_ends_a_change),
      cmocka_unit_test(a_cancel_is_heard_soon),
      cmocka_unit_test(random_changes_of_a_solid),
      cmocka_unit_test(random_changes_of_meshes),
      cmocka_unit_test(another_scene_is_a_change_too),
  };
  return cmocka_run_group_tests(tests, make_context, free_context);
}
