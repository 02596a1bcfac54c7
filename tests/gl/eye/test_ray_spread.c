/* How neighbouring rays go apart at mirrors and interfaces: the shader's first order against the
 * difference of two rays that are followed in doubles. */
#include "tests/gl/glsl.h"

#include "base/maths.h"

enum { CASES = 256, STEPS = 4 };
static const double EYE[3] = {0.1, -0.2, -1}, RADIUS = 0.3;

/* The body: a sphere about the origin, or a triangle with normals of its own. */
static const double corner[3][3] = {{-2, -1.5, 0.2}, {2.1, -1.4, -0.1}, {0.1, 2.2, 0.1}};
static const double normal[3][3] = {{-0.5, -0.3, -0.9}, {0.3, -0.3, -1.1}, {0.1, 0.4, -1.0}};

/* a: direction, index of what is behind the first interface (0: a mirror); b: how many times the
 * light meets a sphere from within before it leaves, or -1: a triangle; the neighbour's turn. */
static const char source[] =
    "#include \"optics.glsl\"\n"
    "#include \"ray_spread.glsl\"\n"
    "const vec3 eye = vec3(0.1, -0.2, -1);\n"
    "const float radius = 0.3;\n"
    "vec4 f(vec4 a, vec4 b) {\n"
    "  vec3 d = a.xyz, n, face_n, p;\n"
    "  float t, index = a.w;\n"
    "  mat3 bend;\n"
    "  Spread s = no_spread();\n"
    "  s.turn_x = b.yzw;\n"
    "  if (b.x < 0.0) {\n"
    "    vec3 c = vec3(-2, -1.5, 0.2), e1 = vec3(2.1, -1.4, -0.1) - c, e2 = vec3(0.1, 2.2, 0.1) - "
    "c;\n"
    "    vec3 n0 = vec3(-0.5, -0.3, -0.9), n1 = vec3(0.3, -0.3, -1.1), n2 = vec3(0.1, 0.4, -1.0);\n"
    "    face_n = -normalize(cross(e1, e2));\n"
    "    t = dot(c - eye, face_n) / dot(d, face_n);\n"
    "    vec3 q = eye + t * d - c, g = cross(e1, e2);\n"
    "    float u = dot(cross(q, e2), g) / dot(g, g), v = dot(cross(e1, q), g) / dot(g, g);\n"
    "    vec3 sum = (1.0 - u - v) * n0 + u * n1 + v * n2;\n"
    "    n = normalize(sum);\n"
    "    bend = triangle_bend(e1, e2, n0, n1, n2, sum);\n"
    "  } else {\n"
    "    float m = dot(eye, d);\n"
    "    t = -m - sqrt(radius * radius - dot(eye, eye) + m * m);\n"
    "    n = face_n = normalize(eye + t * d);\n"
    "    bend = mat3(1.0 / radius);\n"
    "  }\n"
    "  p = eye + t * d;\n"
    "  s = spread_at(s, d, t, face_n);\n"
    "  if (index == 0.0) return vec4(spread_mirrored(s, d, n, bend).turn_x, 0);\n"
    "  vec3 inner, outer;\n"
    "  refract_direction(d, n, 1.0 / index, inner);\n"
    "  s = spread_refracted(s, d, n, bend, 1.0 / index);\n"
    "  if (b.x < 0.0) return vec4(s.turn_x, 0);\n"
    "  for (float k = 0.0; k <= b.x; k++) {\n"
    "    d = inner;\n"
    "    t = -2.0 * dot(p, d);\n"
    "    p += t * d;\n"
    "    n = normalize(p);\n"
    "    s = spread_at(s, d, t, n);\n"
    "    if (k < b.x) {\n"
    "      s = spread_mirrored(s, d, -n, -bend);\n"
    "      inner = reflect(d, n);\n"
    "    }\n"
    "  }\n"
    "  return vec4(spread_refracted(s, d, -n, -bend, index).turn_x, 0);\n"
    "}\n";

static void normalise(double v[3]) {
  const double size = sqrt(abbe_vector_dot(v, v));
  for (int k = 0; k < 3; k++) v[k] /= size;
}

