/* gpu.h: what every pass does with the device: buffers and textures, counted; targets; uniforms;
 * lists whose length stays on the device; the time of a pass. It knows no scene and no pass.
 * Internal to gl/.
 */
#ifndef ABBE_GL_DEVICE_GPU_H
#define ABBE_GL_DEVICE_GPU_H

#include "base/error.h"
#include "gl/device/api.h"
#include "gl/device/program.h"
#include "gl/device/statistics.h"
#include "gl/plan/facts/render_desc.h"

#include <stdbool.h>
#include <stddef.h>

/* Buffers, textures and programs of a device, each with what it was made as, so that what is made
 * again alike takes up what was put back. It makes nothing itself. */

typedef enum abbe_stored_kind {
  ABBE_STORED_BUFFER,
  ABBE_STORED_TEXTURE,
  ABBE_STORED_PROGRAM
} abbe_stored_kind;

/* A buffer's bytes; a texture's format, size, array layers and levels; a program's text, files and
 * definitions, which the store copies. */
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

/* Memory of the process's own for large buffers, where a processor runs the shaders and OpenGL
 * takes such memory (GL_AMD_pinned_memory, as Mesa's llvmpipe does).
 *
 * The driver itself clears all of a buffer when it makes it, in one go, and gives its pages back
 * with it: 1.5 ms a MiB on a virtual machine, during which cancel cannot be polled. Here
 * the pages come as they are used, and stay for the next buffer. */

#define ABBE_MEMORY_LEAST ((size_t)1 << 20)    /* bytes of a buffer that is large */
#define ABBE_MEMORY_UNUSED ((size_t)128 << 20) /* bytes that stay for the next, at the most */
#define ABBE_MEMORY_LARGE ((size_t)64 << 20)   /* of one before which what is unused goes */
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

/* Reads the limits of OpenGL; software: a processor runs the shaders. */
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
/* So do the pages of what the buffer has, which stays and then holds zeros; the device has finished
 * with it. Nothing happens to a buffer of OpenGL's own. */
void abbe_buffer_memory_forget(abbe_buffer_memory *memory, GLuint buffer);
/* So does all; after its buffers. */
void abbe_buffer_memory_free(abbe_buffer_memory *memory);

/* Texture units up to here show buffers through textures of the device's own. */
#define ABBE_GPU_TEXEL_UNITS 6

/* Threads of a group where there is one an element of a list. */
#define ABBE_GPU_GROUP 256

/* Bytes of a list before its elements: how many there are, and the groups of the dispatch that
 * takes them. */
#define ABBE_GPU_LIST_HEADER 16

typedef struct abbe_gpu {
  const abbe_gl *gl;
  bool software; /* what runs the shaders is a processor; whoever makes the struct says so */
  /* groups of a dispatch, where a GPU runs it: its driver may end one that takes seconds */
  size_t most_groups;
  GLuint framebuffer, empty_array;
  size_t target[2];                    /* texels across and up of what is drawn into */
  GLuint list_groups;                  /* program */
  GLuint sampler_states;               /* program; none where a GPU runs them */
  GLuint texels[ABBE_GPU_TEXEL_UNITS]; /* textures that show buffers, one a unit */
  abbe_gpu_store store;
  abbe_buffer_memory memory; /* memory of large buffers in it */
  abbe_statistics
      *statistics; /* statistics of the frame that runs, or NULL: no pass is waited for */
  double lap_start_ms;
  abbe_render_progress progress; /* the caller's progress function; NULL: there is none */
  void *progress_user;
  double done;                   /* the progress reported last */
  bool stopped;                  /* they want no more: nothing is dispatched */
  void (*compiling)(void *user); /* called once, with progress_user, when shaders are compiled */
} abbe_gpu;

/* *out is zero or made before; free it also where this fails. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_gpu_make(const abbe_gl *gl, abbe_gpu *out, abbe_error *error);
void abbe_gpu_free(abbe_gpu *gpu);

/* A storage buffer; data may be NULL: what is in it is then not known. What is made is put back by
 * abbe_gpu_drop_*, and taken up by what is made alike; where memory is short, what is not in use
 * gives way. So of textures. ABBE_GL, also where an older error of OpenGL is pending, which is
 * cleared; ABBE_UNSUPPORTED beyond what shaders reach; ABBE_NO_MEMORY. */
