#include "gl/renderer.h"

#include "gl/renderer_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_MAP_LEVELS = 6 };

static size_t room(size_t count) {
  return count > 0 ? count : 1;
}

static const char *storage(size_t count, size_t element, const char *define) {
  return count * element > BLOCK_BYTES ? define : "";
}

static void write_defines(abbe_renderer *r) {
  size_t grid = r->plan.desc.photons;
  r->wide = grid * grid * r->plan.desc.wavelengths > MAX_NARROW_PHOTONS;
  r->band_levels = 1;
  r->band_count = r->plan.desc.wavelengths;
  for (size_t n = r->plan.desc.wavelengths; n > 1; r->band_levels++)
    r->band_count += n = (n + 1) / 2;
  const abbe_plan *p = &r->plan;
  r->ways = !p->multi_refractor_paths ? 1 : p->desc.wavelengths > 1 ? 8 : 2;
  size_t planes = 0, spectra = p->refractor_count * p->desc.wavelengths;
  for (size_t i = 0; i < p->refractor_count; i++)
    if (p->model[i] == ABBE_REFRACTOR_CONVEX)
      planes += r->scene->object[p->refractor_object[i]].exact.count;
  snprintf(r->defines, sizeof r->defines,
           "#define LIGHTS %zu\n#define REFRACTORS %zu\n#define RECEIVERS %zu\n"
           "#define WAVELENGTHS %zu\n#define EXITS %zu\n#define SLOTS %zu\n"
           "#define LIGHT_ROOM %zu\n"
           "#define REFRACTOR_ROOM %zu\n#define PLANE_ROOM %zu\n#define RECEIVER_ROOM %zu\n"
           "#define SURFACE_ROOM %zu\n#define SPECTRUM_ROOM %zu\n#define BAND_COUNT %zu\n"
           "#define BAND_LEVELS %zu\n#define BAND_ROOM %zu\n%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s"
           "#define HIERARCHY_STACK %zu\n#define RECEIVER_ROOT %zu\n#define WAYS %u\n",
           p->light_view_count, p->refractor_count, p->parallelogram_count, p->desc.wavelengths,
           p->desc.exits, p->hit_slots, room(p->light_view_count), room(p->refractor_count), room(planes),
           room(p->parallelogram_count), room(p->receiver_count), room(spectra), r->band_count,
           r->band_levels, room(p->refractor_count * r->band_count),
           storage(p->refractor_count * r->band_count, 32, "#define BANDS_IN_STORAGE\n"),
           p->receiver_shadows ? "#define RECEIVER_SHADOWS\n" : "", r->wide ? "#define WIDE\n" : "",
           p->desc.layers ? "#define LIGHT_LAYERS_OUT\n" : "",
           p->convex && p->refractor_count == 1 ? "#define ONE_CONVEX\n" : "",
           storage(planes, 16, "#define PLANES_IN_STORAGE\n"),
           storage(p->receiver_count, 32, "#define SURFACES_IN_STORAGE\n"),
           storage(spectra, 16, "#define SPECTRA_IN_STORAGE\n"),
           p->spheres ? "#define SPHERES\n" : "", p->convex ? "#define CONVEX\n" : "",
           p->layers ? "#define LAYERS\n" : "",
           p->layers || p->bvh ? "#define FRONT_LAYER\n" : "",
           p->bvh ? "#define HIERARCHY\n" : "",
           p->receivers == ABBE_RECEIVER_BVH ? "#define RECEIVER_HIERARCHY\n" : "",
           p->absorbing ? "#define ABSORBING\n" : "", p->textured ? "#define TEXTURED\n" : "",
           p->caustics ? "#define CAUSTICS\n" : "", p->multi_refractor_paths ? "#define WALK\n" : "",
           p->cubes ? "#define CUBES\n" : "", r->hierarchy_depth + 1, r->receiver_root, r->ways);
  const size_t used = strlen(r->defines);
  if (r->shadow_planes > 0)
    snprintf(r->defines + used, sizeof r->defines - used, "#define SHADOW_PLANES %zu\n%s",
             r->shadow_planes,
             p->light_view_count * p->refractor_count == 1 ? "#define ONE_SHADOW\n" : "");
}

