/* The state of OpenGL around the renderer: whatever a caller leaves, pictures are the same, and
 * what a caller finds afterwards is what gl/renderer.h says. */
#include "tests/check.h"

#include "gl/device/api.h"
#include "tests/gl/frame.h"

#include <EGL/egl.h>

/* OpenGL beyond what Abbe itself calls: X(pointer type's middle, name without gl). */
#define MORE(X)                                                                                    \
  X(BINDSAMPLER, BindSampler)                                                                      \
  X(BLENDCOLOR, BlendColor)                                                                        \
  X(BLENDEQUATIONSEPARATE, BlendEquationSeparate)                                                  \
  X(CLAMPCOLOR, ClampColor)                                                                        \
  X(DRAWBUFFER, DrawBuffer)                                                                        \
  X(GENSAMPLERS, GenSamplers)                                                                      \
  X(DELETESAMPLERS, DeleteSamplers)                                                                \
  X(GETBOOLEANV, GetBooleanv)                                                                      \
  X(GETDOUBLEV, GetDoublev)                                                                        \
  X(GETINTEGERI_V, GetIntegeri_v)                                                                  \
  X(ISENABLED, IsEnabled)                                                                          \
  X(LINEWIDTH, LineWidth)                                                                          \
  X(LOGICOP, LogicOp)                                                                              \
  X(MINSAMPLESHADING, MinSampleShading)                                                            \
  X(POINTPARAMETERI, PointParameteri)                                                              \
  X(POINTSIZE, PointSize)                                                                          \
  X(POLYGONOFFSET, PolygonOffset)                                                                  \
  X(PRIMITIVERESTARTINDEX, PrimitiveRestartIndex)                                                  \
  X(SAMPLECOVERAGE, SampleCoverage)                                                                \
  X(SAMPLEMASKI, SampleMaski)                                                                      \
  X(SAMPLERPARAMETERI, SamplerParameteri)                                                          \
  X(STENCILFUNC, StencilFunc)                                                                      \
  X(STENCILOP, StencilOp)
#define FIELD(type, name) static PFNGL##type##PROC name;
MORE(FIELD)

static const abbe_gl *gl;
/* The caller's own things. */
static GLuint sampler, framebuffer, array, buffer, program, texture[3];

static const GLenum enables[] = {GL_BLEND,
                                 GL_COLOR_LOGIC_OP,
                                 GL_CULL_FACE,
                                 GL_DEPTH_CLAMP,
                                 GL_DEPTH_TEST,
                                 GL_FRAMEBUFFER_SRGB,
                                 GL_LINE_SMOOTH,
                                 GL_POLYGON_OFFSET_FILL,
                                 GL_POLYGON_OFFSET_LINE,
                                 GL_POLYGON_OFFSET_POINT,
                                 GL_POLYGON_SMOOTH,
                                 GL_PRIMITIVE_RESTART,
                                 GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                 GL_PROGRAM_POINT_SIZE,
                                 GL_RASTERIZER_DISCARD,
                                 GL_SAMPLE_ALPHA_TO_COVERAGE,
                                 GL_SAMPLE_ALPHA_TO_ONE,
                                 GL_SAMPLE_COVERAGE,
                                 GL_SAMPLE_MASK,
                                 GL_SAMPLE_SHADING,
                                 GL_SCISSOR_TEST,
                                 GL_STENCIL_TEST,
                                 GL_CLIP_DISTANCE0,
                                 GL_CLIP_DISTANCE0 + 7};
enum { ENABLES = sizeof enables / sizeof *enables };

static const struct {
  GLenum name;
  GLint awkward, after;
} pixels[] = {
    {GL_PACK_SWAP_BYTES, 1, 0},     {GL_PACK_LSB_FIRST, 1, 0},     {GL_PACK_ROW_LENGTH, 777, 0},
    {GL_PACK_IMAGE_HEIGHT, 555, 0}, {GL_PACK_SKIP_ROWS, 3, 0},     {GL_PACK_SKIP_PIXELS, 5, 0},
    {GL_PACK_SKIP_IMAGES, 2, 0},    {GL_PACK_ALIGNMENT, 8, 4},     {GL_UNPACK_SWAP_BYTES, 1, 0},
    {GL_UNPACK_LSB_FIRST, 1, 0},    {GL_UNPACK_ROW_LENGTH, 3, 0},  {GL_UNPACK_IMAGE_HEIGHT, 1, 0},
    {GL_UNPACK_SKIP_ROWS, 1, 0},    {GL_UNPACK_SKIP_PIXELS, 1, 0}, {GL_UNPACK_SKIP_IMAGES, 1, 0},
    {GL_UNPACK_ALIGNMENT, 8, 4}};
