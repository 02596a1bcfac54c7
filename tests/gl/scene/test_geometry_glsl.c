/* Rays and views in GLSL against double precision, from 1e-4 to 1e5 m, grazing and straight.
 *
 * A float knows a coordinate to 2^-24 of it, and an intersection multiplies that by 1 / cosine. So
 * errors are counted in units of eps times the distance over the cosine; each bound says how many
 * roundings the function's own operations may add up to.
 */
#include "tests/gl/glsl.h"
#include "tests/random.h"

#include "base/maths.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <float.h>

enum { RAYS = 34816 }; /* of three sizes, a hundred thousand */
static const double eps = FLT_EPSILON;
static const double sizes[] = {1e-4, 1, 1e5};

static const abbe_gl *gl;
static float inputs[RAYS][8], outputs[RAYS][4];

static const char rooms[] =
    "#define LIGHTS 1\n#define REFLECTION_ROOM 64\n#define LIGHT_ROOM 1\n#define REFRACTORS "
    "2\n#define REFRACTOR_ROOM 2\n"
    "#define PLANE_ROOM 6\n#define RECEIVERS 1\n#define RECEIVER_ROOM 1\n#define SURFACE_ROOM 1\n"
    "#define SPECTRUM_ROOM 1\n#define WAVELENGTHS 1\n#define SPHERES\n#define CONVEX\n"
    "#include \"refractor.glsl\"\n#include \"receiver.glsl\"\n";

static void make_gl(void) {
  make_context();
  gl = abbe_context_gl(context);
}

static void unit_vector(uint64_t *random, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = random_normal(random);
  double length = sqrt(abbe_vector_dot(out, out));
  for (int k = 0; k < 3; k++) out[k] /= length;
}

/* Rays that meet a ball of that radius around the origin, from 1.01 to 1000 radii away; every
 * fourth one grazes it. */
static void aim(double radius) {
  uint64_t random = 7;
  for (int i = 0; i < RAYS; i++) {
    double from[3], to[3], d[3], along = 0;
    unit_vector(&random, from);
    unit_vector(&random, to);
    double far = radius * (i % 2 ? random_between(&random, 1.01, 3) : pow(1000, i / (double)RAYS));
    far = fmax(far, 1.01 * radius);
    double miss = i % 4 == 0 ? 1 - pow(10, -random_between(&random, 0, 7)) : sqrt(i % 97 / 97.0);
    for (int k = 0; k < 3; k++) along += to[k] * from[k];
    for (int k = 0; k < 3; k++) to[k] -= along * from[k]; /* across the way to the middle */
    double length = sqrt(abbe_vector_dot(to, to)), sine = miss * radius / far;
    for (int k = 0; k < 3; k++) d[k] = sine * to[k] / length - sqrt(1 - sine * sine) * from[k];
    for (int k = 0; k < 3; k++) {
      inputs[i][k] = (float)(far * from[k]);
      inputs[i][4 + k] = (float)d[k];
    }
    inputs[i][3] = (float)radius;
    inputs[i][7] = 0;
  }
}

static void ray_of(int i, double o[3], double d[3]) {
  for (int k = 0; k < 3; k++) {
    o[k] = inputs[i][k];
    d[k] = inputs[i][4 + k];
  }
}

static void run(const char *body) {
  GLuint program = glsl_make(gl, printed("%s%s", rooms, body));
  glsl_run(gl, program, (const float(*)[8])inputs, RAYS, outputs);
  gl->DeleteProgram(program);
}

/* A ball and a cube of that radius, turned so that no face lies along an axis. */
static void upload_refractors(double radius, double plane[6][4], GLuint buffer[2]) {
  const double n[3][3] = {{0.48, 0.6, 0.64}, {-0.8, 0.6, 0}, {-0.384, -0.512, 0.768}};
  float f[6][4];
  struct {
    float sphere[4];
    int info[4];
  } r[2] = {{{0, 0, 0, (float)radius}, {0, 0, 0, 0}}, {{0, 0, 0, 0}, {1, 0, 6, 0}}};
  for (int i = 0; i < 6; i++) {
    for (int k = 0; k < 3; k++) f[i][k] = (float)(i % 2 ? -n[i / 2][k] : n[i / 2][k]);
    f[i][3] = (float)(0.5 * radius);
    for (int k = 0; k < 4; k++) plane[i][k] = f[i][k];
  }
  buffer[0] = glsl_block(gl, BINDING_REFRACTORS, sizeof r, r);
  buffer[1] = glsl_block(gl, BINDING_PLANES, sizeof f, f);
}

