/* Caustics looked up in volumes: every pixel of a floor has what the processor finds there, however
 * the object and the light are moved; what a volume does not hold is refused. */
#include "tests/gl/frame.h"
#include "tests/scenes/volume/volume_lookup.h"

#include "base/maths.h"
#include "colorimetry/rgb_space.h"
#include "scenes/geometry/transform.h"
#include "scenes/object_motion.h"
#include "scenes/volume/exits/exit_pages.h"
#include "scenes/volume/half.h"
#include "validation/lab/volume_fill.h"

enum { MAP_TEXELS = 16 }; /* a side of a page: so few that it has one level */

static const char ball[] =
    CAMERA SUN FLOOR "- {name: orb, shape: sphere, radius: 0.1, levels: 4, material: crown, "
                     "transform: [{translate: [0, 0, 0.15]}]}\n";
static const char wedge[] =
    CAMERA SUN FLOOR "- {name: wedge, shape: prism, apex: 50, side: 0.2, length: 0.2, material: "
                     "crown, transform: [{translate: [0, 0, 0.2]}]}\n";

#define SUN_OF(name) "- {name: " name ", kind: directional, direction: [0, 0, -1], irradiance: 1}\n"
#define SUNS(name) SUN_OF(name "1") SUN_OF(name "2") SUN_OF(name "3")
#define CHEST(name, x)                                                                             \
  "- {name: " name                                                                                 \
  ", shape: box, size: [0.2, 0.2, 0.2], reflectance: 0.5, transform: [{translate: "                \
  "[" x ", 0, 0]}]}\n"

static const abbe_region_desc regions[] = {
    {.kind = ABBE_REGION_GRID, .side = 16},
    {.kind = ABBE_REGION_GEODESIC, .levels = 3, .shells = 8},
    {.kind = ABBE_REGION_OCTAHEDRAL, .side = 16, .shells = 8}};

static void make_volume(const abbe_scene *scene, abbe_volume_kind kind, size_t region, size_t nodes,
                        abbe_caustic_volume *out) {
  abbe_volume_fill_statistics done;
  const bool exits = kind == ABBE_VOLUME_EXITS;
  const abbe_volume_fill_desc desc =
      FIELDS(.object = scene->object_count - 1, .kind = exits ? ABBE_VOLUME_VECTOR : kind,
             .exits = exits ? 400 : 0, .nodes = nodes, .region = regions[region], .photons = 8192,
             .passes = 1, .threads = 2);
  OK(abbe_volume_fill(scene, &desc, out, &done, &error));
}

/* Where pixel i of the picture sees the floor; false where the object may be in the way. */
static bool see_floor(const abbe_scene *scene, size_t width, size_t height, size_t i,
                      const abbe_volume_place *place, double radius, double p[3]) {
  const abbe_camera *c = &scene->camera;
  double forward[3], right[3], up[3], d[3], to[3];
  abbe_vector_subtract(c->target, c->eye, forward);
  abbe_vector_normalise(forward);
  abbe_vector_cross(forward, c->up, right);
  abbe_vector_normalise(right);
  abbe_vector_cross(right, forward, up);
  const double half = tan(c->fov_y_rad / 2);
  const double x = (2 * ((double)(i % width) + 0.5) / (double)width - 1) * half * (double)width /
                   (double)height,
               y = (1 - 2 * ((double)(i / width) + 0.5) / (double)height) * half;
  for (int k = 0; k < 3; k++) d[k] = forward[k] + x * right[k] + y * up[k];
  if (!(d[2] < 0)) return false;
  for (int k = 0; k < 3; k++) p[k] = c->eye[k] - c->eye[2] / d[2] * d[k];
  if (fabs(p[0]) > 0.99 || fabs(p[1]) > 0.99) return false;
  abbe_vector_normalise(d);
  abbe_vector_subtract(place->centre, c->eye, to);
  const double along = abbe_vector_dot(to, d);
  return abbe_vector_dot(to, to) - along * along > 1.1 * radius * radius;
}

