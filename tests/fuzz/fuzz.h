/* fuzz.h: a fuzz target: reads any bytes, and must neither crash, leak, hang nor break its
 * promises.
 *
 * Each target is a file that defines the two names below. With clang and ABBE_FUZZ it is linked
 * with libFuzzer; in the ordinary tests with tests/fuzz/driver.c, which feeds it a corpus and
 * mutations.
 */
#ifndef ABBE_TESTS_FUZZ_H
#define ABBE_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Words of the format that mutations insert; NULL ends them. */
extern const char *const fuzz_words[];

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
