/* The shader's waves of crystals against spectral/biaxial.h in doubles: their vectors and rays
 * behind a face, what of unpolarised light enters each, and how an axis' absorption counts in a
 * wave's. */
#include "tests/gl/glsl.h"

#include "base/maths.h"
#include "spectral/biaxial.h"

enum { RAYS = 20000 };

/* a: unit direction of the light in air, the face's normal is z; what is asked. */
static const char source[] =
    "#define REFRACTORS 1\n#define PLEOCHROIC\n"
    "#include \"optics.glsl\"\n"
    "#include \"crystals.glsl\"\n"
    "uniform vec4 z, x, row;\n"
    "Crystal crystal_of(int r) { return make_crystal(z.xyz, x.xyz, row); }\n"
    "vec4 f(vec4 a, vec4 b) {\n"
    "  Crystal c = crystal_of(0);\n"
    "  vec3 n = vec3(0, 0, 1), d = a.xyz, k, ray;\n"
    "  int wave = int(b.y);\n"
    "  bool is = wave_from(c, wave, d - dot(d, n) * n, -n, k, ray);\n"
    "  vec2 field = field_parts(c, wave, k, n);\n"
    "  vec3 reflects = face_reflects(-dot(d, n), 1.0, length(k));\n"
    "  float enters = 0.5 * (1.0 - dot(reflects.xy, field * field));\n"
    "  if (b.x == 0.0) return vec4(k, is ? 1 : 0);\n"
    "  return b.x == 1.0 ? vec4(ray, enters) : vec4(axis_shares(c, wave, k), 0);\n"
    "}\n";

typedef struct answers {
  float k[RAYS][4], ray[RAYS][4], shares[RAYS][4];
} answers;

static void ask(const abbe_gl *gl, GLuint program, int wave, float (*in)[8], answers *out) {
  float(*const to[3])[4] = {out->k, out->ray, out->shares};
  for (int what = 0; what < 3; what++) {
    for (int i = 0; i < RAYS; i++) {
      in[i][4] = (float)what;
      in[i][5] = (float)wave;
    }
    glsl_run(gl, program, (const float(*)[8])in, RAYS, to[what]);
  }
}

static void set_vector(const abbe_gl *gl, GLuint program, const char *name, const double v[3],
                       double w) {
  gl->Uniform4f(gl->GetUniformLocation(program, name), (float)v[0], (float)v[1], (float)v[2],
                (float)w);
}

static double apart(const float *a, const double b[3], double by) {
  double square = 0;
  for (int i = 0; i < 3; i++) square += pow((double)a[i] - by * b[i], 2);
  return sqrt(square);
}

/* share_bound: of the light, by which a wave's part may be off. uniaxial: by the closed form for
 * two indices. */
