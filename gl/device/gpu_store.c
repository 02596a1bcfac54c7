#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "gl/device/gpu.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define EXTERNAL_VIRTUAL_MEMORY 0x9160 /* a value of GL_AMD_pinned_memory */

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
static abbe_memory_block *find_block(abbe_buffer_memory *memory, size_t size) {
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
  abbe_memory_block *b = find_block(memory, room);
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

void abbe_buffer_memory_forget(abbe_buffer_memory *memory, GLuint buffer) {
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS && buffer != 0; i++) {
    const abbe_memory_block *b = &memory->block[i];
    if (b->buffer == buffer) madvise(b->at, b->size, MADV_DONTNEED);
  }
}

void abbe_buffer_memory_free(abbe_buffer_memory *memory) {
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++)
    if (memory->block[i].at != NULL) give_back(&memory->block[i]);
  *memory = (abbe_buffer_memory){0};
}

static bool same(const abbe_stored_key *a, const abbe_stored_key *b) {
  if (a->kind != b->kind) return false;
  if (a->kind == ABBE_STORED_PROGRAM) return strcmp(a->text, b->text) == 0;
  return a->format == b->format && a->bytes == b->bytes && a->width == b->width &&
         a->height == b->height && a->layers == b->layers && a->levels == b->levels;
}

size_t abbe_gpu_store_room(size_t bytes) {
  enum { LARGE = 1 << 20, STEPS = 16, MORE = 256 };
  size_t power = LARGE;
  while (power <= bytes / 2) power *= 2;
  const size_t step = bytes >= LARGE ? power / STEPS : 4;
  if (bytes > SIZE_MAX - step - 2 * MORE) return bytes;
  size_t room = (bytes + step - 1) / step * step;
  while ((room & (room - 1)) == 0 || (room >> 8 & 255) == 0) room += MORE;
  return room;
}

GLuint abbe_gpu_store_take(abbe_gpu_store *store, const abbe_stored_key *key) {
  for (size_t i = 0; i < store->count; i++) {
    abbe_stored *item = &store->item[i];
    if ((item->used && key->kind != ABBE_STORED_PROGRAM) || !same(&item->key, key)) continue;
    item->used = true;
    return item->name;
  }
  return 0;
}

abbe_result abbe_gpu_store_add(abbe_gpu_store *store, const abbe_stored_key *key, GLuint name,
                               abbe_error *error) {
  abbe_stored item = {.key = *key, .name = name, .used = true};
  if (store->count == store->room) {
    const size_t room = 2 * store->room + 64;
    abbe_stored *grown = realloc(store->item, room * sizeof *grown);
    if (grown == NULL)
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to keep what is made");
    store->item = grown;
    store->room = room;
  }
  if (key->text != NULL && (item.key.text = strdup(key->text)) == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to keep a shader");
  store->item[store->count++] = item;
  return ABBE_OK;
}

void abbe_gpu_store_put_back(abbe_gpu_store *store, abbe_stored_kind kind, GLuint name) {
  for (size_t i = 0; i < store->count; i++)
    if (store->item[i].key.kind == kind && store->item[i].name == name) store->item[i].used = false;
}

static void delete_item(abbe_stored *item, const abbe_gl *gl) {
  if (item->key.kind == ABBE_STORED_BUFFER) gl->DeleteBuffers(1, &item->name);
  if (item->key.kind == ABBE_STORED_TEXTURE) gl->DeleteTextures(1, &item->name);
  if (item->key.kind == ABBE_STORED_PROGRAM) gl->DeleteProgram(item->name);
  free((char *)item->key.text);
}

void abbe_gpu_store_trim(abbe_gpu_store *store, const abbe_gl *gl) {
  size_t kept = 0;
  for (size_t i = 0; i < store->count; i++) {
    if (store->item[i].used)
      store->item[kept++] = store->item[i];
    else
      delete_item(&store->item[i], gl);
  }
  store->count = kept;
}

void abbe_gpu_store_free(abbe_gpu_store *store, const abbe_gl *gl) {
  for (size_t i = 0; i < store->count; i++) delete_item(&store->item[i], gl);
  free(store->item);
  *store = (abbe_gpu_store){0};
}

size_t abbe_gpu_store_bytes(const abbe_gpu_store *store) {
  size_t bytes = 0;
  for (size_t i = 0; i < store->count; i++)
    if (store->item[i].used) bytes += store->item[i].key.bytes;
  return bytes;
}

static const abbe_stored *find(const abbe_gpu_store *store, abbe_stored_kind kind, GLuint name) {
  for (size_t i = 0; i < store->count; i++)
    if (store->item[i].key.kind == kind && store->item[i].name == name) return &store->item[i];
  return NULL;
}

size_t abbe_gpu_store_bytes_of(const abbe_gpu_store *store, abbe_stored_kind kind, GLuint name) {
  const abbe_stored *item = find(store, kind, name);
  return item != NULL ? item->key.bytes : 0;
}

bool abbe_gpu_store_has(const abbe_gpu_store *store, abbe_stored_kind kind, GLuint name) {
  return find(store, kind, name) != NULL;
}

size_t abbe_gpu_store_count(const abbe_gpu_store *store, abbe_stored_kind kind) {
  size_t count = 0;
  for (size_t i = 0; i < store->count; i++) count += store->item[i].key.kind == kind;
  return count;
}

void *abbe_gpu_map(abbe_gpu_maps *maps, GLuint buffer, GLbitfield access) {
  GLint size = 0;
  maps->gl->BindBuffer(GL_COPY_READ_BUFFER, buffer);
  maps->gl->GetBufferParameteriv(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
  void *at = maps->gl->MapBufferRange(GL_COPY_READ_BUFFER, 0, size, access);
  if (at != NULL) maps->buffer[maps->count++] = buffer;
  maps->whole = maps->whole && at != NULL;
  return at;
}

void abbe_gpu_unmap(abbe_gpu_maps *maps) {
  for (size_t i = 0; i < maps->count; i++) {
    maps->gl->BindBuffer(GL_COPY_READ_BUFFER, maps->buffer[i]);
    maps->gl->UnmapBuffer(GL_COPY_READ_BUFFER);
  }
  maps->count = 0;
}
