/* optics.glsl against spectral/optics.c: floats against doubles, at every awkward place.
 *
 * A float function cannot be better than its inputs' last digits allow: near the critical angle
 * the reflectance has an infinite slope, and near n = 1 the whole reflectance is a matter of n's
 * last digits. So a result may differ by what the oracle itself makes of inputs a few units in
 * the last place away, and by the rounding of a few operations on values of order one.
 */
#include "tests/gl/glsl.h"

#include "spectral/microfacets.h"
#include "spectral/optics.h"

#include <float.h>

enum { MAX_CASES = 16384 };
static const double eps = FLT_EPSILON;
static const double steps_in = 4;  /* units in the last place, of the inputs */
static const double steps_out = 8; /* of the results */

static float inputs[MAX_CASES][8], outputs[MAX_CASES][4];
static size_t count;

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

static double tilt(int i) {
  return fmod(0.37 + 0.618034 * i, 1.0);
}

/* One case a pair of eta and cosine, each with a normal of its own: a = (d, eta), b = (n, cos). */
static void make_cases(void) {
  count = 0;
  for (int k = 0; k < 2 * INDICES; k++)
    for (int i = 0; i < COSINES; i++) {
      double eta = (float)(k % 2 ? indices[k / 2] : 1 / indices[k / 2]);
      double c = cosine(i, eta), s = sqrt((1 - c) * (1 + c));
      double z = 2 * tilt(i + 7 * k) - 1, turn = 6.283185307 * tilt(3 * i + k), r = sqrt(1 - z * z);
      double n[3] = {r * cos(turn), r * sin(turn), z};
      double t[3] = {-sin(turn), cos(turn), 0};
      for (int j = 0; j < 3; j++) {
        inputs[count][j] = (float)(s * t[j] - c * n[j]);
        inputs[count][4 + j] = (float)n[j];
      }
      inputs[count][3] = (float)eta;
      inputs[count++][7] = (float)c;
    }
}

/* The largest change of the oracle as its inputs move by a few units in the last place. */
static double slack(double (*oracle)(double, double), double c, double eta) {
  double here = oracle(c, eta), most = 0;
  for (int k = 0; k < 9; k++) {
    double dc = (k % 3 - 1) * steps_in * eps, de = (k / 3 - 1) * steps_in * eps;
    double there = oracle(fmin(fmax(c + dc, 0), 1), eta * (1 + de));
    most = fmax(most, fabs(there - here));
  }
  return most;
}

GROUP(make_context, free_context);

TEST(fresnel) {
  make_cases();
  glsl_evaluate(abbe_context_gl(context),
                "#include \"optics.glsl\"\n"
                "vec4 f(vec4 a, vec4 b) { return vec4(fresnel(b.w, a.w)); }\n",
                (const float(*)[8])inputs, count, outputs);
  double worst = 0;
  for (size_t i = 0; i < count; i++) {
    double c = inputs[i][7], eta = inputs[i][3], value = outputs[i][0];
    double expected = abbe_optics_fresnel(c, eta), allowed = slack(abbe_optics_fresnel, c, eta);
    assert_near(value, expected, allowed + steps_out * eps);
    assert_true(value >= 0 && value <= 1 + steps_out * eps);
    if (allowed < 1e-4) worst = fmax(worst, fabs(value - expected));
  }
  /* 7e-7 is what llvmpipe does; five times that leaves room for another driver's square root. */
  assert_true(worst < 3.5e-6);
  print_message("largest error of fresnel where it is well conditioned: %.2g\n", worst);
}

/* Metals, and n and k that come near to glass, to air and to nothing. */
TEST(fresnel_conductor) {
  static const double nk[][2] = {{0.03, 5.2}, {0.05, 1.9}, {0.13, 3.0}, {0.4, 2.4},  {1.5, 1.9},
                                 {3, 3},      {1, 0.01},   {1.5, 0},    {0.01, 9.9}, {1.3, 7.8}};
  enum { METALS = sizeof nk / sizeof *nk, ANGLES = 101 };
  double worst = 0;
  count = 0;
  for (int m = 0; m < METALS; m++)
    for (int i = 0; i < ANGLES; i++, count++) {
      inputs[count][0] = (float)i / (ANGLES - 1);
      inputs[count][1] = (float)nk[m][0];
      inputs[count][2] = (float)nk[m][1];
    }
  glsl_evaluate(abbe_context_gl(context),
                "#define MIRRORS\n#include \"optics.glsl\"\n"
                "vec4 f(vec4 a, vec4 b) { return vec4(fresnel_conductor(a.x, a.y, a.z)); }\n",
                (const float(*)[8])inputs, count, outputs);
  for (size_t i = 0; i < count; i++) {
    const double expected = abbe_optics_fresnel_conductor(
        (double)inputs[i][0], (double)inputs[i][1], (double)inputs[i][2]);
    assert_near(outputs[i][0], expected, 5e-6);
    worst = fmax(worst, fabs((double)outputs[i][0] - expected));
  }
  print_message("largest error of fresnel_conductor: %.2g\n", worst);
}