static void hold_by(const double n[3], double share_bound, bool uniaxial) {
  static float in[RAYS][8];
  static answers got[2];
  const abbe_gl *gl = abbe_context_gl(context);
  abbe_biaxial air = {{1, 1, 1}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
               stone = {{n[0], n[1], n[2]}, {{0}}};
  double z[3] = {0.4, -0.5, 0.7}, up[3] = {0, 1, 0.3}, x[3], y[3];
  abbe_vector_normalise(z);
  abbe_vector_cross(up, z, x);
  abbe_vector_normalise(x);
  abbe_vector_cross(z, x, y);
  memcpy(stone.axis[0], x, sizeof x);
  memcpy(stone.axis[1], y, sizeof y);
  memcpy(stone.axis[2], z, sizeof z);
  const double a = pow(n[0], -2), b = pow(n[1], -2), c = pow(n[2], -2);
  const double cos2 = (b - c) / (a - c), row[3] = {(a + c) / 2, (a - c) / 2, sqrt(1 - cos2)};
  for (int i = 0; i < RAYS; i++) {
    const double sine = 0.98 * sqrt((i + 0.5) / RAYS), turn = 2.399963 * i;
    in[i][0] = (float)(sine * cos(turn));
    in[i][1] = (float)(sine * sin(turn));
    in[i][2] = -(float)sqrt(1 - sine * sine);
  }
  const GLuint program =
      glsl_make(gl, printed("%s%s", uniaxial ? "#define UNIAXIAL\n" : "", source));
  set_vector(gl, program, "z", z, 0);
  set_vector(gl, program, "x", x, 0);
  set_vector(gl, program, "row", row, sqrt(cos2));
  for (int wave = 0; wave < 2; wave++) ask(gl, program, wave, in, &got[wave]);
  const double shader_ns = glsl_time(gl, program, (const float(*)[8])in, RAYS, got[1].shares);
  gl->DeleteProgram(program);
  double vector = 0, ray = 0, share = 0, absorbed = 0;
  const double from = glsl_processor_ns();
  for (int i = 0; i < RAYS; i++) {
    const double normal[3] = {0, 0, 1},
                 d[3] = {(double)in[i][0], (double)in[i][1], (double)in[i][2]};
    abbe_biaxial_split split;
    abbe_biaxial_meet_unpolarised(&air, &stone, normal, d, NULL, &split);
  }
  const double twin_ns = (glsl_processor_ns() - from) / RAYS;
  const double takes[3] = {2000, uniaxial ? 2000 : 300, 900};
  for (int i = 0; i < RAYS; i++) {
    const double normal[3] = {0, 0, 1};
    double d[3] = {(double)in[i][0], (double)in[i][1], (double)in[i][2]};
    abbe_vector_normalise(d);
    abbe_biaxial_split split;
    abbe_biaxial_meet_unpolarised(&air, &stone, normal, d, NULL, &split);
    for (int m = 0; m < 2; m++) {
      const abbe_biaxial_wave *w = &split.transmitted[m];
      const double to[2] = {apart(got[0].k[i], w->state.normal, w->state.index),
                            apart(got[1].k[i], w->state.normal, w->state.index)};
      const answers *is = &got[to[0] < to[1] ? 0 : 1];
      const double right = abbe_biaxial_attenuation(&stone, takes, w->state.field);
      double sum = 0;
      for (int axis = 0; axis < 3; axis++) sum += takes[axis] * (double)is->shares[i][axis];
      assert_true(is->k[i][3] == 1);
      vector = fmax(vector, fmin(to[0], to[1]));
      ray = fmax(ray, apart(is->ray[i], w->state.ray, 1));
      share = fmax(share, fabs((double)is->ray[i][3] - w->share));
      absorbed = fmax(absorbed, fabs(sum / right - 1));
    }
  }
  print_message("%.4f %.4f %.4f: vectors within %.1e, rays %.1e, shares %.4f, absorption %.1e; "
                "a wave %.0f ns, in doubles both with what is reflected %.0f ns\n",
                n[0], n[1], n[2], vector, ray, share, absorbed, shader_ns, twin_ns);
  assert_true(vector < 1e-6);
  assert_true(ray < 1e-6);
  assert_true(share < share_bound);
  assert_true(absorbed < 1e-5);
}

static void hold(const double n[3], double share_bound) {
  hold_by(n, share_bound, false);
  if (n[0] == n[1]) hold_by(n, share_bound, true);
}

GROUP(make_context, free_context);

TEST(waves_of_two_indices) {
  hold((const double[3]){1.65834, 1.65834, 1.48613}, 0.01); /* calcite */
  hold((const double[3]){1.5442, 1.5442, 1.5533}, 0.001);   /* quartz */
  hold((const double[3]){2.616, 2.616, 2.903}, 0.01);       /* rutile */
}

TEST(waves_of_three_indices) {
  hold((const double[3]){1.692, 1.693, 1.700}, 0.001);  /* tanzanite */
  hold((const double[3]){1.900, 1.907, 2.034}, 0.01);   /* sphene */
  hold((const double[3]){1.530, 1.681, 1.6854}, 0.012); /* aragonite */
}
