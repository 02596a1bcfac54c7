/* What is put back is taken up by what is made alike, and nothing else; no OpenGL is needed. */
#include "tests/check.h"

#include "gl/device/gpu.h"

static GLuint deleted[8];
static size_t deleted_count;

static void delete_some(GLsizei count, const GLuint *name) {
  for (GLsizei i = 0; i < count; i++) deleted[deleted_count++] = name[i];
}

static void delete_program(GLuint name) {
  deleted[deleted_count++] = name;
}

static const abbe_gl gl = {
    .DeleteBuffers = delete_some, .DeleteTextures = delete_some, .DeleteProgram = delete_program};

static void add(abbe_gpu_store *store, abbe_stored_key key, GLuint name) {
  OK(abbe_gpu_store_add(store, &key, name, &error));
}

static GLuint take(abbe_gpu_store *store, abbe_stored_key key) {
  return abbe_gpu_store_take(store, &key);
}

#define BUFFER(size) ((abbe_stored_key){.kind = ABBE_STORED_BUFFER, .bytes = (size)})
#define TEXTURE(side, count)                                                                       \
  ((abbe_stored_key){.kind = ABBE_STORED_TEXTURE,                                                  \
                     .format = GL_RGBA32F,                                                         \
                     .bytes = 16 * (side) * (side) * (count),                                      \
                     .width = (side),                                                              \
                     .height = (side),                                                             \
                     .layers = (count),                                                            \
                     .levels = 1})
#define PROGRAM(words) ((abbe_stored_key){.kind = ABBE_STORED_PROGRAM, .text = (words)})

TEST(what_is_alike_is_taken_up_once) {
  abbe_gpu_store store = {0};
  assert_int_equal(take(&store, BUFFER(64)), 0);
  add(&store, BUFFER(64), 5);
  assert_int_equal(take(&store, BUFFER(64)), 0); /* in use */
  abbe_gpu_store_put_back(&store, ABBE_STORED_TEXTURE, 5);
  assert_int_equal(take(&store, BUFFER(64)), 0); /* a texture of that name is another thing */
  abbe_gpu_store_put_back(&store, ABBE_STORED_BUFFER, 5);
  assert_int_equal(take(&store, BUFFER(65)), 0);
  assert_int_equal(take(&store, BUFFER(64)), 5);
  assert_int_equal(take(&store, BUFFER(64)), 0);
  add(&store, TEXTURE(8, 1), 5);
  abbe_gpu_store_put_back(&store, ABBE_STORED_TEXTURE, 5);
  assert_int_equal(take(&store, TEXTURE(8, 2)), 0);
  assert_int_equal(take(&store, TEXTURE(8, 1)), 5);
  abbe_gpu_store_free(&store, &gl);
}

/* No room is a power of two or has nothing in bits 8 to 15; large ones are shared, and not much is
 * wasted. */
TEST(rooms_are_of_one_kind) {
  size_t kinds = 0, last = 0;
  for (size_t size = 0; size < (size_t)1 << 28; size += 1 + size / 300) {
    const size_t room = abbe_gpu_store_room(size);
    assert_true(room >= size && room <= size + size / 16 + 768 && room % 4 == 0);
    assert_true((room & (room - 1)) != 0 && (room >> 8 & 255) != 0);
    kinds += size >= 1 << 20 && room != last;
    last = room;
  }
  assert_int_in_range(kinds, 8 * 16, 8 * 16 + 1);
  for (int bit = 0; bit < 28; bit++) {
    const size_t room = abbe_gpu_store_room((size_t)1 << bit);
    assert_true((room & (room - 1)) != 0 && (room >> 8 & 255) != 0);
  }
  assert_int_equal(abbe_gpu_store_room(SIZE_MAX), SIZE_MAX); /* which nobody has */
}

TEST(programs_are_shared_by_their_text) {
  abbe_gpu_store store = {0};
  char text[] = "a.comp\n#define A\n";
  add(&store, PROGRAM(text), 7);
  text[0] = 'b'; /* the store has a copy */
  assert_int_equal(take(&store, PROGRAM("a.comp\n#define A\n")), 7);
  assert_int_equal(take(&store, PROGRAM("a.comp\n#define A\n")), 7);
  assert_int_equal(take(&store, PROGRAM("a.comp\n")), 0);
  assert_int_equal(abbe_gpu_store_count(&store, ABBE_STORED_PROGRAM), 1);
  abbe_gpu_store_free(&store, &gl);
}

TEST(only_what_is_not_in_use_is_deleted) {
  abbe_gpu_store store = {0};
  for (GLuint i = 1; i <= 100; i++) add(&store, BUFFER(i), i);
  assert_int_equal(abbe_gpu_store_bytes(&store), 5050);
  abbe_gpu_store_put_back(&store, ABBE_STORED_BUFFER, 40);
  abbe_gpu_store_put_back(&store, ABBE_STORED_BUFFER, 60);
  assert_int_equal(abbe_gpu_store_bytes(&store), 4950);
  deleted_count = 0;
  abbe_gpu_store_trim(&store, &gl);
  assert_int_equal(deleted_count, 2);
  assert_int_equal(deleted[0] + deleted[1], 100);
  assert_int_equal(abbe_gpu_store_count(&store, ABBE_STORED_BUFFER), 98);
  assert_int_equal(take(&store, BUFFER(40)), 0);
  while (store.count > 3) store.count--; /* the rest were never there */
  deleted_count = 0;
  abbe_gpu_store_free(&store, &gl);
  assert_int_equal(deleted_count, 3);
}