enum { PIXELS = sizeof pixels / sizeof *pixels };

static const struct {
  GLenum name;
  GLint after;
} settings[] = {{GL_BLEND_EQUATION_RGB, GL_FUNC_ADD},
                {GL_BLEND_EQUATION_ALPHA, GL_FUNC_ADD},
                {GL_BLEND_SRC_RGB, GL_ONE},
                {GL_BLEND_DST_RGB, GL_ZERO},
                {GL_BLEND_SRC_ALPHA, GL_ONE},
                {GL_BLEND_DST_ALPHA, GL_ZERO},
                {GL_CLIP_ORIGIN, GL_LOWER_LEFT},
                {GL_CLIP_DEPTH_MODE, GL_NEGATIVE_ONE_TO_ONE},
                {GL_CULL_FACE_MODE, GL_BACK},
                {GL_DEPTH_FUNC, GL_LESS},
                {GL_DEPTH_WRITEMASK, GL_TRUE},
                {GL_FRONT_FACE, GL_CCW},
                {GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_DONT_CARE},
                {GL_PROVOKING_VERTEX, GL_LAST_VERTEX_CONVENTION},
                {GL_DRAW_FRAMEBUFFER_BINDING, 0},
                {GL_READ_FRAMEBUFFER_BINDING, 0},
                {GL_CURRENT_PROGRAM, 0},
                {GL_VERTEX_ARRAY_BINDING, 0},
                {GL_ACTIVE_TEXTURE, GL_TEXTURE0},
                {GL_PIXEL_PACK_BUFFER_BINDING, 0},
                {GL_PIXEL_UNPACK_BUFFER_BINDING, 0}};

static void make_things(void) {
  make_context();
  gl = abbe_context_gl(context);
#define LOAD(type, name) name = (PFNGL##type##PROC)(abbe_gl_function)eglGetProcAddress("gl" #name);
  MORE(LOAD)
  GenSamplers(1, &sampler);
  SamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  SamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  SamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
  SamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_MIRRORED_REPEAT);
  SamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl->GenTextures(3, texture);
  gl->BindTexture(GL_TEXTURE_2D, texture[0]);
  gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 8, 8);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture[1]);
  gl->TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, 8, 8, 2);
  gl->GenBuffers(1, &buffer);
  gl->BindBuffer(GL_UNIFORM_BUFFER, buffer);
  gl->BufferData(GL_UNIFORM_BUFFER, 1 << 16, NULL, GL_STATIC_DRAW);
  gl->BindTexture(GL_TEXTURE_BUFFER, texture[2]);
  gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
  gl->GenVertexArrays(1, &array);
  gl->GenFramebuffers(1, &framebuffer);
  gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture[0], 0);
  program = gl->CreateProgram();
  const GLuint shader = gl->CreateShader(GL_COMPUTE_SHADER);
  const char *text = "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
  gl->ShaderSource(shader, 1, &text, NULL);
  gl->CompileShader(shader);
  gl->AttachShader(program, shader);
  gl->LinkProgram(program);
  gl->DeleteShader(shader);
  OK(abbe_gl_check(gl, "the test's own things", &error));
}

