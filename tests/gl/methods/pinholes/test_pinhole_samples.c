/* How wide a pinhole's part of the surroundings is: on a sphere and on a plane as geometry has it,
 * seen at any angle; and rows of samples for the device. */
#include "tests/gl/frame.h"
#include "tests/gl/glsl.h"

#include "gl/methods/pinholes/pinhole_samples.h"

enum { CASES = 64 };

/* a: angle of incidence, distance, radius of the sphere (0: a plane), half width; out: widths in
 * the plane of incidence and across it, over the half width. */
static const char source[] =
    "#include \"pinholes.glsl\"\n"
    "vec4 f(vec4 a, vec4 b) {\n"
    "  vec3 n = vec3(0, 0, 1), p = vec3(0), from = a.y * vec3(sin(a.x), 0, cos(a.x)), by_u, by_v;\n"
    "  float turn = a.z > 0.0 ? 1.0 / a.z : 0.0;\n"
    "  Pinhole s = Pinhole(p, n, 1.0, a.w, vec3(1, 0, 0), vec3(0, 1, 0), vec2(turn), vec3(1));\n"
    "  footprint(s, from, mirrored(from, p, n), by_u, by_v);\n"
    "  return vec4(length(by_u), length(by_v), dot(by_u, by_v), 0.0) / a.w;\n"
    "}\n";

GROUP(make_context, free_context);

TEST(footprints) {
  static float in[CASES][8], out[CASES][4];
  for (int i = 0; i < CASES; i++) {
    in[i][0] = (float)(1.4 * (i % 8) / 7);
    in[i][1] = (float)(0.05 + 0.3 * (i / 8 % 4));
    in[i][2] = i < 32 ? 0.02f : 0;
    in[i][3] = 1e-4f;
  }
  glsl_evaluate(abbe_context_gl(context), source, (const float(*)[8])in, CASES, out);
  for (int i = 0; i < CASES; i++) {
    const double c = cos((double)in[i][0]), d = (double)in[i][1],
                 bend = in[i][2] > 0 ? 1 / (double)in[i][2] : 0;
    const double tangential = c / d + 2 * bend, sagittal = 1 / d + 2 * c * bend;
    assert_near((double)out[i][0] / tangential, 1, 0.02);
    assert_near((double)out[i][1] / sagittal, 1, 0.02);
    assert_near((double)out[i][2], 0, 0.03 * tangential * sagittal * 1e-4 + 0.01);
  }
}