/* Levels halve the side as long as it is even, so that coarse texels cover whole fine ones. */
static void size_map(abbe_renderer *r, size_t side) {
  r->map_levels = 1;
  r->map_texels = side * side;
  while (r->map_levels < MAX_MAP_LEVELS && side % 2 == 0 && side > 2) {
    side /= 2;
    r->map_levels++;
    r->map_texels += side * side;
  }
}

static size_t map_side(const abbe_renderer *r) {
  return r->plan.caustics ? r->plan.desc.map_size : 1;
}

abbe_result abbe_renderer_make_map(abbe_renderer *r, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  const size_t side = map_side(r);
  size_t layers = r->plan.light_view_count;
  for (size_t i = 0; i < r->plan.light_view_count; i++)
    if (r->light[i].pages.count > 0) layers++;
  r->map_layers = layers;
  gl->GenTextures(1, &r->map);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, r->map);
  gl->TexStorage3D(GL_TEXTURE_2D_ARRAY, (GLsizei)r->map_levels, GL_RGBA32F, (GLsizei)side,
                   (GLsizei)side, (GLsizei)layers);
  gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  r->device_bytes += r->map_texels * layers * 16;
  if (r->plan.caustics) return abbe_gl_check(gl, "the allocation of the map", error);
  static const float black[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < layers; i++)
    gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)i, 1, 1, 1, GL_RGBA, GL_FLOAT, black);
  return abbe_gl_check(gl, "the clearing of the map", error);
}

static abbe_result make_passes(abbe_renderer *r, abbe_error *error) {
  r->gl->GenFramebuffers(1, &r->framebuffer);
  r->gl->GenVertexArrays(1, &r->empty_array);
  abbe_result result = abbe_renderer_upload_scene(r, error);
  size_map(r, map_side(r));
  /* Photons tell first which layers it has. */
  const bool photons = r->plan.caustics && !abbe_profile_is_thesis(r->plan.desc.profile);
  if (result == ABBE_OK && !photons) result = abbe_renderer_make_map(r, error);
  if (result == ABBE_OK) result = abbe_renderer_make_light(r, error);
  if (result == ABBE_OK && abbe_profile_is_thesis(r->plan.desc.profile))
    return abbe_renderer_make_thesis(r, error);
  if (result == ABBE_OK && r->plan.caustics) result = abbe_renderer_make_photons(r, error);
  if (result == ABBE_OK) result = abbe_renderer_make_eye(r, error);
  return result;
}

/* A cube's further faces are lights of their own. */
static abbe_result repeat_lights(abbe_renderer *r, const abbe_scene *scene, abbe_error *error) {
  const size_t own = scene->light_count;
  size_t of[ABBE_SCENE_MAX_LIGHTS] = {0};
  for (size_t i = own; i < r->plan.light_view_count; i++) of[i - own] = r->plan.light_view[i].light;
  return abbe_local_scene_repeat_lights(&r->local, of, r->plan.light_view_count - own, error);
}

