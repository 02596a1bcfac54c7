/* What a ray sees around a scene where it stands for many directions: the map itself where they lie
 * close together, its means elsewhere, without jumps. */
#include "tests/gl/frame.h"
#include "tests/gl/glsl.h"

#include "base/maths.h"
#include "gl/device/api.h"
#include "gl/scene/gpu_scene.h"

enum { LOOKS = 4096 };

/* a: direction, width along b's direction; b: unit vector across a, width along the other. */
static const char source[] =
    "#define ENVIRONMENT\n"
    "const float PI = 3.14159265;\n"
    "const vec3 background = vec3(0);\n"
    "#include \"view.glsl\"\n#include \"surroundings.glsl\"\n"
    "vec4 f(vec4 a, vec4 b) {\n"
    "  vec3 across = cross(a.xyz, b.xyz);\n"
    "  return vec4(surroundings_over(a.xyz, a.w * b.xyz, b.w * across), 1);\n"
    "}\n";

static float in[LOOKS][8], out[LOOKS][4];

typedef struct sky {
  abbe_scene scene;
  abbe_gpu gpu;
  abbe_gpu_environment environment;
  GLuint program;
} sky;

static void make_sky(const char *environment, sky *out_sky) {
  const abbe_render_desc desc = {.min_nm = 380, .max_nm = 780};
  const abbe_gl *gl = abbe_context_gl(context);
  *out_sky = (sky){0};
  out_sky->scene = scene_of(
      printed("materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.2], fov: 40}\n"
              "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5}\n"
              "environment: {size: 256, %s}\n",
              environment));
  abbe_gl_state_begin(gl);
  OK(abbe_gpu_make(gl, &out_sky->gpu, &error));
  OK(abbe_gpu_environment_make(&out_sky->gpu, &out_sky->scene, ABBE_RGB_SPACE_REC709, &desc,
                               &out_sky->environment, &error));
  out_sky->program = glsl_make(gl, source);
  abbe_gpu_environment_set(&out_sky->gpu, &out_sky->scene, &out_sky->environment, 1,
                           out_sky->program);
}

static void sky_free(sky *s) {
  abbe_context_gl(context)->DeleteProgram(s->program);
  abbe_gpu_environment_free(&s->gpu, &s->environment);
  abbe_gpu_free(&s->gpu);
  abbe_gl_state_end(abbe_context_gl(context));
  abbe_scene_free(&s->scene);
}

static void look(sky *s, size_t count) {
  glsl_run(abbe_context_gl(context), s->program, (const float(*)[8])in, count, out);
}

static void set_look(size_t i, const double d[3], double wide, double other) {
  const double up[3] = {0.3, -0.5, 0.81};
  double across[3], size = 0;
  for (int k = 0; k < 3; k++)
    across[k] = up[(k + 1) % 3] * d[(k + 2) % 3] - up[(k + 2) % 3] * d[(k + 1) % 3];
  for (int k = 0; k < 3; k++) size += across[k] * across[k];
  for (int k = 0; k < 3; k++) {
    in[i][k] = (float)d[k];
    in[i][4 + k] = (float)(across[k] / sqrt(size));
  }
  in[i][3] = (float)wide;
  in[i][7] = (float)other;
}

/* Evenly over the sphere. */
static void direction_of(size_t i, size_t count, double d[3]) {
  const double turn = 2.399963229728653 * (double)i;
  d[2] = 1 - (2 * (double)i + 1) / (double)count;
  d[0] = sqrt(1 - d[2] * d[2]) * cos(turn);
  d[1] = sqrt(1 - d[2] * d[2]) * sin(turn);
}

#define LAMPS                                                                                      \
  "rotate: 20, uniform: [0.1, 0.2, 0.3], softboxes: [{elevation: 80, azimuth: 90, width: 60, "     \
  "height: 40, radiance: 2.5}, {elevation: 0, azimuth: 65, radius: 20, radiance: [1, 2, 3]}, "     \
  "{elevation: -35, azimuth: 200, radius: 1, radiance: 200}]"

GROUP(make_context, free_context);

/* Away from the poles, over which the texture does not go on. */
TEST(a_narrow_ray_sees_the_map) {
  FILLED(sky, s, make_sky(LAMPS, &s));
  for (size_t i = 0; i < LOOKS; i++) {
    double d[3];
    direction_of(i, LOOKS, d);
    set_look(i, d, i % 2 == 0 ? 0 : 0.01, 0);
  }
  look(&s, LOOKS);
  for (size_t i = 0; i < LOOKS; i++) {
    double d[3], rgb[3];
    direction_of(i, LOOKS, d);
    abbe_environment_radiance(s.scene.environment, d, rgb);
    for (int k = 0; k < 3; k++)
      if (fabs(d[2]) < 0.999) assert_near((double)out[i][k], rgb[k], 2e-3 * rgb[k] + 0.1);
  }
}

TEST(what_is_alike_all_around_stays_so) {
  FILLED(sky, s, make_sky("uniform: [0.7, 1, 1.6]", &s));
  for (size_t i = 0; i < LOOKS; i++) {
    double d[3];
    direction_of(i, LOOKS, d);
    set_look(i, d, pow(10, -3 + 4.0 * (double)(i % 17) / 16),
             pow(10, -3 + 4.0 * (double)(i % 7) / 6));
  }
  look(&s, LOOKS);
  for (size_t i = 1; i < LOOKS; i++)
    for (int k = 0; k < 3; k++)
      assert_near((double)out[i][k], (double)out[0][k], 1e-6 * (double)out[0][k]);
}

