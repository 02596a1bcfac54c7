/* digest.h: a number that tells whether parts of a scene have changed. Not for who may forge them.
 */
#ifndef ABBE_SCENES_DIGEST_H
#define ABBE_SCENES_DIGEST_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of what h is of, and then a run of bytes. */
uint64_t abbe_digest(uint64_t h, const void *data, size_t size);
/* The same for long runs, some times as fast; another number than abbe_digest's. */
uint64_t abbe_digest_long(uint64_t h, const void *data, size_t size);
/* Of an array of `count` elements, and whether there is one: data may be NULL. */
uint64_t abbe_digest_array(uint64_t h, const void *data, size_t count, size_t size);

#ifdef __cplusplus
}
#endif
#endif