abbe_result abbe_renderer_make(abbe_context *context, const abbe_scene *scene,
                               const abbe_render_desc *desc, abbe_renderer **out,
                               abbe_error *error) {
  ABBE_REQUIRE(context && scene && out, error);
  *out = NULL;
  abbe_renderer *r = calloc(1, sizeof *r);
  if (r == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a renderer");
  r->context = context;
  r->gl = abbe_context_gl(context);
  abbe_result result = abbe_plan_make(scene, desc, &r->plan, error);
  if (result == ABBE_OK) result = abbe_local_scene_make(scene, &r->local, error);
  if (result == ABBE_OK && !abbe_profile_is_thesis(r->plan.desc.profile))
    result = abbe_local_scene_scale_light(&r->local, error);
  if (result == ABBE_OK && r->plan.cubes) result = repeat_lights(r, scene, error);
  r->scene = r->local.scene;
  if (result == ABBE_OK && r->local.moved && r->plan.desc.map_layout != NULL) {
    r->given = *r->plan.desc.map_layout;
    abbe_local_scene_from_world(&r->local, &r->given.view);
    r->plan.desc.map_layout = &r->given;
  }
  if (result == ABBE_OK && r->plan.pages)
    result = abbe_receiver_charts_make(r->scene, &r->plan, &r->charts, error);
  if (result == ABBE_OK) result = abbe_renderer_make_hierarchy(r, error);
  if (result == ABBE_OK) result = abbe_renderer_make_shadows(r, error);
  if (result == ABBE_OK) {
    write_defines(r);
    result = make_passes(r, error);
  }
  if (result != ABBE_OK) {
    abbe_renderer_free(r);
    return result;
  }
  *out = r;
  return ABBE_OK;
}

void abbe_renderer_free(abbe_renderer *r) {
  if (r == NULL) return;
  const abbe_gl *gl = r->gl;
  abbe_renderer_free_thesis(r);
  abbe_renderer_free_scene(r);
  abbe_renderer_free_refinement(r);
  abbe_renderer_free_pages(r);
  abbe_local_scene_free(&r->local);
  gl->DeleteBuffers(BINDING_COUNT, r->buffer);
  gl->DeleteBuffers(LEVELS, r->list);
  gl->DeleteTextures(3, r->hierarchy_texture);
  gl->DeleteBuffers(3, r->hierarchy);
  gl->DeleteTextures(sizeof r->texels / sizeof *r->texels, r->texels);
  free(r->refractor_root);
  free(r->shadow_row);
  free(r->lit);
  gl->DeleteBuffers(1, &r->table_bands);
  gl->DeleteBuffers(1, &r->band_attenuation);
  const GLuint lists[] = {r->table_warps, r->table_shadows, r->texel_sizes,
                          r->pixel_list,  r->refine_list,   r->path_marks,
                          r->path_list,   r->splat_list,    r->map_sums};
  gl->DeleteBuffers(sizeof lists / sizeof *lists, lists);
  const GLuint textures[] = {
      r->texture_surface, r->light_layers,     r->light_owner, r->light_depth, r->map,
      r->eye_receivers,   r->eye_direct,       r->eye_caustic, r->eye_depth,   r->eye_refraction,
      r->eye_layers,      r->eye_layers_depth, r->eye_owner,   r->eye_picture, r->eye_floor};
  gl->DeleteTextures(sizeof textures / sizeof *textures, textures);
  const GLuint programs[] = {r->place,      r->cover,      r->groups,          r->trace,
                             r->paths,      r->deposit,    r->splat,           r->list_groups,
                             r->resolve,    r->mip,        r->layer,           r->receivers,
                             r->unlit,      r->refraction, r->refraction_fine, r->refraction_list,
                             r->eye_resolve};
  for (size_t i = 0; i < sizeof programs / sizeof *programs; i++) gl->DeleteProgram(programs[i]);
  gl->DeleteFramebuffers(1, &r->framebuffer);
  gl->DeleteVertexArrays(1, &r->empty_array);
  abbe_plan_free(&r->plan);
  free(r);
}

const abbe_plan *abbe_renderer_plan(const abbe_renderer *r) {
  return &r->plan;
}

void abbe_renderer_photon_view(const abbe_renderer *r, size_t light, abbe_view *out) {
  *out = r->light[light].near_view;
  abbe_local_scene_to_world(&r->local, out);
}

void abbe_renderer_map_layout(const abbe_renderer *r, size_t light, abbe_map_layout *out) {
  *out = r->light[light].map;
  abbe_local_scene_to_world(&r->local, &out->view);
}

static void summarise(const abbe_renderer *r, double start_ms, abbe_statistics *s) {
  s->frame_ms = abbe_renderer_now_ms() - start_ms - r->untimed_ms;
  s->wavelengths = r->plan.desc.wavelengths;
  s->device_bytes = r->device_bytes;
  if (!abbe_profile_is_thesis(r->plan.desc.profile)) s->layer_faces = abbe_renderer_layer_faces(r);
  for (size_t i = 0; i < r->plan.light_view_count; i++) s->photons += r->light[i].photon_count;
  double cells = (double)r->light[0].cells[0] * (double)r->light[0].cells[1];
  s->refractor_share = (double)r->light[0].photon_count / cells;
  double *part = &s->energy.reached;
  for (size_t i = 0; i < sizeof s->energy / sizeof *part; i++) part[i] *= r->local.unit;
}

abbe_result abbe_renderer_frame(abbe_renderer *r, abbe_render_progress progress, void *user,
                                abbe_statistics *statistics, abbe_error *error) {
  ABBE_REQUIRE(r, error);
  if (statistics != NULL) memset(statistics, 0, sizeof *statistics);
  r->statistics = statistics;
  r->untimed_ms = 0;
  r->drawn = false;
  double start_ms = abbe_renderer_now_ms();
  abbe_renderer_bind_tables(r);
  abbe_result result;
  if (abbe_profile_is_thesis(r->plan.desc.profile)) {
    result = abbe_renderer_thesis_frame(r, error);
  } else {
    result = abbe_renderer_light_layers(r, error);
    if (result == ABBE_OK && r->plan.caustics)
      result = abbe_renderer_photons(r, progress, user, error);
    if (result == ABBE_OK) result = abbe_renderer_eye(r, progress, user, error);
  }
  r->gl->Finish();
  if (statistics != NULL && result == ABBE_OK) summarise(r, start_ms, statistics);
  r->statistics = NULL;
  r->drawn = result == ABBE_OK;
  return result;
}

static abbe_result check_drawn(const abbe_renderer *r, abbe_error *error) {
  if (r->drawn) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "no frame has been drawn, so there is nothing to read; "
                        "abbe_renderer_frame comes first");
}

