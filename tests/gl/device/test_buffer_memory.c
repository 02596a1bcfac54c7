/* Memory for large buffers is lent, taken back and lent again; no OpenGL is needed. */
#include "tests/check.h"

#include "gl/device/gpu.h"

static const char *extension;
static const void *given;
static size_t waits;

static void get_integer(GLenum name, GLint *out) {
  *out = name == GL_NUM_EXTENSIONS ? 2 : 0;
}

static const GLubyte *get_string(GLenum name, GLuint i) {
  return (const GLubyte *)(name == GL_EXTENSIONS && i == 1 ? extension : "GL_EXT_else");
}

static void bind_buffer(GLenum target, GLuint buffer) {
  (void)target;
  (void)buffer;
}

static void buffer_data(GLenum target, GLsizeiptr size, const void *data, GLenum usage) {
  (void)target;
  (void)size;
  (void)usage;
  given = data;
}

static void finish(void) {
  waits++;
}

static const abbe_gl gl =
    FIELDS(.GetIntegerv = get_integer, .GetStringi = get_string, .BindBuffer = bind_buffer,
           .BufferData = buffer_data, .Finish = finish);

static abbe_buffer_memory begun(const char *name, bool software) {
  abbe_buffer_memory m = {0};
  extension = name;
  abbe_buffer_memory_begin(&m, &gl, software);
  return m;
}

static void add(abbe_gpu_store *store, GLuint name, size_t bytes) {
  const abbe_stored_key key = {.kind = ABBE_STORED_BUFFER, .bytes = bytes};
  OK(abbe_gpu_store_add(store, &key, name, &error));
}

TEST(nothing_is_lent_where_it_does_not_serve) {
  abbe_buffer_memory without = begun("GL_EXT_other", true),
                     gpu = begun("GL_AMD_pinned_memory", false);
  assert_false(abbe_buffer_memory_lend(&without, &gl, ABBE_MEMORY_LEAST, 1));
  assert_false(abbe_buffer_memory_lend(&gpu, &gl, ABBE_MEMORY_LEAST, 1));
  OWNED(abbe_buffer_memory, m) = begun("GL_AMD_pinned_memory", true);
  assert_false(abbe_buffer_memory_lend(&m, &gl, ABBE_MEMORY_LEAST - 1, 1));
  assert_false(abbe_buffer_memory_lend(&m, &gl, SIZE_MAX, 1));
}

TEST(what_comes_back_is_lent_again) {
  const size_t size = 3 * ABBE_MEMORY_LEAST + 5;
  abbe_buffer_memory m = begun("GL_AMD_pinned_memory", true);
  abbe_gpu_store store = {0};
  assert_true(abbe_buffer_memory_lend(&m, &gl, size, 7));
  const void *first = given;
  assert_int_equal((size_t)first % 4096, 0);
  memset((void *)(size_t)first, 1, size + 4096); /* and some beyond */
  abbe_buffer_memory_forget(&m, 8);              /* nobody's */
  assert_int_equal(*(const char *)first, 1);
  abbe_buffer_memory_forget(&m, 7);
  assert_int_equal(*(const char *)first, 0);
  add(&store, 7, size);
  waits = 0;
  abbe_buffer_memory_sweep(&m, &gl, &store); /* it is in use */
  assert_int_equal(waits, 0);
  assert_true(abbe_buffer_memory_lend(&m, &gl, size, 8));
  assert_ptr_not_equal(given, first);
  abbe_gpu_store_put_back(&store, ABBE_STORED_BUFFER, 7);
  assert_true(abbe_gpu_store_has(&store, ABBE_STORED_BUFFER, 7)); /* until it is deleted */
  assert_int_equal(abbe_gpu_store_bytes_of(&store, ABBE_STORED_BUFFER, 7), size);
  abbe_gpu_store none = {0};
  add(&none, 8, size);
  abbe_buffer_memory_sweep(&m, &gl, &none);
  assert_int_equal(waits, 1);
  assert_true(abbe_buffer_memory_lend(&m, &gl, size - 100000, 9));
  assert_ptr_equal(given, first);
  abbe_buffer_memory_sweep(&m, &gl, &none);                             /* 9 is gone */
  assert_true(abbe_buffer_memory_lend(&m, &gl, ABBE_MEMORY_LEAST, 10)); /* far smaller */
  assert_ptr_not_equal(given, first);
  abbe_buffer_memory_shrink(&m);
  size_t blocks = 0;
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++) blocks += m.block[i].at != NULL;
  assert_int_equal(blocks, 2); /* of 8 and 10 */
  abbe_buffer_memory_free(&m);
  static const abbe_gl deletes_nothing;
  store.count = none.count = 0; /* there is no OpenGL to delete with */
  abbe_gpu_store_free(&store, &deletes_nothing);
  abbe_gpu_store_free(&none, &deletes_nothing);
}

/* More than stays goes back; untouched pages are no memory. */
TEST(little_is_kept) {
  const size_t size = ABBE_MEMORY_UNUSED / 2;
  OWNED(abbe_buffer_memory, m) = begun("GL_AMD_pinned_memory", true);
  const abbe_gpu_store none = {0};
  for (GLuint i = 1; i <= 3; i++) assert_true(abbe_buffer_memory_lend(&m, &gl, size, i));
  abbe_buffer_memory_sweep(&m, &gl, &none);
  size_t kept = 0;
  for (size_t i = 0; i < ABBE_MEMORY_BLOCKS; i++) kept += m.block[i].size;
  assert_true(kept > 0 && kept <= ABBE_MEMORY_UNUSED);
}
