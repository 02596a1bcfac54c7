#include "gl/eye/picture.h"

#include "gl/device/bindings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const abbe_render_desc *desc_of(const abbe_picture *picture) {
  return &picture->receivers->lighting->scene->plan->desc;
}

/* From samples to more pixels. */
static bool enlarges(const abbe_picture *picture) {
  const abbe_render_desc *desc = desc_of(picture);
  return desc->upsample > 1 && desc->coarse == ABBE_COARSE_NONE;
}

void abbe_picture_size(const abbe_picture *picture, size_t out[2]) {
  const abbe_render_desc *desc = desc_of(picture);
  const bool as_sampled = desc->coarse != ABBE_COARSE_NONE && desc->supersample == 1;
  const size_t *samples = picture->receivers->lighting->camera->samples;
  out[0] = as_sampled ? samples[0] : desc->width;
  out[1] = as_sampled ? samples[1] : desc->height;
}

abbe_result abbe_picture_make(const abbe_receivers_pass *receivers,
                              const abbe_refraction_pass *refraction, abbe_picture *out,
                              abbe_error *error) {
  abbe_gpu *gpu = receivers->lighting->scene->gpu;
  out->receivers = receivers;
  out->refraction = refraction;
  const abbe_render_desc *desc = desc_of(out);
  if (desc->supersample == 1 && !enlarges(out)) return ABBE_OK;
  if (desc->receiver_samples < desc->supersample)
    return refraction->merged != 0
               ? abbe_gpu_compute(gpu, "eye_merge.comp", NULL, &out->program, error)
               : ABBE_OK;
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_RGBA32F, desc->width, desc->height, 0, false, &out->pixels,
                                 error));
  /* Drawn, not computed: a software rasteriser stores pixel by pixel what is no target. */
  const abbe_program_stage stages[] = {
      {GL_VERTEX_SHADER, "screen.vert"},
      {GL_FRAGMENT_SHADER, enlarges(out) ? "eye_enlarge.frag" : "eye_resolve.frag"}};
  return abbe_gpu_program(gpu, stages, 2, "", &out->program, error);
}

void abbe_picture_free(abbe_picture *picture) {
  if (picture->receivers == NULL) return;
  abbe_gpu_drop_textures(picture->receivers->lighting->scene->gpu, 1, &picture->pixels);
  picture->receivers->lighting->scene->gpu->gl->DeleteTextures(1, &picture->view);
}

/* Over what receivers show, in its place. */
static void merge(abbe_picture *picture) {
  abbe_gpu *gpu = picture->receivers->lighting->scene->gpu;
  const abbe_render_desc *desc = desc_of(picture);
  const abbe_refraction_pass *refraction = picture->refraction;
  gpu->gl->UseProgram(picture->program);
  abbe_gpu_bind_texture(gpu, picture->program, "refraction", 1, refraction->colour);
  abbe_gpu_set_int(gpu, picture->program, "samples", (int)desc->supersample);
  abbe_gpu_bind_storage(gpu, BINDING_MERGED_PIXELS, refraction->merged);
  gpu->gl->BindImageTexture(0, picture->receivers->colour, 0, GL_FALSE, 0, GL_READ_WRITE,
                            GL_RGBA32F);
  abbe_gpu_dispatch_list(gpu, picture->program, refraction->merged, 0, desc->width * desc->height,
                         1);
  gpu->gl->MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                         GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_PICTURE);
}

abbe_result abbe_picture_run(abbe_picture *picture, abbe_error *error) {
  static const int flat = -1;
  abbe_gpu *gpu = picture->receivers->lighting->scene->gpu;
  const abbe_gl *gl = gpu->gl;
  const abbe_render_desc *desc = desc_of(picture);
  const GLuint program = picture->program;
  if (program == 0) return ABBE_OK;
  abbe_gpu_start_lap(gpu);
  if (desc->receiver_samples < desc->supersample) {
    merge(picture);
    return ABBE_OK;
  }
  ABBE_TRY(
      abbe_gpu_set_target(gpu, &picture->pixels, &flat, 1, 0, desc->width, desc->height, error));
  gl->Disable(GL_DEPTH_TEST);
  gl->UseProgram(program);
  abbe_gpu_bind_array(gpu, program, "receivers", 0, picture->receivers->colour);
  if (desc->supersample > 1) {
    abbe_gpu_bind_texture(gpu, program, "refraction", 1, picture->refraction->colour);
    abbe_gpu_set_int(gpu, program, "samples", (int)desc->supersample);
  } else {
    abbe_gpu_set_int(gpu, program, "pixels", (int)desc->upsample);
  }
  abbe_gpu_draw_screen(gpu);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_PICTURE);
  return ABBE_OK;
}

GLuint abbe_picture_texture(abbe_picture *picture) {
  const abbe_gl *gl = picture->receivers->lighting->scene->gpu->gl;
  if (picture->pixels != 0 || picture->view != 0)
    return picture->pixels != 0 ? picture->pixels : picture->view;
  gl->GenTextures(1, &picture->view);
  gl->TextureView(picture->view, GL_TEXTURE_2D, picture->receivers->colour, GL_RGBA32F, 0, 1, 0, 1);
  gl->BindTexture(GL_TEXTURE_2D, picture->view);
  gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return picture->view;
}

void abbe_picture_copy_flipped(const float *from, size_t first, abbe_image *image, size_t to,
                               size_t count, size_t samples) {
  double scale = 1.0 / (double)(samples * samples);
  for (size_t y = 0; y < image->height; y++)
    for (size_t x = 0; x < image->width; x++) {
      float *pixel = image->data + (y * image->width + x) * image->channels + to;
      for (size_t c = 0; c < count; c++) {
        double sum = 0;
        for (size_t k = 0; k < samples * samples; k++) {
          size_t row = (image->height - 1 - y) * samples + k / samples;
          size_t column = x * samples + k % samples;
          sum += (double)from[(row * image->width * samples + column) * 4 + first + c];
        }
        pixel[c] = (float)(sum * scale);
      }
    }
}

