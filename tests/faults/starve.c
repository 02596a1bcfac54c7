/* starve.c: feeds a target its input, and once more with an allocation of its readers failing. */
#include "tests/faults/memory.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>

enum { CALLS = 16 };

static struct {
  size_t call, wanted;        /* which call is starved, of which allocation; 0: none */
  size_t calls, count[CALLS]; /* calls so far, and what each allocates when none fails */
  bool every;
  abbe_result whole[CALLS]; /* what the calls hand back and make when none fails */
  uint64_t made[CALLS];
} now;

void fuzz_begin(void) {
  faults_memory_begin(now.calls == now.call ? now.wanted : 0, now.every);
}

abbe_result fuzz_end(abbe_result result, const abbe_error *error) {
  const size_t count = faults_memory_end();
  FUZZ_PROMISE(now.calls < CALLS);
  abbe_result *whole = &now.whole[now.calls];
  if (now.wanted == 0) {
    *whole = result;
    now.count[now.calls] = count;
  }
  now.calls++;
  if (now.wanted == 0) return result;
  const bool starved = faults_memory_failed() > 0 &&
                       (result == ABBE_NO_MEMORY ||
                        (result == ABBE_IO && strstr(error->text, "Cannot allocate memory")));
  if (result != *whole && !starved)
    fprintf(stderr, "allocation %zu (%s): %s: %s\n", now.wanted, faults_memory_what(),
            abbe_result_text(result), error->text);
  FUZZ_PROMISE(result == *whole || starved);
  return result;
}

static uint64_t hash(const uint8_t *data, size_t size) {
  uint64_t h = 14695981039346656037u;
  for (size_t i = 0; i < size; i++) h = (h ^ data[i]) * 1099511628211u;
  return h;
}

void fuzz_same(const void *data, size_t size) {
  const uint64_t made = hash(data, size);
  FUZZ_PROMISE(now.calls > 0);
  uint64_t *whole = &now.made[now.calls - 1];
  if (now.wanted == 0)
    *whole = made;
  else if (*whole != made)
    fprintf(stderr, "allocation %zu (%s)\n", now.wanted, faults_memory_what());
  FUZZ_PROMISE(*whole == made);
}

/* Returns how many allocations all calls made. */
static size_t feed_whole(const uint8_t *data, size_t size) {
  size_t all = 0;
  now.wanted = now.calls = 0;
  fuzz_input(data, size);
  for (size_t i = 0; i < now.calls; i++) all += now.count[i];
  return all;
}

/* With the n-th of them failing, from 0. */
static void feed_starved(const uint8_t *data, size_t size, size_t n, bool every) {
  for (now.call = 0; n >= now.count[now.call]; now.call++) n -= now.count[now.call];
  now.wanted = 1 + n;
  now.every = every;
  now.calls = 0;
  fuzz_input(data, size);
}

size_t fuzz_starve(const uint8_t *data, size_t size, size_t tries) {
  const size_t count = feed_whole(data, size), tried = tries < count ? tries : count;
  for (size_t k = 0; k < tried; k++)
    for (int every = 0; every < 2; every++) feed_starved(data, size, k * count / tried, every == 1);
  return 2 * tried;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const uint64_t h = hash(data, size);
  const size_t count = feed_whole(data, size);
  if (count > 0 && h >> 62 == 0) feed_starved(data, size, h % count, (h >> 61 & 1) != 0);
  return 0;
}
