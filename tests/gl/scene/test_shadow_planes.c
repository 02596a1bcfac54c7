/* Shadows by planes against the ray to the light, asked face by face: in double precision, and as
 * the shader asks them in single precision; known shadows and outlines; where faces have to be
 * asked. */
#include "tests/gl/frame.h"
#include "tests/gl/glsl.h"
#include "tests/random.h"

#include "base/maths.h"
#include "gl/scene/gpu_scene.h"

enum { MOST = 64, PLACES = 4096, SHADER_SOLIDS = 24 };

typedef struct solid {
  double plane[MOST][4];
  size_t count;
} solid;

static const double origin[3] = {0, 0, 0};

static void unit_vector(uint64_t *random, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = random_normal(random);
  abbe_vector_normalise(out);
}

static void add_plane(solid *s, const double n[3], double d) {
  memcpy(s->plane[s->count], n, 3 * sizeof *n);
  s->plane[s->count++][3] = d;
}

/* A box around the origin. */
static void make_box(solid *s, double x, double y, double z) {
  const double half[3] = {x, y, z};
  s->count = 0;
  for (int k = 0; k < 6; k++) {
    double n[3] = {0, 0, 0};
    n[k / 2] = k % 2 ? 1 : -1;
    add_plane(s, n, half[k / 2]);
  }
}

/* Sides from z = -0.5 to an apex at z = 0.5. */
static void make_pyramid(solid *s, int sides) {
  const double down[3] = {0, 0, -1};
  s->count = 0;
  add_plane(s, down, 0.5);
  for (int i = 0; i < sides; i++) {
    const double turn = 2 * 3.141592653589793 * i / sides;
    const double n[3] = {cos(turn) * sqrt(0.5), sin(turn) * sqrt(0.5), sqrt(0.5)};
    add_plane(s, n, 0.5 * sqrt(0.5));
  }
}

/* Boxes, also as flat as a coin and as thin as a needle, pyramids, and what random planes cut of a
 * box, some by planes that cut nothing. */
static void make_solid(int i, uint64_t *random, solid *s) {
  static const double flat[4][3] = {{1, 1, 1}, {1, 1, 1e-4}, {1e-3, 1e-3, 1}, {0.2, 1, 0.5}};
  make_box(s, flat[i % 4][0], flat[i % 4][1], flat[i % 4][2]);
  if (i % 3 == 1) make_pyramid(s, 3 + i % 40);
  if (i % 3 != 2) return;
  for (int k = 0; k < 4 + i % 50; k++) {
    double n[3];
    unit_vector(random, n);
    add_plane(s, n, random_between(random, 0.3, 1.5));
  }
}

static double before(const solid *s, const double x[3]) {
  double most = -INFINITY;
  for (size_t i = 0; i < s->count; i++)
    most = fmax(most, abbe_vector_dot(s->plane[i], x) - s->plane[i][3]);
  return most;
}

/* Lamps outside, near and far; some in the plane of a face; a sun every third time, also along one.
 */
static void make_light(int i, uint64_t *random, const solid *s, abbe_light *out) {
  *out = (abbe_light){.kind = i % 3 == 0 ? ABBE_LIGHT_DIRECTIONAL : ABBE_LIGHT_POINT};
  double direction[3], place[3] = {0, 0, 0};
  unit_vector(random, direction);
  if (i % 5 == 4) { /* exactly, for faces across an axis */
    direction[i % 2] = 0;
    abbe_vector_normalise(direction);
  }
  memcpy(out->direction, direction, sizeof direction);
  for (double far = 1.01; before(s, place) < 0.01; far *= 1.2)
    for (int k = 0; k < 3; k++) place[k] = far * direction[k];
  if (i % 5 == 4) place[i % 2] = i % 4 < 2 ? 1 : 0.5;
  if (i % 7 == 0)
    for (int k = 0; k < 3; k++) place[k] *= 1000;
  memcpy(out->position, place, sizeof place);
}

/* Whether the way from the light to x meets the solid grown by so much, face by face. */
static bool is_hidden(const solid *s, double grown, const abbe_light *light, const double x[3]) {
  double enter = 0, leave = 1, d[3], o[3];
  for (int k = 0; k < 3; k++) {
    d[k] = light->kind == ABBE_LIGHT_DIRECTIONAL ? 1e4 * light->direction[k]
                                                 : x[k] - light->position[k];
    o[k] = x[k] - d[k];
  }
  for (size_t i = 0; i < s->count; i++) {
    const double slope = abbe_vector_dot(s->plane[i], d);
    const double gap = s->plane[i][3] + grown - abbe_vector_dot(s->plane[i], o);
    if (slope < 0) enter = fmax(enter, gap / slope);
    if (slope > 0) leave = fmin(leave, gap / slope);
    if (slope == 0 && gap <= 0) return false;
  }
  return enter < leave;
}