/* Distance to the sphere, its entry and exit; false where the ray misses. */
static bool meet_sphere(const double o[3], const double d[3], double radius, double t[2]) {
  double a = abbe_vector_dot(d, d), b = abbe_vector_dot(o, d),
         c = abbe_vector_dot(o, o) - radius * radius, disc = b * b - a * c;
  if (disc <= 0) return false;
  t[0] = (-b - sqrt(disc)) / a;
  t[1] = (-b + sqrt(disc)) / a;
  return true;
}

GROUP(make_gl, free_context);

TEST(spheres_are_met) {
  double worst = 0, worst_inner = 0;
  size_t met = 0;
  for (int s = 0; s < 3; s++) {
    double plane[6][4];
    GLuint buffer[2];
    aim(sizes[s]);
    upload_refractors(sizes[s], plane, buffer);
    run("vec4 f(vec4 a, vec4 b) {\n"
        "  Hit h; h.t = 1e30;\n"
        "  if (!sphere_front(vec4(0, 0, 0, a.w), a.xyz, b.xyz, h)) return vec4(0, 0, 0, -1);\n"
        "  return vec4(h.p, h.t);\n"
        "}\n");
    for (int i = 0; i < RAYS; i++) {
      double o[3], d[3], t[2], apart = 0;
      ray_of(i, o, d);
      bool hit = meet_sphere(o, d, sizes[s], t);
      double far = sqrt(abbe_vector_dot(o, o)),
             sine2 =
                 1 - pow(abbe_vector_dot(o, d), 2) / abbe_vector_dot(o, o) / abbe_vector_dot(d, d);
      double cosine = sqrt(fmax(1 - sine2 * pow(far / sizes[s], 2), 0));
      /* Which rays just miss is a matter of the last digits. */
      double known = cosine * cosine;
      if (outputs[i][3] < 0 || !hit) {
        assert_true(known < 16 * eps * far / sizes[s] || hit == (outputs[i][3] > 0));
        continue;
      }
      for (int k = 0; k < 3; k++)
        apart = fmax(apart, fabs((double)outputs[i][k] - (o[k] + t[0] * d[k])));
      /* the distance is known to eps far; so is the place, over the cosine */
      met++;
      if (known > 64 * eps * far / sizes[s]) worst = fmax(worst, apart * cosine / (eps * far));
      assert_true(isfinite(outputs[i][0]));
    }
    run("vec4 f(vec4 a, vec4 b) {\n"
        "  vec3 n = -normalize(a.xyz), q, m; int next;\n"
        "  inner_hit(0, 0, -a.w * n, normalize(b.xyz + n), q, m, next);\n"
        "  return vec4(q, dot(m, m));\n"
        "}\n");
    for (int i = 0; i < RAYS; i++) {
      double length = 0;
      for (int k = 0; k < 3; k++) length += pow((double)outputs[i][k], 2);
      worst_inner = fmax(worst_inner, fabs(sqrt(length) / sizes[s] - 1) / eps);
      worst_inner = fmax(worst_inner, fabs((double)outputs[i][3] - 1) / eps);
    }
    gl->DeleteBuffers(2, buffer);
  }
  print_message("sphere_front: %.2g eps distance / cosine; inner_hit: %.2g eps off the sphere\n",
                worst, worst_inner);
  assert_true(met > 2 * RAYS);
  /* Three vectors of three terms: a dozen roundings. */
  assert_true(worst < 12);
  assert_true(worst_inner < 8);
}

/* Where the ray enters or leaves the cube by the planes, and the cosine there. */
static bool meet_planes(const double plane[6][4], const double o[3], const double d[3], double t[2],
                        double *cosine) {
  t[0] = -INFINITY;
  t[1] = INFINITY;
  for (int i = 0; i < 6; i++) {
    double slope = abbe_vector_dot(plane[i], d),
           at = (plane[i][3] - abbe_vector_dot(plane[i], o)) / slope;
    if (slope < 0 && at > t[0]) {
      t[0] = at;
      *cosine = -slope;
    }
    if (slope > 0) t[1] = fmin(t[1], at);
  }
  return t[0] < t[1];
}

