/* image_search.glsl against estimator_run.h: every estimator, after one iteration and more,
 * on planes and in a sphere, for point and directional lights. */
#include "tests/gl/glsl.h"

#include "tests/scenes/view/estimator_run.h"

enum { CASES = 64 };

/* The same lookup in both languages: a plane z = -0.5 + 0.2 x - 0.1 y, or a sphere of radius 1.1.
 */
static const char surfaces[] =
    "bool look_up(vec3 at, out vec3 seen) {\n"
    "  View v = places_view();\n"
    "  bool point = v.origin.w > 0.5;\n"
    "  vec3 o = point ? v.origin.xyz : at, d = point ? normalize(at - o) : v.forward.xyz;\n"
    "#ifdef ROUND\n"
    "  float b = dot(o, d), h = b * b - dot(o, o) + 1.21;\n"
    "  float t = -b + sqrt(max(h, 0.0));\n"
    "  bool meets = h >= 0.0;\n"
    "#else\n"
    "  vec3 n = vec3(-0.2, 0.1, 1);\n"
    "  float t = (-0.5 - dot(n, o)) / dot(n, d);\n"
    "  bool meets = true;\n"
    "#endif\n"
    "  seen = o + t * d;\n"
    "  return meets && (t > 0.0 || !point);\n"
    "}\n";

typedef struct world {
  abbe_view view;
  bool round;
} world;

static bool look(void *user, const double at[3], double seen[3]) {
  const world *w = user;
  const abbe_view *v = &w->view;
  double o[3], d[3], t;
  for (int k = 0; k < 3; k++) {
    o[k] = v->orthographic ? at[k] : v->origin[k];
    d[k] = v->orthographic ? v->forward[k] : at[k] - o[k];
  }
  abbe_vector_normalise(d);
  if (w->round) {
    const double b = abbe_vector_dot(o, d), h = b * b - abbe_vector_dot(o, o) + 1.21;
    if (h < 0) return false;
    t = -b + sqrt(h);
  } else {
    static const double n[3] = {-0.2, 0.1, 1};
    t = (-0.5 - abbe_vector_dot(n, o)) / abbe_vector_dot(n, d);
  }
  for (int k = 0; k < 3; k++) seen[k] = o[k] + t * d[k];
  return t > 0 || v->orthographic;
}

static void make_rays(float in[CASES][8]) {
  memset(in, 0, CASES * sizeof *in);
  for (int i = 0; i < CASES; i++) {
    double d[3] = {fmod(0.37 + 0.61803 * i, 1) - 0.5, fmod(0.11 + 0.41421 * i, 1) - 0.5, -1};
    abbe_vector_normalise(d);
    for (int k = 0; k < 3; k++) in[i][4 + k] = (float)d[k];
    in[i][0] = (float)(0.2 * (fmod(0.7 * i, 1) - 0.5));
    in[i][1] = 0.02f;
    in[i][2] = 0.25f;
  }
}

static GLuint make_program(const abbe_gl *gl, const world *w, abbe_estimator kind,
                           size_t iterations, bool printed) {
  char text[3500];
  snprintf(
      text, sizeof text,
      "#define ESTIMATOR_SHAH 1\n#define ESTIMATOR_AXIS 2\n#define ESTIMATOR_NEWTON 3\n"
      "#define ESTIMATOR_SECANT 4\n#define ESTIMATOR_FALSE_POSITION 5\n"
      "#define ESTIMATOR_ILLINOIS 6\n#define ESTIMATOR_BISECTION 7\n"
      "#define ESTIMATOR_MARCH 8\n#define ESTIMATOR_IMPOSTOR 9\n#define ESTIMATOR_RATIO 10\n"
      "#define ESTIMATOR_EXACT 11\n#define ESTIMATOR %d\n#define ITERATIONS %zu\n%s%s#include "
      "\"view.glsl\"\nuniform vec4 rows[6];\n"
      "View places_view() { return View(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]); }\n"
      "vec3 places_axis(vec3 at) { return places_view().forward.xyz; }\n"
      "%s#include \"image_search.glsl\"\n"
      "vec4 f(vec4 a, vec4 b) {\n  vec3 at;\n"
      "  bool found = find_receiver(a.xyz, b.xyz, at);\n"
      "  return vec4(at, found ? 1.0 : 0.0);\n}\n",
      (int)kind, iterations, printed ? "#define SEARCH_AS_PRINTED\n" : "",
      w->round ? "#define ROUND\n" : "", surfaces);
  float packed[24];
  const GLuint program = glsl_make(gl, text);
  abbe_view_pack(&w->view, packed);
  gl->Uniform4fv(gl->GetUniformLocation(program, "rows"), 6, packed);
  return program;
}

/* How many of both found the place, and how many agree on that. */
static void compare(abbe_estimator kind, size_t iterations, bool printed, const world *w,
                    size_t *found, size_t *alike) {
  const abbe_gl *gl = abbe_context_gl(context);
  float in[CASES][8], out[CASES][4];
  make_rays(in);
  const GLuint program = make_program(gl, w, kind, iterations, printed);
  glsl_run(gl, program, (const float(*)[8])in, CASES, out);
  gl->DeleteProgram(program);
  for (int i = 0; i < CASES; i++) {
    double o[3], d[3];
    for (int k = 0; k < 3; k++) {
      o[k] = (double)in[i][k];
      d[k] = (double)in[i][4 + k];
    }
    const abbe_estimator_desc desc =
        FIELDS(.kind = kind, .iterations = iterations, .printed = printed, .view = &w->view,
               .lookup = look, .user = (void *)w);
    const abbe_estimate e = abbe_estimator_run(&desc, o, d);
    *alike += e.found == (out[i][3] > 0);
    if (!e.found || out[i][3] == 0) continue;
    ++*found;
    for (int k = 0; k < 3; k++) assert_near((double)out[i][k], e.at[k], 1e-3 * fmax(1, e.distance));
  }
}

GROUP(make_context, free_context);

/* Floats against doubles: where a step divides by a difference of two lookups that nearly agree,
 * the place is known to 1e-3 of what is a metre deep. Newton's difference is a sixty-fourth. */
TEST(every_estimator) {
  static const double lamp[3] = {0.2, -0.1, 0.7}, down[3] = {-0.1, 0.15, -1}, up[3] = {0, 1, 0};
  static const size_t iterations[] = {1, 3, 8};
  for (int kind = ABBE_ESTIMATOR_SHAH; kind < ABBE_ESTIMATOR_EXACT; kind++) {
    size_t found = 0, alike = 0, all = 0;
    for (int k = 0; k < 4; k++) {
      world w = {.round = k & 1};
      abbe_view_look(lamp, down, up, k & 2, &w.view);
      w.view.near = 0.01;
      w.view.far = 3;
      for (int i = 0; i < 3; i++, all += CASES)
        compare((abbe_estimator)kind, iterations[i], false, &w, &found, &alike);
      if (kind != ABBE_ESTIMATOR_SHAH) continue;
      compare((abbe_estimator)kind, 2, true, &w, &found, &alike);
      all += CASES;
    }
    print_message("%s: %zu of %zu found\n", abbe_estimator_name((abbe_estimator)kind), found, all);
    assert_true(alike >= all * 98 / 100);
    assert_true(found >= all / 2);
  }
}
