#define _GNU_SOURCE /* nftw, environ */
#include "validation/sweep/sweep_process.h"

#include "base/clock.h"
#include "base/number.h"
#include "library/choice/sweep_trace.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_WORDS = 48, WORD = 64, MOST_RUNS = 99, PATH = 512 };

/* Where drivers keep compiled shaders: Mesa's, and NVIDIA's for EGL. */
static const char *const caches[] = {"MESA_SHADER_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH"};
enum { CACHES = sizeof caches / sizeof *caches };

struct abbe_sweep_process {
  abbe_sweep_process_desc desc;
  char folder[PATH];
  size_t caches; /* that were made */
};

typedef struct command {
  char *word[MAX_WORDS];
  char own[MAX_WORDS][WORD]; /* numbers as text */
  size_t count;
} command;

static void add(command *c, const char *text) {
  if (c->count + 1 < MAX_WORDS) c->word[c->count++] = (char *)text;
}

static void add_count(command *c, const char *option, size_t value) {
  add(c, option);
  snprintf(c->own[c->count], WORD, "%zu", value);
  add(c, c->own[c->count]);
}

static void add_render(command *c, const abbe_sweep_process_desc *d, const abbe_sweep_setting *s) {
  add(c, "--profile");
  add(c, s->profile);
  add_count(c, "--wavelengths", s->wavelengths);
  add_count(c, "--photons", s->photons);
  add_count(c, "--map", s->map);
  if (s->upsample > 1)
    add_count(c, "--upsample", s->upsample);
  else
    add_count(c, "--samples", s->samples);
  add(c, "--fill");
  add(c, s->fill);
  add(c, "--model");
  add(c, s->model);
  if (strcmp(s->profile, "default") == 0) {
    add_count(c, "--exits", s->exits);
    add(c, "--share");
    add(c, abbe_number_text(s->share, c->own[c->count]));
  }
  if (d->backend != NULL) {
    add(c, "--backend");
    add(c, d->backend);
  }
}

static void add_trace(command *c, const abbe_sweep_setting *s) {
  add_count(c, "--spp", s->passes);
  add_count(c, "--photons", s->photons * s->photons);
  add_count(c, "--seed", ABBE_SWEEP_TRACE_SEED);
  if (strcmp(s->profile, ABBE_SWEEP_TRACE_FILTER) == 0) add(c, "--filter");
}

static void make_command(const abbe_sweep_process_desc *d, const abbe_sweep_setting *s,
                         const char *picture, command *c) {
  const bool traced = abbe_sweep_setting_is_traced(s);
  *c = (command){0};
  add(c, d->program);
  add(c, traced ? "trace" : "render");
  add(c, d->scene);
  add(c, "--quiet");
  add(c, "-o");
  add(c, picture);
  if (d->materials != NULL) {
    add(c, "--materials");
    add(c, d->materials);
  }
  if (d->width > 0) {
    add(c, "--size");
    snprintf(c->own[c->count], WORD, "%zux%zu", d->width, d->height);
    add(c, c->own[c->count]);
  }
  if (traced)
    add_trace(c, s);
  else
    add_render(c, d, s);
}

/* The environment with the caches in that folder; the strings are its own, in `own`. */
static char **make_environment(const char *cache, char own[CACHES][PATH + 64]) {
  size_t count = 0, used = 0;
  while (environ[count] != NULL) count++;
  char **out = calloc(count + CACHES + 1, sizeof *out);
  if (out == NULL) return NULL;
  for (size_t i = 0; i < CACHES; i++) {
    snprintf(own[i], PATH + 64, "%s=%s", caches[i], cache);
    out[used++] = own[i];
  }
  for (size_t i = 0; i < count; i++) {
    bool replaced = false;
    for (size_t k = 0; k < CACHES; k++) {
      size_t length = strlen(caches[k]);
      replaced |= strncmp(environ[i], caches[k], length) == 0 && environ[i][length] == '=';
    }
    if (!replaced) out[used++] = environ[i];
  }
  return out;
}

static abbe_result failed(const command *c, const char *how, abbe_error *error) {
  char text[600] = "";
  size_t used = 0;
  for (size_t i = 0; i < c->count && used < sizeof text / 2; i++)
    used +=
        (size_t)snprintf(text + used, sizeof text - used, "%s%.200s", i > 0 ? " " : "", c->word[i]);
  return abbe_error_set(error, ABBE_IO, "the command %s: %s", how, text);
}

