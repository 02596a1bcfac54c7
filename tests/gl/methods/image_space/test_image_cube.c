/* A cube of views around a light, by caustics mapping: what is sent arrives in every direction, the
 * seams between faces show nothing, and where one view would do the light is the same. */
#include "tests/gl/frame.h"

#include "gl/methods/shah2007/shah2007.h"
#include "gl/renderer_state.h"

enum { SIDE = 192, FACES = ABBE_LIGHT_CUBE_FACES };

#define ROOM                                                                                       \
  "materials: glass.yaml\ncamera: {eye: [0, -0.9, 0.5], target: [0, 0, 0]}\n"                      \
  "lights:\n- {name: lamp, kind: point, position: [0.1, 0.05, -0.07], intensity: 1}\n"             \
  "objects:\n- {name: room, shape: box, size: [2, 2.2, 1.8], reflectance: 0.5}\n"

static const double lamp[3] = {0.1, 0.05, -0.07};

static const abbe_render_desc around =
    FIELDS(.profile = ABBE_PROFILE_SHAH2007_CIE, .width = 16, .height = 16, .photons = 192,
           .map_size = SIDE, .space = ABBE_RGB_SPACE_XYZ);

/* The light on the faces as the window has it, [face][y][x][4], and where its texels look. */
typedef struct cube_map {
  abbe_view view[FACES];
  float *texel;
} cube_map;

static void draw_cube(const abbe_scene *scene, const abbe_render_desc *desc, cube_map *out) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, desc);
  const abbe_shah2007 *shah = (const abbe_shah2007 *)renderer->method;
  assert_int_equal(shah->base.light.faces, FACES);
  for (int f = 0; f < FACES; f++) out->view[f] = shah->base.light.face[f].view;
  out->texel = calloc((size_t)FACES * SIDE * SIDE * 4, sizeof *out->texel);
  assert_non_null(out->texel);
  OK(abbe_context_make_current(context, &error));
  const abbe_gl *gl = abbe_context_gl(context);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, shah->map);
  gl->GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, out->texel);
  OK(abbe_gl_check(gl, "the reading of the map", &error));
}

static void cube_map_free(cube_map *m) {
  free(m->texel);
  *m = (cube_map){0};
}

/* Of a texel: its direction, its light by the window's area, and that area; false in the border
 * that faces share. */
static bool texel_at(const cube_map *m, int face, int x, int y, double d[3], double *light,
                     double *area) {
  const abbe_view *v = &m->view[face];
  const double uv[2] = {(x + 0.5) / SIDE, (y + 0.5) / SIDE};
  double origin[3];
  abbe_view_ray(v, uv, origin, d);
  *area = abbe_view_area(v) / (SIDE * SIDE);
  *light = (double)m->texel[(((size_t)face * SIDE + (size_t)y) * SIDE + (size_t)x) * 4 + 1];
  return abbe_light_cube_face(d) == face;
}

/* All of it, W; where: the mean direction times it, may be NULL. */
static double cube_light(const cube_map *m, double where[3]) {
  double sum = 0, mean[3] = {0};
  for (int i = 0; i < FACES * SIDE * SIDE; i++) {
    double d[3], light, area;
    if (!texel_at(m, i / (SIDE * SIDE), i % SIDE, i / SIDE % SIDE, d, &light, &area)) continue;
    sum += light * area;
    for (int k = 0; k < 3; k++) mean[k] += light * area * d[k];
  }
  for (int k = 0; k < 3 && where != NULL; k++) where[k] = mean[k];
  return sum;
}

/* Panes of 0.2 x 0.2 m, 0.3 m from the lamp, across these directions: the faces' middles, that of
 * an edge, and a corner. */
