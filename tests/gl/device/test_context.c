/* Contexts: the CPU gives OpenGL 4.5 everywhere; a GPU gives it or says why not. */
#include "tests/check.h"

#include "gl/device/context.h"

HOLDS(abbe_context);

static void assert_works(abbe_context *context) {
  const abbe_gl *gl = abbe_context_gl(context);
  GLint major = 0, minor = 0;
  gl->GetIntegerv(GL_MAJOR_VERSION, &major);
  gl->GetIntegerv(GL_MINOR_VERSION, &minor);
  assert_true(10 * major + minor >= 45);
  OK(abbe_gl_check(gl, "nothing", &error));
}

TEST(the_cpu_makes_4_5) {
  HELD(abbe_context, context) = NULL;
  OK(abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
  assert_works(context);
  assert_contains(abbe_context_description(context), "cpu: llvmpipe");
}

/* Where there is no GPU the sentence says so and names the way out. */
TEST(a_gpu_makes_one_or_says_why) {
  abbe_context *context = NULL;
  abbe_error error = {0};
  if (abbe_context_make(ABBE_CONTEXT_GPU, &context, &error) == ABBE_OK) {
    assert_works(context);
    assert_contains(abbe_context_description(context), "gpu: ");
    abbe_context_free(context);
    return;
  }
  assert_null(context);
  assert_contains(error.text, "--backend cpu");
}

TEST(contexts_follow_each_other) {
  for (int i = 0; i < 3; i++) {
    HELD(abbe_context, context) = NULL;
    OK(abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
    assert_works(context);
  }
  abbe_context_free(NULL);
}

TEST(gl_errors_are_named_and_cleared) {
  HELD(abbe_context, context) = NULL;
  OK(abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
  const abbe_gl *gl = abbe_context_gl(context);
  gl->Enable(0xffff);
  REFUSED(ABBE_GL, "the test's own mistake", abbe_gl_check(gl, "the test's own mistake", &error));
  assert_contains(last_error.text, "invalid enum");
  OK(abbe_gl_check(gl, "nothing", &error));
}

TEST(unknown_back_ends_are_refused) {
  abbe_context *context = NULL;
  abbe_error error = {0};
  abbe_result result = abbe_context_make(ABBE_CONTEXT_BACKEND_COUNT, &context, &error);
  assert_int_equal(result, ABBE_INVALID_ARGUMENT);
  assert_null(context);
}

static GLint major_of_host = 4, limit_of_host = 1 << 16;
static bool host_refuses;
static size_t host_calls;

static void host_integer(GLenum name, GLint *out) {
  *out = name == GL_MAJOR_VERSION ? major_of_host : name == GL_MINOR_VERSION ? 6 : limit_of_host;
}

static const GLubyte *host_string(GLenum name) {
  return (const GLubyte *)(name == GL_RENDERER ? "a made-up one" : "4.6");
}

static void nothing(void) {}

static abbe_gl_function host_lookup(const char *name) {
  if (strcmp(name, "glGetIntegerv") == 0) return (abbe_gl_function)host_integer;
  if (strcmp(name, "glGetString") == 0) return (abbe_gl_function)host_string;
  return nothing;
}

static abbe_gl_function empty_lookup(const char *name) {
  return strcmp(name, "glFinish") == 0 ? NULL : host_lookup(name);
}

static bool host_make_current(void *user) {
  assert_ptr_equal(user, &host_calls);
  host_calls++;
  return !host_refuses;
}

static void assert_not_adopted(const abbe_context_host *host, abbe_result expected,
                               const char *part) {
  abbe_context *context = NULL;
  abbe_error error = {0};
  assert_int_equal(abbe_context_adopt(host, &context, &error), expected);
  assert_null(context);
  assert_contains(error.text, part);
}

/* What is adopted is checked as an own one; nothing but what the host gives is called. */
TEST(a_host_is_adopted_or_told_why_not) {
  const abbe_context_host host = {host_lookup, host_make_current, &host_calls};
  abbe_context *context = NULL;
  assert_not_adopted(&(abbe_context_host){0}, ABBE_INVALID_ARGUMENT, "lookup");
  assert_not_adopted(&(abbe_context_host){.lookup = empty_lookup}, ABBE_GL,
                     "a made-up one, OpenGL 4.6: this OpenGL has no glFinish;");
  major_of_host = 3;
  assert_not_adopted(&host, ABBE_GL, "adopted: a made-up one offers OpenGL 3.6; Abbe needs 4.5");
  major_of_host = 4;
  limit_of_host = 4;
  assert_not_adopted(&host, ABBE_GL, "adopted: a made-up one, OpenGL 4.6 has 4 storage buffers");
  limit_of_host = 1 << 16;
  host_refuses = true;
  assert_not_adopted(&host, ABBE_GL, "'adopted' cannot be made current");
  host_refuses = false;
  OK(abbe_context_adopt(&host, &context, &error));
  assert_string_equal(abbe_context_description(context), "adopted: a made-up one, OpenGL 4.6");
  const size_t before = host_calls;
  OK(abbe_context_make_current(context, &error));
  assert_int_equal(host_calls, before + 1);
  host_refuses = true;
  REFUSED(ABBE_GL, "a made-up one", abbe_context_make_current(context, &error));
  abbe_context_free(context);
  assert_int_equal(host_calls, before + 2);
}

/* What each holds, it holds by itself: a buffer of so many bytes under the first name. */
static void assert_has(abbe_context *context, GLint size) {
  const abbe_gl *gl = abbe_context_gl(context);
  GLint bound = 0;
  OK(abbe_context_make_current(context, &error));
  gl->GetIntegerv(GL_UNIFORM_BUFFER_BINDING, &bound);
  assert_int_equal(bound, 1);
  char bytes[8] = {0};
  gl->GetBufferSubData(GL_UNIFORM_BUFFER, 0, size, bytes);
  OK(abbe_gl_check(gl, "the test", &error));
  assert_int_equal(bytes[0], size);
  gl->GetBufferSubData(GL_UNIFORM_BUFFER, 0, size + 1, bytes);
  REFUSED(ABBE_GL, "", abbe_gl_check(gl, "the test", &error));
}

static void make_two(const abbe_context_backend backend[2]) {
  abbe_context *made[2] = {NULL, NULL};
  for (GLint i = 0; i < 2; i++) {
    const char bytes[2] = {(char)(i + 1), 0};
    GLuint buffer = 0;
    OK(abbe_context_make(backend[i], &made[i], &error));
    const abbe_gl *gl = abbe_context_gl(made[i]);
    gl->GenBuffers(1, &buffer);
    assert_int_equal(buffer, 1);
    gl->BindBuffer(GL_UNIFORM_BUFFER, buffer);
    gl->BufferData(GL_UNIFORM_BUFFER, i + 1, bytes, GL_STATIC_DRAW);
  }
  for (int k = 0; k < 5; k++) assert_has(made[k % 2], k % 2 + 1);
  abbe_context_free(made[0]);
  assert_has(made[1], 2);
  abbe_context_free(made[1]);
}

TEST(two_are_two) {
  abbe_context *gpu = NULL;
  make_two((abbe_context_backend[]){ABBE_CONTEXT_CPU, ABBE_CONTEXT_CPU});
  if (abbe_context_make(ABBE_CONTEXT_GPU, &gpu, NULL) != ABBE_OK) return;
  abbe_context_free(gpu);
  make_two((abbe_context_backend[]){ABBE_CONTEXT_GPU, ABBE_CONTEXT_GPU});
  make_two((abbe_context_backend[]){ABBE_CONTEXT_CPU, ABBE_CONTEXT_GPU});
  make_two((abbe_context_backend[]){ABBE_CONTEXT_GPU, ABBE_CONTEXT_CPU});
}
