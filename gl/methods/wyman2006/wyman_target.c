#include "gl/methods/wyman2006/wyman2006.h"

#include "base/maths.h"

#include <math.h>
#include <stdio.h>

/* The plane of the largest receiver, where that is flat; else of its face. */
static void find_background(const abbe_gpu_scene *scene, double out[4]) {
  double most = 0;
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_mesh *mesh = &scene->local->object[scene->plan->receiver_object[i]].mesh;
    for (size_t f = 0; f < mesh->face_count; f++) {
      const double *corner = mesh->position[mesh->face[f][0]];
      double u[3], v[3], n[3];
      abbe_vector_subtract(mesh->position[mesh->face[f][1]], corner, u);
      abbe_vector_subtract(mesh->position[mesh->face[f][2]], corner, v);
      abbe_vector_cross(u, v, n);
      const double area = abbe_vector_length(n);
      if (area <= most) continue;
      most = area;
      for (int k = 0; k < 3; k++) out[k] = n[k] / area;
      out[3] = abbe_vector_dot(out, corner);
    }
  }
}

static abbe_result make_program(abbe_wyman_photons *p, const abbe_shader_variant *variant,
                                const char *definitions, abbe_error *error) {
  const abbe_render_desc *d = &p->scene->plan->desc;
  char text[1024];
  const int length =
      snprintf(text, sizeof text,
               "%s#define ESTIMATOR %d\n#define ITERATIONS %zu\n#define OBJECT_FACES %zu\n%s",
               definitions, (int)d->estimator, d->iterations, p->light->object_faces,
               p->light->faces > 1 ? "#define PLACES_CUBE\n" : "");
  if (length < 0 || (size_t)length >= sizeof text)
    return abbe_error_set(error, ABBE_GL, "a shader's definitions are too long");
  const abbe_image_program photons = {&p->program,          "screen.vert", NULL,
                                      "wyman_photons.frag", text,          false};
  return abbe_image_programs_make(variant, p->scene->gpu, &photons, 1, error);
}

abbe_result abbe_wyman_photons_make(const abbe_gpu_scene *scene, const abbe_image_places *light,
                                    const abbe_shader_variant *variant, const char *definitions,
                                    abbe_wyman_photons *out, abbe_error *error) {
  const size_t side = scene->plan->desc.photons;
  const GLenum format =
      abbe_method_of(scene->plan->desc.profile)->printed ? GL_RGBA16F : GL_RGBA32F;
  *out = (abbe_wyman_photons){.scene = scene, .light = light};
  find_background(scene, out->background);
  ABBE_TRY(abbe_gpu_make_texture(scene->gpu, format, side, side, 0, false, &out->places, error));
  ABBE_TRY(abbe_gpu_make_texture(scene->gpu, format, side, side, 0, false, &out->incident, error));
  return make_program(out, variant, definitions, error);
}

void abbe_wyman_photons_free(abbe_wyman_photons *p) {
  if (p->scene == NULL) return;
  abbe_gpu_drop_textures(p->scene->gpu, 1, &p->places);
  abbe_gpu_drop_textures(p->scene->gpu, 1, &p->incident);
  *p = (abbe_wyman_photons){0};
}

/* The light's places are drawn by then; face: of its views of objects. ABBE_GL. */
static abbe_result wyman_photons_run(const abbe_wyman_photons *p, size_t wavelength, size_t face,
                                     abbe_error *error) {
  static const int flat[2] = {-1, -1};
  const abbe_gpu_scene *scene = p->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const size_t side = scene->plan->desc.photons;
  const GLuint targets[2] = {p->places, p->incident};
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, targets, flat, 2, 0, side, side, error));
  gl->Disable(GL_DEPTH_TEST);
  gl->UseProgram(p->program);
  abbe_gpu_scene_set(scene, p->program);
  abbe_image_places_set(p->light, p->program);
  abbe_image_view_set_lamp(scene, p->program, scene->local->light[0].direction);
  abbe_gpu_set_int(scene->gpu, p->program, "wavelength", (int)wavelength);
  abbe_gpu_set_int(scene->gpu, p->program, "object_face", (int)face);
  abbe_gpu_set_float(scene->gpu, p->program, "object_bias", 1e-3 * scene->refractor_radius);
  gl->Uniform4f(gl->GetUniformLocation(p->program, "mirror_plane"), (float)p->background[0],
                (float)p->background[1], (float)p->background[2], (float)p->background[3]);
  abbe_gpu_draw_screen(scene->gpu);
  return ABBE_OK;
}