/* What the floor sends of a light, in ACEScg; printed in the light's own white. */
static void oracle(const abbe_scene *scene, const abbe_caustic_volume *v, abbe_volume_lookup lookup,
                   const abbe_volume_place *place, const double p[3], double rgb[3]) {
  const abbe_light *light = &scene->light[0];
  double from[3], to_light[3], own[3], at[3], matrix[9], xyz[3], f[3][3];
  abbe_volume_sight sight;
  const bool rays = lookup == ABBE_VOLUME_LOOKUP_COUNT; /* which have the light's distance */
  double strength = light->power;
  abbe_vector_subtract(p, place->centre, from);
  for (int k = 0; k < 3; k++) to_light[k] = -light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_vector_subtract(light->position, place->centre, to_light);
    if (!rays) strength /= abbe_vector_dot(to_light, to_light);
    abbe_vector_normalise(to_light);
  }
  for (int k = 0; k < 3; k++) {
    own[k] = at[k] = 0;
    for (int j = 0; j < 3; j++) {
      own[k] += place->turn[3 * j + k] * to_light[j];
      at[k] += place->turn[3 * j + k] * from[j];
    }
  }
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  abbe_caustic_volume_look(v, rays ? ABBE_VOLUME_LOOKUP_BLEND : lookup,
                           rays ? v->nodes.direction[0] : own, &sight);
  if (v->kind == ABBE_VOLUME_PRINTED) {
    double ratio[3], white[3];
    abbe_caustic_volume_ratio(v, &sight, at, ratio);
    abbe_rgb_space_apply(matrix, v->white, white);
    const double facing = fmax(-from[2] / abbe_vector_length(from), 0);
    for (int k = 0; k < 3; k++) rgb[k] = 0.5 / ABBE_PI * strength * facing * ratio[k] * white[k];
    return;
  }
  abbe_caustic_volume_flux(v, &sight, at, f);
  for (int c = 0; c < 3; c++) {
    double down = 0; /* of F in the world */
    for (int j = 0; j < 3; j++) down -= place->turn[6 + j] * f[c][j];
    xyz[c] = 0.5 / ABBE_PI * strength * fmax(down, 0);
  }
  abbe_rgb_space_apply(matrix, xyz, rgb);
}

/* What rays bring to the cells in the scene's light, as a volume of one node that lights alike from
 * anywhere at any distance. */
static void fill_by_rays(const abbe_scene *scene, const abbe_caustic_volume *v,
                         const abbe_volume_place *place, abbe_caustic_volume *out) {
  const abbe_exit_light_desc desc = FIELDS(.light = &scene->light[0], .object = &scene->object[1],
                                           .place = place, .min_nm = 380, .max_nm = 780);
  const size_t count = 9 * v->region.cells;
  FREED float *value = malloc(count * sizeof *value);
  assert_non_null(value);
  *out = (abbe_caustic_volume){.body = v->body};
  OK(abbe_volume_region_make(&v->region.desc, &out->region, &error));
  OK(abbe_light_nodes_make(1, (const double[3]){0, 0, 1}, &out->nodes, &error));
  OK(abbe_caustic_volume_allocate(out, &error));
  OK(abbe_exit_light_fill(v, &desc, value, &error));
  for (size_t i = 0; i < count; i++) out->value[i] = abbe_half_of((double)value[i]);
}

/* What rays bring to the floor, straight from their maps. */
static void look_at_pages(const abbe_scene *scene, const abbe_exit_pages *pages, const double p[3],
                          double rgb[3]) {
  const double *at = scene->object[0].exact.parallelogram[0];
  double from[3], n[3], matrix[9], xyz[3];
  abbe_vector_subtract(p, at, from);
  abbe_vector_cross(at + 3, at + 6, n);
  const double u = abbe_vector_dot(from, at + 3) / abbe_vector_dot(at + 3, at + 3),
               v = abbe_vector_dot(from, at + 6) / abbe_vector_dot(at + 6, at + 6);
  abbe_exit_pages_at(pages, n[2] > 0 ? 0 : 1, u, v, xyz);
  for (int k = 0; k < 3; k++) xyz[k] *= 0.5 / ABBE_PI * scene->light[0].power;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
}