enum { PANES = 8 };
static const double pane[PANES][3] = {
    {1, 0, 0},
    {-1, 0, 0},
    {0, 1, 0},
    {0, -1, 0},
    {0, 0, 1},
    {0, 0, -1},
    {0, -0.70710678118654752, -0.70710678118654752},
    {0.57735026918962576, 0.57735026918962576, 0.57735026918962576}};

static size_t add_pane(const double d[3], const char *of, char *text, size_t used, size_t size) {
  const double across = hypot(d[0], d[1]), angle = atan2(across, d[2]) * 180 / 3.14159265358979324;
  const bool turned = across > 1e-9;
  const double axis[3] = {turned ? -d[1] : 1, turned ? d[0] : 0, 0};
  used += (size_t)snprintf(
      text + used, size - used,
      "- {name: pane%zu, shape: box, size: [0.2, 0.2, 0.001], %s, transform: [{rotate: {axis: "
      "[%.9g, %.9g, 0], angle: %.9g}}, {translate: [%.9g, %.9g, %.9g]}]}\n",
      used, of, axis[0], axis[1], angle, lamp[0] + 0.3 * d[0], lamp[1] + 0.3 * d[1],
      lamp[2] + 0.3 * d[2]);
  assert_true(used < size);
  return used;
}

/* Of what a pane lets through to an index of 1.5 at two interfaces, almost straight. */
static const double through = 0.9216;

static double pane_light(void) {
  const double a = 0.1, h = 0.2995;
  return through * 4 * asin(a * a / (a * a + h * h));
}

GROUP(make_context, free_context);

/* Light of all panes, and what a texel well within one of them is of the lamp's: by how far it is
 * from the seams. */
TEST(what_is_sent_arrives_all_around) {
  char text[4096] = ROOM;
  size_t used = strlen(text);
  double sum[2] = {0}, worst = 0;
  size_t count[2] = {0};
  for (int i = 0; i < PANES; i++)
    used = add_pane(pane[i], "material: flat", text, used, sizeof text);
  abbe_render_desc desc = around;
  desc.photons = 256; /* denser than texels, else the two grids beat */
  OWNED(abbe_scene, scene) = scene_of(text);
  FILLED(cube_map, m, draw_cube(&scene, &desc, &m));
  const double all = cube_light(&m, NULL) / (PANES * pane_light());
  for (int i = 0; i < FACES * SIDE * SIDE; i++) {
    double d[3], light, area, nearest = -1, second = 0;
    if (!texel_at(&m, i / (SIDE * SIDE), i % SIDE, i / SIDE % SIDE, d, &light, &area)) continue;
    for (int p = 0; p < PANES; p++)
      nearest = fmax(nearest, d[0] * pane[p][0] + d[1] * pane[p][1] + d[2] * pane[p][2]);
    if (nearest < cos(0.28)) continue; /* 16 of 18.4 degrees */
    const double *axis = m.view[i / (SIDE * SIDE)].forward;
    const double c = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
    for (int f = 0; f < FACES; f++) {
      const double *other = m.view[f].forward;
      const double o = d[0] * other[0] + d[1] * other[1] + d[2] * other[2];
      if (f != i / (SIDE * SIDE)) second = fmax(second, o);
    }
    const bool by_seam = second > c - 0.02;
    const double share = light / (c * c * c) / through;
    sum[by_seam] += share;
    count[by_seam]++;
    worst = fmax(worst, fabs(share - 1));
  }
  assert_true(count[0] > 1000 && count[1] > 50);
  print_message(
      "%.4f of the light; within panes %.4f, beside seams %.4f of it, off by %.4f at the most\n",
      all, sum[0] / (double)count[0], sum[1] / (double)count[1], worst);
  assert_near(all, 1, 0.02);
  assert_near(sum[0] / (double)count[0], 1, 0.01);
  assert_near(sum[1] / (double)count[1], 1, 0.01);
  assert_true(worst < 0.05);
}

