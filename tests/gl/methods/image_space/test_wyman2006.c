/* Photons in image space, in units and as printed: what arrives, light that nothing bends, what a
 * flat mirror sends, the three directions, sparse neighbourhoods, and the filter over frames. */
#include "tests/gl/methods/image_space/image_pictures.h"

#include "base/maths.h"
#include "gl/scene/local_scene.h"

static const abbe_fill fills[] = {ABBE_FILL_POINTS, ABBE_FILL_QUADS, ABBE_FILL_TRIANGLES,
                                  ABBE_FILL_GATHER_EYE, ABBE_FILL_GATHER_LIGHT};
enum { FILLS = sizeof fills / sizeof *fills };

GROUP(make_context, free_context);

/* A pane turns no light: each reconstruction's map holds the lamp's power through it, less two
 * reflections. Polygons miss half a cell all around. */
TEST(what_arrives_is_what_was_sent) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  /* as of the thesis's passes, whose test says how much it is */
  const double h = 0.2995, a = 0.15, angle = 4 * asin(a * a / (a * a + h * h));
  for (int k = 0; k < FILLS; k++) {
    abbe_render_desc desc = small;
    desc.fill = fills[k];
    const double sum = map_energy(&scene, &desc);
    print_message("%s: %.4f of what was sent\n", abbe_fill_name(fills[k]), sum / (angle * 0.9216));
    assert_near(sum, angle * 0.9216, 0.03 * angle);
  }
}

/* Behind a thin pane, where the shadow map knows a shadow, the ratio of solid angles is 1, and the
 * picture is that of the light through it. Gathers of a constant field are constant. */
TEST(a_pane_is_direct_light) {
  abbe_image picture = {0};
  double spread, own_spread;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  abbe_render_desc desc = small;
  desc.width = desc.height = 192;
  desc.profile = ABBE_PROFILE_DEFAULT;
  FILLED(abbe_image, right, make_picture(&scene, &desc, &right));
  const double direct = middle(&right, &own_spread);
  assert_true(direct > 0);
  for (int k = 0; k < FILLS; k++) {
    desc = small;
    desc.width = desc.height = 192;
    desc.photons = 1024;
    desc.fill = fills[k];
    make_picture(&scene, &desc, &picture);
    const double mean = middle(&picture, &spread);
    print_message("%s: %.4f of the direct light, spread %.3f\n", abbe_fill_name(fills[k]),
                  mean / direct, spread);
    assert_near(mean / direct, 1, 0.02);
    if (fills[k] != ABBE_FILL_POINTS) assert_true(spread < own_spread + 0.06);
    abbe_image_free(&picture);
  }
}

/* As printed, likewise: shadowed by the pane and lit by its photons as the floor is beside it, for
 * Fresnel's law is not known; by whatever direction, for all are the direct light's. */
TEST(a_pane_as_printed) {
  static const abbe_direction directions[] = {ABBE_DIRECTION_OWN, ABBE_DIRECTION_MEAN,
                                              ABBE_DIRECTION_DIRECT};
  abbe_image picture = {0};
  double spread;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  for (int k = 0; k < FILLS; k++)
    for (int i = 0; i < 3; i++) {
      abbe_render_desc desc = small;
      desc.width = desc.height = 192;
      desc.profile = ABBE_PROFILE_WYMAN2006;
      desc.space = ABBE_RGB_SPACE_REC709;
      desc.fill = fills[k];
      desc.direction = directions[i];
      make_picture(&scene, &desc, &picture);
      assert_string_equal(picture.channel[1], "G");
      const double mean = middle(&picture, &spread);
      /* 0.5 (cos + 0.1): the middle is at 0.12 of the floor, 0.6 below the lamp */
      print_message("%s, %d: %.4f\n", abbe_fill_name(fills[k]), i, mean);
      assert_near(mean, 0.5 * (0.99 + 0.1), 0.03);
      abbe_image_free(&picture);
    }
}

/* A flat mirror sends all of its share of the lamp's light to the floor, as the default profile has
 * it. */
TEST(a_flat_mirror_has_the_lamps_light) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR MIRROR("0.8"));
  abbe_render_desc desc = small;
  desc.photons = 1024;
  double sum[FILLS];
  for (int k = 0; k < FILLS; k++) {
    desc.fill = fills[k];
    sum[k] = map_energy(&scene, &desc);
    desc.estimator = ABBE_ESTIMATOR_EXACT;
    assert_near(map_energy(&scene, &desc) / sum[k], 1, 0.01); /* places are found */
    desc.estimator = ABBE_ESTIMATOR_AUTO;
  }
  desc = small;
  desc.profile = ABBE_PROFILE_DEFAULT;
  const double right = map_energy(&scene, &desc);
  assert_true(right > 0);
  for (int k = 0; k < FILLS; k++) {
    print_message("%s: %.4f of the mirror's light\n", abbe_fill_name(fills[k]), sum[k] / right);
    assert_near(sum[k] / right, 1, 0.05); /* its cells are whole ones */
  }
}