TEST(the_mean_over_the_sphere_is_kept) {
  FILLED(sky, s, make_sky(LAMPS, &s));
  for (double wide = 0.1; wide < 4; wide *= 2) {
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < LOOKS; i++) {
      double d[3];
      direction_of(i, LOOKS, d);
      set_look(i, d, wide, wide);
    }
    look(&s, LOOKS);
    for (size_t i = 0; i < LOOKS; i++)
      for (int k = 0; k < 3; k++) sum[k] += (double)out[i][k] / LOOKS;
    print_message("%.1f rad wide: %.4f\n", wide, sum[1] / s.scene.environment->mean[1]);
    /* faces stretch a bilinear filter by their own place */
    for (int k = 0; k < 3; k++) assert_near(sum[k] / s.scene.environment->mean[k], 1, 0.02);
  }
}

/* Great circles over edges and corners of the cube, poles and the map's own seam: as steep as its
 * width lets it be, and no steeper. */
TEST(nothing_jumps) {
  static const double axes[4][2][3] = {
      {{1, 0, 0}, {0, 1, 0}},
      {{0, 0, 1}, {0.8, 0.6, 0}},
      {{0.70710678, 0.70710678, 0}, {0, 0, 1}},
      {{0.57735027, 0.57735027, 0.57735027}, {0.70710678, -0.70710678, 0}}};
  double steepest = 0;
  FILLED(sky, s, make_sky(LAMPS, &s));
  for (int circle = 0; circle < 4; circle++)
    for (double wide = 0.1; wide < 1; wide *= 2) {
      const double step = 2 * ABBE_PI / LOOKS;
      double most = 0;
      for (size_t i = 0; i < LOOKS; i++) {
        double d[3];
        for (int k = 0; k < 3; k++)
          d[k] = cos(step * (double)i) * axes[circle][0][k] +
                 sin(step * (double)i) * axes[circle][1][k];
        set_look(i, d, wide, wide);
      }
      look(&s, LOOKS);
      for (size_t i = 0; i < LOOKS; i++) most = fmax(most, (double)out[i][1]);
      for (size_t i = 0; i < LOOKS; i++) {
        const double change = fabs((double)out[i][1] - (double)out[(i + 1) % LOOKS][1]);
        steepest = fmax(steepest, change / most / (step / wide));
      }
    }
  print_message("in a step of a width: %.2f of the most\n", steepest);
  assert_true(steepest < 4);
}

/* The map's mean over a parallelogram of directions, by 40 x 40 places. */
static void mean_over(const abbe_environment *e, const float a[4], const float b[4],
                      double rgb[3]) {
  enum { SIDE = 40 };
  double across[3];
  for (int k = 0; k < 3; k++)
    across[k] = (double)a[(k + 1) % 3] * (double)b[(k + 2) % 3] -
                (double)a[(k + 2) % 3] * (double)b[(k + 1) % 3];
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double u = (i % SIDE + 0.5) / SIDE - 0.5, v = (i / SIDE + 0.5) / SIDE - 0.5;
    double d[3], here[3], size = 0;
    for (int k = 0; k < 3; k++) {
      d[k] = (double)a[k] + u * (double)a[3] * (double)b[k] + v * (double)b[3] * across[k];
      size += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) d[k] /= sqrt(size);
    abbe_environment_radiance(e, d, here);
    for (int k = 0; k < 3; k++) rgb[k] += here[k] / (SIDE * SIDE);
  }
}

/* A small lamp is as bright in a wide ray as its share of the ray: near the middle of the
 * footprint, where it does not matter how the filter fades. */
TEST(a_wide_ray_sees_the_mean) {
  enum { RAYS = 400 };
  double off = 0, all = 0, narrow_off = 0;
  FILLED(sky, s, make_sky(LAMPS, &s));
  for (int pass = 0; pass < 2; pass++) {
    for (size_t i = 0; i < RAYS; i++) {
      double d[3];
      direction_of(i, RAYS, d);
      set_look(i, d, pass * 0.08 * (double)(1 + i % 5), pass * 0.08 * (double)(1 + i / 5 % 3));
    }
    look(&s, RAYS);
    for (size_t i = 0; i < RAYS; i++) {
      double mean[3];
      set_look(i, (const double[3]){(double)in[i][0], (double)in[i][1], (double)in[i][2]},
               0.08 * (double)(1 + i % 5), 0.08 * (double)(1 + i / 5 % 3));
      mean_over(s.scene.environment, in[i], in[i] + 4, mean);
      *(pass ? &off : &narrow_off) += pow((double)out[i][1] - mean[1], 2);
      all += pow(mean[1], 2) / 2;
    }
  }
  print_message("off by %.3f in the root mean square; one direction alone by %.3f\n",
                sqrt(off / all), sqrt(narrow_off / all));
  assert_true(sqrt(off / all) < 0.15);
  assert_true(off < 0.2 * narrow_off);
}

/* Bits that a look finds are the same whatever is looked at beside it: every second look here is
 * along an edge or a corner of the cube, and the others move from place to place. */
TEST(looks_are_by_themselves) {
  enum { TURN = 5 };
  static float first[LOOKS][4];
  FILLED(sky, s, make_sky(LAMPS, &s));
  for (int pass = 0; pass < 2; pass++) {
    for (size_t i = 0; i < LOOKS; i++) {
      const size_t from = pass == 0 || i % 2 != 0 ? i : (i + 2 * TURN) % LOOKS;
      double d[3] = {1, i % 4 == 1 ? 1 : 0.3, 1};
      if (i % 2 == 0) direction_of(from, LOOKS, d);
      set_look(i, d, 0.1 + 0.4 * (double)(from % 3), 0.3);
    }
    look(&s, LOOKS);
    if (pass == 0) memcpy(first, out, sizeof first);
  }
  for (size_t i = 0; i < LOOKS; i += 2)
    assert_memory_equal(out[i], first[(i + 2 * TURN) % LOOKS], sizeof out[i]);
}
