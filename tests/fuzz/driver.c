/* driver.c: runs a fuzz target without libFuzzer: every file of a folder, then seeded mutations of
 * them. usage: fuzz_NAME FOLDER [RUNS [SEED]]. Each file is also read with a share of its
 * allocations failing in turn, with ABBE_FAULTS_ALL in the environment all of them.
 *
 * The same seed makes the same inputs. An input that takes longer than its share ends the program,
 * as does one that needs too much memory; what was fed last is left in fuzz_NAME.last. The share is
 * of processor time: a machine that is busy with other things is no hang.
 */
#include "tests/fuzz/fuzz.h"

#include <dirent.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>

enum { MAX_FILES = 64, MAX_BYTES = 1 << 16, SECONDS_EACH = 20, TRIES = 100, TRIED_SECONDS = 600 };

#if defined(__SANITIZE_ADDRESS__)
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

typedef struct input {
  size_t size;
  uint8_t data[MAX_BYTES];
} input;

static input *files[MAX_FILES];
static size_t file_count;
static input fed;
static char last[256];

static uint64_t state;

static uint64_t next(void) {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return state;
}

static size_t below(size_t limit) {
  return limit == 0 ? 0 : (size_t)(next() % limit);
}

/* ---- mutations ---- */

static void replace(size_t at, size_t cut, const void *with, size_t count) {
  if (at > fed.size) at = fed.size;
  if (cut > fed.size - at) cut = fed.size - at;
  if (fed.size - cut + count > MAX_BYTES) return;
  static uint8_t kept[MAX_BYTES];
  memcpy(kept, with, count); /* it may be a part of the input itself */
  memmove(fed.data + at + count, fed.data + at + cut, fed.size - at - cut);
  memcpy(fed.data + at, kept, count);
  fed.size = fed.size - cut + count;
}

static void insert_word(void) {
  static const char *const numbers[] = {"0",     "-1", "1e308", "1e-308", "1e999",
                                        "nan",   "-0", "65536", "1.5",    "1e6",
                                        "0.001", "-",  "1e-06", "",       "99999999999999999999"};
  size_t words = 0, many = sizeof numbers / sizeof numbers[0];
  while (fuzz_words[words] != NULL) words++;
  size_t which = below(words + many);
  const char *word = which < words ? fuzz_words[which] : numbers[which - words];
  replace(below(fed.size + 1), below(2) * below(12), word, strlen(word));
}

static void splice(void) {
  const input *other = files[below(file_count)];
  size_t from = below(other->size + 1), count = below(other->size - from + 1);
  if (count > 2000) count = below(2000);
  replace(below(fed.size + 1), below(200), other->data + from, count);
}

static void mutate(void) {
  size_t at = below(fed.size), count = below(40);
  switch (below(7)) {
  case 0:
    if (fed.size > 0) fed.data[at] ^= (uint8_t)(1u << below(8));
    break;
  case 1:
    if (fed.size > 0) fed.data[at] = (uint8_t)next();
    break;
  case 2:
    replace(at, count, "", 0);
    break;
  case 3:
    if (at + count > fed.size) count = fed.size - at;
    replace(below(fed.size + 1), 0, fed.data + at, count);
    break;
  case 4:
    splice();
    break;
  case 5:
    if (below(20) == 0) fed.size = at;
    break;
  default:
    insert_word();
  }
}

/* ---- feeding ---- */

static void end(int number) {
  FILE *file = fopen(last, "wb");
  if (file != NULL) {
    fwrite(fed.data, 1, fed.size, file);
    fclose(file);
  }
  fprintf(stderr, "%s on the input in %s\n", number == SIGPROF ? "too slow" : "stopped", last);
  signal(number, SIG_DFL);
  signal(SIGABRT, SIG_DFL);
  raise(number == SIGPROF ? SIGABRT : number);
}

static void allow(int seconds) {
  setitimer(ITIMER_PROF, &(struct itimerval){.it_value.tv_sec = seconds}, NULL);
}

/* Returns how often allocations failed: tries is how many of them are tried for each. */
static size_t feed(size_t tries) {
  /* a copy of its own, so that reading past the end is seen */
  uint8_t *data = malloc(fed.size + (fed.size == 0));
  if (data == NULL) exit(2);
  memcpy(data, fed.data, fed.size);
  allow(tries > 0 ? TRIED_SECONDS : SECONDS_EACH);
  const size_t starved = tries > 0 ? fuzz_starve(data, fed.size, tries)
                                   : (size_t)LLVMFuzzerTestOneInput(data, fed.size);
  allow(0);
  free(data);
  return starved;
}

static int is_named(const struct dirent *entry) {
  return entry->d_name[0] != '.';
}

/* By name: the order of a folder differs from disk to disk, and the inputs would with it. */
static int by_name(const struct dirent **a, const struct dirent **b) {
  return strcmp((*a)->d_name, (*b)->d_name);
}

static int load(const char *folder) {
  struct dirent **entry;
  const int count = scandir(folder, &entry, is_named, by_name);
  if (count < 0) return 0;
  for (int i = 0; i < count && file_count < MAX_FILES; i++) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, entry[i]->d_name);
    FILE *file = fopen(path, "rb");
    input *made = calloc(1, sizeof *made);
    if (file == NULL || made == NULL) exit(2);
    made->size = fread(made->data, 1, MAX_BYTES, file);
    fclose(file);
    files[file_count++] = made;
  }
  for (int i = 0; i < count; i++) free(entry[i]);
  free(entry);
  return file_count > 0;
}

int main(int argc, char **argv) {
  if (argc < 2 || !load(argv[1])) {
    fprintf(stderr, "usage: %s FOLDER [RUNS [SEED]]: FOLDER holds the files to begin with\n",
            argv[0]);
    return 2;
  }
  unsigned long runs = argc > 2 ? strtoul(argv[2], NULL, 10) : 1000;
  state = 0x9e3779b97f4a7c15u ^ (argc > 3 ? strtoul(argv[3], NULL, 10) : 1);
  const char *slash = strrchr(argv[0], '/');
  snprintf(last, sizeof last, "%s.last", slash != NULL ? slash + 1 : argv[0]);
  if (!SANITIZED) setrlimit(RLIMIT_AS, &(struct rlimit){1u << 30, 1u << 30});
  const int numbers[] = {SIGPROF, SIGABRT, SIGSEGV, SIGFPE, SIGBUS};
  for (int i = 0; i < (SANITIZED ? 2 : 5); i++) signal(numbers[i], end);
  const size_t tries = getenv("ABBE_FAULTS_ALL") != NULL ? SIZE_MAX : TRIES;
  size_t starved = 0;
  for (size_t i = 0; i < file_count; i++) {
    fed = *files[i];
    starved += feed(tries);
  }
  for (unsigned long i = 0; i < runs; i++) {
    fed = *files[below(file_count)];
    for (size_t k = 1 + below(6); k > 0; k--) mutate();
    feed(0);
  }
  printf("%zu files, %zu times with failing allocations, and %lu mutations\n", file_count, starved,
         runs);
  for (size_t i = 0; i < file_count; i++) free(files[i]);
  return 0;
}
