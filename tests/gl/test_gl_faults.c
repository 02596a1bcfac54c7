/* A GL context that cannot be had or lacks something: a back end that is real but for what is
 * hidden, lowered or broken. Every time: ABBE_GL, a sentence with a way out, and nothing left
 * behind. */
#include "tests/check.h"

#include "cli/options/own_context.h"
#include "gl/device/context.h"
#include "gl/device/context_backend.h"
#include "gl/renderer.h"
#include "scenes/import/scene_file.h"

#include <unistd.h>

HOLDS(abbe_context);
HOLDS(abbe_renderer);

static const char *hidden; /* a function that is not there */
static GLenum lowered;     /* a limit that is `low` */
static GLint low;
static bool refused, mute, breaks; /* no context; no strings; shaders do not compile */
static bool as_gpu, first_fails;   /* of EGL's devices */
static bool bad_gpu;               /* another one, which opens for nobody */
static bool gone;                  /* the device */
static size_t tried;
static abbe_gl_lookup real_lookup;
static PFNGLGETINTEGERVPROC real_integer;
static PFNGLGETSHADERIVPROC real_shader;
static PFNGLGETERRORPROC real_error;

static void integer(GLenum name, GLint *out) {
  if (name == lowered && lowered != 0)
    *out = low;
  else
    real_integer(name, out);
}

static const GLubyte *no_string(GLenum name) {
  (void)name;
  return NULL;
}

static void broken_shader(GLuint shader, GLenum name, GLint *out) {
  real_shader(shader, name, out);
  if (name == GL_COMPILE_STATUS) *out = GL_FALSE;
}

/* A lost device's error is there again as soon as it is taken. */
static GLenum lost_error(void) {
  return gone ? GL_CONTEXT_LOST : real_error();
}

static abbe_gl_function lookup(const char *name) {
  abbe_gl_function found = real_lookup(name);
  if (hidden != NULL && strcmp(name, hidden) == 0) return NULL;
  if (strcmp(name, "glGetIntegerv") == 0) {
    real_integer = (PFNGLGETINTEGERVPROC)found;
    return (abbe_gl_function)integer;
  }
  if (strcmp(name, "glGetError") == 0) {
    real_error = (PFNGLGETERRORPROC)found;
    return (abbe_gl_function)lost_error;
  }
  if (mute && strcmp(name, "glGetString") == 0) return (abbe_gl_function)no_string;
  if (breaks && strcmp(name, "glGetShaderiv") == 0) {
    real_shader = (PFNGLGETSHADERIVPROC)found;
    return (abbe_gl_function)broken_shader;
  }
  return found;
}

abbe_result __real_abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                                    abbe_error *error);
abbe_result __wrap_abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                                    abbe_error *error);
/* The CPU's device is there once as itself, or as two of a GPU's. */
abbe_result __wrap_abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                                    abbe_error *error) {
  if (bad_gpu && !software && device == 0)
    return abbe_error_set(error, ABBE_GL, "EGL's device (a bad one) does not open");
  if (software != !as_gpu || device > (as_gpu ? 1 : 0))
    return abbe_error_set(error, ABBE_UNSUPPORTED, "there is no other device");
  tried++;
  if (refused || (first_fails && device == 0))
    return abbe_error_set(error, ABBE_GL, "EGL gives no context");
  const abbe_result result = __real_abbe_context_egl(true, 0, out, error);
  real_lookup = out->lookup;
  out->lookup = lookup;
  return result;
}

abbe_result __wrap_abbe_context_osmesa(abbe_context_native *out, abbe_error *error);
abbe_result __wrap_abbe_context_osmesa(abbe_context_native *out, abbe_error *error) {
  (void)out;
  return abbe_error_set(error, ABBE_UNSUPPORTED, "there is no OSMesa");
}

static void reset(void) {
  hidden = NULL;
  lowered = 0;
  refused = mute = breaks = as_gpu = first_fails = bad_gpu = gone = false;
  tried = 0;
}