/* Rough mirrors' lobe, its density and its sampler, from straight on to grazing. */
TEST(microfacets) {
  static const double facets[][2] = {{0.05, 0.05}, {0.1, 0.5}, {0.7, 0.2}, {1, 1}};
  count = 0;
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
  static const char start[] =
      "const float PI = 3.14159265358979;\n#define ROUGH\n#include \"optics.glsl\"\n"
      "vec4 f(vec4 a, vec4 b) {\n  vec3 h, wi, wo = vec3(a.xy, sqrt(1.0 - dot(a.xy, a.xy)));\n"
      "  float share = facets_sample(a.zw, wo, b.xy, h, wi);\n";
  static const char *const end[] = {
      "  return vec4(wi, share);\n}\n",
      "  return vec4(facets_reflect(a.zw, wi, wo), facets_pdf(a.zw, wo, wi), h.xy);\n}\n"};
  for (int part = 0; part < 2; part++) {
    glsl_evaluate(abbe_context_gl(context), printed("%s%s", start, end[part]),
                  (const float(*)[8])inputs, count, outputs);
    for (size_t i = 0; i < count; i++) {
      const double x = inputs[i][0], y = inputs[i][1], u[2] = {inputs[i][4], inputs[i][5]};
      const double wo[3] = {x, y, sqrt(1 - x * x - y * y)};
      const abbe_microfacets m = {inputs[i][2], inputs[i][3]};
      double h[3], wi[3];
      const double share = abbe_microfacets_sample(&m, wo, u, h, wi);
      if (part == 0) {
        for (int k = 0; k < 3; k++) assert_near(outputs[i][k], wi[k], 1e-4);
        if (fabs(wi[2]) > 1e-3) assert_near(outputs[i][3], share, 5e-3);
      } else if (wi[2] > 1e-2) {
        const double f = abbe_microfacets_reflect(&m, wi, wo),
                     pdf = abbe_microfacets_pdf(&m, wo, wi);
        assert_near(outputs[i][0], f, 2e-3 * f);
        assert_near(outputs[i][1], pdf, 2e-3 * pdf);
      }
    }
  }
}

static double refracted_angle(double c, double eta) {
  bool total;
  double t = abbe_optics_cos_refracted(c, eta, &total);
  return total ? acos(0) : acos(t);
}

static void check_direction(const float in[8], const float out[4], double *worst) {
  double wi[3], n[3], wt[3], c = 0, away = 0, length = 0, eta = in[3];
  for (int j = 0; j < 3; j++) {
    wi[j] = -(double)in[j];
    n[j] = in[4 + j];
    c += wi[j] * n[j];
  }
  double allowed = slack(refracted_angle, fmax(c, 0), eta) + steps_out * eps;
  for (int j = 0; j < 3; j++) {
    assert_true(isfinite(out[j]));
    length += (double)out[j] * out[j];
  }
  assert_near(sqrt(length), 1, steps_out * eps);
  bool passes = abbe_optics_refract(wi, n, eta, wt);
  if (passes != (out[3] > 0)) {
    /* Only where the last digits of the inputs decide, and that is at the critical angle. */
    double from_grazing = fabs(refracted_angle(fmax(c, 0), eta) - acos(0));
    assert_true(from_grazing <= allowed);
    return;
  }
  if (!passes) return;
  for (int j = 0; j < 3; j++) away = fmax(away, fabs(out[j] - wt[j]));
  assert_near(away, 0, allowed);
  if (allowed < 1e-4) *worst = fmax(*worst, away);
}

TEST(refract_direction) {
  double worst = 0;
  make_cases();
  glsl_evaluate(abbe_context_gl(context),
                "#include \"optics.glsl\"\n"
                "vec4 f(vec4 a, vec4 b) {\n"
                "  vec3 t;\n"
                "  bool passes = refract_direction(a.xyz, b.xyz, a.w, t);\n"
                "  return vec4(t, passes ? 1.0 : -1.0);\n"
                "}\n",
                (const float(*)[8])inputs, count, outputs);
  for (size_t i = 0; i < count; i++) check_direction(inputs[i], outputs[i], &worst);
  /* 3.5e-6 on llvmpipe, towards the critical angle. */
  assert_true(worst < 1.8e-5);
  print_message("largest error of refract_direction, well conditioned: %.2g\n", worst);
}

TEST(equal_indices_change_nothing) {
  make_cases();
  for (size_t i = 0; i < count; i++) inputs[i][3] = 1;
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
