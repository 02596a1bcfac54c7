/* march.glsl: rays against layers of distances whose surfaces are known in closed form. */
#include "tests/glsl.h"

#include "scenes/view.h"

enum { SIDE = 512, RAYS = 256 };

static const abbe_gl *gl;
static abbe_view view;
static float layer[SIDE][SIDE][4], rays[RAYS][8], hits[RAYS][4];
static size_t ray_count;

static int make_gl(void **state) {
  if (make_context(state) != 0) return 1;
  gl = abbe_context_gl(context);
  return 0;
}

/* Straight down on the square from -1 to 1, from 2 m above, or from that point. */
static void look_down(bool orthographic) {
  static const double from[3] = {0, 0, 2}, down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  static const double metres[4] = {-1, 1, -1, 1}, tangents[4] = {-0.5, 0.5, -0.5, 0.5};
  abbe_view_look(from, down, up, orthographic, &view);
  memcpy(view.window, orthographic ? metres : tangents, sizeof view.window);
  view.near = 0.1;
  view.far = 5;
}

/* Distance along the ray from o to the surface, or 0. */
typedef double (*surface)(const double o[3], const double d[3]);

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double to_plane(const double o[3], const double d[3], double slope, double height) {
  double t = (height + slope * o[0] - o[2]) / (d[2] - slope * d[0]); /* z = height + slope x */
  return t > 0 ? t : 0;
}

static double floor_below(const double o[3], const double d[3]) {
  return to_plane(o, d, 0, 0);
}

static double ramp(const double o[3], const double d[3]) {
  return to_plane(o, d, 0.4, 0);
}

static double cliff(const double o[3], const double d[3]) {
  return to_plane(o, d, 4, -1);
}

static double ball(const double o[3], const double d[3]) {
  double b = dot(o, d), inside = b * b - dot(o, o) + 0.6 * 0.6;
  return inside > 0 && -b - sqrt(inside) > 0 ? -b - sqrt(inside) : 0;
}

/* A small lid half way up hides a part of the floor. */
static double floor_under_a_lid(const double o[3], const double d[3]) {
  double t = to_plane(o, d, 0, 1), x = o[0] + t * d[0], y = o[1] + t * d[1];
  return fabs(x) < 0.1 && fabs(y) < 0.1 ? t : to_plane(o, d, 0, 0);
}

static double nothing(const double o[3], const double d[3]) {
  return 0 * o[0] * d[0];
}

static GLuint draw(surface s) {
  GLuint texture = 0;
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      double uv[2] = {(x + 0.5) / SIDE, (y + 0.5) / SIDE}, o[3], d[3];
      abbe_view_ray(&view, uv, o, d);
      layer[y][x][3] = (float)s(o, d);
    }
  gl->GenTextures(1, &texture);
  gl->ActiveTexture(GL_TEXTURE0);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  gl->TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA32F, SIDE, SIDE, 1);
  gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, SIDE, SIDE, 1, GL_RGBA, GL_FLOAT, layer);
  gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

static void add_ray(double px, double py, double pz, double dx, double dy, double dz,
                    double start) {
  double length = sqrt(dx * dx + dy * dy + dz * dz);
  const double row[8] = {px, py, pz, start, dx / length, dy / length, dz / length, 0};
  for (int i = 0; i < 8; i++) rays[ray_count][i] = (float)row[i];
  ray_count++;
}

/* x: t; y: 1 for a hit. The search ends at t_max = 4. */
static void march_all(surface s) {
  GLuint texture = draw(s);
  float packed[24];
  abbe_view_pack(&view, packed);
  GLuint program = glsl_make(
      gl, "#define LIGHT_ROOM 1\n#define REFRACTOR_ROOM 1\n#define PLANE_ROOM 1\n"
          "#define RECEIVER_ROOM 1\n#define SURFACE_ROOM 1\n#define SPECTRUM_ROOM 1\n"
          "#include \"view.glsl\"\n"
          "#include \"march.glsl\"\n"
          "uniform sampler2DArray harness_layer;\n"
          "uniform vec4 harness_view[6];\n"
          "vec4 f(vec4 a, vec4 b) {\n"
          "  View v = View(harness_view[0], harness_view[1], harness_view[2], harness_view[3],\n"
          "                harness_view[4], harness_view[5]);\n"
          "  float t = -1.0;\n"
          "  bool hit = march(v, harness_layer, 0.0, a.xyz, b.xyz, a.w, 4.0, t);\n"
          "  return vec4(t, hit ? 1.0 : 0.0, 0, 0);\n"
          "}\n");
  gl->Uniform4fv(gl->GetUniformLocation(program, "harness_view"), 6, packed);
  gl->Uniform1i(gl->GetUniformLocation(program, "harness_layer"), 0);
  glsl_run(gl, program, (const float(*)[8])rays, ray_count, hits);
  gl->DeleteProgram(program);
  gl->DeleteTextures(1, &texture);
}

