/* The shader's kernels of light against their doubles in C, at awkward and at random inputs.
 *
 * A float function cannot be better than its inputs' last digits allow: near the critical angle
 * the reflectance has an infinite slope, and near n = 1 the whole reflectance is a matter of n's
 * last digits. So an error is counted in ULPs of the result and of each input together: divided by
 * the result's last digit and by what the double makes of each input one last digit away.
 */
#include "tests/gl/glsl.h"
#include "tests/random.h"

#include "base/maths.h"
#include "gl/device/shader_maths.h"
#include "gl/scene/spectra/camera_bands.h"
#include "spectral/microfacets.h"
#include "spectral/optics.h"

#include <float.h>

enum { CASES = 100000 };
static float inputs[CASES][8], outputs[CASES][4];
static uint64_t state = 1;

static const double indices[] = {1,    1 + 1e-7, 1 + 1e-6, 1 + 1e-5, 1.0001, 1.001, 1.01, 1.1,
                                 1.33, 1.5,      1.77,     2,        2.42,   3,     4};
enum { INDICES = sizeof indices / sizeof *indices, COSINES = 64 };

/* Grazing, normal, and all between; the last few straddle the critical angle. */
static double cosine(int i, double eta) {
  static const double ends[] = {0, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 0.999, 0.99999, 1 - 6e-8, 1};
  static const double steps[] = {-1e-2, -1e-4, -1e-6, 0, 1e-7, 1e-6, 1e-4, 1e-2};
  if (i < 10) return ends[i];
  if (i < 56) return (i - 9) / 47.0;
  double critical = eta > 1 ? sqrt((1 - 1 / eta) * (1 + 1 / eta)) : 0.5;
  return fmin(fmax(critical * (1 + steps[i - 56]), 0), 1);
}

/* a = (d, eta), b = (n, cosine): every index, both ways, with every cosine; then any. */
static void draw_face(int i, float in[8]) {
  const int k = i / COSINES;
  const bool any = k >= 2 * INDICES;
  const double n = any ? exp(random_between(&state, 0, 1.4)) : indices[k / 2];
  const double eta = (float)(i / COSINES % 2 ? n : 1 / n);
  const double c = any && i % 4 ? random_between(&state, 0, 1) : cosine(i % COSINES, eta);
  double normal[3], across[3];
  random_unit(&state, normal);
  random_unit(&state, across);
  const double along = abbe_vector_dot(normal, across);
  for (int j = 0; j < 3; j++) across[j] -= along * normal[j];
  abbe_vector_normalise(across);
  for (int j = 0; j < 3; j++) {
    in[j] = (float)(sqrt((1 - c) * (1 + c)) * across[j] - c * normal[j]);
    in[4 + j] = (float)normal[j];
  }
  in[3] = (float)eta;
  in[7] = (float)c;
}

/* a = (cosine, n, k): metals, and n and k that come near to glass, to air and to nothing. */
static void draw_metal(int i, float in[8]) {
  static const double nk[][2] = {{0.03, 5.2}, {0.05, 1.9}, {0.13, 3.0}, {0.4, 2.4},  {1.5, 1.9},
                                 {3, 3},      {1, 0.01},   {1.5, 0},    {0.01, 9.9}, {1.3, 7.8}};
  const bool any = i >= 10 * COSINES;
  in[0] = (float)(any ? random_between(&state, 0, 1) : cosine(i % COSINES, 1));
  in[1] = (float)(any ? exp(random_between(&state, -4, 1.5)) : nk[i / COSINES][0]);
  in[2] = (float)(any ? exp(random_between(&state, -4, 2.3)) : nk[i / COSINES][1]);
}

/* a = (1/m, m): up to where nothing is left. */
static void draw_way(int i, float in[8]) {
  in[0] = i % 100 ? (float)exp(random_between(&state, -7, 7)) : 0;
  in[1] = (float)(random_between(&state, 0, 80) / fmax((double)in[0], 1e-3));
}

/* a = (wi, roughness along x), b = (wo, along y). */
static void draw_lobe(int i, float in[8]) {
  for (int k = 0; k < 2; k++) {
    double w[3];
    random_unit(&state, w);
    w[2] = fabs(w[2]) + (i % 3 ? 0.02 : 1e-3);
    abbe_vector_normalise(w);
    for (int j = 0; j < 3; j++) in[4 * k + j] = (float)w[j];
    in[4 * k + 3] = (float)exp(random_between(&state, -3, 0));
  }
}

