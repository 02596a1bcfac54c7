/* edits.h: a whole file with a hash at its end, FNV-1a of all before it, and what inputs make of
 * it.
 *
 * Input: a byte of choices, then edits of four bytes each: where (two, from the end if the choice 1
 * is set), what to do (0 flips bits, 1 cuts there, 2 repeats from there), and the bits. Choice 2
 * hashes the file anew, so that what is behind the hash is met as well; choice 4 takes the input
 * itself as the file.
 */
#ifndef ABBE_TESTS_FUZZ_EDITS_H
#define ABBE_TESTS_FUZZ_EDITS_H

#include "tests/fuzz/fuzz.h"

#include <stdbool.h>
#include <string.h>
#include <unistd.h>

enum { EDITS_MOST = 1 << 16 };

typedef struct edited {
  uint8_t whole[EDITS_MOST], file[2 * EDITS_MOST];
  size_t whole_size, size;
} edited;

/* Takes the file at path, which is removed. */
static inline void edits_begin(edited *e, const char *path) {
  FILE *from = fopen(path, "rb");
  FUZZ_PROMISE(from != NULL);
  e->whole_size = fread(e->whole, 1, sizeof e->whole, from);
  fclose(from);
  unlink(path);
  FUZZ_PROMISE(e->whole_size > 100 && e->whole_size < EDITS_MOST);
}

static inline void edits_apply(edited *e, const uint8_t *data, size_t size, bool from_end) {
  e->size = e->whole_size;
  memcpy(e->file, e->whole, e->size);
  for (; size >= 4 && e->size > 0; data += 4, size -= 4) {
    size_t at = ((size_t)data[0] | (size_t)data[1] << 8) % e->size;
    if (from_end) at = e->size - 1 - at;
    if (data[2] % 4 == 1) e->size = at;
    if (data[2] % 4 == 2 && e->size + (e->size - at) <= EDITS_MOST) {
      memcpy(e->file + e->size, e->file + at, e->size - at);
      e->size += e->size - at;
    }
    if (data[2] % 4 == 0 || data[2] % 4 == 3) e->file[at] ^= data[3];
  }
}

static inline void edits_hash(edited *e) {
  uint64_t h = 14695981039346656037u;
  if (e->size < sizeof h) return;
  for (size_t i = 0; i < e->size - sizeof h; i++) h = (h ^ e->file[i]) * 1099511628211u;
  memcpy(e->file + e->size - sizeof h, &h, sizeof h);
}

/* What the input makes of it, size bytes of e->file. */
static inline void edits_make(edited *e, const uint8_t *data, size_t size) {
  e->size = size - 1;
  if ((data[0] & 4) != 0 && e->size <= EDITS_MOST)
    memcpy(e->file, data + 1, e->size);
  else
    edits_apply(e, data + 1, size - 1, (data[0] & 1) != 0);
  if ((data[0] & 2) != 0) edits_hash(e);
}

static inline bool edits_changed(const edited *e) {
  return e->size != e->whole_size || memcmp(e->file, e->whole, e->size) != 0;
}

#endif
