/* gl_context.h: one OpenGL context for all tests of a file. */
#ifndef ABBE_TESTS_GL_GL_CONTEXT_H
#define ABBE_TESTS_GL_GL_CONTEXT_H

#include "tests/check.h"

#include "gl/device/context.h"

static abbe_context *context;

static inline int make_context(void **state) {
  abbe_error error = {0};
  (void)state;
  if (abbe_context_make(ABBE_CONTEXT_CPU, &context, &error) == ABBE_OK) return 0;
  print_error("%s\n", error.text);
  return 1;
}

static inline int free_context(void **state) {
  (void)state;
  abbe_context_free(context);
  return 0;
}

#endif