static void refraction(const double x[8], double out[4]) {
  const double wi[3] = {-x[0], -x[1], -x[2]};
  double length = 0;
  out[3] = abbe_optics_refract(wi, x + 4, x[3], out) ? 1 : -1;
  for (int k = 0; k < 3; k++) out[k] = out[3] > 0 ? out[k] : x[k];
  if (out[3] > 0) length = abbe_vector_length(out);
  for (int k = 0; k < 3 && out[3] > 0; k++) out[k] /= length;
}

static void refraction_of_processor(const float x[8], float out[4]) {
  v3 t;
  out[3] = refract_direction(vector_at(x), vector_at(x + 4), x[3], &t) ? 1 : -1;
  memcpy(out, &t, sizeof t);
}

static void reflectance(const double x[8], double out[4]) {
  out[0] = abbe_optics_fresnel(x[7], x[3]);
}

static void reflectance_of_processor(const float x[8], float out[4]) {
  out[0] = fresnel(x[7], x[3]);
}

static void reflectance_of_metal(const double x[8], double out[4]) {
  out[0] = abbe_optics_fresnel_conductor(x[0], x[1], x[2]);
}

static void absorption(const double x[8], double out[4]) {
  out[0] = abbe_optics_transmittance(x[0], x[1]);
}

static void lobe(const double x[8], double out[4]) {
  const abbe_microfacets m = {x[3], x[7]};
  out[0] = abbe_microfacets_reflect(&m, x, x + 4);
  out[1] = abbe_microfacets_pdf(&m, x + 4, x);
  out[2] = abbe_microfacets_visible(&m, x);
  out[3] = abbe_microfacets_density(&m, x);
}

/* A film's shares by the angle, as its tables have them: what is looked up is nearly that. */
static double film_share(int angle, int share) {
  return (double)(float)(0.5 + 0.45 * sin(0.06 * angle + 2 * share));
}

static void bind_film(const abbe_gl *gl) {
  static float texel[2 + 2 * ABBE_FILM_ANGLES + 1][4]; /* behind a refractor and a plane */
  for (int i = 0; i <= 2 * ABBE_FILM_ANGLES; i++)
    for (int k = 0; k < 3; k++) texel[2 + i][k] = (float)film_share(i, k);
  glsl_texels(gl, UNIT_FILMS, GL_RGBA32F, sizeof texel, texel);
}

/* a = (cosine, n, from outside): straddling total reflection from inside. */
static void draw_film(int i, float in[8]) {
  const double n = i % 3 ? exp(random_between(&state, 0.05, 1)) : indices[7 + i / 3 % 8];
  in[1] = (float)n;
  in[2] = i % 2 ? 1 : 0;
  in[0] = (float)(i % 5 ? random_between(&state, 0, 1) : cosine(i / 5 % COSINES, n));
}

static void film(const double x[8], double out[4]) {
  const double c2 = x[0] * x[0], n2 = x[1] * x[1];
  const double in_air = x[2] > 0.5 ? c2 : (1 - n2) + n2 * c2;
  const double beyond = fmin(fmax(-in_air / (n2 - 1), 0), 1);
  const double at = ABBE_FILM_ANGLES * (1 + (in_air > 0 ? sqrt(fmin(in_air, 1))
                                                        : -sqrt(beyond) / (1 + sqrt(1 - beyond))));
  const int i = (int)fmin(fmax(floor(at), 0), 2 * ABBE_FILM_ANGLES - 1);
  for (int k = 0; k < 2; k++) {
    const int share = k == 1 ? 2 : x[2] > 0.5 ? 0 : 1;
    out[k] = film_share(i, share) + (at - i) * (film_share(i + 1, share) - film_share(i, share));
  }
}

typedef struct kernel {
  const char *name, *text;
  void (*draw)(int i, float in[8]);
  void (*twin)(const double x[8], double out[4]);
  void (*processor)(const float x[8], float out[4]); /* what a processor's thread does, or NULL */
  int results;
  bool direction; /* three results whose last digit is that of 1; the fourth says whether it is one
                   */
  double bound;
} kernel;

static double last_digit(double x) {
  const float size = fabsf((float)x);
  return (double)(nextafterf(size, INFINITY) - size);
}