/* Of the solid, beside it, before and behind it. */
static void make_place(uint64_t *random, const abbe_light *light, double out[3]) {
  double spread[3], along = random_between(random, -3, 6);
  unit_vector(random, spread);
  const bool far = light->kind == ABBE_LIGHT_DIRECTIONAL;
  const double size = pow(10, random_between(random, -3, 0.3));
  for (int k = 0; k < 3; k++) {
    const double to =
        far ? light->direction[k] : -light->position[k] / abbe_vector_length(light->position);
    out[k] = size * spread[k] + along * to;
  }
}

static double outside(const double (*plane)[4], size_t count, const abbe_light *light,
                      const double x[3]) {
  double most = -INFINITY;
  for (size_t i = 0; i < count; i++) {
    double from[3] = {x[0], x[1], x[2]};
    if (light->kind != ABBE_LIGHT_DIRECTIONAL) abbe_vector_subtract(x, light->position, from);
    most = fmax(most, abbe_vector_dot(plane[i], from) - plane[i][3]);
  }
  return most;
}

static double edge[2 * MOST + 1][4]; /* of the planes that planes_of has found last */

static size_t planes_of(const solid *s, const abbe_light *light, bool faces, double (*out)[4]) {
  size_t count = 0;
  OK(abbe_shadow_planes_make((const double(*)[4])s->plane, s->count, origin, light, faces, out,
                             edge, &count, &error));
  assert_true(count >= 1 && count <= 2 * s->count);
  for (size_t i = 0; i < count; i++)
    assert_true(fabs(abbe_vector_length(out[i]) - 1) < 1e-12 && isfinite(out[i][3]));
  return count;
}

GROUP(make_context, free_context);

TEST(same_as_face_by_face) {
  size_t hidden = 0, lit = 0, in_front = 0;
  uint64_t random = 11;
  for (int i = 0; i < 210; i++) {
    solid s;
    abbe_light light;
    double with[2 * MOST + 1][4], without[2 * MOST + 1][4];
    make_solid(i, &random, &s);
    make_light(i, &random, &s, &light);
    const size_t all = planes_of(&s, &light, true, with);
    const size_t outline = planes_of(&s, &light, false, without);
    assert_true(outline < all);
    for (int k = 0; k < 300; k++) {
      double x[3];
      make_place(&random, &light, x);
      const bool hides = is_hidden(&s, 0, &light, x);
      if (is_hidden(&s, 1e-9, &light, x) != is_hidden(&s, -1e-9, &light, x)) continue;
      const bool found = outside((const double(*)[4])with, all, &light, x) < 0;
      if (found != hides) fail_msg("solid %d, place %d: %d, not %d", i, k, found, hides);
      hidden += hides;
      lit += !hides;
      /* Without the faces only what is between light and solid differs. */
      const bool rough = outside((const double(*)[4])without, outline, &light, x) < 0;
      assert_true(rough || !hides);
      if (rough && !hides) in_front++;
      if (rough && !hides) assert_true(before(&s, x) > 0);
    }
  }
  print_message("%zu places hidden, %zu lit, %zu of them in front\n", hidden, lit, in_front);
  assert_true(hidden > 5000 && lit > 5000 && in_front > 500);
}

/* A cube of 1 m, its lamp 1.5 m above its top: on the ground 1 m below its foot the shadow is a
 * square with sides of 1 m times 3.5 / 1.5. */
TEST(a_cube_over_the_ground) {
  solid s;
  make_box(&s, 0.5, 0.5, 0.5);
  const abbe_light lamp = {.kind = ABBE_LIGHT_POINT, .position = {0, 0, 2}};
  const abbe_light sun = {.kind = ABBE_LIGHT_DIRECTIONAL, .direction = {0.6, 0, -0.8}};
  double plane[2 * MOST + 1][4];
  size_t count = planes_of(&s, &lamp, false, plane);
  assert_int_equal(count, 4);
  for (int k = -1; k <= 1; k += 2) {
    const double half = 0.5 * 3.5 / 1.5, inside[3] = {k * (half - 1e-9), 0.3, -1.5};
    const double beside[3] = {k * (half + 1e-9), 0.3, -1.5};
    assert_true(outside((const double(*)[4])plane, count, &lamp, inside) < 0);
    assert_true(outside((const double(*)[4])plane, count, &lamp, beside) > 0);
  }
  for (size_t i = 0; i < count; i++) {
    const double half = 0.5 * 3.5 / 1.5,
                 mid[3] = {half * round(plane[i][0]), half * round(plane[i][1]), -3.5};
    assert_float_equal(abbe_vector_dot(edge[i], mid), 3.5 / 1.5, 1e-12);
  }
  /* From x = -0.5 at the foot's near edge to where the ray over the far upper edge lands. */
  count = planes_of(&s, &sun, false, plane);
  assert_int_equal(count, 4);
  const double reach[2] = {-0.5 + 0.75, 0.5 + 2 * 0.75};
  for (int k = 0; k < 2; k++) {
    const double in[3] = {reach[k] + (k ? -1e-9 : 1e-9), 0.4, -1.5};
    const double out[3] = {reach[k] + (k ? 1e-9 : -1e-9), 0.4, -1.5};
    assert_true(outside((const double(*)[4])plane, count, &sun, in) < 0);
    assert_true(outside((const double(*)[4])plane, count, &sun, out) > 0);
  }
}