static abbe_result run(const command *c, const char *cache, double *ms, abbe_error *error) {
  char own[CACHES][PATH + 64];
  posix_spawn_file_actions_t actions;
  pid_t child;
  int status;
  char **environment = make_environment(cache, own);
  if (environment == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to start a process");
  posix_spawn_file_actions_init(&actions);
  for (int i = 0; i < 3; i++)
    posix_spawn_file_actions_addopen(&actions, i, "/dev/null", i == 0 ? O_RDONLY : O_WRONLY, 0);
  const double start = abbe_clock_seconds();
  int wrong = posix_spawn(&child, c->word[0], &actions, NULL, c->word, environment);
  while (wrong == 0 && waitpid(child, &status, 0) < 0)
    if (errno != EINTR) wrong = errno;
  *ms = 1e3 * (abbe_clock_seconds() - start);
  posix_spawn_file_actions_destroy(&actions);
  free(environment);
  if (wrong != 0) return failed(c, "could not be run", error);
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGINT || WTERMSIG(status) == SIGTERM))
    return abbe_error_set(error, ABBE_CANCELLED, "stopped");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return failed(c, "did not end well", error);
  return ABBE_OK;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *at) {
  (void)info;
  (void)kind;
  (void)at;
  return remove(path);
}

static int compare_times(const void *a, const void *b) {
  const double *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

abbe_result abbe_sweep_process_make(const abbe_sweep_process_desc *desc, abbe_sweep_process **out,
                                    abbe_error *error) {
  assert(desc->program && desc->scene);
  const char *base = getenv("TMPDIR");
  *out = NULL;
  abbe_sweep_process *p = calloc(1, sizeof *p);
  if (p == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to time processes");
  p->desc = *desc;
  p->desc.runs = desc->runs == 0 ? 1 : desc->runs > MOST_RUNS ? MOST_RUNS : desc->runs;
  int length = snprintf(p->folder, sizeof p->folder, "%s/abbe-process-XXXXXX",
                        base != NULL && base[0] != '\0' ? base : "/tmp");
  if (length < 0 || (size_t)length >= sizeof p->folder || mkdtemp(p->folder) == NULL) {
    abbe_result result =
        abbe_error_set(error, ABBE_IO, "there is no folder for temporary files: %.200s: %s",
                       p->folder, strerror(errno));
    free(p);
    return result;
  }
  *out = p;
  return ABBE_OK;
}

void abbe_sweep_process_free(abbe_sweep_process *p) {
  if (p == NULL) return;
  nftw(p->folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
  free(p);
}

abbe_result abbe_sweep_process_measure(abbe_sweep_process *p, bool cold, abbe_sweep_row *row,
                                       abbe_error *error) {
  char picture[PATH + 32], cache[PATH + 32], filled[PATH + 32];
  double first = 0, warm[MOST_RUNS];
  command c;
  snprintf(picture, sizeof picture, "%s/picture.exr", p->folder);
  snprintf(filled, sizeof filled, "%s/shaders", p->folder);
  snprintf(cache, sizeof cache, "%s/shaders-%zu", p->folder, ++p->caches);
  make_command(&p->desc, &row->setting, picture, &c);
  /* The first fills what is missing in the cache, so it is not warm. The tracer needs none. */
  const bool traced = abbe_sweep_setting_is_traced(&row->setting);
  abbe_result result = traced ? ABBE_OK : run(&c, cold ? cache : filled, &first, error);
  for (size_t i = 0; i < p->desc.runs && result == ABBE_OK; i++)
    result = run(&c, cold ? cache : filled, &warm[i], error);
  if (cold) nftw(cache, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
  if (result != ABBE_OK) return result;
  qsort(warm, p->desc.runs, sizeof *warm, compare_times);
  row->number[ABBE_SWEEP_WARM_MS] = warm[p->desc.runs / 2];
  if (cold) row->number[ABBE_SWEEP_COLD_MS] = traced ? warm[p->desc.runs / 2] : first;
  return ABBE_OK;
}
