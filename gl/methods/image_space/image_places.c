#include "gl/methods/image_space/image_places.h"

#include "base/maths.h"
#include "gl/light/photon_lights.h"

#include <math.h>

static const double widest = 1.55;        /* tangent of a window of objects */
static const double nearest_share = 1e-3; /* share of the farthest distance */

void abbe_image_cube_one(const abbe_view *view, abbe_image_cube *out) {
  *out = (abbe_image_cube){.faces = 1, .object_faces = 1};
  out->face[0] = out->object_face[0] = *view;
}

static double farthest_of(const abbe_gpu_scene *scene, const size_t *object, size_t count) {
  const double *from = scene->local->light[0].position;
  double far = 0;
  for (size_t i = 0; i < count; i++) {
    const abbe_mesh *mesh = &scene->local->object[object[i]].mesh;
    for (size_t k = 0; k < mesh->vertex_count; k++) {
      double to[3];
      abbe_vector_subtract(mesh->position[k], from, to);
      far = fmax(far, abbe_vector_length(to));
    }
  }
  return far;
}

static void open_faces(const double origin[3], double tangent, double far,
                       abbe_view out[ABBE_LIGHT_CUBE_FACES]) {
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    abbe_light_cube_look(origin, face, &out[face]);
    for (int k = 0; k < 4; k++) out[face].window[k] = k % 2 == 0 ? -tangent : tangent;
    out[face].near = nearest_share * far;
    out[face].far = far;
  }
}

/* A square around all objects; false where one view does not show them well. */
static bool fit_objects(const abbe_gpu_scene *scene, double far, abbe_view *view) {
  const abbe_plan *plan = scene->plan;
  bool all = true;
  abbe_photon_light_look(scene, 0, view);
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_mesh *mesh = &scene->local->object[plan->refractor_object[i]].mesh;
    all = abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count) && all;
  }
  if (!all) return false;
  abbe_view_pad(view, 0.01);
  abbe_view_square(view);
  view->near = nearest_share * far;
  view->far = far;
  for (int k = 0; k < 4; k++) all = all && fabs(view->window[k]) <= widest;
  return all;
}

void abbe_image_cube_make(const abbe_gpu_scene *scene, size_t side, size_t border, bool whole,
                          abbe_image_cube *out) {
  const abbe_plan *plan = scene->plan;
  const double *origin = scene->local->light[0].position;
  const double far = 1.01 * fmax(farthest_of(scene, plan->receiver_object, plan->receiver_count),
                                 farthest_of(scene, plan->refractor_object, plan->refractor_count));
  *out = (abbe_image_cube){.faces = ABBE_LIGHT_CUBE_FACES, .object_faces = 1};
  open_faces(origin, (double)side / (double)(side - 2 * border), far, out->face);
  if (!whole && fit_objects(scene, far, &out->object_face[0])) return;
  out->object_faces = ABBE_LIGHT_CUBE_FACES;
  open_faces(origin, 1, far, out->object_face);
}

static const GLfloat nothing[4] = {0, 0, 0, 0}, far_away = 1;
static const int all_of_it = -1;

static abbe_result make_targets(abbe_image_places *p, abbe_error *error) {
  const size_t faces = p->faces > 1 ? p->faces : 0, layers = 2 * p->object_faces;
  const size_t *size = p->size, *grid = p->grid;
  const abbe_image_texture all[] = {
      {&p->receivers, GL_RGBA32F, size[0], size[1], faces, false},
      {&p->depth, GL_DEPTH_COMPONENT32F, size[0], size[1], faces, false},
      {&p->places, GL_RGBA32F, grid[0], grid[1], layers, false},
      {&p->normals, GL_RGBA32F, grid[0], grid[1], layers, true},
      {&p->depths, GL_DEPTH_COMPONENT32F, grid[0], grid[1], layers, false}};
  return abbe_image_textures_make(p->scene->gpu, all, sizeof all / sizeof *all, error);
}