static const GLfloat nothing[4] = {0, 0, 0, 0};
static const int flat[2] = {-1, -1};

static bool is_printed(const abbe_gpu_scene *scene) {
  return abbe_method_of(scene->plan->desc.profile)->printed;
}

/* What polygons are compiled for. */
static void define_polygons(const abbe_wyman_target *t, char *out, size_t size) {
  const unsigned kind = t->scene->plan->desc.polygons;
  const abbe_image_places *light = t->photons->light;
  *out = '\0';
  if (t->polygons)
    snprintf(out, size, "%s%s%s%s#define OBJECT_FACES %zu\n",
             kind & ABBE_POLYGONS_EVEN ? "#define EVEN\n" : "",
             kind & ABBE_POLYGONS_CORNERS ? "#define CORNERS\n" : "",
             kind & ABBE_POLYGONS_CULLED ? "#define CULLED\n" : "",
             light->faces > 1 ? "#define PLACES_CUBE\n" : "", light->object_faces);
}

static abbe_result make_programs(abbe_wyman_target *t, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  const abbe_render_desc *d = &t->scene->plan->desc;
  char more[320], kind[160];
  define_polygons(t, kind, sizeof kind);
  snprintf(more, sizeof more, "%s%s%s%s%s%s", t->camera ? "#define IN_CAMERA\n" : "",
           d->fill == ABBE_FILL_TRIANGLES ? "#define TRIANGLES\n" : "",
           t->directions ? "#define DIRECTIONS\n" : "",
           d->direction == ABBE_DIRECTION_MEAN ? "#define MEAN_DIRECTION\n" : "",
           is_printed(t->scene) ? "#define AS_PRINTED\n" : "", kind);
  const abbe_image_program all[] = {
      {&t->draw, t->polygons ? "wyman_polygons.vert" : "wyman_points.vert", NULL,
       t->polygons ? "wyman_polygons.frag" : "wyman_points.frag", more, false},
      {t->gathers ? &t->area : NULL, "screen.vert", NULL, "wyman_areas.frag", NULL, true},
      {t->gathers ? &t->gather : NULL, "screen.vert", NULL, "wyman_gather.frag", more, true},
      {d->history > 1 ? &t->filter : NULL, "screen.vert", NULL, "wyman_history.frag", more, true}};
  return abbe_image_programs_make(variant, t->scene->gpu, all, sizeof all / sizeof *all, error);
}

static abbe_result make_targets(abbe_wyman_target *t, abbe_error *error) {
  const size_t *size = t->places->size, history = t->scene->plan->desc.history;
  for (int k = 0; k < 2; k++) t->history.size[k] = size[k];
  t->history.printed = is_printed(t->scene);
  const GLenum format = is_printed(t->scene) ? GL_RGBA16F : GL_RGBA32F;
  const bool filters = history > 1;
  const bool directed = t->directions;
#define OF_SIZE size[0], size[1], 0, true
  const abbe_image_texture all[] = {
      {&t->sum, format, OF_SIZE},
      {directed ? &t->direction_sum : NULL, format, OF_SIZE},
      {t->gathers ? &t->areas : NULL, GL_R32F, OF_SIZE},
      {t->gathers ? &t->gathered[0] : NULL, format, OF_SIZE},
      {t->gathers && directed ? &t->gathered[1] : NULL, format, OF_SIZE},
      {filters ? &t->filtered[0] : NULL, format, OF_SIZE},
      {filters && directed ? &t->filtered[1] : NULL, format, OF_SIZE},
      {filters ? &t->history.sums[0] : NULL, format, OF_SIZE},
      {history > 2 ? &t->history.sums[1] : NULL, format, OF_SIZE},
      {history > 3 ? &t->history.sums[2] : NULL, format, OF_SIZE}};
#undef OF_SIZE
  return abbe_image_textures_make(t->scene->gpu, all, sizeof all / sizeof *all, error);
}

abbe_result abbe_wyman_target_make(const abbe_wyman_photons *photons,
                                   const abbe_image_places *places, bool camera,
                                   const abbe_shader_variant *variant, abbe_wyman_target *out,
                                   abbe_error *error) {
  const abbe_render_desc *d = &photons->scene->plan->desc;
  *out = (abbe_wyman_target){
      .scene = photons->scene,
      .photons = photons,
      .places = places,
      .camera = camera,
      .directions = d->direction != ABBE_DIRECTION_DIRECT,
      .polygons = d->fill == ABBE_FILL_QUADS || d->fill == ABBE_FILL_TRIANGLES,
      .gathers = d->fill == ABBE_FILL_GATHER_EYE || d->fill == ABBE_FILL_GATHER_LIGHT};
  if (out->polygons) photons->scene->gpu->gl->GenQueries(1, &out->query);
  ABBE_TRY(make_targets(out, error));
  return make_programs(out, variant, error);
}