/* Everything as it serves a pass the least, and an error on top. */
static void make_awkward(void) {
  for (size_t i = 0; i < ENABLES; i++) gl->Enable(enables[i]);
  gl->Disable(GL_DITHER);
  gl->Disable(GL_MULTISAMPLE);
  for (size_t i = 0; i < PIXELS; i++) gl->PixelStorei(pixels[i].name, pixels[i].awkward);
  BlendColor(0.3f, 0.2f, 0.1f, 0.4f);
  BlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MAX);
  gl->BlendFunc(GL_ZERO, GL_CONSTANT_COLOR);
  ClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
  gl->ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl->ColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
  gl->CullFace(GL_FRONT_AND_BACK);
  gl->DepthFunc(GL_NEVER);
  gl->DepthMask(GL_FALSE);
  gl->DepthRange(0.9, 0.2);
  gl->FrontFace(GL_CW);
  gl->Hint(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_NICEST);
  LineWidth(1);
  LogicOp(GL_CLEAR);
  MinSampleShading(1);
  PointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT);
  PointSize(7);
  gl->PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  PolygonOffset(8, 1000);
  PrimitiveRestartIndex(1);
  gl->ProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
  SampleCoverage(0, GL_TRUE);
  SampleMaski(0, 0);
  StencilFunc(GL_NEVER, 1, 255);
  StencilOp(GL_ZERO, GL_ZERO, GL_ZERO);
  gl->Scissor(1, 2, 1, 1);
  gl->Viewport(3, 4, 1, 1);
  for (GLuint unit = 0; unit < ABBE_GL_STATE_UNITS; unit++) {
    BindSampler(unit, sampler);
    gl->ActiveTexture(GL_TEXTURE0 + unit);
    gl->BindTexture(GL_TEXTURE_2D, texture[0]);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture[1]);
    gl->BindTexture(GL_TEXTURE_BUFFER, texture[2]);
  }
  for (GLuint at = 0; at < 16; at++) {
    gl->BindBufferBase(GL_UNIFORM_BUFFER, at, buffer);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, at, buffer);
  }
  gl->BindImageTexture(0, texture[0], 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
  gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl->BindVertexArray(array);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
  gl->BindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer);
  gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer);
  gl->BindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
  gl->UseProgram(program);
  assert_int_equal(gl->GetError(), GL_NO_ERROR);
  gl->Enable(0xffff);
}

static void assert_after(const char *what) {
  GLint value = 0;
  GLboolean mask[4] = {0};
  GLdouble range[2] = {0};
  size_t wrong = 0;
#define EXPECT(name, there, expected)                                                              \
  if ((there) != (expected)) {                                                                     \
    print_error("after %s, %#x is %d, not %d\n", what, (unsigned)(name), (int)(there),             \
                (int)(expected));                                                                  \
    wrong++;                                                                                       \
  }
  for (size_t i = 0; i < ENABLES; i++) EXPECT(enables[i], IsEnabled(enables[i]), GL_FALSE)
  EXPECT(GL_DITHER, IsEnabled(GL_DITHER), GL_TRUE)
  EXPECT(GL_MULTISAMPLE, IsEnabled(GL_MULTISAMPLE), GL_TRUE)
  for (size_t i = 0; i < PIXELS; i++) {
    gl->GetIntegerv(pixels[i].name, &value);
    EXPECT(pixels[i].name, value, pixels[i].after)
  }
  for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
    gl->GetIntegerv(settings[i].name, &value);
    EXPECT(settings[i].name, value, settings[i].after)
  }
  gl->GetIntegerv(GL_POLYGON_MODE, &value);
  EXPECT(GL_POLYGON_MODE, value, GL_FILL)
  GetBooleanv(GL_COLOR_WRITEMASK, mask);
  for (int c = 0; c < 4; c++) EXPECT(GL_COLOR_WRITEMASK, mask[c], GL_TRUE)
  GetDoublev(GL_DEPTH_RANGE, range);
  EXPECT(GL_DEPTH_RANGE, range[0], 0)
  EXPECT(GL_DEPTH_RANGE, range[1], 1)
  for (GLuint unit = 0; unit < ABBE_GL_STATE_UNITS; unit++) {
    gl->ActiveTexture(GL_TEXTURE0 + unit);
    gl->GetIntegerv(GL_SAMPLER_BINDING, &value);
    EXPECT(GL_SAMPLER_BINDING, value, 0)
  }
  EXPECT(GL_NO_ERROR, gl->GetError(), GL_NO_ERROR)
  assert_int_equal(wrong, 0);
}

/* All that a renderer gives. */
typedef struct taken {
  abbe_image picture, map, bands;
  abbe_renderer_hits hits;
} taken;