static void make_pages(const abbe_scene *scene, const abbe_caustic_volume *v,
                       const abbe_volume_place *place, abbe_exit_pages *out) {
  const abbe_exit_light_desc desc = FIELDS(.light = &scene->light[0], .object = &scene->object[1],
                                           .place = place, .min_nm = 380, .max_nm = 780);
  const double(*floor)[9] = (const double(*)[9])scene->object[0].exact.parallelogram;
  OK(abbe_exit_pages_make(v, &desc, floor, 1, MAP_TEXELS, out, &error));
}

/* Mean difference between the caustic of a frame and the oracle's, of the mean. */
static double mean_difference(const abbe_scene *scene, const abbe_caustic_volume *v,
                              abbe_volume_lookup lookup) {
  enum { SIDE = 64 };
  abbe_volume_place place;
  const bool printed = v->kind == ABBE_VOLUME_PRINTED;
  const abbe_render_desc desc =
      FIELDS(.profile = printed ? ABBE_PROFILE_WYMAN2003 : ABBE_PROFILE_DEFAULT, .width = SIDE,
             .height = SIDE, .supersample = 1, .adaptive = 1, .map_size = 4 * MAP_TEXELS,
             .aovs = true, .transport = ABBE_TRANSPORT_VOLUME, .volume = v, .lookup = lookup);
  OWNED(abbe_caustic_volume, filled) = {0};
  OK(abbe_volume_body_find(&v->body, &scene->object[1], &place, &error));
  abbe_renderer *renderer = drawn_renderer(scene, &desc);
  OWNED(abbe_image, picture) = aovs_of(renderer);
  OWNED(abbe_exit_pages, pages) = {0};
  if (v->kind == ABBE_VOLUME_EXITS && scene->object_count == 2)
    make_pages(scene, v, &place, &pages);
  if (v->kind == ABBE_VOLUME_EXITS && pages.count == 0) {
    fill_by_rays(scene, v, &place, &filled);
    lookup = ABBE_VOLUME_LOOKUP_COUNT;
    v = &filled;
  }
  abbe_renderer_free(renderer);
  const size_t first = abbe_image_find_channel(&picture, "caustic.R");
  double off = 0, all = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    double p[3], rgb[3];
    if (!see_floor(scene, SIDE, SIDE, i, &place, v->body.radius, p)) continue;
    if (pages.count > 0)
      look_at_pages(scene, &pages, p, rgb);
    else
      oracle(scene, v, lookup, &place, p, rgb);
    for (size_t k = 0; k < 3; k++) {
      const double seen = (double)picture.data[i * picture.channels + first + k];
      off += fabs(seen - rgb[k]);
      all += fabs(rgb[k]);
    }
  }
  assert_true(all > 0);
  return off / all;
}

GROUP(make_context, free_context);

/* Single precision finds another cell than double at its edges, once in a thousand places. */
TEST(pixels_have_what_the_volume_holds) {
  OWNED(abbe_scene, scene) = scene_of(ball);
  for (size_t region = 0; region < 3; region++)
    for (int kind = 0; kind < 2; kind++) {
      FILLED(abbe_caustic_volume, v, make_volume(&scene, (abbe_volume_kind)kind, region, 12, &v));
      for (int lookup = ABBE_VOLUME_LOOKUP_NEAREST; lookup < ABBE_VOLUME_LOOKUP_COUNT; lookup++)
        assert_near(mean_difference(&scene, &v, (abbe_volume_lookup)lookup), 0, 0.004);
    }
}

/* The object turned and moved, the light a point elsewhere: the same volume. */
TEST(objects_and_lights_move) {
  double turn[16], step[16];
  static const double axis[3] = {0.3, 1, 0.2}, offset[3] = {0.05, 0.1, 0.12};
  OWNED(abbe_scene, scene) = scene_of(wedge);
  FILLED(abbe_caustic_volume, v, make_volume(&scene, ABBE_VOLUME_VECTOR, 2, 12, &v));
  abbe_transform_rotate(0.7, axis, turn);
  abbe_transform_translate(offset, step);
  abbe_transform_multiply(step, turn, turn);
  OK(abbe_object_move(&scene.object[1], turn, &error));
  for (int lookup = ABBE_VOLUME_LOOKUP_NEAREST; lookup < ABBE_VOLUME_LOOKUP_COUNT; lookup++)
    assert_near(mean_difference(&scene, &v, (abbe_volume_lookup)lookup), 0, 0.004);
  scene.light[0].kind = ABBE_LIGHT_POINT;
  static const double there[3] = {-0.8, -0.4, 2.4};
  memcpy(scene.light[0].position, there, sizeof there);
  assert_near(mean_difference(&scene, &v, ABBE_VOLUME_LOOKUP_BLEND), 0, 0.004);
}

