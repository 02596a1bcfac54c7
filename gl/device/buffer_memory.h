/* buffer_memory.h: memory of the process's own for large buffers, where a processor runs the
 * shaders and OpenGL takes such memory (GL_AMD_pinned_memory, as Mesa's llvmpipe does). Internal to
 * gl/.
 *
 * The driver itself clears all of a buffer when it makes it, in one go, and gives its pages back
 * with it: 1.5 ms a MiB on a virtual machine, in which nobody is asked whether work goes on. Here
 * the pages come as they are used, and stay for the next buffer.
 */
#ifndef ABBE_GL_DEVICE_BUFFER_MEMORY_H
#define ABBE_GL_DEVICE_BUFFER_MEMORY_H

#include "gl/device/gpu_store.h"

#define ABBE_MEMORY_LEAST ((size_t)1 << 20)    /* bytes of a buffer that is large */
#define ABBE_MEMORY_UNUSED ((size_t)512 << 20) /* bytes that stay for the next, at the most */
#define ABBE_MEMORY_BLOCKS 48

typedef struct abbe_memory_block {
  void *at; /* NULL: no block */
  size_t size;
  GLuint buffer; /* 0: nobody has it */
} abbe_memory_block;

/* Zeroed: none is lent. */
typedef struct abbe_buffer_memory {
  bool pins; /* OpenGL takes it */
  abbe_memory_block block[ABBE_MEMORY_BLOCKS];
} abbe_buffer_memory;

/* Asks OpenGL; software: what runs the shaders is a processor. */
void abbe_buffer_memory_begin(abbe_buffer_memory *memory, const abbe_gl *gl, bool software);
/* Gives a buffer without storage so many bytes, whatever is in them; it is not bound, and OpenGL's
 * error is left pending where it refuses them. False: it has none, and OpenGL's own will do. */
bool abbe_buffer_memory_lend(abbe_buffer_memory *memory, const abbe_gl *gl, size_t size,
                             GLuint buffer);
/* Takes back what the buffers had that are not in the store any more. It waits for the device where
 * there are any. */
void abbe_buffer_memory_sweep(abbe_buffer_memory *memory, const abbe_gl *gl,
                              const abbe_gpu_store *store);
/* What nobody has goes back to the system. */
void abbe_buffer_memory_shrink(abbe_buffer_memory *memory);
/* So does all; after its buffers. */
void abbe_buffer_memory_free(abbe_buffer_memory *memory);

#endif