static void taken_free(taken *t) {
  abbe_image_free(&t->picture);
  abbe_image_free(&t->map);
  abbe_image_free(&t->bands);
  abbe_renderer_hits_free(&t->hits);
}

/* Makes a renderer and calls each of its entries, each in a state that is awkward or as it comes.
 */
static void take(const abbe_scene *scene, const abbe_render_desc *desc, bool awkward, taken *out) {
  const bool thesis = abbe_method_of(desc->profile)->own_passes;
  abbe_renderer *renderer = NULL;
  double ms = 0;
#define ENTRY(what, call)                                                                          \
  do {                                                                                             \
    if (awkward) make_awkward();                                                                   \
    call;                                                                                          \
    assert_after(what);                                                                            \
  } while (0)
  ENTRY("make", OK(abbe_renderer_make(context, scene, desc, &renderer, &error)));
  ENTRY("frame", draw_frame(renderer));
  if (!thesis) ENTRY("baseline", OK(abbe_renderer_baseline(renderer, &ms, &error)));
  ENTRY("read", out->picture = aovs_of(renderer));
  ENTRY("read_map", out->map = map_of(renderer, 0));
  if (!thesis) {
    ENTRY("read_map_bands", OK(abbe_renderer_read_map_bands(renderer, 0, 4, &out->bands, &error)));
    ENTRY("read_hits", OK(abbe_renderer_read_hits(renderer, 0, 0, NULL, NULL, &out->hits, &error)));
    assert_true(out->hits.count > 0);
  }
  assert_true(image_max(&out->picture, 1) > 0 && image_max(&out->map, 1) > 0);
  ENTRY("free", abbe_renderer_free(renderer));
}

/* The thesis's splats are blended, as floats, in the order in which threads put them on a list. */
static void assert_alike(const abbe_image *a, const abbe_image *b) {
  const size_t count = a->width * a->height * a->channels;
  assert_int_equal(count, b->width * b->height * b->channels);
  for (size_t i = 0; i < count; i++)
    assert_near((double)a->data[i], (double)b->data[i], 1e-5 * image_max(b, i % b->channels));
}

static void assert_same_in_any_state(const char *text, const abbe_render_desc *desc) {
  OWNED(abbe_scene, scene) = scene_of(text);
  FILLED(taken, calm, take(&scene, desc, false, &calm));
  FILLED(taken, awkward, take(&scene, desc, true, &awkward));
  if (abbe_method_of(desc->profile)->own_passes) {
    assert_alike(&awkward.picture, &calm.picture);
    assert_alike(&awkward.map, &calm.map);
  } else {
    assert_same_pixels(&calm.picture, &awkward.picture);
    assert_same_pixels(&calm.map, &awkward.map);
    assert_same_pixels(&calm.bands, &awkward.bands);
    const abbe_renderer_hits *a = &calm.hits, *b = &awkward.hits;
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->at, b->at, a->count * a->slots * a->samples * 4 * sizeof *a->at);
  }
}

static const abbe_render_desc tiny = {
    .width = 16, .height = 12, .photons = 16, .map_size = 32, .wavelengths = 3, .aovs = true};

GROUP(make_things, free_context);

TEST(the_default_profile) {
  assert_same_in_any_state(CAMERA POINT_LIGHT FLOOR HILL BALL("murk"), &tiny);
}

/* Triangles as texels, and samples that are resolved. */
TEST(a_mesh) {
  abbe_render_desc desc = tiny;
  desc.supersample = 2;
  assert_same_in_any_state(CAMERA SUN FLOOR RING("flat"), &desc);
}

TEST(the_thesis) {
  abbe_render_desc desc = tiny;
  desc.profile = ABBE_PROFILE_THESIS;
  desc.wavelengths = 7;
  desc.aovs = false;
  desc.photons = desc.map_size = 64;
  assert_same_in_any_state(CAMERA POINT_LIGHT FLOOR BALL("crown"), &desc);
}

TEST(caustics_mapping) {
  abbe_render_desc desc = tiny;
  desc.profile = ABBE_PROFILE_SHAH2007_CIE;
  desc.aovs = false;
  desc.photons = desc.map_size = 64;
  assert_same_in_any_state(CAMERA SUN FLOOR BALL("crown"), &desc);
}