/* Where the camera's pixel sees the floor. */
static void floor_of(const abbe_camera_view *camera, size_t x, size_t y, double out[3]) {
  const double uv[2] = {((double)x + 0.5) / 64, 1 - ((double)y + 0.5) / 64};
  double o[3], d[3];
  abbe_view_ray(&camera->view, uv, o, d);
  for (int k = 0; k < 3; k++) out[k] = o[k] - d[k] * o[2] / d[2];
}

static double cosine(const double at[3], const double lamp[3]) {
  double to[3];
  abbe_vector_subtract(lamp, at, to);
  return to[2] / abbe_vector_length(to);
}

/* Shading by photons' direction is the direct light's times the ratio of their cosines to the
 * floor, and only the direct light's is right: area is counted with the cosine already. */
TEST(directions_differ_by_their_cosines) {
  static const double lamp[3] = {0.05, 0.03, 0.6}, centre[3] = {0.1, 0, 0.15};
  const double n[3] = {sin(60 * 3.14159265358979 / 180), 0, 0.5};
  double image[3], to[3], dark[64 * 64];
  abbe_camera_view camera;
  abbe_image picture[3];
  abbe_render_desc desc = small;
  desc.profile = ABBE_PROFILE_WYMAN2006;
  desc.space = ABBE_RGB_SPACE_REC709;
  for (int i = 0; i < 3; i++) {
    OWNED(abbe_scene, scene) = scene_of(i == 0 ? CAMERA POINT_LIGHT FLOOR MIRROR("0.0001")
                                               : CAMERA POINT_LIGHT FLOOR MIRROR("0.8"));
    desc.direction = i == 1 ? ABBE_DIRECTION_OWN : ABBE_DIRECTION_DIRECT;
    make_picture(&scene, &desc, &picture[i]);
    abbe_camera_view_fit(&scene, &desc, &camera);
  }
  abbe_vector_subtract(lamp, centre, to);
  for (int k = 0; k < 3; k++) image[k] = lamp[k] - 2 * abbe_vector_dot(to, n) * n[k];
  size_t met = 0;
  for (size_t i = 0; i < 64 * 64; i++) {
    double at[3];
    dark[i] = (double)picture[0].data[3 * i + 1];
    const double own = (double)picture[1].data[3 * i + 1] - dark[i];
    const double direct = (double)picture[2].data[3 * i + 1] - dark[i];
    if (direct < 0.05 || dark[i] < 0.04) continue; /* little light; the mirror itself */
    floor_of(&camera, i % 64, i / 64, at);
    if (fabs(at[0]) > 0.9 || fabs(at[1]) > 0.9 || at[0] < 0.15) continue;
    assert_near(own / direct, cosine(at, image) / cosine(at, lamp), 0.06);
    met++;
  }
  print_message("%zu pixels\n", met);
  assert_true(met > 20);
  for (int i = 0; i < 3; i++) abbe_image_free(&picture[i]);
}

/* One photon in 32 x 32 texels: as printed all are dropped, in units none is. */
TEST(sparse_neighbourhoods) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  abbe_render_desc desc = small;
  desc.photons = 64;
  desc.map_size = 1024;
  assert_true(map_energy(&scene, &desc) > 0.5);
  desc.profile = ABBE_PROFILE_WYMAN2006;
  desc.space = ABBE_RGB_SPACE_REC709;
  assert_true(map_energy(&scene, &desc) == 0);
}

/* Frames */

static const double jitter[4][2] = {
    {-0.375, -0.125}, {0.125, -0.375}, {0.375, 0.125}, {-0.125, 0.375}};

static void next_frame(abbe_renderer *renderer, abbe_image *map) {
  abbe_renderer_redraw(renderer);
  draw_frame(renderer);
  abbe_image_free(map);
  *map = map_of(renderer, 0);
}

/* A still scene is the same frame by frame as printed; in units it is the mean of four grids. */
TEST(a_still_scene) {
  OWNED(abbe_image, first) = {0}, map = {0}, one = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  abbe_render_desc desc = FIELDS(.profile = ABBE_PROFILE_WYMAN2006, .width = 16, .height = 16,
                                 .photons = 256, .map_size = 128, .history = 4);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  next_frame(renderer, &first);
  for (int k = 0; k < 4; k++) next_frame(renderer, &map);
  assert_same_pixels(&first, &map);
  abbe_renderer_free(renderer);

  desc.profile = ABBE_PROFILE_WYMAN2006_CIE;
  renderer = make_renderer(&scene, &desc);
  for (int k = 0; k < 6; k++) next_frame(renderer, &map);
  abbe_renderer_free(renderer);
  FREED double *mean = calloc(128 * 128, sizeof *mean);
  assert_non_null(mean);
  double apart = 0;
  for (int k = 0; k < 4; k++) {
    desc.history = 1;
    for (int axis = 0; axis < 2; axis++) desc.photon_shift[axis] = jitter[k][axis];
    renderer = make_renderer(&scene, &desc);
    next_frame(renderer, &one);
    abbe_renderer_free(renderer);
    for (size_t i = 0; i < 128 * 128; i++) mean[i] += (double)one.data[3 * i + 1] / 4;
  }
  const double most = image_max(&map, 1);
  for (size_t i = 0; i < 128 * 128; i++) {
    assert_near((double)map.data[3 * i + 1], mean[i], 1e-4 * most);
    apart = fmax(apart, fabs((double)one.data[3 * i + 1] - mean[i]));
  }
  assert_true(apart > 1e-3 * most); /* the grids do differ */
}

