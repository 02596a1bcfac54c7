#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "gl/device/gpu.h"

#include <string.h>
#include <sys/mman.h>

#define EXTERNAL_VIRTUAL_MEMORY 0x9160 /* of GL_AMD_pinned_memory */

/* Readers of texels take some more than they use. */
enum { BEYOND = 4096, GRAIN = 65536 };

static size_t rounded(size_t size) {
  return (size + BEYOND + GRAIN - 1) / GRAIN * GRAIN;
}

void abbe_buffer_memory_begin(abbe_buffer_memory *memory, const abbe_gl *gl, bool software) {
  GLint count = 0;
  memory->pins = false;
  if (!software) return;
  gl->GetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count && !memory->pins; i++) {
    const char *name = (const char *)gl->GetStringi(GL_EXTENSIONS, (GLuint)i);
    memory->pins = name != NULL && strcmp(name, "GL_AMD_pinned_memory") == 0;
  }
}

/* The smallest free block that holds so much and is not far too large, else a place for a new one;
 * NULL: there is neither. */
static abbe_memory_block *find(abbe_buffer_memory *memory, size_t size) {
  abbe_memory_block *best = NULL, *empty = NULL;
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++) {
    abbe_memory_block *b = &memory->block[i];
    if (b->at == NULL) empty = b;
    const bool serves = b->at != NULL && b->buffer == 0 && b->size >= size && b->size / 2 <= size;
    if (serves && (best == NULL || b->size < best->size)) best = b;
  }
  return best != NULL ? best : empty;
}

bool abbe_buffer_memory_lend(abbe_buffer_memory *memory, const abbe_gl *gl, size_t size,
                             GLuint buffer) {
  if (!memory->pins || size < ABBE_MEMORY_LEAST || size > SIZE_MAX / 2) return false;
  const size_t room = rounded(size);
  abbe_memory_block *b = find(memory, room);
  if (b == NULL) return false;
  if (b->at == NULL) {
    void *at = mmap(NULL, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) return false;
    *b = (abbe_memory_block){.at = at, .size = room};
  }
  gl->BindBuffer(EXTERNAL_VIRTUAL_MEMORY, buffer);
  gl->BufferData(EXTERNAL_VIRTUAL_MEMORY, (GLsizeiptr)size, b->at, GL_DYNAMIC_COPY);
  gl->BindBuffer(EXTERNAL_VIRTUAL_MEMORY, 0);
  b->buffer = buffer;
  return true;
}

static void give_back(abbe_memory_block *b) {
  munmap(b->at, b->size);
  *b = (abbe_memory_block){0};
}

void abbe_buffer_memory_sweep(abbe_buffer_memory *memory, const abbe_gl *gl,
                              const abbe_gpu_store *store) {
  size_t unused = 0;
  bool waited = false;
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++)
    if (memory->block[i].buffer == 0) unused += memory->block[i].size;
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++) {
    abbe_memory_block *b = &memory->block[i];
    if (b->buffer == 0 || abbe_gpu_store_has(store, ABBE_STORED_BUFFER, b->buffer)) continue;
    if (!waited) gl->Finish(); /* what was dispatched may use it still */
    waited = true;
    b->buffer = 0;
    unused += b->size;
    if (unused <= ABBE_MEMORY_UNUSED) continue;
    unused -= b->size;
    give_back(b);
  }
}

void abbe_buffer_memory_shrink(abbe_buffer_memory *memory) {
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++)
    if (memory->block[i].at != NULL && memory->block[i].buffer == 0) give_back(&memory->block[i]);
}

void abbe_buffer_memory_free(abbe_buffer_memory *memory) {
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++)
    if (memory->block[i].at != NULL) give_back(&memory->block[i]);
  *memory = (abbe_buffer_memory){0};
}
