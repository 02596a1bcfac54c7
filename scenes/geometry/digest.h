/* digest.h: a number by which changes of a scene's parts are found. It is no protection against
 * forgery. */
#ifndef ABBE_SCENES_GEOMETRY_DIGEST_H
#define ABBE_SCENES_GEOMETRY_DIGEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Mixes a run of bytes into the digest h: words one after another, by a multiplication and a
 * shift. */
static inline uint64_t abbe_digest(uint64_t h, const void *data, size_t size) {
  const unsigned char *at = (const unsigned char *)data;
  for (; size > 0;) {
    uint64_t word = 0;
    const size_t n = size < sizeof word ? size : sizeof word;
    memcpy(&word, at, n);
    h = (h ^ word) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
    at += n;
    size -= n;
  }
  return h;
}

/* The same for long runs, another number: four words at a time, none of which waits for another. */
static inline uint64_t abbe_digest_long(uint64_t h, const void *data, size_t size) {
  const unsigned char *bytes = (const unsigned char *)data;
  const size_t quarter = size / 4 / sizeof h * sizeof h;
  uint64_t part[4] = {h, h + 1, h + 2, h + 3};
  for (size_t at = 0; at < quarter; at += sizeof h)
    for (size_t k = 0; k < 4; k++)
      part[k] = abbe_digest(part[k], bytes + k * quarter + at, sizeof h);
  return abbe_digest(abbe_digest(h, part, sizeof part), bytes + 4 * quarter, size - 4 * quarter);
}

/* Mixes in an array of `count` elements, and whether there is one: data may be NULL. */
static inline uint64_t abbe_digest_array(uint64_t h, const void *data, size_t count, size_t size) {
  const bool there = data != NULL;
  h = abbe_digest(h, &there, sizeof there);
  h = abbe_digest(h, &count, sizeof count);
  return there ? abbe_digest_long(h, data, count * size) : h;
}

#endif
