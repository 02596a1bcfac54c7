/* shader_texts [--gpu] FOLDER SCENE.yaml...: the text of every stage of every program that these
 * scenes reach, each once, as FOLDER/NUMBER-FILE (photon_trace.comp is 12-photon_trace.comp): by
 * the published methods and the transports, at rest and in motion, on a processor and on a GPU, or
 * on a GPU alone. Prints how many frames it has drawn and how many texts there are. Nothing is
 * compiled and nothing runs on the device: programs are left empty, and what is read from buffers
 * is zero. */
#include "gl/device/context.h"
#include "gl/device/gpu.h"
#include "gl/renderer.h"
#include "scenes/import/scene_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool as_gpu;
static const char *folder;
static char **texts;
static size_t text_count;

static void fail(const char *what, const char *why) {
  fprintf(stderr, "shader_texts: %s: %s\n", what, why);
  exit(1);
}

static void keep(char *text, const char *file) {
  char path[4096];
  for (size_t i = 0; i < text_count; i++)
    if (strcmp(texts[i], text) == 0) {
      free(text);
      return;
    }
  texts = realloc(texts, (text_count + 1) * sizeof *texts);
  if (texts == NULL) fail(file, "no memory");
  texts[text_count++] = text;
  snprintf(path, sizeof path, "%s/%zu-%s", folder, text_count, file);
  FILE *out = fopen(path, "w");
  if (out == NULL || fputs(text, out) < 0 || fclose(out) != 0) fail(path, "cannot be written");
}

abbe_result __wrap_abbe_program_make(const abbe_gl *gl, const abbe_program_stage *stages,
                                     size_t count, const char *defines, GLuint *out,
                                     abbe_error *error);
abbe_result __wrap_abbe_program_make(const abbe_gl *gl, const abbe_program_stage *stages,
                                     size_t count, const char *defines, GLuint *out,
                                     abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    char *text = NULL;
    const abbe_result result = abbe_program_text(stages[i].file, defines, &text, error);
    if (result != ABBE_OK) return result;
    keep(text, stages[i].file);
  }
  *out = gl->CreateProgram();
  return ABBE_OK;
}

/* ---- calls that a program which is empty would refuse, or that wait for the device ---- */

static void APIENTRY use_program(GLuint program) {
  (void)program;
}
static GLint APIENTRY no_location(GLuint program, const GLchar *name) {
  (void)program, (void)name;
  return -1;
}
static void APIENTRY dispatch(GLuint x, GLuint y, GLuint z) {
  (void)x, (void)y, (void)z;
}
static void APIENTRY dispatch_indirect(GLintptr at) {
  (void)at;
}
static void APIENTRY draw_arrays(GLenum mode, GLint first, GLsizei count) {
  (void)mode, (void)first, (void)count;
}
static void APIENTRY draw_indirect(GLenum mode, const void *at) {
  (void)mode, (void)at;
}
static void APIENTRY draw_elements(GLenum mode, GLsizei count, GLenum type, const void *at) {
  (void)mode, (void)count, (void)type, (void)at;
}
static void APIENTRY read_zeros(GLenum target, GLintptr from, GLsizeiptr size, void *data) {
  (void)target, (void)from;
  memset(data, 0, (size_t)size);
}

static PFNGLGETSTRINGPROC real_string;
static const GLubyte *APIENTRY get_string(GLenum name) {
  return name == GL_RENDERER && as_gpu ? (const GLubyte *)"a GPU" : real_string(name);
}

/* No program is in use, so each uniform is an error. */
static GLenum APIENTRY no_error(void) {
  return GL_NO_ERROR;
}

abbe_result __real_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);
abbe_result __wrap_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);
abbe_result __wrap_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error) {
  const abbe_result result = __real_abbe_gl_load(lookup, out, error);
  real_string = out->GetString;
  out->GetString = get_string;
  out->UseProgram = use_program;
  out->GetUniformLocation = no_location;
  out->GetError = no_error;
  out->DispatchCompute = dispatch;
  out->DispatchComputeIndirect = dispatch_indirect;
  out->DrawArrays = draw_arrays;
  out->DrawArraysIndirect = draw_indirect;
  out->DrawElements = draw_elements;
  out->GetBufferSubData = read_zeros;
  return result;
}

/* What the plan refuses of a scene has no program. */
static size_t draw(abbe_context *context, const char *path, const abbe_scene *scene,
                   const abbe_render_desc *desc) {
  abbe_renderer *renderer = NULL;
  abbe_error error = {0};
  abbe_result result = abbe_renderer_make(context, scene, desc, &renderer, &error);
  if (result == ABBE_UNSUPPORTED || result == ABBE_INVALID_ARGUMENT) return 0;
  for (int i = 0; i < 2 && result == ABBE_OK; i++)
    result = abbe_renderer_frame(renderer, NULL, NULL, NULL, &error);
  if (result != ABBE_OK) fail(path, error.text);
  abbe_renderer_free(renderer);
  return 1;
}

static size_t draw_all(abbe_context *context, const char *path) {
  static const abbe_render_desc more[] = {{.aovs = true},
                                          {.coarse = ABBE_COARSE_EYE, .upsample = 2},
                                          {.coarse = ABBE_COARSE_ALL, .upsample = 3},
                                          {.everything = true},
                                          {.history = 2},
                                          {.model = ABBE_MODEL_LAYERS},
                                          {.model = ABBE_MODEL_BVH},
                                          {.fill = ABBE_FILL_NONE},
                                          {.transport = ABBE_TRANSPORT_PINHOLE}};
  abbe_scene scene = {0};
  abbe_error error = {0};
  size_t frames = 0;
  if (abbe_scene_load(path, NULL, &scene, &error) != ABBE_OK) fail(path, error.text);
  for (size_t i = 0; i < ABBE_PROFILE_COUNT + sizeof more / sizeof *more; i++) {
    abbe_render_desc desc = {.profile = (abbe_profile)i};
    if (i >= ABBE_PROFILE_COUNT) desc = more[i - ABBE_PROFILE_COUNT];
    desc.width = desc.height = 32;
    desc.photons = 32;
    desc.map_size = 64;
    frames += draw(context, path, &scene, &desc);
  }
  abbe_scene_free(&scene);
  return frames;
}

int main(int argc, char **argv) {
  size_t frames = 0;
  const int alone = argc > 1 && strcmp(argv[1], "--gpu") == 0;
  if (argc < 3 + alone) fail("used wrongly", "shader_texts [--gpu] FOLDER SCENE.yaml...");
  folder = argv[1 + alone];
  for (int gpu = alone; gpu < 2; gpu++) {
    abbe_context *context = NULL;
    abbe_error error = {0};
    as_gpu = gpu == 1;
    if (abbe_context_make(ABBE_CONTEXT_CPU, &context, &error) != ABBE_OK)
      fail("OpenGL", error.text);
    for (int i = 2 + alone; i < argc; i++) frames += draw_all(context, argv[i]);
    abbe_context_free(context);
  }
  printf("%zu frames, %zu texts\n", frames, text_count);
  for (size_t i = 0; i < text_count; i++) free(texts[i]);
  free(texts);
  return 0;
}