/* GL's rows run upwards. */
static void copy_flipped(const float *from, size_t first, abbe_image *image, size_t to,
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

/* As eye_enlarge.comp does. */
static void copy_enlarged(const abbe_renderer *r, const float *from, abbe_image *image, size_t to,
                          size_t count) {
  const size_t samples[2] = {abbe_renderer_samples(r, 0), abbe_renderer_samples(r, 1)};
  for (size_t y = 0; y < image->height; y++)
    for (size_t x = 0; x < image->width; x++) {
      float *pixel = image->data + (y * image->width + x) * image->channels + to;
      size_t column[2], row[2];
      const double across = between(x, r->plan.desc.upsample, samples[0], column);
      const double up = between(image->height - 1 - y, r->plan.desc.upsample, samples[1], row);
      for (size_t c = 0; c < count; c++) {
        double sum = 0;
        for (size_t k = 0; k < 4; k++)
          sum += (k % 2 == 0 ? 1 - across : across) * (k / 2 == 0 ? 1 - up : up) *
                 (double)from[(row[k / 2] * samples[0] + column[k % 2]) * 4 + c];
        pixel[c] = (float)sum;
      }
    }
}

static void to_output_space(const abbe_renderer *r, abbe_image *image, size_t first) {
  if (r->plan.desc.space != ABBE_RGB_SPACE_XYZ || r->plan.desc.profile == ABBE_PROFILE_THESIS)
    return;
  double matrix[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (size_t i = 0; i < image->width * image->height; i++) {
    float *pixel = image->data + i * image->channels + first;
    double v[3] = {pixel[0], pixel[1], pixel[2]};
    abbe_rgb_space_apply(matrix, v, v);
    for (int c = 0; c < 3; c++) pixel[c] = (float)v[c];
  }
}

abbe_result abbe_renderer_read(abbe_renderer *r, bool layers, abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  static const char *const rgb[] = {"R",        "G",        "B",         "Z",         "direct.R",
                                    "direct.G", "direct.B", "caustic.R", "caustic.G", "caustic.B"};
  static const char *const xyz[] = {"X",        "Y",        "Z",         "depth.Z",   "direct.X",
                                    "direct.Y", "direct.Z", "caustic.X", "caustic.Y", "caustic.Z"};
  bool thesis = r->plan.desc.profile == ABBE_PROFILE_THESIS;
  bool as_xyz = r->plan.desc.space == ABBE_RGB_SPACE_XYZ && !thesis;
  layers = layers && r->plan.desc.layers && !abbe_profile_is_thesis(r->plan.desc.profile);
  *out = (abbe_image){0};
  abbe_result result = check_drawn(r, error);
  if (result != ABBE_OK) return result;
  result = abbe_image_make(r->plan.desc.width, r->plan.desc.height, layers ? 10 : 3,
                           as_xyz ? xyz : rgb, out, error);
  if (result != ABBE_OK) return result;
  const size_t side = layers ? r->plan.desc.supersample : 1;
  float *data = malloc(out->width * out->height * side * side * 4 * sizeof *data);
  if (data == NULL) {
    abbe_image_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the picture");
  }
  const abbe_gl *gl = r->gl;
  const bool resolved = r->eye_picture != 0;
  const GLenum target = resolved ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY;
  gl->BindTexture(target, resolved ? r->eye_picture : r->eye_receivers);
  gl->GetTexImage(target, 0, GL_RGBA, GL_FLOAT, data);
  copy_flipped(data, 0, out, 0, layers ? 4 : 3, 1);
  to_output_space(r, out, 0);
  const GLuint texture[2] = {r->eye_direct, r->eye_caustic};
  for (size_t k = 0; k < 2 && layers; k++) {
    gl->BindTexture(GL_TEXTURE_2D, texture[k]);
    gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, data);
    if (r->plan.desc.upsample > 1)
      copy_enlarged(r, data, out, 4 + 3 * k, 3);
    else
      copy_flipped(data, 0, out, 4 + 3 * k, 3, side);
    to_output_space(r, out, 4 + 3 * k);
  }
  free(data);
  for (size_t i = 0; i < out->width * out->height * out->channels && r->local.unit != 1; i++)
    if (i % out->channels != 3) out->data[i] = (float)((double)out->data[i] * r->local.unit);
  abbe_rgb_space space = thesis ? ABBE_RGB_SPACE_REC709 : r->plan.desc.space;
  abbe_rgb_space_chromaticities(space, out->xy);
  result = abbe_image_set_attribute(out, "abbe:space", abbe_rgb_space_name(space), error);
  if (result == ABBE_OK) result = abbe_gl_check(gl, "the reading of the picture", error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

abbe_result abbe_renderer_check_map(const abbe_renderer *r, size_t light, abbe_error *error) {
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] || r->plan.light_view[light].light != light)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no spectral map of light %zu", light);
  abbe_result result = check_drawn(r, error);
  if (result != ABBE_OK) return result;
  if (!abbe_renderer_is_face(r, light) || abbe_renderer_map_is_given(r, light)) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the light '%s' has a cube of maps, each with its own layout; give one "
                        "layout for all, such as that of a traced map (--map-like)",
                        r->scene->light[light].name);
}

