/* Contexts: OSMesa gives OpenGL 4.5 everywhere; EGL gives it or says why not. */
#include "tests/check.h"

#include "gl/device/context.h"

static void assert_works(abbe_context *context) {
  const abbe_gl *gl = abbe_context_gl(context);
  GLint major = 0, minor = 0, units = 0;
  abbe_error error = {0};
  gl->GetIntegerv(GL_MAJOR_VERSION, &major);
  gl->GetIntegerv(GL_MINOR_VERSION, &minor);
  assert_true(10 * major + minor >= 45);
  gl->GetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &units);
  assert_true(units >= 16); /* the passes name bindings 0 to 15 */
  assert_int_equal(abbe_gl_check(gl, "nothing", &error), ABBE_OK);
}

static void test_osmesa_makes_4_5(void **state) {
  (void)state;
  abbe_context *context = NULL;
  abbe_error error = {0};
  assert_int_equal(abbe_context_make(ABBE_CONTEXT_OSMESA, &context, &error), ABBE_OK);
  assert_works(context);
  assert_contains(abbe_context_description(context), "osmesa: ");
  assert_contains(abbe_context_description(context), "4.5");
  abbe_context_free(context);
}

/* Where there is no EGL display the sentence says so and names the way out. */
static void test_egl_makes_one_or_says_why(void **state) {
  (void)state;
  abbe_context *context = NULL;
  abbe_error error = {0};
  abbe_result result = abbe_context_make(ABBE_CONTEXT_EGL, &context, &error);
  if (result == ABBE_OK) {
    assert_works(context);
    assert_contains(abbe_context_description(context), "egl: ");
    abbe_context_free(context);
    return;
  }
  assert_true(result == ABBE_GL || result == ABBE_UNSUPPORTED);
  assert_null(context);
  assert_contains(error.text, "EGL");
  assert_contains(error.text, "osmesa");
}

static void test_contexts_follow_each_other(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++) {
    abbe_context *context = NULL;
    assert_int_equal(abbe_context_make(ABBE_CONTEXT_OSMESA, &context, NULL), ABBE_OK);
    assert_works(context);
    abbe_context_free(context);
  }
  abbe_context_free(NULL);
}

static void test_gl_errors_are_named_and_cleared(void **state) {
  (void)state;
  abbe_context *context = NULL;
  abbe_error error = {0};
  assert_int_equal(abbe_context_make(ABBE_CONTEXT_OSMESA, &context, NULL), ABBE_OK);
  const abbe_gl *gl = abbe_context_gl(context);
  gl->Enable(0xffff);
  assert_int_equal(abbe_gl_check(gl, "the test's own mistake", &error), ABBE_GL);
  assert_contains(error.text, "the test's own mistake");
  assert_contains(error.text, "invalid enum");
  assert_int_equal(abbe_gl_check(gl, "nothing", &error), ABBE_OK);
  abbe_context_free(context);
}

static void test_unknown_back_ends_are_refused(void **state) {
  (void)state;
  abbe_context *context = NULL;
  abbe_error error = {0};
  abbe_result result = abbe_context_make(ABBE_CONTEXT_BACKEND_COUNT, &context, &error);
  assert_int_equal(result, ABBE_INVALID_ARGUMENT);
  assert_null(context);
  assert_string_equal(abbe_context_backend_name(ABBE_CONTEXT_OSMESA), "osmesa");
  assert_string_equal(abbe_context_backend_name(ABBE_CONTEXT_EGL), "egl");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_osmesa_makes_4_5),
                                     cmocka_unit_test(test_egl_makes_one_or_says_why),
                                     cmocka_unit_test(test_contexts_follow_each_other),
                                     cmocka_unit_test(test_gl_errors_are_named_and_cleared),
                                     cmocka_unit_test(test_unknown_back_ends_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