/* The march stops within 1e-4 t_max of the surface, along the view's ray; along its own, on
 * surfaces that it meets at 20 degrees or more, that is up to 3 times as far. */
static const double tolerance = 3 * 1e-4 * 4;

static void assert_hits(surface s) {
  assert_true(ray_count > 0);
  for (size_t i = 0; i < ray_count; i++) {
    double p[3], d[3];
    for (int k = 0; k < 3; k++) {
      p[k] = rays[i][k];
      d[k] = rays[i][4 + k];
    }
    if (hits[i][1] < 0.5f) print_error("ray %zu (%g %g %g) misses\n", i, p[0], p[1], p[2]);
    assert_true(hits[i][1] > 0.5f);
    assert_near(hits[i][0], s(p, d), tolerance);
  }
}

static void aim_downwards(void) {
  ray_count = 0;
  for (int i = 0; i < 5; i++)
    for (int k = 0; k < 8; k++)
      add_ray(0.1 * (i - 2), 0.05 * i, 0.5, 0.25 * i * cos(k), 0.25 * i * sin(k), -1,
              0.05 + 0.1 * i);
}

static void test_planes(void **state) {
  (void)state;
  static const surface planes[] = {floor_below, ramp};
  for (int i = 0; i < 4; i++) {
    look_down(i % 2);
    aim_downwards();
    march_all(planes[i / 2]);
    assert_hits(planes[i / 2]);
  }
}

/* From the side and from above, onto the upper half that the view sees. */
static void test_a_sphere(void **state) {
  (void)state;
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    look_down(orthographic);
    ray_count = 0;
    for (int i = 0; i < 8; i++)
      for (int k = 0; k < 4; k++) {
        double x = 0.9 * cos(i), y = 0.9 * sin(i), up = 0.4 + 0.1 * k;
        add_ray(x, y, up, -x, -y, 0.25 - up, 0.3);
      }
    march_all(ball);
    assert_hits(ball);
  }
}

/* The plain iteration: to the distance of the surface point that the estimate projects to. */
static double iterate(double t, int times) {
  const double s = sqrt(0.5); /* down the cliff at 45 degrees, seen from straight above */
  for (int i = 0; i < times; i++) t = hypot(t * s, 4 * t * s - 1);
  return t;
}

static void test_where_the_iteration_swings_the_bisection_converges(void **state) {
  (void)state;
  const double root = sqrt(2) / 5;
  /* Its slope at the root is 1/2 - 4/2: each step is on the other side and farther away. */
  double near = root + 1e-3;
  assert_true((iterate(near, 1) - root) < -1.4e-3);
  assert_true((iterate(near, 2) - root) > 2e-3);
  assert_true(fabs(iterate(near, 31) - root) > 0.02);
  look_down(true);
  ray_count = 0;
  for (int i = 0; i < 20; i++) add_ray(0, 0, 0, 1, 0, -1, root * (0.3 + 0.1 * i));
  march_all(cliff);
  for (size_t i = 0; i < ray_count; i++) {
    assert_true(hits[i][1] > 0.5f);
    assert_near(hits[i][0], root, tolerance);
  }
}

/* Passing below a lid is no hit on it: the floor behind is met. */
static void test_a_rim_is_no_hit(void **state) {
  (void)state;
  look_down(true);
  ray_count = 0;
  for (int i = 0; i < 8; i++) add_ray(-0.5, 0.01 * i, 0.5, 1, 0, -0.5 - 0.02 * i, 0.8);
  march_all(floor_under_a_lid);
  assert_hits(floor_below);
}

static void test_misses_are_misses(void **state) {
  (void)state;
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    look_down(orthographic);
    aim_downwards();
    march_all(nothing);
    for (size_t i = 0; i < ray_count; i++) assert_true(hits[i][1] == 0.0f);
    ray_count = 0;
    add_ray(0, 0, 0.5, 1, 0, 0, 0.5);      /* along the floor */
    add_ray(0, 0, 0.5, 0, 0, 1, 0.5);      /* up */
    add_ray(0, 0, 0.5, 1, 1, 0.1, 3);      /* out of the window */
    add_ray(0.9, 0.9, 0.5, 1, 1, -0.5, 1); /* down, but beyond it */
    march_all(floor_below);
    for (size_t i = 0; i < ray_count; i++) assert_true(hits[i][1] == 0.0f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_planes),
      cmocka_unit_test(test_a_sphere),
      cmocka_unit_test(test_where_the_iteration_swings_the_bisection_converges),
      cmocka_unit_test(test_a_rim_is_no_hit),
      cmocka_unit_test(test_misses_are_misses),
  };
  return cmocka_run_group_tests(tests, make_gl, free_context);
}