/* Rays: of the sun, a lamp that is near, a cone that meets a part of the object; of any white. */
TEST(rays_serve_any_light) {
  static const double lamp[3] = {-0.1, -0.2, 0.7}, down[3] = {0, 0, -1};
  OWNED(abbe_scene, scene) = scene_of(wedge);
  FILLED(abbe_caustic_volume, v, make_volume(&scene, ABBE_VOLUME_EXITS, 2, 12, &v));
  assert_near(mean_difference(&scene, &v, ABBE_VOLUME_LOOKUP_AUTO), 0, 0.004);
  abbe_light *light = &scene.light[0];
  light->illuminant = (abbe_illuminant){.kind = ABBE_ILLUMINANT_A};
  light->kind = ABBE_LIGHT_POINT;
  memcpy(light->position, lamp, sizeof lamp);
  assert_near(mean_difference(&scene, &v, ABBE_VOLUME_LOOKUP_AUTO), 0, 0.004);
  light->kind = ABBE_LIGHT_SPOT;
  memcpy(light->direction, down, sizeof down);
  light->cone_rad = 0.4;
  light->soft_rad = 0.1;
  assert_near(mean_difference(&scene, &v, ABBE_VOLUME_LOOKUP_AUTO), 0, 0.004);
  abbe_scene_free(&scene);
  /* where a receiver is a mesh: in cells */
  scene = scene_of(printed("%s%s", wedge, HILL));
  assert_near(mean_difference(&scene, &v, ABBE_VOLUME_LOOKUP_AUTO), 0, 0.004);
}

/* The largest step between pictures of a light that turns past nodes, of the mean light. */
static double largest_step(abbe_scene *scene, const abbe_caustic_volume *v,
                           abbe_volume_lookup lookup) {
  enum { FRAMES = 24, SIDE = 32 };
  const abbe_render_desc desc = FIELDS(.width = SIDE, .height = SIDE, .supersample = 1,
                                       .adaptive = 1, .aovs = true, .volume = v, .lookup = lookup);
  HELD(abbe_renderer, renderer) = NULL;
  OWNED(abbe_image, before) = {0};
  abbe_image now = {0};
  double most = 0;
  for (int f = 0; f < FRAMES; f++) {
    const double turn = 0.5 + 0.8 * f / FRAMES;
    scene->light[0].direction[0] = 0.6 * cos(turn);
    scene->light[0].direction[1] = 0.6 * sin(turn);
    scene->light[0].direction[2] = -0.8;
    if (renderer == NULL)
      renderer = make_renderer(scene, &desc);
    else
      OK(abbe_renderer_change(renderer, scene, &desc, &error));
    draw_frame(renderer);
    now = aovs_of(renderer);
    const size_t green = abbe_image_find_channel(&now, "caustic.G");
    double step = 0;
    for (size_t i = 0; f > 0 && i < SIDE * SIDE; i++)
      step += fabs((double)now.data[i * now.channels + green] -
                   (double)before.data[i * now.channels + green]);
    most = fmax(most, step / image_sum(&now, green));
    abbe_image_free(&before);
    before = now;
    now = (abbe_image){0};
  }
  return most;
}

/* From node to node the nearest one's caustic jumps; three nodes' fades. */
TEST(blends_do_not_pop) {
  OWNED(abbe_scene, scene) = scene_of(wedge);
  FILLED(abbe_caustic_volume, v, make_volume(&scene, ABBE_VOLUME_VECTOR, 2, 42, &v));
  const double jump = largest_step(&scene, &v, ABBE_VOLUME_LOOKUP_NEAREST);
  const double fade = largest_step(&scene, &v, ABBE_VOLUME_LOOKUP_BLEND);
  print_message("largest step: nearest %.3f, blend %.3f of the light\n", jump, fade);
  assert_true(fade < 0.4 * jump);
}

