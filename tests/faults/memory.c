#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "tests/faults/memory.h"

#include <errno.h>
#include <expat.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_interp.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <locale.h>
#include <sqlite3.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <yaml.h>

/* Child processes, as the one that reads a mesh, count with their parent. */
static struct shared {
  atomic_bool on, every;
  atomic_size_t seen, wanted, failed;
  char what[160];
} none, *shared = &none;

static void share(void) {
  if (shared != &none) return;
  void *memory =
      mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) abort();
  shared = memory;
}

void faults_memory_begin(size_t n, bool all) {
  share();
  shared->seen = shared->failed = 0;
  shared->wanted = n;
  shared->every = all;
  shared->what[0] = '\0';
  shared->on = true;
}

size_t faults_memory_end(void) {
  shared->on = false;
  return shared->seen;
}

size_t faults_memory_failed(void) {
  return shared->failed;
}

const char *faults_memory_what(void) {
  return shared->what;
}

static bool fails(const char *name, const void *caller) {
  if (!shared->on) return false;
  const size_t mine = ++shared->seen;
  if (shared->wanted == 0 || mine < shared->wanted || (mine > shared->wanted && !shared->every))
    return false;
  if (shared->failed++ == 0)
    snprintf(shared->what, sizeof shared->what, "%s called at %p", name, caller);
  errno = ENOMEM;
  return true;
}

/* WRAP(type, name, (parameters), (arguments), result): of the same name, with a failure in turn. */
#define WRAP(type, name, parameters, arguments, none)                                              \
  type __real_##name parameters;                                                                   \
  type __wrap_##name parameters;                                                                   \
  type __wrap_##name parameters {                                                                  \
    return fails(#name, __builtin_return_address(0)) ? (none) : __real_##name arguments;           \
  }

WRAP(void *, malloc, (size_t size), (size), NULL)
WRAP(void *, calloc, (size_t count, size_t size), (count, size), NULL)
WRAP(void *, realloc, (void *old, size_t size), (old, size), NULL)
WRAP(void *, aligned_alloc, (size_t alignment, size_t size), (alignment, size), NULL)
WRAP(char *, strdup, (const char *text), (text), NULL)
WRAP(char *, strndup, (const char *text, size_t size), (text, size), NULL)
WRAP(char *, realpath, (const char *path, char *resolved), (path, resolved), NULL)
WRAP(FILE *, fopen, (const char *path, const char *mode), (path, mode), NULL)
WRAP(FILE *, fdopen, (int fd, const char *mode), (fd, mode), NULL)
WRAP(FILE *, open_memstream, (char **text, size_t *size), (text, size), NULL)
WRAP(locale_t, newlocale, (int mask, const char *name, locale_t base), (mask, name, base),
     (locale_t)0)

WRAP(int, yaml_parser_initialize, (yaml_parser_t * parser), (parser), 0)
WRAP(int, yaml_parser_parse, (yaml_parser_t * parser, yaml_event_t *event), (parser, event),
     (memset(event, 0, sizeof *event), parser->error = YAML_MEMORY_ERROR, 0))

WRAP(int, sqlite3_open_v2, (const char *path, sqlite3 **db, int flags, const char *vfs),
     (path, db, flags, vfs), (*db = NULL, SQLITE_NOMEM))
WRAP(int, sqlite3_prepare_v2,
     (sqlite3 * db, const char *sql, int size, sqlite3_stmt **out, const char **rest),
     (db, sql, size, out, rest), (*out = NULL, SQLITE_NOMEM))
WRAP(int, sqlite3_step, (sqlite3_stmt * statement), (statement), SQLITE_NOMEM)
WRAP(unsigned char *, sqlite3_serialize,
     (sqlite3 * db, const char *schema, sqlite3_int64 *size, unsigned flags),
     (db, schema, size, flags), NULL)

WRAP(gsl_vector *, gsl_vector_alloc, (size_t n), (n), NULL)
WRAP(gsl_matrix *, gsl_matrix_alloc, (size_t n, size_t m), (n, m), NULL)
WRAP(gsl_eigen_symmv_workspace *, gsl_eigen_symmv_alloc, (size_t n), (n), NULL)
WRAP(gsl_interp *, gsl_interp_alloc, (const gsl_interp_type *type, size_t n), (type, n), NULL)
WRAP(gsl_integration_workspace *, gsl_integration_workspace_alloc, (size_t n), (n), NULL)
WRAP(gsl_multifit_linear_workspace *, gsl_multifit_linear_alloc, (size_t n, size_t p), (n, p), NULL)
WRAP(gsl_multifit_nlinear_workspace *, gsl_multifit_nlinear_alloc,
     (const gsl_multifit_nlinear_type *type, const gsl_multifit_nlinear_parameters *parameters,
      size_t n, size_t p),
     (type, parameters, n, p), NULL)

/* ---- expat takes its caller's malloc ---- */

static void *inner_malloc(size_t size) {
  return fails("malloc within a library", __builtin_return_address(0)) ? NULL : __real_malloc(size);
}

static void *inner_realloc(void *old, size_t size) {
  return fails("realloc within a library", __builtin_return_address(0)) ? NULL
                                                                        : __real_realloc(old, size);
}

XML_Parser __wrap_XML_ParserCreate(const XML_Char *encoding);
XML_Parser __wrap_XML_ParserCreate(const XML_Char *encoding) {
  static const XML_Memory_Handling_Suite suite = {inner_malloc, inner_realloc, free};
  return XML_ParserCreate_MM(encoding, &suite, NULL);
}
