/* A device with a limit of bytes: a real one, whose allocations beyond the limit fail as
 * GL_OUT_OF_MEMORY says. What a change makes anew need not fit beside what was there before. */
#include "tests/gl/frame.h"

#include "gl/device/context_backend.h"
#include "gl/scene/gpu_scene.h"

enum { MOST_THINGS = 4096 };

/* Buffers and textures that hold storage, by their name and kind. */
static struct {
  GLuint name;
  bool texture;
  size_t bytes;
} held[MOST_THINGS];
static size_t held_count, held_bytes, most_bytes; /* most_bytes: the limit; 0: none */
static GLenum pending;                            /* an error, or none */
static GLenum fault;                              /* of every allocation, or none */
static size_t takes;                              /* allocations that were tried */
static GLuint bound_buffer, bound_texture;

static abbe_gl_lookup real_lookup;
static abbe_gl real;

static void drop(bool texture, GLuint name) {
  for (size_t i = 0; i < held_count; i++) {
    if (held[i].texture != texture || held[i].name != name) continue;
    held_bytes -= held[i].bytes;
    held[i] = held[--held_count];
    return;
  }
}

static bool take(bool texture, GLuint name, size_t bytes) {
  drop(texture, name);
  takes++;
  GLenum error = fault;
  if (most_bytes > 0 && held_bytes + bytes > most_bytes) error = GL_OUT_OF_MEMORY;
  if (pending == GL_NO_ERROR) pending = error; /* the first one stays, as in OpenGL */
  if (error != GL_NO_ERROR) return false;
  assert_true(held_count < MOST_THINGS);
  held[held_count].name = name;
  held[held_count].texture = texture;
  held[held_count++].bytes = bytes;
  held_bytes += bytes;
  return true;
}

static void bind_buffer(GLenum target, GLuint name) {
  bound_buffer = name;
  real.BindBuffer(target, name);
}

static void bind_texture(GLenum target, GLuint name) {
  bound_texture = name;
  real.BindTexture(target, name);
}

static void buffer_data(GLenum target, GLsizeiptr size, const void *data, GLenum usage) {
  if (take(false, bound_buffer, (size_t)size)) real.BufferData(target, size, data, usage);
}

/* Of a format of sixteen bytes, which most are, and of its first level. */
static void storage_2d(GLenum target, GLsizei levels, GLenum format, GLsizei width,
                       GLsizei height) {
  if (take(true, bound_texture, (size_t)width * (size_t)height * 16))
    real.TexStorage2D(target, levels, format, width, height);
}

static void storage_3d(GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height,
                       GLsizei depth) {
  if (take(true, bound_texture, (size_t)width * (size_t)height * (size_t)depth * 16))
    real.TexStorage3D(target, levels, format, width, height, depth);
}

static void delete_buffers(GLsizei count, const GLuint *names) {
  for (GLsizei i = 0; i < count; i++) drop(false, names[i]);
  real.DeleteBuffers(count, names);
}

static void delete_textures(GLsizei count, const GLuint *names) {
  for (GLsizei i = 0; i < count; i++) drop(true, names[i]);
  real.DeleteTextures(count, names);
}

static GLenum get_error(void) {
  const GLenum error = pending != GL_NO_ERROR ? pending : real.GetError();
  pending = GL_NO_ERROR;
  return error;
}

static abbe_gl_function lookup(const char *name) {
#define STANDS_FOR(gl_name, function)                                                              \
  if (strcmp(name, gl_name) == 0) return (abbe_gl_function)(function);
  STANDS_FOR("glBindBuffer", bind_buffer)
  STANDS_FOR("glBindTexture", bind_texture)
  STANDS_FOR("glBufferData", buffer_data)
  STANDS_FOR("glTexStorage2D", storage_2d)
  STANDS_FOR("glTexStorage3D", storage_3d)
  STANDS_FOR("glDeleteBuffers", delete_buffers)
  STANDS_FOR("glDeleteTextures", delete_textures)
  STANDS_FOR("glGetError", get_error)
#undef STANDS_FOR
  return real_lookup(name);
}

abbe_result __real_abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                                    abbe_error *error);
abbe_result __wrap_abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                                    abbe_error *error);
abbe_result __wrap_abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                                    abbe_error *error) {
  abbe_result result = __real_abbe_context_egl(software, device, out, error);
  real_lookup = out->lookup;
  if (result == ABBE_OK) result = abbe_gl_load(real_lookup, &real, error);
  out->lookup = lookup;
  return result;
}

static const abbe_render_desc before = {
    .width = 32, .height = 32, .photons = 96, .map_size = 640, .wavelengths = 21};

static const char text[] = CAMERA POINT_LIGHT FLOOR BRICK("crown");

static abbe_image drawn(abbe_renderer *renderer) {
  draw_frame(renderer);
  return picture_of(renderer);
}

static void draw_as_made_anew(abbe_renderer *renderer, const abbe_scene *scene,
                              const abbe_render_desc *desc) {
  OWNED(abbe_image, kept) = drawn(renderer);
  most_bytes = 0;
  HELD(abbe_renderer, other) = make_renderer(scene, desc);
  OWNED(abbe_image, anew) = drawn(other);
  assert_same_pixels(&kept, &anew);
}

GROUP(make_context, free_context);