static void refuse(const abbe_scene *scene, const abbe_render_desc *desc, abbe_result wanted,
                   const char *part) {
  abbe_plan plan;
  REFUSED(wanted, part, abbe_plan_make(scene, desc, &plan, &error));
}

TEST(what_it_does_not_hold_is_refused) {
  OWNED(abbe_scene, scene) = scene_of(ball);
  OWNED(abbe_scene, two) = scene_of(CAMERA SUN FLOOR BALL("crown") BRICK("crown"));
  FILLED(abbe_caustic_volume, v, make_volume(&scene, ABBE_VOLUME_VECTOR, 0, 1, &v));
  FILLED(abbe_caustic_volume, printed, make_volume(&scene, ABBE_VOLUME_PRINTED, 0, 1, &printed));
  abbe_render_desc d = {.transport = ABBE_TRANSPORT_VOLUME};
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "abbe volume");
  d = (abbe_render_desc){.transport = ABBE_TRANSPORT_PHOTONS, .volume = &v};
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "photons");
  d = (abbe_render_desc){.profile = ABBE_PROFILE_WYMAN2003, .volume = &v};
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "--printed");
  d = (abbe_render_desc){.volume = &printed};
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "--printed");
  d = (abbe_render_desc){.profile = ABBE_PROFILE_THESIS, .volume = &v};
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "thesis");
  d = (abbe_render_desc){.lookup = ABBE_VOLUME_LOOKUP_BLEND};
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "lookup");
  d = (abbe_render_desc){.volume = &v};
  refuse(&two, &d, ABBE_UNSUPPORTED, "one object alone");
  scene.light[0].kind = ABBE_LIGHT_POINT;
  scene.light[0].position[2] = 0.9;
  refuse(&scene, &d, ABBE_UNSUPPORTED, "far away");
  scene.light[0].kind = ABBE_LIGHT_SPOT;
  scene.light[0].position[2] = 3;
  scene.light[0].cone_rad = 0.01;
  refuse(&scene, &d, ABBE_UNSUPPORTED, "cone");
  scene.light[0].kind = ABBE_LIGHT_DIRECTIONAL;
  v.white[0] += 0.1;
  refuse(&scene, &d, ABBE_UNSUPPORTED, "white");
  v.kind = ABBE_VOLUME_EXITS;
  d.lookup = ABBE_VOLUME_LOOKUP_BLEND;
  refuse(&scene, &d, ABBE_INVALID_ARGUMENT, "interpolated");
  d = (abbe_render_desc){.volume = &v, .max_nm = 800};
  refuse(&scene, &d, ABBE_UNSUPPORTED, "800");
  v.kind = ABBE_VOLUME_VECTOR;
}

/* Maps of rays are as many as uniforms hold, 192: of eight suns on both sides of twelve faces; of a
 * ninth there are none. */
TEST(maps_of_rays_are_as_many_as_fit) {
  abbe_plan plan;
  OWNED(abbe_scene, scene) = scene_of(CAMERA "lights:\n" SUNS("a") SUNS("b") SUNS(
      "c") "objects:\n" CHEST("left", "-0.6") CHEST("right", "0.6") BALL("crown"));
  assert_int_equal(scene.light_count, 9);
  FILLED(abbe_caustic_volume, v, make_volume(&scene, ABBE_VOLUME_EXITS, 2, 12, &v));
  const abbe_render_desc d = {.volume = &v};
  OK(abbe_plan_make(&scene, &d, &plan, &error));
  assert_int_equal(plan.volume_pages, 0);
  abbe_plan_free(&plan);
  scene.light_count = 8;
  OK(abbe_plan_make(&scene, &d, &plan, &error));
  scene.light_count = 9;
  assert_int_equal(plan.volume_pages * plan.light_view_count, 192);
  abbe_plan_free(&plan);
}