abbe_result abbe_renderer_read_map(abbe_renderer *r, size_t light, bool filled, abbe_image *out,
                                   abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  static const char *const xyz[] = {"X", "Y", "Z"}, *const rgb[] = {"R", "G", "B"};
  bool thesis = r->plan.desc.profile == ABBE_PROFILE_THESIS;
  bool flat = abbe_profile_is_thesis(r->plan.desc.profile);
  size_t side = r->plan.desc.map_size;
  *out = (abbe_image){0};
  abbe_result result = abbe_renderer_check_map(r, light, error);
  if (result != ABBE_OK) return result;
  result = abbe_image_make(side, side, 3, thesis ? rgb : xyz, out, error);
  if (result != ABBE_OK) return result;
  float *data = malloc((flat ? 1 : r->map_layers) * side * side * 4 * sizeof *data);
  if (data == NULL) {
    abbe_image_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the map");
  }
  GLenum target = flat ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY;
  r->gl->BindTexture(target, flat ? abbe_renderer_thesis_map(r, filled) : r->map);
  r->gl->GetTexImage(target, 0, GL_RGBA, GL_FLOAT, data);
  /* Faces of a cube that share a layout add up. */
  for (size_t i = 0; i < r->plan.light_view_count; i++) {
    const float *layer = data + i * side * side * 4;
    if (i == light || r->plan.light_view[i].light != light) continue;
    for (size_t k = 0; k < side * side * 4; k++) data[light * side * side * 4 + k] += layer[k];
  }
  copy_flipped(data + light * side * side * 4, 0, out, 0, 3, 1);
  free(data);
  /* The thesis's passes sum the light of a lamp of unit power. */
  double power = r->local.unit * (flat ? r->scene->light[light].power : 1);
  for (size_t y = 0; y < side && !thesis; y++) {
    double height = power * abbe_renderer_texel_size(r, light, 1, side - 1 - y);
    for (size_t x = 0; x < side; x++)
      for (size_t c = 0; c < 3; c++)
        out->data[(y * side + x) * 3 + c] *=
            (float)(height * abbe_renderer_texel_size(r, light, 0, x));
  }
  abbe_rgb_space_chromaticities(thesis ? ABBE_RGB_SPACE_REC709 : ABBE_RGB_SPACE_XYZ, out->xy);
  result = abbe_gl_check(r->gl, "the reading of the map", error);
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene->light[light].name, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
