/* starve.c: feeds a target its input, and once more with an allocation of its readers failing. */
#include "tests/faults/memory.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>

enum { CALLS = 16 };

static struct {
  size_t wanted, most, calls; /* the allocation that fails, the most a call makes, calls so far */
  bool every;
  abbe_result whole[CALLS]; /* what the calls hand back and make when none fails */
  uint64_t made[CALLS];
} now;

void fuzz_begin(void) {
  faults_memory_begin(now.wanted, now.every);
}

abbe_result fuzz_end(abbe_result result, const abbe_error *error) {
  const size_t count = faults_memory_end();
  FUZZ_PROMISE(now.calls < CALLS);
  abbe_result *whole = &now.whole[now.calls++];
  if (now.wanted == 0) {
    *whole = result;
    if (count > now.most) now.most = count;
    return result;
  }
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

static void feed(const uint8_t *data, size_t size, size_t wanted, bool every) {
  now.wanted = wanted;
  now.every = every;
  now.calls = 0;
  fuzz_input(data, size);
}

size_t fuzz_starve(const uint8_t *data, size_t size, size_t tries) {
  now.most = 0;
  feed(data, size, 0, false);
  const size_t count = now.most, tried = tries < count ? tries : count;
  for (size_t k = 0; k < tried; k++)
    for (int every = 0; every < 2; every++) feed(data, size, 1 + k * count / tried, every == 1);
  return 2 * tried;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const uint64_t h = hash(data, size);
  now.most = 0;
  feed(data, size, 0, false);
  if (now.most > 0 && h >> 62 == 0) feed(data, size, 1 + h % now.most, (h >> 61 & 1) != 0);
  return 0;
}
