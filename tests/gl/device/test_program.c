/* Every shader compiles, in every combination of models that a plan can ask for. */
#include "tests/gl/gl_context.h"

#include "gl/device/program.h"

/* Those of gl/: one that is added is compiled here, and counted. */
enum { COMPUTE_SHADERS = 26 };

/* Bits: spheres, convex, layers, what no model asks for (many exits, further channels, shared
 * bands), absorbing (and caustics), shadows (and textures, and lengths kept of paths inside),
 * hierarchy, walk. */
static void write_defines(unsigned bits, char *out, size_t size) {
  static const char *const names[] = {
      "SPHERES",
      "CONVEX",
      "LAYERS\n#define FRONT_LAYER",
      "MANY_EXITS\n#define AOVS\n#define INTERLEAVES",
      "ABSORBING\n#define CAUSTICS\n#define HAZE\n#define HAZE_BEYOND\n#define SHAFTS 2\n#define "
      "SHAFT_STEPS 40",
      "RECEIVER_SHADOWS\n#define TEXTURED\n#define RECEIVER_COLOURS\n#define SHADOW_PLANES "
      "32\n#define BAND_PARTS",
      "HIERARCHY",
      "WALK\n#define COARSE_EYE"};
  int used = snprintf(
      out, size,
      "#define LIGHTS 2\n#define REFRACTORS 2\n#define RECEIVERS 6\n"
      "#define WAVELENGTHS 7\n#define PIXEL_THREADS 8\n"
      "#define LIGHT_ROOM 2\n#define REFRACTOR_ROOM 2\n#define REFLECTION_ROOM 64\n#define "
      "PLANE_ROOM 9\n"
      "#define RECEIVER_ROOM 6\n#define SURFACE_ROOM 6\n#define SPECTRUM_ROOM 14\n"
      "#define BAND_ROOM 140\n#define BAND_SETS 5\n#define HIERARCHY_STACK 24\n#define STEPS 64\n"
      "#define BRIDGE\n#define DOUBTS_BRIDGES\n#define BAND_TURNS 128\n#define BAND_RINGS 12\n"
      "#define HAZE_BANDS 12\n#define PART_SURFACES 2\n");
  for (int i = 0; i < 8; i++)
    if (bits >> i & 1) used += snprintf(out + used, size - (size_t)used, "#define %s\n", names[i]);
}

static void compiles(const abbe_program_stage *stages, size_t count, const char *defines) {
  GLuint program = 0;
  OK(abbe_program_make(abbe_context_gl(context), stages, count, defines, &program, &error));
  abbe_context_gl(context)->DeleteProgram(program);
}

GROUP(make_context, free_context);

TEST(all_combinations) {
  char defines[1024];
  for (unsigned bits = 0; bits < 256; bits++) {
    /* triangles are walked, and layers are not */
    if ((bits >> 6 & 1) > (bits >> 7) || (bits >> 7 & bits >> 2 & 1)) continue;
    /* what those two add is tried with and without the rest */
    if ((bits >> 7 & 1) && (bits >> 4 & 1) != (bits >> 5 & 1)) continue;
    /* each pair of them, on and off */
    if (!all_cases() && __builtin_popcount(bits) > 2 && __builtin_popcount(bits) < 6) continue;
    write_defines(bits, defines, sizeof defines);
    const abbe_program_stage trace = {GL_COMPUTE_SHADER, "photon_trace.comp"};
    const abbe_program_stage lit[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                      {GL_FRAGMENT_SHADER, "receivers.frag"}};
    const abbe_program_stage refracted = {GL_COMPUTE_SHADER, "refraction.comp"};
    compiles(&trace, 1, defines);
    compiles(lit, 2, defines);
    compiles(&refracted, 1, defines);
  }
}

