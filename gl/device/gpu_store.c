#include "gl/device/gpu.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