TEST(solids_are_met) {
  double worst = 0, worst_inner = 0;
  size_t met = 0;
  for (int s = 0; s < 3; s++) {
    double plane[6][4];
    GLuint buffer[2];
    aim(sizes[s]);
    upload_refractors(sizes[s], plane, buffer);
    run("vec4 f(vec4 a, vec4 b) {\n"
        "  Hit h; h.t = 1e30;\n"
        "  if (!convex_front(refractors[1].info, a.xyz, b.xyz, h)) return vec4(-1, 0, 0, 0);\n"
        "  vec3 q, n; int next;\n"
        "  inner_hit(1, h.facet, h.p, b.xyz, q, n, next);\n"
        "  return vec4(h.t, distance(q, h.p), h.facet, next);\n"
        "}\n");
    for (int i = 0; i < RAYS; i++) {
      double o[3], d[3], t[2], cosine = 1;
      ray_of(i, o, d);
      double far = sqrt(abbe_vector_dot(o, o));
      bool hit = meet_planes((const double(*)[4])plane, o, d, t, &cosine);
      double unit = eps * far / cosine;
      if (hit != (outputs[i][0] > 0)) {
        assert_true(fabs(t[1] - t[0]) < 16 * unit); /* along an edge */
        continue;
      }
      if (!hit) continue;
      met++;
      worst = fmax(worst, fabs((double)outputs[i][0] - t[0]) / unit);
      double chord = (t[1] - t[0]) * sqrt(abbe_vector_dot(d, d));
      worst_inner =
          fmax(worst_inner, fabs((double)outputs[i][1] - chord) / unit *
                                fmin(cosine, fabs(abbe_vector_dot(plane[(int)outputs[i][3]], d))));
    }
    gl->DeleteBuffers(2, buffer);
  }
  print_message("convex_front: %.2g eps distance / cosine; inner_hit: %.2g\n", worst, worst_inner);
  assert_true(met > RAYS);
  assert_true(worst < 12);
  assert_true(worst_inner < 12);
}