/* As many planes as the outline has edges, however many pairs of faces there are. */
TEST(outlines_are_short) {
  solid s;
  double plane[2 * MOST + 1][4];
  make_box(&s, 0.5, 0.5, 0.5);
  const abbe_light corner = {.kind = ABBE_LIGHT_POINT, .position = {2, 2.1, 2.2}};
  assert_int_equal(planes_of(&s, &corner, false, plane), 6);
  assert_int_equal(planes_of(&s, &corner, true, plane), 6 + 3);
  make_pyramid(&s, 40);
  const abbe_light above = {.kind = ABBE_LIGHT_POINT, .position = {0, 0, 3}};
  assert_int_equal(planes_of(&s, &above, false, plane), 40);
  const abbe_light below = {.kind = ABBE_LIGHT_POINT, .position = {0.01, 0, -3}};
  assert_int_equal(planes_of(&s, &below, true, plane), 40 + 1);
  const abbe_light within = {.kind = ABBE_LIGHT_POINT, .position = {0, 0.1, 0}};
  const double anywhere[3] = {5, 6, 7};
  assert_int_equal(planes_of(&s, &corner, true, plane) > 3, 1);
  size_t count = 0;
  OK(abbe_shadow_planes_make((const double(*)[4])s.plane, s.count, origin, &within, true, plane,
                             edge, &count, &error));
  assert_int_equal(count, 1);
  assert_true(outside((const double(*)[4])plane, count, &within, anywhere) > 0);
}

/* The shader's own test, of every solid with another light at once. */
TEST(the_shader_agrees) {
  static float in[PLACES][8], out[PLACES][4];
  const abbe_gl *gl = abbe_context_gl(context);
  static solid s[SHADER_SOLIDS];
  static abbe_light light[SHADER_SOLIDS];
  static float lights[SHADER_SOLIDS][68];
  static struct {
    int range[SHADER_SOLIDS][4]; /* first, and how many */
    float plane[SHADER_SOLIDS * (2 * MOST + 1)][4];
  } shadow;
  size_t hidden = 0, lit = 0, near = 0;
  uint64_t random = 5;
  int next = 0;
  for (int i = 0; i < SHADER_SOLIDS; i++) {
    double plane[2 * MOST + 1][4];
    make_solid(i, &random, &s[i]);
    make_light(i + 1, &random, &s[i], &light[i]);
    if (abbe_vector_length(light[i].position) > 100) light[i].position[0] *= 0.01;
    const int count = (int)planes_of(&s[i], &light[i], true, plane);
    shadow.range[i][0] = next;
    shadow.range[i][1] = count;
    for (int k = 0; k < count; k++, next++)
      for (int c = 0; c < 4; c++) shadow.plane[next][c] = (float)plane[k][c];
    for (int c = 0; c < 3; c++) lights[i][48 + c] = (float)light[i].position[c];
    lights[i][51] = (float)light[i].kind;
  }
  for (int i = 0; i < PLACES; i++) {
    double x[3];
    make_place(&random, &light[i % SHADER_SOLIDS], x);
    for (int c = 0; c < 3; c++) in[i][c] = (float)x[c];
    in[i][3] = (float)(i % SHADER_SOLIDS);
  }
  const char *text = printed(
      "#define LIGHTS %d\n#define REFLECTION_ROOM 64\n#define LIGHT_ROOM %d\n#define "
      "REFRACTORS 1\n#define REFRACTOR_ROOM 1\n#define PLANE_ROOM 1\n#define RECEIVERS "
      "1\n#define RECEIVER_ROOM 1\n#define SURFACE_ROOM 1\n#define SPECTRUM_ROOM 1\n#define "
      "WAVELENGTHS 1\n#define CONVEX\n"
      "#define SHADOW_PLANES %zu\n"
      "#include \"refractor.glsl\"\n#include \"receiver.glsl\"\n"
      "vec4 f(vec4 a, vec4 b) {\n"
      "  return vec4(1.0 - convex_lit(int(a.w), 0, a.xyz));\n}\n",
      SHADER_SOLIDS, SHADER_SOLIDS, sizeof shadow.plane / sizeof shadow.plane[0]);
  GLuint block[2] = {glsl_block(gl, BINDING_LIGHTS, sizeof lights, lights),
                     glsl_block(gl, BINDING_SHADOW_PLANES, sizeof shadow, &shadow)};
  glsl_evaluate(gl, text, (const float(*)[8])in, PLACES, out);
  gl->DeleteBuffers(2, block);
  for (int i = 0; i < PLACES; i++) {
    const int which = i % SHADER_SOLIDS;
    const double x[3] = {in[i][0], in[i][1], in[i][2]};
    const double far = abbe_vector_length(x) + abbe_vector_length(light[which].position);
    const double rounding = 4e-7 * far; /* a few roundings of what the products add up */
    const bool hides = is_hidden(&s[which], 0, &light[which], x);
    if (is_hidden(&s[which], rounding, &light[which], x) !=
        is_hidden(&s[which], -rounding, &light[which], x)) {
      near++;
      continue;
    }
    if ((out[i][0] > 0) != hides) fail_msg("solid %d, place %d: not %d", which, i, hides);
    hidden += hides;
    lit += !hides;
  }
  print_message("%zu places hidden, %zu lit, %zu too near to tell\n", hidden, lit, near);
  assert_true(hidden > PLACES / 10 && lit > PLACES / 10 && near < PLACES / 4);
}

