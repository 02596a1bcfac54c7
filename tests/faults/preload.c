/* preload.c: put before a program by LD_PRELOAD, lets one of its calls fail, or kills it there.
 *
 * ABBE_FAULT says what: "kill:N" ends it by SIGKILL at the N-th call that changes files (open for
 * writing, pwrite, fsync, link, rename, unlink), before that call; "memory:N" lets the N-th
 * allocation fail, "starve:N" every one from the N-th on. Allocations count where the call comes
 * from the program itself or one of the libraries named in `fallible`: others end a program that
 * gets no memory, each in its own way. ABBE_FAULT_COUNT names a file that gets the number of calls.
 */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const fallible[] = {"libyaml", "libcjson", "libpng", "libOpenEXRCore"};

enum { MAX_RANGES = 16 };
static struct { uintptr_t from, to; } range[MAX_RANGES];
static int ranges;

static bool kills, memory, starves;
static size_t wanted;
static atomic_size_t files, allocations;

static int note(struct dl_phdr_info *info, size_t size, void *user) {
  (void)size, (void)user;
  bool counts = info->dlpi_name[0] == '\0'; /* the program */
  for (size_t i = 0; i < sizeof fallible / sizeof *fallible; i++)
    counts = counts || strstr(info->dlpi_name, fallible[i]) != NULL;
  for (int i = 0; counts && i < info->dlpi_phnum && ranges < MAX_RANGES; i++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[i];
    if (p->p_type != PT_LOAD || (p->p_flags & PF_X) == 0) continue;
    range[ranges].from = info->dlpi_addr + p->p_vaddr;
    range[ranges++].to = info->dlpi_addr + p->p_vaddr + p->p_memsz;
  }
  return 0;
}

__attribute__((constructor)) static void begin(void) {
  const char *what = getenv("ABBE_FAULT"), *colon = what != NULL ? strchr(what, ':') : NULL;
  dl_iterate_phdr(note, NULL);
  if (colon == NULL) return;
  wanted = strtoul(colon + 1, NULL, 10);
  kills = strncmp(what, "kill", 4) == 0;
  starves = strncmp(what, "starve", 6) == 0;
  memory = starves || strncmp(what, "memory", 6) == 0;
}

__attribute__((destructor)) static void end(void) {
  const char *path = getenv("ABBE_FAULT_COUNT");
  FILE *file = path != NULL ? fopen(path, "w") : NULL;
  if (file == NULL) return;
  fprintf(file, "%zu %zu\n", (size_t)files, (size_t)allocations);
  fclose(file);
}

/* ---- files ---- */

static void count_file_call(void) {
  if (++files == wanted && kills) raise(SIGKILL);
}

#define NEXT(name) (__extension__(__typeof__(&name)) dlsym(RTLD_NEXT, #name))

int open(const char *path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE) {
    va_list list;
    va_start(list, flags);
    mode = va_arg(list, mode_t);
    va_end(list);
    count_file_call();
  }
  return NEXT(open)(path, flags, mode);
}

ssize_t pwrite(int fd, const void *data, size_t size, off_t at) {
  count_file_call();
  return NEXT(pwrite)(fd, data, size, at);
}

int fsync(int fd) {
  count_file_call();
  return NEXT(fsync)(fd);
}

int linkat(int a, const char *from, int b, const char *to, int flags) {
  count_file_call();
  return NEXT(linkat)(a, from, b, to, flags);
}

int rename(const char *from, const char *to) {
  count_file_call();
  return NEXT(rename)(from, to);
}

int unlink(const char *path) {
  count_file_call();
  return NEXT(unlink)(path);
}

/* ---- memory ---- */

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *old, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);

static bool starved(const void *caller) {
  const uintptr_t at = (uintptr_t)caller;
  bool counts = false;
  for (int i = 0; i < ranges; i++) counts = counts || (at >= range[i].from && at < range[i].to);
  if (!counts) return false;
  const size_t n = ++allocations;
  if (!memory || n < wanted || (n > wanted && !starves)) return false;
  errno = ENOMEM;
  return true;
}

void *malloc(size_t size) {
  return starved(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
  return starved(__builtin_return_address(0)) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *old, size_t size) {
  return starved(__builtin_return_address(0)) ? NULL : __libc_realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
  return starved(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, size);
}

char *strdup(const char *text) {
  const size_t size = strlen(text) + 1;
  char *copy = starved(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
  return copy != NULL ? memcpy(copy, text, size) : NULL;
}
