/* gl_context.h: one OpenGL context for all tests of a file. */
#ifndef ABBE_TESTS_GL_GL_CONTEXT_H
#define ABBE_TESTS_GL_GL_CONTEXT_H

#include "tests/check.h"

#include "gl/device/context.h"

HOLDS(abbe_context);

static abbe_context *context;

static inline void make_context(void) {
  abbe_error error = {0};
  if (abbe_context_make(ABBE_CONTEXT_CPU, &context, &error) == ABBE_OK) return;
  print_error("%s\n", error.text);
  fail();
}

static inline void free_context(void) {
  abbe_context_free(context);
}

#endif
