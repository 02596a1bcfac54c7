#include "gl/beams/beam_list.h"

#include "colorimetry/weights.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "gl/plan/examine/examine.h"

#include <math.h>
#include <stdlib.h>

enum { BEAM_BYTES = 96, FIRST_BEAMS = 1 << 16, MOST_BEAMS = 1 << 20 };
enum { PARTS = 8 }; /* as in beam_list.comp */

static const abbe_gpu_scene *scene_of(const abbe_beam_list *list) {
  return list->caustics->views->scene;
}

static const abbe_plan *plan_of(const abbe_beam_list *list) {
  return scene_of(list)->plan;
}

static size_t intervals_of(const abbe_beam_list *list) {
  const size_t n = plan_of(list)->desc.wavelengths;
  return n > 1 ? n - 1 : 1;
}

/* Part k of an interval. Its ends lie evenly in 1 / wavelength^2, with which an index is nearly
 * linear. */
static double end_of_part(double from_nm, double to_nm, size_t k) {
  const double a = 1 / (from_nm * from_nm), b = 1 / (to_nm * to_nm);
  return k == 0 ? from_nm : k == PARTS ? to_nm : 1 / sqrt(a + (b - a) * (double)k / PARTS);
}

/* What the parts of an interval add. */
static void fill_interval(const abbe_beam_list *list, const abbe_light *light,
                          const abbe_weights_range *range, const double ends_nm[2],
                          float (*out)[4]) {
  double matrix[9];
  abbe_rgb_space_from_xyz(abbe_gpu_scene_working_space(scene_of(list)), matrix);
  for (size_t k = 0; k < PARTS; k++) {
    double xyz[3], rgb[3];
    abbe_weights_range_xyz(range, end_of_part(ends_nm[0], ends_nm[1], k),
                           end_of_part(ends_nm[0], ends_nm[1], k + 1), xyz);
    abbe_rgb_space_apply(matrix, xyz, rgb);
    for (int c = 0; c < 3; c++) rgb[c] *= light->power;
    abbe_float4_store(rgb, 0, out[k]);
  }
}

/* Where an interval begins and ends; of one wavelength, all of the range. */
static void ends_of(const abbe_beam_list *list, size_t interval, double nm[2]) {
  const abbe_wavelengths *w = &scene_of(list)->tables.all;
  nm[0] = w->count > 1 ? w->lambda_nm[interval] : w->edge_nm[0];
  nm[1] = w->count > 1 ? w->lambda_nm[interval + 1] : w->edge_nm[w->count];
}

static void fill_light(const abbe_beam_list *list, size_t view, float (*out)[4]) {
  const abbe_gpu_scene *scene = scene_of(list);
  const abbe_light *light = &scene->local->light[scene->plan->light_view[view].light];
  const abbe_wavelengths *w = &scene->tables.all;
  abbe_weights_range range;
  abbe_weights_range_make_by(scene->plan->desc.observer, &light->illuminant, w->edge_nm[0],
                             w->edge_nm[w->count], &range);
  for (size_t i = 0; i < intervals_of(list); i++) {
    double nm[2];
    ends_of(list, i, nm);
    fill_interval(list, light, &range, nm, out + i * PARTS);
  }
}

/* A medium's attenuation in each part of an interval, the mean of three places. */
static void fill_haze(const abbe_beam_list *list, size_t interval, float (*out)[4]) {
  const abbe_scene *scene = scene_of(list)->local;
  const bool air = list->medium < 0;
  const abbe_object *object =
      air ? NULL : &scene->object[plan_of(list)->refractor_object[list->medium]];
  const abbe_medium *medium = air ? scene->medium : object->medium;
  double nm[2];
  ends_of(list, interval, nm);
  for (size_t k = 0; k < PARTS; k++) {
    const double from = end_of_part(nm[0], nm[1], k), to = end_of_part(nm[0], nm[1], k + 1);
    double sum[3] = {0};
    for (int i = 0; i < 3; i++) {
      const double at = from + (to - from) * (i + 0.5) / 3;
      const double scattering = abbe_medium_scattering(medium, at);
      const double absorption = air ? abbe_medium_absorption(medium, at)
                                    : abbe_material_attenuation(object->material, at);
      sum[0] += (scattering + absorption) / 3;
      sum[1] += scattering / 3;
    }
    abbe_float4_store(sum, 0, out[k]);
  }
}

/* What a refractor takes of the parts of all intervals. */
static void fill_tint(const abbe_beam_list *list, size_t refractor, float *out) {
  for (size_t i = 0; i < intervals_of(list); i++) {
    double nm[2];
    ends_of(list, i, nm);
    for (size_t k = 0; k < PARTS; k++) {
      const double from = end_of_part(nm[0], nm[1], k), to = end_of_part(nm[0], nm[1], k + 1);
      double sum = 0;
      for (int j = 0; j < 3; j++)
        sum += abbe_tint_attenuation(scene_of(list)->local, plan_of(list), refractor,
                                     from + (to - from) * (j + 0.5) / 3) /
               3;
      *out++ = (float)sum;
    }
  }
}

