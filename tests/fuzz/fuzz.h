/* fuzz.h: a fuzz target: reads any bytes, and must neither crash, leak, hang nor break its
 * promises.
 *
 * Each target is a file that defines the two names below. With clang and ABBE_FUZZ it is linked
 * with libFuzzer; in the ordinary tests with tests/fuzz/driver.c, which feeds it a corpus, each
 * file of it with every allocation failing in turn, and mutations.
 */
#ifndef ABBE_TESTS_FUZZ_H
#define ABBE_TESTS_FUZZ_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Words of the format that mutations insert; NULL ends them. */
extern const char *const fuzz_words[];

int fuzz_input(const uint8_t *data, size_t size);

/* A call of the reader that a target is about, with its error: some of its allocations fail
 * (tests/faults/starve.c). It must hand back what it does when none fails, or that there was no
 * memory. */
#define FUZZED(call, error) (fuzz_begin(), fuzz_end((call), (error)))
void fuzz_begin(void);
abbe_result fuzz_end(abbe_result result, const abbe_error *error);

/* What the call before made, once a call: it is the same where an allocation failed and the call
 * did not. */
void fuzz_same(const void *data, size_t size);

/* The input, then again for each allocation of its calls (of at most so many, spread over all):
 * with it failing, and with it and all later ones. Returns how often it was fed again. */
size_t fuzz_starve(const uint8_t *data, size_t size, size_t tries);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A promise that is broken ends the program, as a crash does. */
#define FUZZ_PROMISE(holds)                                                                        \
  do {                                                                                             \
    if (!(holds)) {                                                                                \
      fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, #holds);                          \
      abort();                                                                                     \
    }                                                                                              \
  } while (0)

#endif