/* Another size of everything, within an eighth more than what it was. */
TEST(a_change_needs_no_room_for_both) {
  OWNED(abbe_scene, scene) = scene_of(text);
  abbe_renderer *renderer = drawn_renderer(&scene, &before);
  const size_t needs = held_bytes;
  abbe_render_desc after = before;
  after.photons = 98;
  after.map_size = 644;
  after.width = after.height = 33;
  most_bytes = needs + needs / 8;
  OK(abbe_renderer_change(renderer, &scene, &after, &error));
  print_message("%zu KiB before, %zu KiB after\n", needs >> 10, held_bytes >> 10);
  draw_as_made_anew(renderer, &scene, &after);
  abbe_renderer_free(renderer);
  assert_int_equal(held_bytes, 0);
}

/* So of a mesh, which is uploaded before the light's buffers are made. */
TEST(a_larger_mesh_needs_no_room_beside_them) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  OWNED(abbe_scene, finer) = scene_of(CAMERA POINT_LIGHT FLOOR
                                      "- {name: ball, shape: sphere, radius: 0.08, levels: 6, "
                                      "transform: [{translate: [0, 0, 0.2]}], material: crown}\n");
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &before);
  const size_t mesh = finer.object[1].mesh.face_count * sizeof *finer.object[1].mesh.face;
  abbe_render_desc after = before;
  after.map_size = 512;
  most_bytes = held_bytes + mesh / 2;
  OK(abbe_renderer_change(renderer, &finer, &after, &error));
  draw_as_made_anew(renderer, &finer, &after);
}

/* What does not fit at all is refused, and a smaller change goes on from there. */
TEST(what_does_not_fit_is_refused) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &before);
  abbe_render_desc large = before;
  large.map_size = 1600;
  most_bytes = held_bytes + held_bytes / 8;
  REFUSED(ABBE_NO_MEMORY, "out of memory", abbe_renderer_change(renderer, &scene, &large, &error));
  assert_int_equal(abbe_renderer_frame(renderer, NULL, NULL, NULL, NULL), ABBE_INVALID_ARGUMENT);
  OK(abbe_renderer_change(renderer, &scene, &before, &error));
  draw_as_made_anew(renderer, &scene, &before);
}

enum { BUFFER, TEXTURE, LEVELS, MESHES, KINDS, UNUSED_BYTES = 1 << 20 };

/* As by a renderer, of a size that nothing else has. */
static abbe_result allocate(abbe_gpu_scene *scene, int kind, GLuint *out, abbe_error *error) {
  abbe_gpu *gpu = scene->gpu;
  switch (kind) {
  case BUFFER:
    return abbe_gpu_make_buffer(gpu, 77, NULL, out, error);
  case TEXTURE:
    return abbe_gpu_make_texture(gpu, GL_RGBA32F, 7, 11, 0, false, out, error);
  case LEVELS:
    return abbe_gpu_make_levels(gpu, GL_RGBA32F, 16, 3, 2, out, error);
  default:
    return abbe_gpu_meshes_upload(scene, error);
  }
}

static void give_back(abbe_gpu_scene *scene, int kind, GLuint *out) {
  if (kind == BUFFER) abbe_gpu_drop_buffers(scene->gpu, 1, out);
  if (kind == TEXTURE || kind == LEVELS) abbe_gpu_drop_textures(scene->gpu, 1, out);
  abbe_gpu_meshes_free(scene);
}

/* What is not in use gives way to what has no room, and to no other error: neither to one of the
 * allocation itself nor to one that was pending before it, which is told as it is. */
TEST(only_a_lack_of_memory_is_tried_again) {
  abbe_error why = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  OK(abbe_context_make_current(context, &error));
  MADE(abbe_gpu, gpu, abbe_gpu_make(abbe_context_gl(context), &gpu, &error));
  abbe_gpu_scene on = {.gpu = &gpu, .local = &scene};
  for (int kind = 0; kind < KINDS; kind++) {
    static const GLenum codes[] = {GL_INVALID_OPERATION, GL_OUT_OF_MEMORY};
    GLuint unused = 0, out = 0;
    OK(abbe_gpu_make_buffer(&gpu, UNUSED_BYTES, NULL, &unused, &error));
    const GLuint name = unused;
    abbe_gpu_drop_buffers(&gpu, 1, &unused);

    for (int k = 0; k < 2; k++) {
      pending = codes[k];
      takes = 0;
      assert_int_equal(allocate(&on, kind, &out, &why), k == 0 ? ABBE_GL : ABBE_NO_MEMORY);
      assert_contains(why.text, "what came before");
      assert_int_equal(takes, 0);
      give_back(&on, kind, &out);
    }
    takes = 0;
    fault = GL_INVALID_VALUE;
    REFUSED(ABBE_GL, "invalid value", allocate(&on, kind, &out, &error));
    assert_int_equal(takes, kind == MESHES ? 2 : 1); /* of a mesh: vertices and faces */
    fault = GL_NO_ERROR;
    give_back(&on, kind, &out);
    OK(abbe_gpu_make_buffer(&gpu, UNUSED_BYTES, NULL, &unused, &error));
    assert_int_equal(unused, name); /* it is still there */
    abbe_gpu_drop_buffers(&gpu, 1, &unused);

    const size_t with_unused = most_bytes = held_bytes;
    OK(allocate(&on, kind, &out, &error));
    assert_true(held_bytes < with_unused);
    most_bytes = 0;
    give_back(&on, kind, &out);
    abbe_gpu_trim(&gpu);
  }
}