static abbe_result make_programs(abbe_image_places *p, abbe_error *error) {
  const bool around = p->faces > 1;
  const char *vertex = around ? "image_objects.vert" : "surface.vert";
  const char *faces = around ? "image_faces.geom" : NULL;
  const abbe_image_program all[] = {
      {&p->seen, vertex, faces, "image_places.frag", NULL, true},
      {&p->depth_only, vertex, faces, "depth.frag", NULL, true},
      {&p->objects, "image_objects.vert", "image_objects.geom", "image_objects.frag", NULL, true}};
  return abbe_image_programs_make(NULL, p->scene->gpu, all, sizeof all / sizeof *all, error);
}

void abbe_image_places_look(abbe_image_places *p, const abbe_image_cube *cube) {
  p->faces = cube->faces;
  p->object_faces = cube->object_faces;
  for (size_t f = 0; f < p->faces; f++) abbe_image_view_make(&cube->face[f], &p->face[f]);
  for (size_t f = 0; f < p->object_faces; f++)
    abbe_image_view_make(&cube->object_face[f], &p->object_face[f]);
  p->view = p->face[0];
}

abbe_result abbe_image_places_make(const abbe_gpu_scene *scene, const abbe_image_cube *cube,
                                   const size_t size[2], const size_t grid[2], bool counts,
                                   abbe_image_places *out, abbe_error *error) {
  *out = (abbe_image_places){.scene = scene};
  abbe_image_places_look(out, cube);
  for (int k = 0; k < 2; k++) {
    out->size[k] = size[k];
    out->grid[k] = grid[k];
  }
  if (counts) scene->gpu->gl->GenQueries(1, &out->query);
  ABBE_TRY(make_targets(out, error));
  return make_programs(out, error);
}

void abbe_image_places_free(abbe_image_places *p) {
  if (p->scene == NULL) return;
  GLuint textures[] = {p->receivers, p->depth, p->places, p->normals, p->depths};
  abbe_gpu_drop_textures(p->scene->gpu, sizeof textures / sizeof *textures, textures);
  if (p->query != 0) p->scene->gpu->gl->DeleteQueries(1, &p->query);
  *p = (abbe_image_places){0};
}

static void set_faces(const abbe_image_places *p, GLuint program) {
  static const char *const names[ABBE_LIGHT_CUBE_FACES] = {"face_matrix[0]", "face_matrix[1]",
                                                           "face_matrix[2]", "face_matrix[3]",
                                                           "face_matrix[4]", "face_matrix[5]"};
  if (p->faces == 1) abbe_image_view_set_clip(p->scene, program, "view_projection", &p->view);
  for (size_t f = 0; f < p->faces && p->faces > 1; f++)
    abbe_image_view_set_clip(p->scene, program, names[f], &p->face[f]);
}