/* A mirror that is uncovered shows by quarters, and one that is covered goes by them. */
static void step(abbe_profile profile, bool up) {
  OWNED(abbe_image, map) = {0};
  OWNED(abbe_scene, dark) = scene_of(CAMERA POINT_LIGHT FLOOR MIRROR("0.0001"));
  OWNED(abbe_scene, bright) = scene_of(CAMERA POINT_LIGHT FLOOR MIRROR("0.8"));
  abbe_render_desc desc = {
      .profile = profile, .width = 16, .height = 16, .photons = 512, .map_size = 64, .history = 4};
  HELD(abbe_renderer, renderer) = make_renderer(&bright, &desc);
  for (int k = 0; k < 4; k++) next_frame(renderer, &map);
  const double full = image_sum(&map, 1);
  if (up) {
    OK(abbe_renderer_change(renderer, &dark, &desc, &error));
    for (int k = 0; k < 4; k++) next_frame(renderer, &map);
    assert_true(image_sum(&map, 1) < 0.01 * full);
  }
  OK(abbe_renderer_change(renderer, up ? &bright : &dark, &desc, &error));
  for (int k = 1; k <= 4; k++) {
    next_frame(renderer, &map);
    const double share = image_sum(&map, 1) / full;
    print_message("%s, %s: %.3f after %d\n", abbe_profile_name(profile), up ? "up" : "down", share,
                  k);
    assert_near(share, up ? 0.25 * k : 1 - 0.25 * k, 0.02);
  }
}

TEST(steps) {
  step(ABBE_PROFILE_WYMAN2006_CIE, true);
  step(ABBE_PROFILE_WYMAN2006_CIE, false);
}

/* A ball that moves half a millimetre a frame, in maps of 8 mm, of so many photons a side. flicker:
 * the mean square of the difference between two frames by that of a frame; ghost: the share of
 * light where the photons of a frame alone bring none. */
static void measure_motion(size_t photons, size_t history, double *flicker, double *ghost) {
  abbe_image map[2] = {{0}}, plain = {0};
  abbe_renderer *renderer = NULL;
  abbe_render_desc desc = FIELDS(.profile = ABBE_PROFILE_WYMAN2006_CIE, .width = 16, .height = 16,
                                 .photons = photons, .map_size = 256, .history = history);
  abbe_scene scene[8] = {{0}};
  double change = 0, all = 0, nowhere = 0, light = 0;
  for (int k = 0; k < 8; k++) {
    scene[k] = scene_of(
        printed(CAMERA POINT_LIGHT FLOOR
                "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: "
                "[0.00%02d, 0, 0.2]}], material: flat}\n",
                5 * k));
    if (k == 0)
      renderer = make_renderer(&scene[k], &desc);
    else
      OK(abbe_renderer_change(renderer, &scene[k], &desc, &error));
    draw_frame(renderer);
    abbe_image_free(&map[k & 1]);
    map[k & 1] = map_of(renderer, 0);
    if (k < 4) continue;
    abbe_render_desc alone = desc;
    alone.history = 1;
    make_map(&scene[k], &alone, &plain);
    for (size_t i = 1; i < 3 * 256 * 256; i += 3) {
      const double here = (double)map[k & 1].data[i], before = (double)map[!(k & 1)].data[i];
      change += (here - before) * (here - before);
      all += here * here;
      light += here;
      if (plain.data[i] == 0) nowhere += here;
    }
    abbe_image_free(&plain);
  }
  *flicker = change / all;
  *ghost = nowhere / light;
  abbe_renderer_free(renderer);
  for (int k = 0; k < 8; k++) abbe_scene_free(&scene[k]);
  for (int k = 0; k < 2; k++) abbe_image_free(&map[k]);
}

/* Less the difference that the motion itself makes, by maps of many photons. */
TEST(flicker_and_ghost) {
  double flicker[2], ghost[2], own, none;
  measure_motion(1024, 1, &own, &none);
  for (int k = 0; k < 2; k++) {
    measure_motion(96, k == 0 ? 1 : 4, &flicker[k], &ghost[k]);
    flicker[k] = sqrt(fmax(flicker[k] - own, 0));
    print_message("%d frames: flicker %.3f, ghost %.4f; the motion's own %.3f\n", k == 0 ? 1 : 4,
                  flicker[k], ghost[k], sqrt(own));
  }
  assert_true(flicker[0] > 0 && flicker[1] < 0.75 * flicker[0]);
  assert_true(ghost[0] < 1e-6 && ghost[1] > ghost[0]);
}

/* What it does not know. */
TEST(refusals) {
  abbe_renderer *renderer = NULL;
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR BALL("flat"));
  REFUSED(ABBE_UNSUPPORTED, "directional",
          abbe_renderer_make(context, &scene, &small, &renderer, &error));
}