static double ulps_off(const kernel *k, const float in[8], const float out[4]) {
  double x[8], exact[4], moved[4], unit[4], worst = 0;
  for (int j = 0; j < 8; j++) x[j] = (double)in[j];
  k->twin(x, exact);
  if (k->direction && out[3] != exact[3]) { /* only where the last digits of eta decide */
    x[3] *= 1 + (out[3] > 0 ? -1 : 1) * k->bound * FLT_EPSILON;
    k->twin(x, moved);
    return out[3] == moved[3] ? 0 : INFINITY;
  }
  for (int r = 0; r < k->results; r++) unit[r] = last_digit(k->direction ? 1 : exact[r]);
  for (int j = 0; j < 8; j++) {
    double most[4] = {0};
    for (int up = -1; up <= 1; up += 2) {
      x[j] = (double)nextafterf(in[j], up * INFINITY);
      k->twin(x, moved);
      for (int r = 0; r < k->results; r++) most[r] = fmax(most[r], fabs(moved[r] - exact[r]));
    }
    x[j] = (double)in[j];
    for (int r = 0; r < k->results; r++) unit[r] += most[r];
  }
  for (int r = 0; r < k->results; r++)
    worst = fmax(worst, isfinite(out[r]) ? fabs((double)out[r] - exact[r]) / unit[r] : INFINITY);
  return worst;
}

/* ns of one. */
static double time_twin(const kernel *k) {
  double x[8], out[4] = {0}, sum = 0;
  const double from = glsl_processor_ns();
  for (int i = 0; i < CASES; i++) {
    for (int j = 0; j < 8; j++) x[j] = (double)inputs[i][j];
    k->twin(x, out);
    sum += out[0];
  }
  const double took = glsl_processor_ns() - from;
  assert_false(isinf(sum));
  return took / CASES;
}

GROUP(make_context, free_context);

TEST(kernels_have_twins) {
  const kernel kernels[] = {
      {"refraction",
       "vec4 f(vec4 a, vec4 b) {\n  vec3 t;\n"
       "  bool passes = refract_direction(a.xyz, b.xyz, a.w, t);\n"
       "  return vec4(t, passes ? 1.0 : -1.0);\n}\n",
       draw_face, refraction, refraction_of_processor, 3, true, 8},
      {"Fresnel", "vec4 f(vec4 a, vec4 b) { return vec4(fresnel(b.w, a.w)); }\n", draw_face,
       reflectance, reflectance_of_processor, 1, false, 16},
      {"Fresnel of metals",
       "vec4 f(vec4 a, vec4 b) { return vec4(fresnel_conductor(a.x, a.y, a.z)); }\n", draw_metal,
       reflectance_of_metal, NULL, 1, false, 16},
      {"absorption", "vec4 f(vec4 a, vec4 b) { return vec4(exp(-a.x * a.y)); }\n", draw_way,
       absorption, NULL, 1, false, 8},
      {"lobe",
       "vec4 f(vec4 a, vec4 b) {\n  vec2 r = vec2(a.w, b.w);\n"
       "  return vec4(facets_reflect(r, a.xyz, b.xyz), facets_pdf(r, b.xyz, a.xyz),\n"
       "              facets_visible(r, a.xyz), facets_density(r, a.xyz));\n}\n",
       draw_lobe, lobe, NULL, 4, false, 8},
      {"films",
       printed("#define REFRACTORS 1\n#define REFRACTOR_ROOM 1\n#define PLANE_ROOM 1\n"
               "#define LIGHT_ROOM 1\n#define RECEIVER_ROOM 1\n#define SURFACE_ROOM 1\n"
               "#define SPECTRUM_ROOM 1\n#define FILMS\n#define FILM_ANGLES %d\n"
               "#define BAND_SETS %d\n#include \"refractor.glsl\"\n"
               "vec4 f(vec4 a, vec4 b) {\n  film_row = 0;\n"
               "  return film_shares(0, a.z > 0.5, a.x, a.y).xyxy;\n}\n",
               ABBE_FILM_ANGLES, ABBE_CAMERA_BAND_SETS),
       draw_film, film, NULL, 2, false, 32}};
  const abbe_gl *gl = abbe_context_gl(context);
  bind_film(gl);
  size_t wrong = 0;
  for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++) {
    const kernel *is = &kernels[k];
    double device = 0, processor = 0;
    memset(inputs, 0, sizeof inputs);
    for (int i = 0; i < CASES; i++) is->draw(i, inputs[i]);
    const char *head = is->text[0] == '#' ? ""
                                          : "const float PI = 3.14159265358979;\n#define MIRRORS\n"
                                            "#define ROUGH\n#include \"optics.glsl\"\n";
    const GLuint program = glsl_make(gl, printed("%s%s", head, is->text));
    const double shader_ns = glsl_time(gl, program, (const float(*)[8])inputs, CASES, outputs);
    gl->DeleteProgram(program);
    const double twin_ns = time_twin(is);
    for (int i = 0; i < CASES; i++) {
      device = fmax(device, ulps_off(is, inputs[i], outputs[i]));
      float out[4];
      if (is->processor == NULL) continue;
      is->processor(inputs[i], out);
      processor = fmax(processor, ulps_off(is, inputs[i], out));
    }
    print_message("%s: %.2f ULPs, %.0f ns; in doubles %.0f ns", is->name, device, shader_ns,
                  twin_ns);
    if (is->processor != NULL) print_message("; on the processor %.2f ULPs", processor);
    print_message("\n");
    wrong += device > is->bound || processor > is->bound;
  }
  assert_int_equal(wrong, 0);
}

