#include "gl/plan/layer_detail.h"
#include "gl/renderer_state.h"

#include <math.h>
#include <stdlib.h>

static double keep_within(const abbe_renderer *r, const abbe_mesh *mesh) {
  const size_t samples[2] = {abbe_renderer_samples(r, 0), abbe_renderer_samples(r, 1)};
  double cell = INFINITY, sample = INFINITY;
  for (size_t i = 0; i < r->plan.light_view_count; i++)
    if (r->plan.reaches[i])
      cell = fmin(cell, abbe_layer_detail_step(&r->light[i].near_view, r->light[i].cells, mesh));
  if (r->plan.camera_sees_refractor) sample = abbe_layer_detail_step(&r->eye, samples, mesh);
  return abbe_layer_detail_distance(cell, sample);
}

/* The mesh's vertices, under another list of faces. */
static abbe_result upload_faces(abbe_renderer *r, mesh_buffers *mesh, const uint32_t (*face)[3],
                                size_t count, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  const size_t size = count * sizeof *face;
  gl->GenVertexArrays(1, &mesh->layer_array);
  gl->BindVertexArray(mesh->layer_array);
  gl->BindBuffer(GL_ARRAY_BUFFER, mesh->vertices);
  abbe_renderer_point_to_vertices(r);
  gl->GenBuffers(1, &mesh->layer_indices);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->layer_indices);
  gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)size, face, GL_STATIC_DRAW);
  mesh->layer_index_count = (GLsizei)(3 * count);
  r->device_bytes += size;
  return abbe_gl_check(gl, "the upload of a simplified mesh", error);
}

static abbe_result simplify(abbe_renderer *r, size_t object, abbe_error *error) {
  const abbe_mesh *mesh = &r->scene->object[object].mesh;
  const double within = keep_within(r, mesh);
  uint32_t(*face)[3] = NULL;
  size_t count = 0;
  if (!(within > 0) || !isfinite(within)) return ABBE_OK;
  abbe_result result = abbe_mesh_simplify(mesh, within, &face, &count, error);
  if (result == ABBE_OK && abbe_layer_detail_saves(count, mesh->face_count))
    result = upload_faces(r, &r->mesh[object], (const uint32_t(*)[3])face, count, error);
  free(face);
  return result;
}

abbe_result abbe_renderer_make_layer_faces(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->plan.refractor_count && result == ABBE_OK; i++)
    if (abbe_layer_detail_asks(r->scene, &r->plan, i))
      result = simplify(r, r->plan.refractor_object[i], error);
  return result;
}

size_t abbe_renderer_layer_faces(const abbe_renderer *r) {
  size_t faces = 0;
  for (size_t i = 0; i < r->plan.refractor_count; i++) {
    const mesh_buffers *mesh = &r->mesh[r->plan.refractor_object[i]];
    faces += (size_t)(mesh->layer_array != 0 ? mesh->layer_index_count : mesh->index_count) / 3;
  }
  return faces;
}

void abbe_renderer_draw_refractor(abbe_renderer *r, size_t refractor) {
  const size_t object = r->plan.refractor_object[refractor];
  const mesh_buffers *mesh = &r->mesh[object];
  if (mesh->layer_array == 0) {
    abbe_renderer_draw(r, object);
    return;
  }
  r->gl->BindVertexArray(mesh->layer_array);
  r->gl->DrawElements(GL_TRIANGLES, mesh->layer_index_count, GL_UNSIGNED_INT, NULL);
}