abbe_result abbe_gpu_make_buffer(abbe_gpu *gpu, size_t size, const void *data, GLuint *out,
                                 abbe_error *error);
/* A texture of one level, an array where layers > 0. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_gpu_make_texture(abbe_gpu *gpu, GLenum format, size_t width, size_t height,
                                  size_t layers, bool linear, GLuint *out, abbe_error *error);
/* A square array with levels, trilinear. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_gpu_make_levels(abbe_gpu *gpu, GLenum format, size_t side, size_t layers,
                                 size_t levels, GLuint *out, abbe_error *error);
/* Back to the device's store; each becomes 0, those that are 0 are left alone. */
void abbe_gpu_drop_buffers(abbe_gpu *gpu, size_t count, GLuint *buffer);
void abbe_gpu_drop_textures(abbe_gpu *gpu, size_t count, GLuint *texture);
/* Deletes what was dropped and not taken up since. */
void abbe_gpu_trim(abbe_gpu *gpu);
/* Frees at once what is not in use, where memory was short: the device has let go of it then.
 * Texels are bound anew. */
void abbe_gpu_make_way(abbe_gpu *gpu);
/* Bytes of buffers and textures in use. */
size_t abbe_gpu_bytes(const abbe_gpu *gpu);

/* Programs, which are the device's: the same stages and definitions are compiled once. Uniforms
 * keep what another user has set. Errors as of abbe_program_make; ABBE_CANCELLED by whoever
 * watches, who is asked before one is compiled. More than ABBE_GPU_MOST_PROGRAMS are many: who
 * makes all programs anew drops them before. */
#define ABBE_GPU_MOST_PROGRAMS 200
size_t abbe_gpu_program_count(const abbe_gpu *gpu);
/* Those of all users. */
void abbe_gpu_drop_programs(abbe_gpu *gpu);
abbe_result abbe_gpu_program(abbe_gpu *gpu, const abbe_program_stage *stages, size_t count,
                             const char *defines, GLuint *out, abbe_error *error);
abbe_result abbe_gpu_compute(abbe_gpu *gpu, const char *file, const char *defines, GLuint *out,
                             abbe_error *error);

/* A buffer of `size` bytes that shaders read as texels of `format`, and its texture, at a unit of
 * its own; what *buffer was is dropped, *texture is made where it is 0. ABBE_GL. */
abbe_result abbe_gpu_make_texels(abbe_gpu *gpu, GLenum format, size_t size, const void *data,
                                 int unit, GLuint *buffer, GLuint *texture, abbe_error *error);

/* Draws into these from now on. A layer of -1 attaches the whole texture: a 2D one, or every layer
 * of an array. count at most 4, depth may be 0. ABBE_GL. */
abbe_result abbe_gpu_set_target(abbe_gpu *gpu, const GLuint *colour, const int *layer, size_t count,
                                GLuint depth, size_t width, size_t height, abbe_error *error);

/* Depths of abbe_view_reversed_matrix, of which the greatest is nearest, or their opposite again,
 * as outside of these two. The target's are cleared where nothing is drawn. */
void abbe_gpu_begin_depths(abbe_gpu *gpu, bool clears);
void abbe_gpu_end_depths(abbe_gpu *gpu);

/* Into the program that is in use; a name that it does not have is left out. */
void abbe_gpu_set_int(abbe_gpu *gpu, GLuint program, const char *name, int value);
void abbe_gpu_set_uint(abbe_gpu *gpu, GLuint program, const char *name, size_t value);
void abbe_gpu_set_float(abbe_gpu *gpu, GLuint program, const char *name, double value);
/* A texture array; a 2D texture; a buffer whose elements are texels, at a unit below
 * ABBE_GPU_TEXEL_UNITS. */
void abbe_gpu_bind_array(abbe_gpu *gpu, GLuint program, const char *name, int unit, GLuint texture);
void abbe_gpu_bind_texture(abbe_gpu *gpu, GLuint program, const char *name, int unit,
                           GLuint texture);
void abbe_gpu_bind_texels(abbe_gpu *gpu, GLuint program, const char *name, int unit, GLenum format,
                          GLuint buffer);
