#include "gl/haze/haze_pass.h"

#include "colorimetry/weights.h"
#include "gl/device/float4.h"

#include <stdlib.h>

enum { PICTURE_UNIT = 6 }; /* that nothing of the scene is at */

static const abbe_lighting *lighting_of(const abbe_haze_pass *pass) {
  return pass->picture->receivers->lighting;
}

static const abbe_gpu_scene *scene_of(const abbe_haze_pass *pass) {
  return lighting_of(pass)->scene;
}

/* ---- make ---- */

/* What a wavelength of a light of unit power adds, in the shaders' space. */
static abbe_result weigh(const abbe_haze_pass *pass, size_t light, float (*out)[4],
                         abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_light *of = &scene->local->light[scene->plan->light_view[light].light];
  abbe_weights weights;
  abbe_result result =
      abbe_weights_make_by(scene->plan->desc.observer, &scene->tables.all, &of->illuminant,
                           abbe_gpu_scene_working_space(scene), &weights, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < weights.count; i++) {
    double rgb[3];
    for (int k = 0; k < 3; k++) rgb[k] = weights.weight[i][k] * of->power;
    abbe_float4_store(rgb, 0, out[i]);
  }
  abbe_weights_free(&weights);
  return ABBE_OK;
}

static abbe_result make_colours(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const size_t lights = scene->plan->light_view_count, n = scene->plan->desc.wavelengths;
  float(*colour)[4] = calloc(lights * n + 1, sizeof *colour);
  abbe_result result =
      colour != NULL ? ABBE_OK
                     : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the colours of beams");
  for (size_t i = 0; i < lights && result == ABBE_OK; i++)
    result = weigh(pass, i, colour + i * n, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, (lights * n + 1) * sizeof *colour, colour,
                                  &pass->colours, error);
  free(colour);
  return result;
}

static abbe_result make_targets(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const size_t w = scene->plan->desc.width, h = scene->plan->desc.height;
  abbe_result result =
      abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, w, h, 0, false, &pass->scattered, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(scene->gpu, GL_DEPTH_COMPONENT32F, w, h, 0, false, &pass->depth,
                                   error);
  return result;
}

abbe_result abbe_haze_pass_make(abbe_picture *picture, abbe_caustics *caustics,
                                const abbe_shader_variant *variant, abbe_haze_pass *out,
                                abbe_error *error) {
  static const abbe_program_stage lines[] = {{GL_VERTEX_SHADER, "beam.vert"},
                                             {GL_FRAGMENT_SHADER, "beam.frag"}};
  static const abbe_program_stage shines[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                              {GL_FRAGMENT_SHADER, "haze.frag"}};
  static const abbe_program_stage overs[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                             {GL_FRAGMENT_SHADER, "haze_over.frag"}};
  static const abbe_program_stage occluders[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                                 {GL_FRAGMENT_SHADER, "depth.frag"}};
  const abbe_plan *plan = picture->receivers->lighting->scene->plan;
  *out = (abbe_haze_pass){0};
  if (!plan->hazy) return ABBE_OK;
  *out = (abbe_haze_pass){.picture = picture, .caustics = plan->caustics ? caustics : NULL};
  abbe_gpu *gpu = scene_of(out)->gpu;
  abbe_result result = abbe_gpu_program(gpu, overs, 2, NULL, &out->over, error);
  if (result == ABBE_OK) result = make_targets(out, error);
  if (result == ABBE_OK)
    result = abbe_shader_variant_program(
        variant, gpu, shines, 2, plan->eye_in_air ? "#define IN_AIR\n" : NULL, &out->shine, error);
  if (result != ABBE_OK || out->caustics == NULL) return result;
  result = abbe_shader_variant_program(variant, gpu, lines, 2, NULL, &out->line, error);
  if (result == ABBE_OK) result = abbe_gpu_program(gpu, occluders, 2, NULL, &out->occluder, error);
  return result == ABBE_OK ? make_colours(out, error) : result;
}

void abbe_haze_pass_free(abbe_haze_pass *pass) {
  if (pass->picture == NULL) return;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  GLuint textures[] = {pass->scattered, pass->depth};
  abbe_gpu_drop_textures(gpu, sizeof textures / sizeof *textures, textures);
  abbe_gpu_drop_buffers(gpu, 1, &pass->colours);
  *pass = (abbe_haze_pass){0};
}

/* ---- the target ---- */

static abbe_result set_target(abbe_haze_pass *pass, abbe_error *error) {
  static const int flat = -1;
  const abbe_gpu_scene *scene = scene_of(pass);
  return abbe_gpu_set_target(scene->gpu, &pass->scattered, &flat, 1, pass->depth,
                             scene->plan->desc.width, scene->plan->desc.height, error);
}

