/* program.h: GLSL programs from the shader files that stand beside their passes.
 *
 * The files are compiled into the library. `#include "name"` lines are expanded (once a file),
 * the version line and the caller's definitions come first, and the compiler's complaints name
 * file and line. Definitions that a stage does not mention are left out of its text.
 */
#ifndef ABBE_GL_DEVICE_PROGRAM_H
#define ABBE_GL_DEVICE_PROGRAM_H

#include "base/error.h"
#include "gl/device/api.h"

#include <stddef.h>

typedef struct abbe_program_stage {
  GLenum type;      /* GL_VERTEX_SHADER, … */
  const char *file; /* "photon_trace.comp" */
} abbe_program_stage;

/* Compiles and links; defines is "#define A 1\n…" or NULL. The program is the caller's, freed by
 * gl->DeleteProgram. ABBE_NOT_FOUND for an unknown file, ABBE_GL with the compiler's first lines.
 */
abbe_result abbe_program_make(const abbe_gl *gl, const abbe_program_stage *stages, size_t count,
                              const char *defines, GLuint *out, abbe_error *error);

/* A compute program of one file. */
abbe_result abbe_program_make_compute(const abbe_gl *gl, const char *file, const char *defines,
                                      GLuint *out, abbe_error *error);

/* The same from text instead of a file, which may include the files: for tests of GLSL functions.
 */
abbe_result abbe_program_make_compute_text(const abbe_gl *gl, const char *text, const char *defines,
                                           GLuint *out, abbe_error *error);

/* What the driver is given as a stage; malloc'd. ABBE_NOT_FOUND, ABBE_NO_MEMORY. */
abbe_result abbe_program_text(const char *file, const char *defines, char **out, abbe_error *error);

/* Names of all shader files, NULL-terminated: a test compiles each. */
const char *const *abbe_program_files(void);

#endif