void abbe_wyman_target_free(abbe_wyman_target *t) {
  if (t->scene == NULL) return;
  abbe_gpu *gpu = t->scene->gpu;
  abbe_gpu_drop_textures(gpu, 1, &t->sum);
  abbe_gpu_drop_textures(gpu, 1, &t->direction_sum);
  abbe_gpu_drop_textures(gpu, 1, &t->areas);
  abbe_gpu_drop_textures(gpu, 2, t->filtered);
  abbe_gpu_drop_textures(gpu, 2, t->gathered);
  abbe_gpu_drop_textures(gpu, ABBE_METHOD_KEPT, t->history.sums);
  if (t->query != 0) gpu->gl->DeleteQueries(1, &t->query);
  *t = (abbe_wyman_target){0};
}

/* The angle of a corner of a window, from its middle. */
static double corner_angle(double x, double y) {
  return atan2(x * y, sqrt(1 + x * x + y * y));
}

/* What a view sees, sr. */
static double solid_angle(const abbe_view *v) {
  return corner_angle(v->window[1], v->window[3]) - corner_angle(v->window[0], v->window[3]) -
         corner_angle(v->window[1], v->window[2]) + corner_angle(v->window[0], v->window[2]);
}

static double window_area(const abbe_view *view) {
  return (view->window[1] - view->window[0]) * (view->window[3] - view->window[2]);
}

static void set_drawing(const abbe_wyman_target *t) {
  const abbe_gpu_scene *scene = t->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_image_places *light = t->photons->light;
  const double side = (double)scene->plan->desc.photons;
  const double cell = window_area(&light->object_face[0].view) / (side * side);
  const double pixel = window_area(&t->places->view.view) /
                       ((double)t->places->size[0] * (double)t->places->size[1]);
  const double *from = light->view.view.origin;
  if (scene->plan->desc.polygons & ABBE_POLYGONS_CULLED) abbe_image_places_set(light, t->draw);
  abbe_image_view_set_view(scene, t->draw, "drawn_from", &t->places->view.view);
  abbe_image_view_set_clip(scene, t->draw, "drawn_matrix", &t->places->view);
  abbe_gpu_bind_texture(scene->gpu, t->draw, "photon_places", 0, t->photons->places);
  abbe_gpu_bind_texture(scene->gpu, t->draw, "photon_directions", 1, t->photons->incident);
  abbe_gpu_bind_texture(scene->gpu, t->draw, "drawn_places", 5, t->places->receivers);
  abbe_gpu_set_int(scene->gpu, t->draw, "grid", (int)side);
  abbe_gpu_set_float(scene->gpu, t->draw, "strength", cell / pixel);
  abbe_gpu_set_float(scene->gpu, t->draw, "cell_area", cell);
  abbe_gpu_set_float(scene->gpu, t->draw, "even_beam",
                     solid_angle(&light->object_face[0].view) / (side * side));
  gl->Uniform3f(gl->GetUniformLocation(t->draw, "light_at"), (float)from[0], (float)from[1],
                (float)from[2]);
}

/* Waits for the device: how many polygons lie over a pixel, in the mean. */
static double count_layers(const abbe_wyman_target *t) {
  GLuint fragments = 0;
  t->scene->gpu->gl->GetQueryObjectuiv(t->query, GL_QUERY_RESULT, &fragments);
  return fragments / ((double)t->places->size[0] * (double)t->places->size[1]);
}

/* What is drawn first clears the image. */
static abbe_result draw(abbe_wyman_target *t, const float colour[3], bool first,
                        abbe_error *error) {
  const abbe_gpu_scene *scene = t->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const size_t side = scene->plan->desc.photons, cells = (side - 1) * (side - 1);
  const GLuint targets[2] = {t->sum, t->direction_sum};
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, targets, flat, t->directions ? 2 : 1, 0,
                               t->places->size[0], t->places->size[1], error));
  for (int i = 0; first && i <= t->directions; i++) gl->ClearBufferfv(GL_COLOR, i, nothing);
  gl->Disable(GL_DEPTH_TEST);
  gl->Enable(GL_BLEND);
  gl->Enable(GL_PROGRAM_POINT_SIZE);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->UseProgram(t->draw);
  set_drawing(t);
  gl->Uniform3f(gl->GetUniformLocation(t->draw, "colour"), colour[0], colour[1], colour[2]);
  const bool counts = t->query != 0 && scene->gpu->statistics != NULL;
  if (counts) gl->BeginQuery(GL_SAMPLES_PASSED, t->query);
  if (t->polygons)
    abbe_gpu_draw_things(scene->gpu, GL_TRIANGLES, cells, 6);
  else
    abbe_gpu_draw_things(scene->gpu, GL_POINTS, side * side, 1);
  if (counts) gl->EndQuery(GL_SAMPLES_PASSED);
  gl->Disable(GL_BLEND);
  if (counts) t->layers += count_layers(t) / (double)scene->plan->desc.wavelengths;
  return ABBE_OK;
}