static void cross(const double a[3], const double b[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void mirror(const double n[3], double d[3]) {
  const double along = abbe_vector_dot(d, n);
  for (int k = 0; k < 3; k++) d[k] -= 2 * along * n[k];
}

static bool bend_at(const double n[3], double eta, double d[3]) {
  const double c = -abbe_vector_dot(d, n), t2 = 1 - eta * eta * (1 - c * c);
  for (int k = 0; k < 3; k++) d[k] = eta * d[k] + (eta * c - sqrt(fmax(t2, 0))) * n[k];
  return t2 > 0.02;
}

static void triangle_normal(const double d[3], double n[3]) {
  double e1[3], e2[3], g[3], q[3], by[3], c[3];
  for (int k = 0; k < 3; k++) {
    e1[k] = corner[1][k] - corner[0][k];
    e2[k] = corner[2][k] - corner[0][k];
    c[k] = corner[0][k] - EYE[k];
  }
  cross(e1, e2, g);
  const double t = abbe_vector_dot(c, g) / abbe_vector_dot(d, g);
  for (int k = 0; k < 3; k++) q[k] = t * d[k] - c[k];
  cross(q, e2, by);
  const double u = abbe_vector_dot(by, g) / abbe_vector_dot(g, g);
  cross(e1, q, by);
  const double v = abbe_vector_dot(by, g) / abbe_vector_dot(g, g);
  for (int k = 0; k < 3; k++)
    n[k] = (1 - u - v) * normal[0][k] + u * normal[1][k] + v * normal[2][k];
  normalise(n);
}

/* The last direction of the light that leaves the eye along d; false where it runs nearly along an
 * interface. */
static bool follow(double index, int inside, double d[3]) {
  double n[3], p[3];
  normalise(d);
  if (inside < 0) {
    triangle_normal(d, n);
    if (index > 0) return bend_at(n, 1 / index, d);
    mirror(n, d);
    return true;
  }
  const double m = abbe_vector_dot(EYE, d),
               t = -m - sqrt(RADIUS * RADIUS - abbe_vector_dot(EYE, EYE) + m * m);
  for (int k = 0; k < 3; k++) n[k] = (p[k] = EYE[k] + t * d[k]) / RADIUS;
  if (index == 0) {
    mirror(n, d);
    return true;
  }
  bool well = bend_at(n, 1 / index, d);
  for (int i = 0; i <= inside; i++) {
    const double way = -2 * abbe_vector_dot(p, d);
    for (int k = 0; k < 3; k++) n[k] = (p[k] += way * d[k]) / RADIUS;
    if (i < inside) mirror(n, d);
  }
  for (int k = 0; k < 3; k++) n[k] = -n[k];
  return bend_at(n, index, d) && well;
}

static void make_case(int i, float in[8]) {
  const double aim = 0.26 * sqrt((i / 8 + 0.5) / 32), turn = 2.4 * i;
  double d[3] = {aim * cos(turn) - EYE[0], aim * sin(turn) - EYE[1], -EYE[2]}, across[3];
  const double any[3] = {cos(i), sin(i), 0.3};
  normalise(d);
  cross(d, any, across);
  normalise(across);
  for (int k = 0; k < 3; k++) {
    in[k] = (float)d[k];
    in[5 + k] = (float)across[k];
  }
  in[3] = i % 2 == 0 ? 0 : 1.5f;
  in[4] = (float)(i / 2 % STEPS - 1);
}

GROUP(make_context, free_context);

TEST(neighbours_go_apart_as_two_rays_do) {
  static float in[CASES][8], out[CASES][4];
  const double step = 1e-5;
  double worst = 0;
  int seen = 0;
  for (int i = 0; i < CASES; i++) make_case(i, in[i]);
  glsl_evaluate(abbe_context_gl(context), source, (const float(*)[8])in, CASES, out);
  for (int i = 0; i < CASES; i++) {
    double a[3], b[3], off = 0, size = 0;
    for (int k = 0; k < 3; k++) {
      a[k] = (double)in[i][k] - step * (double)in[i][5 + k];
      b[k] = (double)in[i][k] + step * (double)in[i][5 + k];
    }
    const bool first = follow((double)in[i][3], (int)in[i][4], a);
    if (!follow((double)in[i][3], (int)in[i][4], b) || !first) continue;
    for (int k = 0; k < 3; k++) {
      const double exact = (b[k] - a[k]) / (2 * step);
      off += pow((double)out[i][k] - exact, 2);
      size += exact * exact;
    }
    worst = fmax(worst, sqrt(off / fmax(size, 0.01)));
    seen++;
  }
  print_message("worst %.2e of %d\n", worst, seen);
  assert_true(seen > CASES * 3 / 4);
  assert_true(worst < 1e-3);
}

/* On facets places do not count: as on anything that is not bent. */
TEST(facets_are_not_bent) {
  static float in[CASES][8], out[CASES][4];
  for (int i = 0; i < CASES; i++) make_case(i, in[i]);
  glsl_evaluate(
      abbe_context_gl(context),
      "#include \"optics.glsl\"\n"
      "#include \"ray_spread.glsl\"\n"
      "vec4 f(vec4 a, vec4 b) {\n"
      "  Spread s = Spread(vec3(1, 2, 3), vec3(3, -1, 0), b.yzw, a.xyz);\n"
      "  vec3 n = -normalize(a.xyz + 0.5 * b.yzw);\n"
      "  Spread m = spread_mirrored(s, n), general = spread_mirrored(s, a.xyz, n, mat3(0));\n"
      "  Spread r = spread_refracted(s, a.xyz, n, 1.4);\n"
      "  Spread r2 = spread_refracted(s, a.xyz, n, mat3(0), 1.4);\n"
      "  return vec4(distance(m.turn_x, general.turn_x), distance(m.turn_y, general.turn_y),\n"
      "              distance(r.turn_x, r2.turn_x), distance(r.turn_y, r2.turn_y));\n"
      "}\n",
      (const float(*)[8])in, CASES, out);
  for (int i = 0; i < CASES; i++)
    for (int k = 0; k < 4; k++) assert_true(out[i][k] < 2e-6f);
}