TEST(what_stands_in_front) {
  static const char *const text =
      CAMERA "lights:\n- {name: lamp, kind: point, position: [0, 0, 1], intensity: 1}\n"
             "- {name: sun, kind: directional, direction: [0, 0.6, -0.8], irradiance: 1}\n"
             "objects:\n"
             "- {name: brick, shape: box, size: [0.2, 0.2, 0.2], transform: [{rotate: {axis: [1, "
             "0, 0], angle: 30}}, {translate: [0, 0, 0.5]}], material: crown}\n"
             "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
             "- {name: wall, shape: rectangle, width: 4, height: 4, transform: [{rotate: {axis: "
             "[1, 0, 0], angle: 80}}, {translate: [0, 1, 0]}], reflectance: 0.5}\n"
             "- {name: shelf, shape: rectangle, width: 0.3, height: 0.3, transform: [{translate: "
             "[0, 0, 0.8]}], reflectance: 0.5}\n"
             "- {name: aside, shape: sphere, radius: 0.05, transform: [{translate: [0.5, 0, "
             "0.8]}], reflectance: 0.5}\n"
             "- {name: before, shape: sphere, radius: 0.05, transform: [{translate: [0, -0.3, "
             "0.9]}], reflectance: 0.5}\n";
  /* By lamp and by sun: the sun comes over the shelf's plane and the ball before the brick. */
  static const bool expected[5][2] = {
      {false, false}, {false, false}, {true, true}, {false, false}, {false, true}};
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t i = 0; i < 5; i++)
    for (size_t k = 0; k < 2; k++)
      if (abbe_shadow_planes_in_front(&scene.object[0], &scene.light[k], &scene.object[i + 1]) !=
          expected[i][k])
        fail_msg("%s and %s", scene.object[i + 1].name, scene.light[k].name);
}

/* A brick hides the floor below it, and not a shelf between it and the lamp, which the picture
 * shows; with the shelf out of the light's way no face is asked, and the floor stays the same. */
TEST(shelves_in_front_are_lit) {
  static const char *const text =
      "materials: glass.yaml\ncamera: {eye: [0, -0.3, 2.5], target: [0, 0, 0.5]}\n"
      "lights:\n- {name: lamp, kind: point, position: [0, 0.02, 1.5], intensity: 1}\n"
      "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
      "- {name: brick, shape: box, size: [0.2, 0.2, 0.2], transform: [{translate: [0, 0, 0.5]}], "
      "material: crown}\n"
      "- {name: shelf, shape: rectangle, width: 0.3, height: 0.3, transform: [{translate: [0, 0, "
      "0.8]}], reflectance: 0.5}\n";
  OWNED(abbe_scene, scene) = scene_of(text);
  abbe_render_desc desc = small_frame;
  desc.aovs = true;
  abbe_renderer *renderer = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, image) = aovs_of(renderer);
  abbe_renderer_free(renderer);
  /* The middle shows the shelf: 1 W/sr from 0.7 m straight above, of the white's Y of 1. */
  const float *pixel = image.data + (32 * image.width + 32) * image.channels;
  const double expected = 0.5 / 3.141592653589793 / (0.7 * 0.7);
  assert_true(fabs((double)pixel[5] / expected - 1) < 0.05);
}
