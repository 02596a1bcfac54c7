/* gpu_store.h: buffers, textures and programs of a device, each with what it was made as, so that
 * what is made again in the same way takes up what was put back. It makes nothing itself. Internal
 * to gl/.
 */
#ifndef ABBE_GL_DEVICE_GPU_STORE_H
#define ABBE_GL_DEVICE_GPU_STORE_H

#include "base/error.h"
#include "gl/device/api.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum abbe_stored_kind {
  ABBE_STORED_BUFFER,
  ABBE_STORED_TEXTURE,
  ABBE_STORED_PROGRAM
} abbe_stored_kind;

/* Of a buffer its bytes; of a texture its format, size, array layers and levels; of a program its
 * text, files and definitions, which the store copies. */
typedef struct abbe_stored_key {
  abbe_stored_kind kind;
  GLenum format;
  size_t bytes, width, height, layers, levels;
  const char *text;
} abbe_stored_key;

typedef struct abbe_stored {
  abbe_stored_key key;
  GLuint name;
  bool used;
} abbe_stored;

typedef struct abbe_gpu_store {
  abbe_stored *item;
  size_t count, room;
} abbe_gpu_store;

/* Bytes to make a buffer with where so many are asked for: large ones in steps of a sixteenth, so
 * that what changes a little takes up what was put back. And no power of two, nor with nothing in
 * the second byte: Mesa 22's llvmpipe takes that byte for levels of a texture, and a power of two
 * for a fact of its own, and compiles what reads texels again where another buffer differs in
 * either. */
size_t abbe_gpu_store_room(size_t bytes);

/* Something that was made so and is not in use, which then is; 0: there is none. A program may be
 * in use several times. */
GLuint abbe_gpu_store_take(abbe_gpu_store *store, const abbe_stored_key *key);
/* What has just been made, and is in use. ABBE_NO_MEMORY; it is the caller's to delete then. */
abbe_result abbe_gpu_store_add(abbe_gpu_store *store, const abbe_stored_key *key, GLuint name,
                               abbe_error *error);
/* Not in use any more; 0 and what the store does not know are left alone. */
void abbe_gpu_store_put_back(abbe_gpu_store *store, abbe_stored_kind kind, GLuint name);

/* Deletes what is not in use. */
void abbe_gpu_store_trim(abbe_gpu_store *store, const abbe_gl *gl);
void abbe_gpu_store_free(abbe_gpu_store *store, const abbe_gl *gl);

/* Bytes of buffers and textures in use. */
size_t abbe_gpu_store_bytes(const abbe_gpu_store *store);
/* Bytes of what there is, in use or not; 0: the store does not know it. */
size_t abbe_gpu_store_bytes_of(const abbe_gpu_store *store, abbe_stored_kind kind, GLuint name);
bool abbe_gpu_store_has(const abbe_gpu_store *store, abbe_stored_kind kind, GLuint name);
/* How many there are of a kind. */
size_t abbe_gpu_store_count(const abbe_gpu_store *store, abbe_stored_kind kind);

#endif