/* The two samples on whose sides pixel i lies, and how far it is from the first to the second. */
static double between(size_t i, size_t pixels, size_t samples, size_t out[2]) {
  const double at = fmax(((double)i + 0.5) / (double)pixels - 0.5, 0);
  out[0] = (size_t)at;
  out[1] = out[0] + 1 < samples ? out[0] + 1 : out[0];
  return at - (double)out[0];
}

/* As eye_enlarge.frag does. */
static void copy_enlarged(const abbe_picture *picture, const float *from, abbe_image *image,
                          size_t to, size_t count) {
  const size_t *samples = picture->receivers->lighting->camera->samples;
  const size_t upsample = desc_of(picture)->upsample;
  for (size_t y = 0; y < image->height; y++)
    for (size_t x = 0; x < image->width; x++) {
      float *pixel = image->data + (y * image->width + x) * image->channels + to;
      size_t column[2], row[2];
      const double across = between(x, upsample, samples[0], column);
      const double up = between(image->height - 1 - y, upsample, samples[1], row);
      for (size_t c = 0; c < count; c++) {
        double sum = 0;
        for (size_t k = 0; k < 4; k++)
          sum += (k % 2 == 0 ? 1 - across : across) * (k / 2 == 0 ? 1 - up : up) *
                 (double)from[(row[k / 2] * samples[0] + column[k % 2]) * 4 + c];
        pixel[c] = (float)sum;
      }
    }
}

void abbe_picture_to_xyz(abbe_image *image, size_t first) {
  double matrix[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (size_t i = 0; i < image->width * image->height; i++) {
    float *pixel = image->data + i * image->channels + first;
    double v[3] = {pixel[0], pixel[1], pixel[2]};
    abbe_rgb_space_apply(matrix, v, v);
    for (int c = 0; c < 3; c++) pixel[c] = (float)v[c];
  }
}

/* Rows of a target, next to each other. */
static void close_up(float *data, size_t width, size_t height, size_t room) {
  for (size_t y = 1; y < height && room != width; y++)
    memmove(data + 4 * width * y, data + 4 * room * y, 4 * width * sizeof *data);
}

static void read_pixels(const abbe_picture *picture, size_t channels, float *data,
                        abbe_image *out) {
  const abbe_gl *gl = picture->receivers->lighting->scene->gpu->gl;
  const bool resolved = picture->pixels != 0;
  const GLenum target = resolved ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY;
  gl->BindTexture(target, resolved ? picture->pixels : picture->receivers->colour);
  gl->GetTexImage(target, 0, GL_RGBA, GL_FLOAT, data);
  if (!resolved)
    close_up(data, out->width, out->height, picture->receivers->lighting->camera->receiver_room[0]);
  abbe_picture_copy_flipped(data, 0, out, 0, channels, 1);
}

/* A layer's samples, three channels from `to` on. */
static void read_layer(const abbe_picture *picture, GLuint texture, float *data, size_t to,
                       abbe_image *out) {
  const abbe_gl *gl = picture->receivers->lighting->scene->gpu->gl;
  const abbe_camera_view *camera = picture->receivers->lighting->camera;
  gl->BindTexture(GL_TEXTURE_2D, texture);
  gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, data);
  close_up(data, camera->receiver_samples[0], camera->receiver_samples[1],
           camera->receiver_room[0]);
  if (enlarges(picture))
    copy_enlarged(picture, data, out, to, 3);
  else
    abbe_picture_copy_flipped(data, 0, out, to, 3, desc_of(picture)->receiver_samples);
}

abbe_result abbe_picture_read(const abbe_picture *picture, bool aovs, double unit, abbe_image *out,
                              abbe_error *error) {
  static const char *const rgb[] = {"R",        "G",        "B",         "Z",         "direct.R",
                                    "direct.G", "direct.B", "caustic.R", "caustic.G", "caustic.B"};
  static const char *const xyz[] = {"X",        "Y",        "Z",         "depth.Z",   "direct.X",
                                    "direct.Y", "direct.Z", "caustic.X", "caustic.Y", "caustic.Z"};
  const abbe_render_desc *desc = desc_of(picture);
  const bool as_xyz = desc->space == ABBE_RGB_SPACE_XYZ;
  aovs = aovs && desc->aovs;
  const size_t *room = picture->receivers->lighting->camera->receiver_room;
  size_t size[2];
  abbe_picture_size(picture, size);
  ABBE_TRY(abbe_image_make(size[0], size[1], aovs ? 10 : 3, as_xyz ? xyz : rgb, out, error));
  const size_t pixels = out->width * out->height, texels = room[0] * room[1];
  float *data = malloc((pixels > texels ? pixels : texels) * 4 * sizeof *data);
  if (data == NULL) {
    abbe_image_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the picture");
  }
  read_pixels(picture, aovs ? 4 : 3, data, out);
  if (aovs) {
    read_layer(picture, picture->receivers->direct, data, 4, out);
    read_layer(picture, picture->receivers->caustic, data, 7, out);
  }
  free(data);
  for (size_t first = 0; as_xyz && first < out->channels; first += first == 0 ? 4 : 3)
    abbe_picture_to_xyz(out, first);
  for (size_t i = 0; i < out->width * out->height * out->channels && unit != 1; i++)
    if (i % out->channels != 3) out->data[i] = (float)((double)out->data[i] * unit);
  return ABBE_OK;
}