static void assert_refused(const char *part) {
  abbe_context *context = NULL;
  REFUSED(ABBE_GL, "", abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
  assert_null(context);
  assert_contains(last_error.text, part);
  assert_contains(last_error.text, "--backend");
}

EACH(reset, NULL);

TEST(no_context) {
  refused = true;
  assert_refused("no context");
}

TEST(every_function_missing) {
  static const char *const names[] = {
#define NAME(type, name) "gl" #name,
      ABBE_GL_FUNCTIONS(NAME)
#undef NAME
  };
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    hidden = names[i];
    assert_refused(printed("has no %s;", names[i]));
  }
}

TEST(versions_and_limits) {
  static const struct {
    GLenum limit;
    GLint value;
    const char *part;
  } rows[] = {
      {GL_MAJOR_VERSION, 3, "offers OpenGL 3."},
      {GL_MINOR_VERSION, 4, "OpenGL 4.4; Abbe needs 4.5"},
      {GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, 4, "4 storage buffers in a compute shader"},
      {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, 8, "8 places for storage buffers"},
      {GL_MAX_UNIFORM_BUFFER_BINDINGS, 8, "8 places for uniform buffers"},
      {GL_MAX_UNIFORM_BLOCK_SIZE, 16384, "16384 bytes in a uniform buffer"},
      {GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, 256, "256 invocations in a compute group"},
      {GL_MAX_COLOR_ATTACHMENTS, 4, "4 colour attachments"},
      {GL_MAX_TEXTURE_SIZE, 1024, "1024 texels a side"},
      {GL_MAX_TEXTURE_SIZE, -1, "-1 texels a side"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    lowered = rows[i].limit;
    low = rows[i].value;
    assert_refused(rows[i].part);
  }
}

static void make_described(abbe_context_backend backend, const char *name) {
  HELD(abbe_context, context) = NULL;
  OK(abbe_context_make(backend, &context, &error));
  assert_int_equal(strncmp(abbe_context_description(context), name, strlen(name)), 0);
}

/* A GPU is taken where one works, whichever it is; the CPU where none does. */
TEST(the_device_that_works_is_taken) {
  abbe_context *context = NULL;
  make_described(ABBE_CONTEXT_AUTO, "cpu: ");
  REFUSED(ABBE_GL, "no GPU", abbe_context_make(ABBE_CONTEXT_GPU, &context, &error));
  assert_contains(last_error.text, "--backend cpu");
  as_gpu = true;
  make_described(ABBE_CONTEXT_AUTO, "gpu: ");
  first_fails = true;
  tried = 0;
  make_described(ABBE_CONTEXT_GPU, "gpu: ");
  assert_int_equal(tried, 2);
  setenv("ABBE_GPU", "1", 1);
  make_described(ABBE_CONTEXT_GPU, "gpu: ");
  assert_int_equal(tried, 3);
  setenv("ABBE_GPU", "2", 1);
  REFUSED(ABBE_GL, "no GPU", abbe_context_make(ABBE_CONTEXT_GPU, &context, &error));
  setenv("ABBE_GPU", "1.5", 1);
  REFUSED(ABBE_INVALID_ARGUMENT, "ABBE_GPU is '1.5'",
          abbe_context_make(ABBE_CONTEXT_GPU, &context, &error));
  unsetenv("ABBE_GPU");
  REFUSED(ABBE_GL, "no OpenGL for the CPU", abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
  assert_contains(last_error.text, "llvmpipe");
}

/* Where neither works the causes are told together, and neither sends the user to the other. */
TEST(two_causes_are_one_sentence) {
  abbe_context *context = NULL;
  as_gpu = refused = true;
  REFUSED(ABBE_GL, "EGL gives no context; there is no OpenGL for the CPU",
          abbe_context_make(ABBE_CONTEXT_AUTO, &context, &error));
  assert_contains(last_error.text, "--backend cpu needs Mesa's llvmpipe");
  assert_null(strstr(last_error.text, "--backend gpu"));
}

/* What a command says on stderr while it makes its context. */
static void make_and_read(bool quiet, char *said, size_t size) {
  abbe_context *context = NULL;
  abbe_error error = {0};
  FILE *file = tmpfile();
  const int kept = dup(STDERR_FILENO);
  assert_non_null(file);
  dup2(fileno(file), STDERR_FILENO);
  const abbe_result result = abbe_own_context_make(ABBE_CONTEXT_AUTO, quiet, &context, &error);
  dup2(kept, STDERR_FILENO);
  close(kept);
  assert_int_equal(result, ABBE_OK);
  abbe_context_free(context);
  rewind(file);
  said[fread(said, 1, size - 1, file)] = '\0';
  fclose(file);
}

/* Why the CPU draws is told once, and only where there is a GPU. */
TEST(a_gpu_that_is_not_taken_is_told_of_once) {
  char said[512];
  make_and_read(false, said, sizeof said);
  assert_string_equal(said, "");
  bad_gpu = true;
  make_and_read(true, said, sizeof said);
  assert_string_equal(said, "");
  make_and_read(false, said, sizeof said);
  assert_string_equal(
      said,
      "note: the GPU is not used, and the CPU draws: EGL's device (a bad one) does not open\n");
  make_and_read(false, said, sizeof said);
  assert_string_equal(said, "");
}

TEST(a_driver_without_a_name) {
  HELD(abbe_context, context) = NULL;
  mute = true;
  OK(abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
  assert_contains(abbe_context_description(context), "unnamed");
}

static void make_gem(abbe_context **context, abbe_renderer **renderer, abbe_result expected,
                     abbe_error *error) {
  OWNED(abbe_scene, scene) = {0};
  const abbe_render_desc desc = {.width = 8, .height = 8, .photons = 8, .map_size = 32};
  assert_int_equal(abbe_context_make(ABBE_CONTEXT_CPU, context, NULL), ABBE_OK);
  assert_int_equal(abbe_scene_load(ABBE_SOURCE_DIR "/scenes/gem.yaml", NULL, &scene, NULL),
                   ABBE_OK);
  assert_int_equal(abbe_renderer_make(*context, &scene, &desc, renderer, error), expected);
}

TEST(shaders_that_do_not_compile) {
  HELD(abbe_context, context) = NULL;
  abbe_renderer *renderer = NULL;
  abbe_error error = {0};
  breaks = true;
  make_gem(&context, &renderer, ABBE_GL, &error);
  assert_null(renderer);
  assert_contains(error.text, "does not compile");
}

/* Only llvmpipe's shaders are known to reach beyond what it says. */
TEST(a_buffer_that_shaders_do_not_reach) {
  abbe_context *context = NULL;
  abbe_renderer *renderer = NULL;
  abbe_error why = {0};
  lowered = GL_MAX_SHADER_STORAGE_BLOCK_SIZE;
  low = 1024;
  mute = true;
  make_gem(&context, &renderer, ABBE_UNSUPPORTED, &why);
  assert_null(renderer);
  assert_contains(why.text, "shaders reach 1024 bytes of a buffer");
  assert_contains(why.text, "--backend cpu");
  abbe_context_free(context);
  mute = false;
  make_gem(&context, &renderer, ABBE_OK, &why);
  abbe_renderer_free(renderer);
  abbe_context_free(context);
}

static bool lose(void *user, double done) {
  (void)user;
  (void)done;
  gone = true;
  return true;
}

/* The frame ends with the driver's name and a way out, and what is freed then is freed. */
TEST(a_device_lost_in_a_frame) {
  HELD(abbe_context, context) = NULL;
  HELD(abbe_renderer, renderer) = NULL;
  abbe_error why = {0};
  make_gem(&context, &renderer, ABBE_OK, &why);
  REFUSED(ABBE_GL, "device was lost in", abbe_renderer_frame(renderer, lose, NULL, NULL, &error));
  assert_contains(last_error.text, "(cpu: llvmpipe");
  assert_contains(last_error.text, "--backend cpu");
}