static double tilt(int i) {
  return fmod(0.37 + 0.618034 * i, 1.0);
}

/* The sampler of rough mirrors' lobe, from straight on to grazing. */
TEST(microfacets) {
  static const double facets[][2] = {{0.05, 0.05}, {0.1, 0.5}, {0.7, 0.2}, {1, 1}};
  size_t count = 0;
  for (int m = 0; m < 4; m++)
    for (int i = 0; i < 500; i++, count++) {
      const double a = tilt(i), b = tilt(3 * i + m), c = 0.02 + 0.97 * tilt(7 * i),
                   s = sqrt(1 - c * c);
      inputs[count][0] = (float)(s * cos(6.2831853 * a));
      inputs[count][1] = (float)(s * sin(6.2831853 * a));
      inputs[count][2] = (float)facets[m][0];
      inputs[count][3] = (float)facets[m][1];
      inputs[count][4] = (float)(0.98 * b); /* the last part of the disk is steep */
      inputs[count][5] = (float)tilt(11 * i + 5 * m);
    }
  static const char text[] =
      "const float PI = 3.14159265358979;\n#define ROUGH\n#include \"optics.glsl\"\n"
      "vec4 f(vec4 a, vec4 b) {\n  vec3 h, wi, wo = vec3(a.xy, sqrt(1.0 - dot(a.xy, a.xy)));\n"
      "  float share = facets_sample(a.zw, wo, b.xy, h, wi);\n"
      "  return vec4(wi, share);\n}\n";
  glsl_evaluate(abbe_context_gl(context), text, (const float(*)[8])inputs, count, outputs);
  for (size_t i = 0; i < count; i++) {
    const double x = inputs[i][0], y = inputs[i][1], u[2] = {inputs[i][4], inputs[i][5]};
    const double wo[3] = {x, y, sqrt(1 - x * x - y * y)};
    const abbe_microfacets m = {inputs[i][2], inputs[i][3]};
    double h[3], wi[3];
    const double share = abbe_microfacets_sample(&m, wo, u, h, wi);
    for (int k = 0; k < 3; k++) assert_near(outputs[i][k], wi[k], 1e-4);
    if (fabs(wi[2]) > 1e-3) assert_near(outputs[i][3], share, 5e-3);
  }
}

TEST(equal_indices_change_nothing) {
  enum { count = 2 * INDICES * COSINES };
  for (int i = 0; i < count; i++) {
    draw_face(i, inputs[i]);
    inputs[i][3] = 1;
  }
  glsl_evaluate(abbe_context_gl(context),
                "#include \"optics.glsl\"\n"
                "vec4 f(vec4 a, vec4 b) {\n"
                "  vec3 t;\n"
                "  bool passes = refract_direction(a.xyz, b.xyz, 1.0, t);\n"
                "  return vec4(passes ? distance(t, a.xyz) : 9.0,\n"
                "              fresnel(b.w, 1.0), 0, 0);\n"
                "}\n",
                (const float(*)[8])inputs, count, outputs);
  for (size_t i = 0; i < count; i++) {
    assert_near(outputs[i][0], 0, 0);
    assert_true(outputs[i][1] == 0.0f);
  }
}