void abbe_gpu_bind_storage(abbe_gpu *gpu, GLuint binding, GLuint buffer);

/* All words to zero. */
void abbe_gpu_clear_buffer(abbe_gpu *gpu, GLuint buffer);
/* Empties a list. */
void abbe_gpu_clear_list(abbe_gpu *gpu, GLuint list);
/* A list has so many elements now, and no groups. */
void abbe_gpu_set_list(abbe_gpu *gpu, GLuint list, size_t count);
/* So many bytes from one buffer to another. */
void abbe_gpu_copy(abbe_gpu *gpu, GLuint from, size_t from_byte, GLuint to, size_t to_byte,
                   size_t bytes);
/* Buffers that the processor's threads read and write where they are. */
typedef struct abbe_gpu_maps {
  const abbe_gl *gl;
  GLuint buffer[16];
  size_t count;
  bool whole; /* all that were asked for are there; true at first */
} abbe_gpu_maps;

/* A whole buffer, which the device has done with; NULL: it cannot be had. */
void *abbe_gpu_map(abbe_gpu_maps *maps, GLuint buffer, GLbitfield access);
void abbe_gpu_unmap(abbe_gpu_maps *maps);

/* Waits for the device: elements of a list, also beyond its capacity. */
size_t abbe_gpu_read_count(abbe_gpu *gpu, GLuint list);

/* From now on somebody watches, or nobody (progress is NULL): work is then done in parts of some
 * milliseconds, and between them they are asked whether it goes on. It waits for the device. */
void abbe_gpu_watch(abbe_gpu *gpu, abbe_render_progress progress, void *user);
/* Reports the share that is done, 0 to 1. ABBE_CANCELLED where the caller has cancelled. */
abbe_result abbe_gpu_tell(abbe_gpu *gpu, double done, abbe_error *error);
/* Polls for cancel, where there is a progress function; whether the work goes on. */
bool abbe_gpu_ask(abbe_gpu *gpu);

/* How many units of work the next part has where somebody watches, at least 1, after one of so many
 * has taken so long. */
size_t abbe_gpu_next_part(size_t units, double ms);

/* Dispatches the program that is in use, whose shader takes its number from thread.glsl: so many
 * groups of ABBE_GPU_GROUP threads; one thread a texel, in groups of 32 x 16. */
void abbe_gpu_dispatch(abbe_gpu *gpu, GLuint program, size_t groups);
void abbe_gpu_dispatch_2d(abbe_gpu *gpu, GLuint program, size_t width, size_t height);
/* So many threads for each of `most` elements of a list from the first on, as far as there are any;
 * the program is set up by then. */
void abbe_gpu_dispatch_list(abbe_gpu *gpu, GLuint program, GLuint list, size_t first, size_t most,
                            size_t threads);
/* The groups that stand in the list's words 1 to 3, as another program has written them for at most
 * so many elements, with a thread each. */
void abbe_gpu_dispatch_counted(abbe_gpu *gpu, GLuint program, GLuint list, size_t most);

/* Draws of the program that is in use, which a GPU gets in parts of no more fragments, or vertices,
 * than a dispatch has threads: a triangle over the whole target, in bands of rows; so many things
 * of some vertices each, without buffers. */
void abbe_gpu_draw_screen(abbe_gpu *gpu);
void abbe_gpu_draw_things(abbe_gpu *gpu, GLenum mode, size_t count, size_t vertices);
/* That many, SIZE_MAX where it is no GPU. */
size_t abbe_gpu_most_threads(const abbe_gpu *gpu);

/* Before a program that reads buffers as texels. Such a sampler has no filter of its own: Mesa
 * leaves there that of the texture which another program had at its place, and llvmpipe compiles a
 * program once more for each that it finds. This puts one and the same there. No program is in use
 * then. */
void abbe_gpu_forget_samplers(abbe_gpu *gpu);

/* The clock of passes, in a frame with statistics: a lap starts; what was done since is booked to a
 * pass, and the next lap starts. Several laps of one pass add up. */
void abbe_gpu_start_lap(abbe_gpu *gpu);
void abbe_gpu_book_lap(abbe_gpu *gpu, abbe_pass pass);

#endif