static void must_differ(const char *a, const char *b, bool differ) {
  char *text[2] = {NULL, NULL};
  OK(abbe_program_text("light_fit.comp", a, &text[0], &error));
  OK(abbe_program_text("light_fit.comp", b, &text[1], &error));
  assert_int_equal(strcmp(text[0], text[1]) != 0, differ);
  free(text[0]);
  free(text[1]);
}

/* A driver that knows a text compiles it no more: what a stage does not mention changes nothing. */
TEST(definitions_that_do_not_matter) {
  char defines[1024];
  write_defines(63, defines, sizeof defines);
  must_differ(defines, "", true);
  must_differ("#define LIGHT_ROOM 2\n#define NOBODYS 1\n", "#define LIGHT_ROOM 2\n", false);
  must_differ("#define LIGHT_ROOM 2\n#define LIGHT_ROO 1", "#define LIGHT_ROOM 2\n", false);
  must_differ("#define LIGHT_ROOM 2\n", "#define LIGHT_ROOM 3\n", true);
  must_differ("#define LIGHT_ROOM (MANY + 1)\n#define MANY 1\n", "#define LIGHT_ROOM (MANY + 1)\n",
              true);
  must_differ("#define NOBODYS LIGHT_ROOM\n#define LIGHT_ROOM 2\n", "#define LIGHT_ROOM 2\n",
              false);
  char *text = (char *)"";
  REFUSED(ABBE_NOT_FOUND, "", abbe_program_text("nobody.comp", NULL, &text, &error));
  assert_null(text);
}

TEST(every_compute_shader) {
  char defines[1024];
  size_t seen = 0;
  write_defines(63, defines, sizeof defines);
  for (const char *const *file = abbe_program_files(); *file != NULL; file++) {
    const char *dot = strrchr(*file, '.');
    if (dot == NULL || strcmp(dot, ".comp") != 0) continue;
    const abbe_program_stage stage = {GL_COMPUTE_SHADER, *file};
    compiles(&stage, 1, defines);
    seen++;
  }
  assert_int_equal(seen, COMPUTE_SHADERS);
}

TEST(thesis_programs) {
  static const char *const fragments[] = {"thesis_fill.frag", "thesis_refraction.frag"};
  char defines[1024];
  write_defines(0, defines, sizeof defines);
  for (size_t i = 0; i < 2; i++) {
    const abbe_program_stage screen[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                         {GL_FRAGMENT_SHADER, fragments[i]}};
    compiles(screen, 2, defines);
  }
  const abbe_program_stage layers[] = {{GL_VERTEX_SHADER, "thesis_layers.vert"},
                                       {GL_GEOMETRY_SHADER, "thesis_layers.geom"},
                                       {GL_FRAGMENT_SHADER, "thesis_layers.frag"}};
  const abbe_program_stage splat[] = {{GL_VERTEX_SHADER, "thesis_splat.vert"},
                                      {GL_GEOMETRY_SHADER, "thesis_splat.geom"},
                                      {GL_FRAGMENT_SHADER, "thesis_splat.frag"}};
  const abbe_program_stage lit[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                    {GL_FRAGMENT_SHADER, "thesis_receivers.frag"}};
  const abbe_program_stage layer[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                      {GL_FRAGMENT_SHADER, "layer.frag"}};
  const abbe_program_stage depth[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                      {GL_FRAGMENT_SHADER, "depth.frag"}};
  compiles(layers, 3, defines);
  compiles(splat, 3, defines);
  compiles(lit, 2, defines);
  compiles(layer, 2, defines);
  compiles(depth, 2, defines);
}

TEST(complaints_name_the_file) {
  const abbe_gl *gl = abbe_context_gl(context);
  GLuint program = 1;
  REFUSED(ABBE_NOT_FOUND, "no_such.comp",
          abbe_program_make_compute(gl, "no_such.comp", NULL, &program, &error));
  assert_int_equal(program, 0);
  REFUSED(
      ABBE_GL, "nonsense",
      abbe_program_make_compute_text(gl, "void main() { nonsense; }\n", NULL, &program, &error));
}