abbe_result abbe_image_places_receivers(abbe_image_places *p, abbe_error *error) {
  const abbe_gl *gl = p->scene->gpu->gl;
  const abbe_plan *plan = p->scene->plan;
  ABBE_TRY(abbe_gpu_set_target(p->scene->gpu, &p->receivers, &all_of_it, 1, p->depth, p->size[0],
                               p->size[1], error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(p->seen);
  set_faces(p, p->seen);
  for (size_t i = 0; i < plan->receiver_count; i++)
    abbe_gpu_meshes_draw(p->scene, plan->receiver_object[i]);
  return ABBE_OK;
}

abbe_result abbe_image_places_shadow(abbe_image_places *p, abbe_error *error) {
  const abbe_gl *gl = p->scene->gpu->gl;
  const abbe_plan *plan = p->scene->plan;
  ABBE_TRY(
      abbe_gpu_set_target(p->scene->gpu, NULL, NULL, 0, p->depth, p->size[0], p->size[1], error));
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(p->depth_only);
  set_faces(p, p->depth_only);
  for (size_t i = 0; i < plan->refractor_count; i++)
    abbe_gpu_meshes_draw(p->scene, plan->refractor_object[i]);
  return ABBE_OK;
}

/* Draws one view: one of the two layers, or with -1 both. */
static void draw_face(abbe_image_places *p, const abbe_image_view *view, size_t face, int only) {
  const abbe_plan *plan = p->scene->plan;
  abbe_image_view_set_clip(p->scene, p->objects, "view_projection", view);
  abbe_gpu_set_int(p->scene->gpu, p->objects, "only", only);
  abbe_gpu_set_int(p->scene->gpu, p->objects, "first_layer", (int)(2 * face));
  for (size_t i = 0; i < plan->refractor_count; i++) {
    abbe_gpu_set_int(p->scene->gpu, p->objects, "object", (int)i);
    abbe_gpu_set_int(p->scene->gpu, p->objects, "mirror", plan->mirror[i]);
    abbe_gpu_meshes_draw(p->scene, plan->refractor_object[i]);
  }
}

/* The view of the objects' pixels. */
static abbe_image_view shifted_view(const abbe_image_places *p, size_t face) {
  abbe_view view = p->object_face[face].view;
  abbe_image_view out = p->object_face[face];
  if (p->shift[0] == 0 && p->shift[1] == 0) return out;
  for (int axis = 0; axis < 2; axis++) {
    double *window = &view.window[2 * axis];
    const double by = p->shift[axis] * (window[1] - window[0]) / (double)p->grid[axis];
    window[0] += by;
    window[1] += by;
  }
  abbe_image_view_make(&view, &out);
  return out;
}

static void draw_objects(abbe_image_places *p, int only) {
  for (size_t f = 0; f < p->object_faces; f++) {
    const abbe_image_view view = shifted_view(p, f);
    draw_face(p, &view, f, only);
  }
}

abbe_result abbe_image_places_objects(abbe_image_places *p, abbe_error *error) {
  static const int all[2] = {-1, -1};
  const abbe_gl *gl = p->scene->gpu->gl;
  const abbe_view *view = &p->view.view;
  const GLuint colour[2] = {p->places, p->normals};
  const double *from = view->orthographic ? view->forward : view->origin;
  ABBE_TRY(
      abbe_gpu_set_target(p->scene->gpu, colour, all, 2, p->depths, p->grid[0], p->grid[1], error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  gl->ClearBufferfv(GL_COLOR, 1, nothing);
  gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(p->objects);
  gl->Uniform4f(gl->GetUniformLocation(p->objects, "seen_along"), (float)from[0], (float)from[1],
                (float)from[2], view->orthographic ? 0 : 1);
  if (p->query == 0) {
    draw_objects(p, -1);
    return ABBE_OK;
  }
  gl->BeginQuery(GL_SAMPLES_PASSED, p->query); /* fronts alone are counted */
  draw_objects(p, 0);
  gl->EndQuery(GL_SAMPLES_PASSED);
  draw_objects(p, 1);
  return ABBE_OK;
}

size_t abbe_image_places_count(const abbe_image_places *p) {
  GLuint count = 0;
  if (p->query != 0) p->scene->gpu->gl->GetQueryObjectuiv(p->query, GL_QUERY_RESULT, &count);
  return count;
}

void abbe_image_places_set(const abbe_image_places *p, GLuint program) {
  abbe_gpu *gpu = p->scene->gpu;
  const abbe_gl *gl = gpu->gl;
  for (size_t f = 0; f < p->faces; f++)
    abbe_image_view_set_face(p->scene, program, "seen_from", f, &p->face[f].view);
  for (size_t f = 0; f < p->object_faces; f++)
    abbe_image_view_set_face(p->scene, program, "objects_from", f, &p->object_face[f].view);
  gl->Uniform2f(gl->GetUniformLocation(program, "grid_shift"),
                (float)(p->shift[0] / (double)p->grid[0]),
                (float)(p->shift[1] / (double)p->grid[1]));
  if (p->faces > 1)
    abbe_gpu_bind_array(gpu, program, "receiver_places", 2, p->receivers);
  else
    abbe_gpu_bind_texture(gpu, program, "receiver_places", 2, p->receivers);
  abbe_gpu_bind_array(gpu, program, "object_places", 3, p->places);
  abbe_gpu_bind_array(gpu, program, "object_normals", 4, p->normals);
}