TEST(receivers_are_met) {
  double worst = 0;
  size_t met = 0;
  for (int s = 0; s < 3; s++) {
    /* A rectangle of two radii a side, across (0.48, 0.6, 0.64). */
    const double n[3] = {0.48, 0.6, 0.64}, u[3] = {-0.78087, 0.62470, 0}, r = sizes[s];
    float block[6][4] = {{0}};
    double v[3] = {n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
    for (int k = 0; k < 3; k++) {
      block[0][k] = (float)(r * (0.1 * n[k] - u[k] - v[k]));
      block[1][k] = (float)(2 * r * u[k]);
      block[2][k] = (float)(2 * r * v[k]);
      block[3][k] = (float)n[k];
      block[4][k] = (float)(u[k] / (2 * r));
      block[5][k] = (float)(v[k] / (2 * r));
    }
    block[3][3] = (float)(0.1 * r);
    aim(r);
    GLuint buffer = glsl_block(gl, BINDING_RECEIVERS, sizeof block, block);
    run("vec4 f(vec4 a, vec4 b) {\n"
        "  float t; int r = receiver_hit(a.xyz, b.xyz, 0.0, 1e30, t);\n"
        "  return vec4(t, r, 0, 0);\n"
        "}\n");
    for (int i = 0; i < RAYS; i++) {
      double o[3], d[3], m[3], from[3], x[3], edge = INFINITY;
      ray_of(i, o, d);
      for (int k = 0; k < 3; k++) {
        m[k] = block[3][k];
        from[k] = block[0][k] - o[k];
      }
      double slope = abbe_vector_dot(m, d),
             t = ((double)block[3][3] - abbe_vector_dot(m, o)) / slope;
      double unit = eps * sqrt(abbe_vector_dot(o, o)) / fabs(slope);
      for (int k = 0; k < 3; k++) x[k] = t * d[k] - from[k];
      for (int axis = 0; axis < 2; axis++) {
        double dual[3] = {block[4 + axis][0], block[4 + axis][1], block[4 + axis][2]};
        double at = abbe_vector_dot(x, dual);
        edge = fmin(edge, fmin(at, 1 - at));
      }
      bool hit = t > 0 && edge >= 0;
      if (hit != (outputs[i][1] >= 0)) {
        assert_true(fabs(edge) * 2 * r < 16 * unit || fabs(t) < 16 * unit);
        continue;
      }
      met += hit;
      if (hit) worst = fmax(worst, fabs((double)outputs[i][0] - t) / unit);
    }
    gl->DeleteBuffers(1, &buffer);
  }
  print_message("receiver_hit: %.2g eps distance / cosine\n", worst);
  assert_true(met > RAYS);
  assert_true(worst < 8);
}

/* Window coordinates of places in the view, and the ray back through them. */
TEST(views_project) {
  double worst = 0, worst_ray = 0, worst_measure = 0;
  for (int s = 0; s < 6; s++) {
    const double r = sizes[s / 2], origin[3] = {0.3 * r, -0.2 * r, 2 * r};
    const double forward[3] = {0.1, 0.2, -1}, up[3] = {0, 1, 0};
    abbe_view view;
    float packed[24];
    uint64_t random = 3;
    abbe_view_look(origin, forward, up, s % 2, &view);
    const double half = s % 2 ? r : 0.5, window[4] = {-half, half, -half, 2 * half};
    memcpy(view.window, window, sizeof window);
    view.near = r;
    view.far = 4 * r;
    abbe_view_pack(&view, packed);
    for (int i = 0; i < RAYS; i++) {
      double uv[2] = {random_between(&random, 0, 1), random_between(&random, 0, 1)}, o[3], d[3];
      double t = r * random_between(&random, 0.5, 4);
      abbe_view_ray(&view, uv, o, d);
      for (int k = 0; k < 3; k++) inputs[i][k] = (float)(o[k] + t * d[k]);
      inputs[i][4] = (float)uv[0];
      inputs[i][5] = (float)uv[1];
    }
    const char *body = printed(
        "%s", "uniform vec4 harness_view[6];\n"
              "View v() { return View(harness_view[0], harness_view[1], harness_view[2],\n"
              "                       harness_view[3], harness_view[4], harness_view[5]); }\n"
              "vec4 f(vec4 a, vec4 b) {\n"
              "  if (b.z < 0.5) { vec3 q; bool seen = project(v(), a.xyz, q);\n"
              "    return vec4(q, seen ? 1 : 0); }\n"
              "  vec3 o, d; view_ray(v(), b.xy, o, d);\n"
              "  return vec4(d, window_measure(v(), d));\n"
              "}\n");
    GLuint program = glsl_make(gl, printed("%s%s", rooms, body));
    gl->Uniform4fv(gl->GetUniformLocation(program, "harness_view"), 6, packed);
    for (int way = 0; way < 2; way++) {
      for (int i = 0; i < RAYS; i++) inputs[i][6] = (float)way;
      glsl_run(gl, program, (const float(*)[8])inputs, RAYS, outputs);
      for (int i = 0; i < RAYS; i++) {
        double p[3] = {inputs[i][0], inputs[i][1], inputs[i][2]}, exact[3], o[3], d[3];
        double uv[2] = {inputs[i][4], inputs[i][5]};
        if (way == 0) {
          assert_true(abbe_view_project(&view, p, exact) && outputs[i][3] > 0);
          for (int k = 0; k < 2; k++)
            worst = fmax(worst, fabs((double)outputs[i][k] - exact[k]) / eps);
          worst = fmax(worst, fabs((double)outputs[i][2] / exact[2] - 1) / eps);
        } else {
          abbe_view_ray(&view, uv, o, d);
          for (int k = 0; k < 3; k++)
            worst_ray = fmax(worst_ray, fabs((double)outputs[i][k] - d[k]) / eps);
          double c = s % 2 ? 1 : abbe_vector_dot(d, view.forward);
          worst_measure = fmax(worst_measure, fabs((double)outputs[i][3] / (c * c * c) - 1) / eps);
        }
      }
    }
    gl->DeleteProgram(program);
  }
  print_message("project: %.2g eps; view_ray: %.2g eps; window_measure: %.2g eps\n", worst,
                worst_ray, worst_measure);
  /* A place is known to eps of its coordinates, up to 6 windows away from the origin. */
  assert_true(worst < 24);
  assert_true(worst_ray < 4);
  assert_true(worst_measure < 16); /* a cosine of three products, cubed, down to 0.6 */
}

TEST(maps_are_warped) {
  static float knot[129][4]; /* x, y, and those of the next */
  double worst = 0;
  uint64_t random = 5;
  for (int k = 1; k <= 128; k++)
    for (int axis = 0; axis < 2; axis++)
      knot[k][axis] = knot[k - 1][axis] + (float)random_between(&random, 1e-6, axis ? 1 : 1e-2);
  for (int k = 0; k <= 128; k++)
    for (int axis = 0; axis < 2; axis++) knot[k][axis] /= knot[128][axis];
  for (int k = 0; k < 128; k++) memcpy(knot[k] + 2, knot[k + 1], 2 * sizeof(float));
  for (int i = 0; i < RAYS; i++)
    for (int k = 0; k < 2; k++)
      inputs[i][k] = (float)(i < 129 ? i / 128.0 : random_between(&random, -0.1, 1.1));
  GLuint buffer = 0, texture = 0;
  gl->GenBuffers(1, &buffer);
  gl->BindBuffer(GL_TEXTURE_BUFFER, buffer);
  gl->BufferData(GL_TEXTURE_BUFFER, sizeof knot, knot, GL_STATIC_DRAW);
  gl->GenTextures(1, &texture);
  gl->ActiveTexture(GL_TEXTURE0 + UNIT_WARPS);
  gl->BindTexture(GL_TEXTURE_BUFFER, texture);
  gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
  run("vec4 f(vec4 a, vec4 b) { return vec4(warp(0, a.xy), 0, 0); }\n");
  for (int i = 0; i < RAYS; i++)
    for (int axis = 0; axis < 2; axis++) {
      double at = fmin(fmax((double)inputs[i][axis], 0), 1) * 128, k = fmin(floor(at), 127);
      double low = knot[(int)k][axis], high = knot[(int)k + 1][axis];
      worst = fmax(worst, fabs((double)outputs[i][axis] - (low + (at - k) * (high - low))) / eps);
    }
  gl->DeleteTextures(1, &texture);
  gl->DeleteBuffers(1, &buffer);
  print_message("warp: %.2g eps\n", worst);
  assert_true(worst < 2);
}

/* A spot's soft edge, and the hard one that softness 0 leaves. */
TEST(spots_fade) {
  static const double cone[] = {0.001, 30, 85}, soft[] = {0, 1e-4, 20};
  double worst = 0;
  const double rad = acos(-1) / 180;
  for (int s = 0; s < 9; s++) {
    abbe_light spot = {.kind = ABBE_LIGHT_SPOT, .direction = {0, 0, -1}};
    float block[17][4] = {{0}};
    spot.cone_rad = cone[s / 3] * rad;
    spot.soft_rad = fmin(soft[s % 3], cone[s / 3]) * rad;
    block[12][3] = ABBE_LIGHT_SPOT;
    block[13][2] = -1;
    block[13][3] = (float)cos(spot.cone_rad);
    block[15][0] = (float)cos(fmax(spot.cone_rad - spot.soft_rad, 0));
    for (int i = 0; i < RAYS; i++) {
      double angle = fmax(spot.cone_rad - 2 * spot.soft_rad * i / RAYS, 0) * (1 + (i % 3) * 1e-3);
      inputs[i][0] = (float)sin(angle);
      inputs[i][1] = 0;
      inputs[i][2] = -(float)cos(angle);
    }
    GLuint buffer = glsl_block(gl, BINDING_LIGHTS, sizeof block, block);
    run("vec4 f(vec4 a, vec4 b) { return vec4(light_profile(lights[0], a.xyz), 0, 0, 0); }\n");
    double width = cos(spot.cone_rad - spot.soft_rad) - cos(spot.cone_rad);
    for (int i = 0; i < RAYS; i++) {
      double d[3] = {inputs[i][0], inputs[i][1], inputs[i][2]}, value = outputs[i][0];
      assert_true(value >= 0 && value <= 1);
      /* The edge is known to eps in its cosine; the fade is 3/2 / width steep. */
      double unit = eps / fmax(width, eps);
      double apart = fabs(value - abbe_light_profile(&spot, d));
      if (unit < 0.1) worst = fmax(worst, apart / unit);
    }
    gl->DeleteBuffers(1, &buffer);
  }
  print_message("light_profile: %.2g eps / width of the fade in cosines\n", worst);
  assert_true(worst < 4);
}

/* Longitude and angle from the zenith, to far below a texel of a map of 8192 (7.7e-4 rad): all
 * around, on the axes, and close to them and to the poles. */
TEST(directions_have_angles) {
  double worst = 0;
  uint64_t random = 11;
  for (int i = 0; i < RAYS; i++) {
    double d[3];
    unit_vector(&random, d);
    for (int k = 0; k < 3; k++)
      if (i / 4 % 4 == k + 1) d[k] *= i % 2 ? pow(10, -random_between(&random, 0, 7)) : 0;
    const double length = sqrt(abbe_vector_dot(d, d));
    for (int k = 0; k < 3; k++) inputs[i][k] = (float)(d[k] / length);
  }
  run("vec4 f(vec4 a, vec4 b) { return vec4(sphere_angles(a.xyz), 0, 0); }\n");
  for (int i = 0; i < RAYS; i++) {
    const double x = inputs[i][0], y = inputs[i][1], z = inputs[i][2], across = hypot(x, y);
    const double around = remainder((double)outputs[i][0] - atan2(y, x), 2 * acos(-1));
    worst = fmax(worst, fmax(fabs(around), fabs((double)outputs[i][1] - atan2(across, z))));
  }
  print_message("sphere_angles: %.2g eps rad\n", worst / eps);
  assert_true(worst < 6 * eps);
}