static abbe_result clear_target(abbe_haze_pass *pass, abbe_error *error) {
  static const GLfloat nothing[4] = {0, 0, 0, 0}, far = 1;
  const abbe_gl *gl = scene_of(pass)->gpu->gl;
  const abbe_result result = set_target(pass, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
  return ABBE_OK;
}

/* ---- lines of light ---- */

/* Whatever the eye's rays meet first hides what is behind it. */
static void draw_occluders(abbe_haze_pass *pass) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  abbe_lighting_use(lighting_of(pass), pass->occluder);
  gl->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl->Enable(GL_DEPTH_TEST);
  for (size_t i = 0; i < scene->local->object_count; i++) abbe_gpu_meshes_draw(scene, i);
  gl->Disable(GL_DEPTH_TEST);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

static void set_lines(abbe_haze_pass *pass, size_t light, size_t first, size_t count) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  abbe_gpu *gpu = scene->gpu;
  const abbe_hits *hits = &pass->caustics->trace.hits;
  const GLenum signature = scene->plan->lengths ? GL_RG32UI : GL_R32UI;
  abbe_lighting_use(lighting_of(pass), pass->line);
  abbe_gpu_bind_texels(gpu, pass->line, "hits", 0, GL_RGBA32F, hits->hits);
  abbe_gpu_bind_texels(gpu, pass->line, "signatures", 1, signature, hits->signatures);
  abbe_gpu_bind_texels(gpu, pass->line, "beam_colours", 2, GL_RGBA32F, pass->colours);
  abbe_gpu_set_int(gpu, pass->line, "light", (int)light);
  abbe_gpu_set_int(gpu, pass->line, "stride", (int)hits->stride);
  abbe_gpu_set_int(gpu, pass->line, "sample_first", (int)first);
  abbe_gpu_set_int(gpu, pass->line, "sample_count", (int)count);
  gl->Uniform2f(gl->GetUniformLocation(pass->line, "size"), (GLfloat)scene->plan->desc.width,
                (GLfloat)scene->plan->desc.height);
  gl->BindVertexArray(gpu->empty_array);
}

/* Of so many wavelengths, into the picture of lines. */
static abbe_result draw_batch(abbe_haze_pass *pass, size_t light, size_t first, size_t count,
                              abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_caustics *c = pass->caustics;
  const size_t lines = c->views->light[light].photon_count * scene->plan->hit_slots * count;
  const abbe_result result = set_target(pass, error);
  if (result != ABBE_OK || lines == 0) return result;
  set_lines(pass, light, first, count);
  gl->Enable(GL_DEPTH_TEST);
  gl->DepthMask(GL_FALSE);
  gl->Enable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  gl->DrawArrays(GL_LINES, 0, (GLsizei)(2 * lines));
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->Disable(GL_BLEND);
  gl->DepthMask(GL_TRUE);
  gl->Disable(GL_DEPTH_TEST);
  return ABBE_OK;
}

static abbe_result draw_light(abbe_haze_pass *pass, size_t light, abbe_error *error) {
  abbe_caustics *c = pass->caustics;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t n = scene_of(pass)->plan->desc.wavelengths, most = c->trace.hits.stride;
  abbe_result result = abbe_photon_start_run(&c->start, light, error);
  for (size_t first = 0; first < n && result == ABBE_OK && !gpu->stopped; first += most) {
    const size_t count = n - first < most ? n - first : most;
    abbe_trace_pass_batch(&c->trace, light, first, count, n);
    result = draw_batch(pass, light, first, count, error);
    if (result == ABBE_OK) result = abbe_gpu_tell(gpu, gpu->done, error);
  }
  return result;
}

static abbe_result draw_beams(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  draw_occluders(pass);
  abbe_result result = abbe_light_layers_run(pass->caustics->layers, error);
  for (size_t i = 0; i < scene->plan->light_view_count && result == ABBE_OK; i++)
    if (scene->plan->reaches[i]) result = draw_light(pass, i, error);
  return result;
}

/* ---- the picture ---- */

/* Lamps' straight light in the air, and what is left of what is behind. */
static abbe_result draw_shine(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_result result = set_target(pass, error);
  if (result != ABBE_OK) return result;
  abbe_lighting_use(lighting_of(pass), pass->shine);
  abbe_gpu_bind_texture(scene->gpu, pass->shine, "picture", PICTURE_UNIT,
                        abbe_picture_texture(pass->picture));
  gl->Uniform2f(gl->GetUniformLocation(pass->shine, "size"), (GLfloat)scene->plan->desc.width,
                (GLfloat)scene->plan->desc.height);
  gl->BindVertexArray(scene->gpu->empty_array);
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  gl->Enable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->Disable(GL_BLEND);
  return ABBE_OK;
}

/* The picture's distances stay. */
static abbe_result lay_over(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_picture *picture = pass->picture;
  const int layer = picture->pixels != 0 ? -1 : 0; /* of a texture, or of an array */
  const GLuint pixels = picture->pixels != 0 ? picture->pixels : picture->receivers->colour;
  const abbe_result result = abbe_gpu_set_target(
      scene->gpu, &pixels, &layer, 1, 0, scene->plan->desc.width, scene->plan->desc.height, error);
  if (result != ABBE_OK) return result;
  gl->UseProgram(pass->over);
  abbe_gpu_bind_texture(scene->gpu, pass->over, "scattered", PICTURE_UNIT, pass->scattered);
  gl->BindVertexArray(scene->gpu->empty_array);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  gl->Enable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_SRC_ALPHA);
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->Disable(GL_BLEND);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return ABBE_OK;
}

abbe_result abbe_haze_pass_run(abbe_haze_pass *pass, abbe_error *error) {
  if (pass->picture == NULL) return ABBE_OK;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_gpu_start_lap(gpu);
  abbe_result result = clear_target(pass, error);
  if (result == ABBE_OK && pass->caustics != NULL) result = draw_beams(pass, error);
  if (result == ABBE_OK && !gpu->stopped) result = draw_shine(pass, error);
  if (result == ABBE_OK && !gpu->stopped) result = lay_over(pass, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_HAZE);
  return result;
}