/* One pane on a corner: the light sees it through one view, and three faces have its light. */
TEST(a_corner_has_its_light) {
  char text[1024] = ROOM;
  add_pane(pane[PANES - 1], "material: flat", text, strlen(text), sizeof text);
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t low_pass = 0; low_pass <= 3; low_pass += 3) {
    abbe_render_desc desc = around;
    double where[3];
    desc.low_pass = low_pass;
    FILLED(cube_map, m, draw_cube(&scene, &desc, &m));
    const double sum = cube_light(&m, where);
    print_message("a corner's pane: %.4f of its light\n", sum / pane_light());
    assert_near(sum / pane_light(), 1, 0.02);
    for (int k = 1; k < 3; k++) assert_near(where[k] / where[0], 1, 0.01);
  }
}

/* Light that a mirror sends back past the lamp is lost by one view, and arrives on a cube. */
TEST(a_mirror_lights_what_is_behind_the_lamp) {
  static const char text[] =
      ROOM "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.8, transform: "
           "[{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.5, 0.05, -0.07]}]}\n";
  abbe_render_desc desc = around;
  double where[3];
  OWNED(abbe_scene, scene) = scene_of(text);
  desc.estimator = ABBE_ESTIMATOR_RATIO;
  desc.iterations = 12;
  FILLED(cube_map, m, draw_cube(&scene, &desc, &m));
  const double a = 0.05, h = 0.4, sent = 0.8 * 4 * asin(a * a / (a * a + h * h));
  const double sum = cube_light(&m, where);
  print_message("behind the lamp: %.4f of what the mirror sends\n", sum / sent);
  assert_near(sum / sent, 1, 0.02);
  assert_true(where[0] / sum < -0.95);
}

/* A ball in an edge's direction bends light across it: every estimator brings it to where the exact
 * one does. */
TEST(estimators_land_across_seams) {
  static const char text[] = ROOM "- {name: ball, shape: sphere, radius: 0.08, levels: 4, "
                                  "transform: [{translate: [0.3, 0.25, -0.05]}], material: flat}\n";
  static const abbe_estimator kinds[] = {ABBE_ESTIMATOR_EXACT,    ABBE_ESTIMATOR_SHAH,
                                         ABBE_ESTIMATOR_AXIS,     ABBE_ESTIMATOR_SECANT,
                                         ABBE_ESTIMATOR_IMPOSTOR, ABBE_ESTIMATOR_RATIO};
  double exact = 0, at[3] = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    abbe_render_desc desc = around;
    double where[3];
    desc.estimator = kinds[i];
    desc.iterations = 8;
    FILLED(cube_map, m, draw_cube(&scene, &desc, &m));
    const double sum = cube_light(&m, where);
    if (i == 0) exact = sum;
    if (i == 0) memcpy(at, where, sizeof at);
    print_message("%s: %.4f of the exact one's light, off by %.4f rad\n",
                  abbe_estimator_name(kinds[i]), sum / exact,
                  hypot(hypot(where[0] / sum - at[0] / exact, where[1] / sum - at[1] / exact),
                        where[2] / sum - at[2] / exact));
    /* what lands on places that were looked up lies in texels' middles, where splats add up to 4 %
     * more than their integral */
    assert_near(sum / exact, i == 1 || i == 2 ? 1.04 : 1, 0.01);
    for (int k = 0; k < 3; k++) assert_near(where[k] / sum, at[k] / exact, 0.002);
  }
}