static abbe_result make_tints(abbe_beam_list *list, abbe_error *error) {
  const size_t surfaces = abbe_plan_surfaces(plan_of(list)), each = intervals_of(list) * PARTS;
  if (plan_of(list)->tints == 0) return ABBE_OK;
  ABBE_FREED float *tint = calloc(surfaces * each, sizeof *tint);
  if (tint == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the colours of beams");
  for (size_t r = 0; r < surfaces; r++) fill_tint(list, r, tint + r * each);
  return abbe_gpu_make_buffer(scene_of(list)->gpu, surfaces * each * sizeof *tint, tint,
                              &list->tints, error);
}

static abbe_result make_colours(abbe_beam_list *list, abbe_error *error) {
  const size_t lights = plan_of(list)->light_view_count, n = intervals_of(list) * PARTS;
  abbe_gpu *gpu = scene_of(list)->gpu;
  float(*colour)[4] = calloc((lights + 1) * n, sizeof *colour);
  if (colour == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the colours of beams");
  for (size_t i = 0; i < lights; i++) fill_light(list, i, colour + i * n);
  for (size_t i = 0; i < intervals_of(list); i++)
    fill_haze(list, i, colour + lights * n + i * PARTS);
  abbe_result result =
      abbe_gpu_make_buffer(gpu, (lights * n + 1) * sizeof *colour, colour, &list->colours, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(gpu, n * sizeof *colour, colour + lights * n, &list->haze, error);
  free(colour);
  return result;
}

static abbe_result make_room(abbe_beam_list *list, size_t beams, abbe_error *error) {
  abbe_gpu *gpu = scene_of(list)->gpu;
  abbe_gpu_drop_buffers(gpu, 1, &list->beams);
  list->room = beams;
  return abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + beams * BEAM_BYTES, NULL, &list->beams,
                              error);
}

abbe_result abbe_beam_list_make(const abbe_shader_variant *variant, abbe_beam_list *list,
                                abbe_error *error) {
  abbe_shader_variant photons = *variant;
  list->chunks = 1;
  photons.hit_stride = list->caustics->trace.hits.stride;
  ABBE_TRY(abbe_shader_variant_compute(&photons, scene_of(list)->gpu, "beam_list.comp",
                                       list->camera == NULL ? "#define IN_WORLD\n" : NULL,
                                       &list->program, error));
  ABBE_TRY(make_colours(list, error));
  ABBE_TRY(make_tints(list, error));
  return make_room(list, FIRST_BEAMS, error);
}

void abbe_beam_list_free(abbe_beam_list *list) {
  if (list->caustics == NULL) return;
  GLuint buffers[] = {list->colours, list->haze, list->tints, list->beams};
  abbe_gpu_drop_buffers(scene_of(list)->gpu, 4, buffers);
  *list = (abbe_beam_list){0};
}

static void set_hits(abbe_beam_list *list, size_t first, size_t count) {
  const abbe_trace_pass *trace = &list->caustics->trace;
  const abbe_plan *plan = plan_of(list);
  abbe_gpu *gpu = scene_of(list)->gpu;
  const GLuint program = list->program;
  const abbe_hits *hits = &trace->hits;
  abbe_gpu_bind_texels(gpu, program, "hits", 0, GL_RGBA32F, hits->hits);
  abbe_gpu_bind_texels(gpu, program, "signatures", 1, abbe_photon_signature_format(plan),
                       hits->signatures);
  abbe_gpu_bind_texels(gpu, program, "beam_colours", 2, GL_RGBA32F, list->colours);
  abbe_gpu_bind_texels(gpu, program, "beam_haze", 4, GL_RGBA32F, list->haze);
  if (plan->tints > 0) {
    abbe_gpu_bind_texels(gpu, program, "beam_tints", 3, GL_R32F, list->tints);
    abbe_gpu_set_int(
        gpu, program, "medium_tint",
        list->medium < 0 ? -1 : abbe_tint_of(scene_of(list)->local, plan, (size_t)list->medium));
  }
  abbe_gpu_set_int(gpu, program, "stride", (int)hits->stride);
  abbe_gpu_set_int(gpu, program, "sample_first", (int)first);
  abbe_gpu_set_int(gpu, program, "sample_count", (int)count);
}

static void set_camera(const abbe_beam_list *list) {
  const abbe_gl *gl = scene_of(list)->gpu->gl;
  const abbe_plan *plan = plan_of(list);
  float packed[24];
  abbe_view_pack(&list->camera->view, packed);
  gl->Uniform3f(gl->GetUniformLocation(list->program, "eye"), packed[0], packed[1], packed[2]);
  gl->Uniform4fv(gl->GetUniformLocation(list->program, "eye_view"), 6, packed);
  gl->Uniform2f(gl->GetUniformLocation(list->program, "size"), (GLfloat)plan->desc.width,
                (GLfloat)plan->desc.height);
}

static void list_chunk(abbe_beam_list *list, size_t light, const abbe_hit_batch *b, size_t chunk) {
  const abbe_caustics *c = list->caustics;
  const abbe_gpu_scene *scene = scene_of(list);
  abbe_gpu *gpu = scene->gpu;
  const GLuint program = list->program;
  abbe_gpu_scene_bind(scene);
  abbe_photon_lights_bind(c->views);
  gpu->gl->UseProgram(program);
  abbe_gpu_scene_set(scene, program);
  if (list->camera != NULL) set_camera(list);
  abbe_photon_start_bind(&c->start);
  abbe_photon_lights_set_grid(c->views, program, light);
  set_hits(list, b->first, b->count);
  abbe_gpu_set_int(gpu, program, "light", (int)light);
  abbe_gpu_set_int(gpu, program, "medium", list->medium);
  abbe_gpu_set_float(gpu, program, "cell_m", list->cell_m);
  abbe_gpu_set_uint(gpu, program, "chunks", list->chunks);
  abbe_gpu_set_uint(gpu, program, "chunk", chunk);
  abbe_gpu_set_uint(gpu, program, "most", list->room);
  abbe_gpu_clear_list(gpu, list->beams);
  abbe_gpu_bind_storage(gpu, BINDING_SPLATS, list->beams);
  abbe_gpu_bind_storage(gpu, BINDING_PATHS, c->trace.hits.paths);
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  abbe_gpu_dispatch_list(gpu, program, c->trace.hits.paths, 0,
                         c->views->light[light].photon_count * scene->plan->hit_slots, 1);
}

/* Lists a chunk, with capacity for all of it; of the first there may be more chunks than before.
 * Waits for the device. */
static abbe_result list_whole(abbe_beam_list *list, size_t light, const abbe_hit_batch *b,
                              size_t chunk, size_t *beams, abbe_error *error) {
  abbe_gpu *gpu = scene_of(list)->gpu;
  *beams = 0;
  while (!gpu->stopped) {
    list_chunk(list, light, b, chunk);
    const size_t found = abbe_gpu_read_count(gpu, list->beams), more = found + found / 4;
    if (found <= list->room) {
      *beams = found;
      return ABBE_OK;
    }
    /* What fitted a capacity before fits it still where chunks are split. */
    if (chunk == 0 && found > MOST_BEAMS) list->chunks *= found / (MOST_BEAMS * 4 / 5) + 1;
    ABBE_TRY(make_room(list, chunk == 0 && more > MOST_BEAMS ? MOST_BEAMS : more, error));
  }
  return ABBE_OK;
}

/* Runs a batch of the paths that are traced. */
static abbe_result run_batch(const abbe_beam_use *to, size_t light, const abbe_hit_batch *b,
                             abbe_error *error) {
  abbe_gpu *gpu = scene_of(to->list)->gpu;
  for (size_t k = 0; k < to->list->chunks && !gpu->stopped; k++) {
    size_t beams = 0;
    ABBE_TRY(list_whole(to->list, light, b, k, &beams, error));
    if (beams > 0) ABBE_TRY(to->use(to->user, beams, error));
  }
  return ABBE_OK;
}

/* All wavelengths in batches that share a node, so that each interval is in one of them. */
static abbe_result run_light(const abbe_beam_use *to, size_t count, size_t light,
                             abbe_error *error) {
  abbe_caustics *c = to->list->caustics;
  abbe_gpu *gpu = scene_of(to->list)->gpu;
  const size_t n = plan_of(to->list)->desc.wavelengths, most = c->trace.hits.stride;
  abbe_hit_batch b = {0};
  ABBE_TRY(abbe_photon_start_run(&c->start, light, error));
  for (size_t known = 0; known < n; known = b.first + b.count) {
    b.first = known == 0 ? 0 : known - 1;
    b.count = n - b.first < most ? n - b.first : most;
    abbe_trace_pass_ways(&c->trace, light, b.first, b.count);
    for (size_t i = 0; i < count; i++) ABBE_TRY(run_batch(&to[i], light, &b, error));
    ABBE_TRY(abbe_gpu_tell(gpu, gpu->done, error));
  }
  return ABBE_OK;
}

abbe_result abbe_beam_list_run(const abbe_beam_use *to, size_t count, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < plan_of(to->list)->light_view_count && result == ABBE_OK; i++)
    if (plan_of(to->list)->reaches[i]) result = run_light(to, count, i, error);
  return result;
}