/* A pass over the image into one texture, or with directions into two. */
static abbe_result draw_over(const abbe_wyman_target *t, const GLuint target[2],
                             abbe_error *error) {
  const abbe_gl *gl = t->scene->gpu->gl;
  ABBE_TRY(abbe_gpu_set_target(t->scene->gpu, target, flat, target[1] != 0 ? 2 : 1, 0,
                               t->places->size[0], t->places->size[1], error));
  gl->Disable(GL_DEPTH_TEST);
  abbe_gpu_draw_screen(t->scene->gpu);
  return ABBE_OK;
}

static void bind_sums(const abbe_wyman_target *t, GLuint program) {
  abbe_gpu *gpu = t->scene->gpu;
  gpu->gl->UseProgram(program);
  abbe_gpu_bind_texture(gpu, program, "photon_sums", 0, t->light);
  abbe_gpu_bind_texture(gpu, program, "photon_direction_sums", 1, t->light_directions);
}

static abbe_result filter(abbe_wyman_target *t, bool next, abbe_error *error) {
  abbe_method_history *h = &t->history;
  abbe_gpu *gpu = t->scene->gpu;
  const size_t most = t->scene->plan->desc.history - 1;
  bind_sums(t, t->filter);
  abbe_gpu_bind_texture(gpu, t->filter, "kept[0]", 2, h->sums[0]);
  abbe_gpu_bind_texture(gpu, t->filter, "kept[1]", 3, h->sums[1]);
  abbe_gpu_bind_texture(gpu, t->filter, "kept[2]", 4, h->sums[2]);
  abbe_gpu_set_int(gpu, t->filter, "frames", (int)h->count);
  abbe_result result = draw_over(t, t->filtered, error);
  t->light = t->filtered[0];
  t->light_directions = t->filtered[1];
  if (result != ABBE_OK || !next) return result;
  const GLuint oldest = h->sums[most - 1];
  for (size_t i = most - 1; i > 0; i--) h->sums[i] = h->sums[i - 1];
  h->sums[0] = t->sum;
  t->sum = oldest;
  if (h->count < most) h->count++;
  return ABBE_OK;
}

static abbe_result gather(abbe_wyman_target *t, abbe_error *error) {
  const GLuint areas[2] = {t->areas, 0};
  abbe_gpu *gpu = t->scene->gpu;
  gpu->gl->UseProgram(t->area);
  abbe_gpu_bind_texture(gpu, t->area, "drawn_places", 0, t->places->receivers);
  ABBE_TRY(draw_over(t, areas, error));
  bind_sums(t, t->gather);
  abbe_gpu_bind_texture(gpu, t->gather, "areas", 2, t->areas);
  abbe_result result = draw_over(t, t->gathered, error);
  t->light = t->gathered[0];
  t->light_directions = t->gathered[1];
  return result;
}

abbe_result abbe_wyman_target_run(abbe_wyman_target *t, float (*colour)[3], bool next_frame,
                                  bool kept, abbe_error *error) {
  const abbe_render_desc *d = &t->scene->plan->desc;
  abbe_result result = ABBE_OK;
  if (t->scene->gpu->statistics != NULL) t->layers = 0;
  const size_t faces = t->photons->light->object_faces;
  for (size_t i = 0; i < d->wavelengths * faces && result == ABBE_OK; i++) {
    if (!kept)
      result = wyman_photons_run(t->photons, i % d->wavelengths, i / d->wavelengths, error);
    if (result == ABBE_OK) result = draw(t, colour[i % d->wavelengths], i == 0, error);
  }
  t->light = t->sum;
  t->light_directions = t->direction_sum;
  if (result == ABBE_OK && d->history > 1) result = filter(t, next_frame, error);
  if (result == ABBE_OK && t->gathers) result = gather(t, error);
  return result;
}