/* A lamp above a floor: the picture by one view and by six. */
TEST(one_view_and_six_agree) {
  abbe_image picture[2] = {{0}};
  double sum[2] = {0}, off = 0;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  for (size_t i = 0; i < 2; i++) {
    abbe_render_desc desc = around;
    desc.width = desc.height = 48;
    desc.map_size = 768;
    desc.photons = i == 0 ? 768 : 192; /* the one view is as wide as the floor */
    desc.faces = i == 0 ? 1 : 6;
    abbe_renderer *renderer = drawn_renderer(&scene, &desc);
    picture[i] = picture_of(renderer);
    abbe_renderer_free(renderer);
    sum[i] = image_sum(&picture[i], 1);
  }
  for (size_t i = 0; i < 48 * 48; i++)
    off += fabs((double)picture[0].data[3 * i + 1] - (double)picture[1].data[3 * i + 1]);
  print_message("six views: %.4f of one's light, off by %.4f\n", sum[1] / sum[0], off / sum[0]);
  assert_near(sum[1] / sum[0], 1, 0.01);
  assert_true(off / sum[0] < 0.03);
  for (size_t i = 0; i < 2; i++) abbe_image_free(&picture[i]);
}

/* Through panes all around, by photons in image space: the camera sees on the walls what it sees by
 * caustics mapping. */
TEST(photons_in_image_space_agree) {
  static const abbe_fill fills[] = {ABBE_FILL_TRIANGLES, ABBE_FILL_QUADS, ABBE_FILL_GATHER_EYE};
  OWNED(abbe_image, right) = {0};
  char text[4096] = ROOM;
  size_t used = strlen(text);
  for (int i = 0; i < PANES; i++)
    used = add_pane(pane[i], "material: flat", text, used, sizeof text);
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t i = 0; i <= sizeof fills / sizeof *fills; i++) {
    abbe_render_desc desc = around;
    OWNED(abbe_image, picture) = {0};
    desc.width = desc.height = 64;
    if (i > 0) {
      desc.profile = ABBE_PROFILE_WYMAN2006_CIE;
      desc.fill = fills[i - 1];
    }
    abbe_renderer *renderer = drawn_renderer(&scene, &desc);
    *(i == 0 ? &right : &picture) = picture_of(renderer);
    abbe_renderer_free(renderer);
    if (i == 0) continue;
    double off = 0;
    for (size_t k = 0; k < 64 * 64; k++)
      off += fabs((double)picture.data[3 * k + 1] - (double)right.data[3 * k + 1]);
    print_message("'%s': off by %.4f of the picture's light\n", abbe_fill_name(fills[i - 1]),
                  off / image_sum(&right, 1));
    assert_true(off / image_sum(&right, 1) < 0.05);
  }
}

/* As printed, too; what a cube is not for, and who takes it by themselves. */
TEST(who_has_a_cube) {
  abbe_plan plan;
  abbe_image map = {0};
  cube_map m;
  abbe_render_desc desc = around;
  OWNED(abbe_scene, scene) = scene_of(ROOM BALL("crown"));
  desc.profile = ABBE_PROFILE_SHAH2007;
  desc.space = ABBE_RGB_SPACE_REC709;
  draw_cube(&scene, &desc, &m);
  assert_true(cube_light(&m, NULL) > 0);
  cube_map_free(&m);
  abbe_renderer *renderer = drawn_renderer(&scene, &desc);
  REFUSED(ABBE_UNSUPPORTED, "--faces 1", abbe_renderer_read_map(renderer, 0, true, &map, &error));
  abbe_renderer_free(renderer);
  desc.map_size = 32;
  desc.low_pass = 8;
  REFUSED(ABBE_INVALID_ARGUMENT, "larger map",
          abbe_renderer_make(context, &scene, &desc, &renderer, &error));
  desc.low_pass = 0;
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  OK(abbe_plan_make(&scene, &around, &plan, &error));
  assert_true(plan.desc.faces <= 1); /* one view holds the floor */
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA SUN FLOOR BALL("crown"));
  desc.faces = 6;
  REFUSED(ABBE_UNSUPPORTED, "directional", abbe_plan_make(&scene, &desc, &plan, &error));
  desc.faces = 3;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_plan_make(&scene, &desc, &plan, &error));
  desc.faces = 6;
  desc.profile = ABBE_PROFILE_DEFAULT;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_plan_make(&scene, &desc, &plan, &error));
}
