#include "gl/scene/gpu_scene.h"

#include "scenes/mesh/mesh.h"

#include <stdlib.h>

/* The attributes of surface.vert, in the bound array from the bound buffer. */
static void point_to_vertices(const abbe_gpu_scene *scene) {
  static const struct {
    GLint size;
    uintptr_t offset;
  } attribute[3] = {{3, 0}, {3, 12}, {2, 24}};
  for (GLuint k = 0; k < 3; k++) {
    scene->gpu->gl->EnableVertexAttribArray(k);
    scene->gpu->gl->VertexAttribPointer(k, attribute[k].size, GL_FLOAT, GL_FALSE, 32,
                                        (const void *)attribute[k].offset);
  }
}

abbe_result abbe_gpu_mesh_upload(const abbe_gpu_scene *scene, const abbe_mesh *mesh,
                                 abbe_gpu_mesh *out, abbe_error *error) {
  const abbe_gl *gl = scene->gpu->gl;
  size_t size = mesh->vertex_count * 8 * sizeof(float);
  float *vertices = malloc(size > 0 ? size : 1);
  if (vertices == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a mesh");
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    float *v = vertices + 8 * i;
    for (int k = 0; k < 3; k++) {
      v[k] = (float)mesh->position[i][k];
      v[3 + k] = (float)mesh->normal[i][k];
    }
    v[6] = mesh->uv != NULL ? (float)mesh->uv[i][0] : 0.0f;
    v[7] = mesh->uv != NULL ? (float)mesh->uv[i][1] : 0.0f;
  }
  gl->GenVertexArrays(1, &out->array);
  gl->BindVertexArray(out->array);
  gl->GenBuffers(1, &out->vertices);
  gl->BindBuffer(GL_ARRAY_BUFFER, out->vertices);
  gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size, vertices, GL_STATIC_DRAW);
  free(vertices);
  size_t index_size = mesh->face_count * sizeof *mesh->face;
  gl->GenBuffers(1, &out->indices);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, out->indices);
  gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)index_size, mesh->face, GL_STATIC_DRAW);
  point_to_vertices(scene);
  out->index_count = (GLsizei)(3 * mesh->face_count);
  out->bytes = size + index_size;
  return abbe_gl_check(gl, "the upload of a mesh", error);
}

void abbe_gpu_mesh_free(const abbe_gpu_scene *scene, abbe_gpu_mesh *mesh) {
  const abbe_gl *gl = scene->gpu->gl;
  gl->DeleteVertexArrays(1, &mesh->array);
  gl->DeleteBuffers(1, &mesh->vertices);
  gl->DeleteBuffers(1, &mesh->indices);
  gl->DeleteBuffers(1, &mesh->coarse);
  *mesh = (abbe_gpu_mesh){0};
}

abbe_result abbe_gpu_meshes_upload(abbe_gpu_scene *scene, abbe_error *error) {
  scene->mesh = calloc(scene->local->object_count + 1, sizeof *scene->mesh);
  if (scene->mesh == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for meshes");
  scene->mesh_count = scene->local->object_count;
  abbe_result result =
      abbe_gl_check(scene->gpu->gl, "what came before meshes were uploaded", error);
  for (size_t i = 0; i < scene->local->object_count && result == ABBE_OK; i++) {
    const abbe_mesh *mesh = &scene->local->object[i].mesh;
    result = abbe_gpu_mesh_upload(scene, mesh, &scene->mesh[i], error);
    if (result == ABBE_NO_MEMORY) {
      abbe_gpu_mesh_free(scene, &scene->mesh[i]);
      abbe_gpu_make_way(scene->gpu);
      result = abbe_gpu_mesh_upload(scene, mesh, &scene->mesh[i], error);
    }
    if (result == ABBE_OK) scene->mesh_bytes += scene->mesh[i].bytes;
  }
  return result;
}

void abbe_gpu_meshes_draw(const abbe_gpu_scene *scene, size_t object) {
  const abbe_gpu_mesh *mesh = &scene->mesh[object];
  scene->gpu->gl->BindVertexArray(mesh->array);
  scene->gpu->gl->DrawElements(GL_TRIANGLES, mesh->index_count, GL_UNSIGNED_INT, NULL);
}

/* Without memory for them there are none. */
static void make_coarse(const abbe_mesh *mesh, const abbe_gl *gl, abbe_gpu_mesh *out) {
  uint32_t(*face)[3] = NULL;
  size_t count = 0;
  out->coarse_known = true;
  if (abbe_coarse_mesh_make(mesh, &face, &count, NULL) != ABBE_OK || count == 0) return;
  gl->GenBuffers(1, &out->coarse);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, out->coarse);
  gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *face), face, GL_STATIC_DRAW);
  out->coarse_count = (GLsizei)(3 * count);
  free(face);
}

void abbe_gpu_meshes_draw_coarse(const abbe_gpu_scene *scene, size_t object) {
  const abbe_gl *gl = scene->gpu->gl;
  abbe_gpu_mesh *mesh = &scene->mesh[object];
  gl->BindVertexArray(mesh->array);
  if (!mesh->coarse_known) make_coarse(&scene->local->object[object].mesh, gl, mesh);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->coarse_count > 0 ? mesh->coarse : mesh->indices);
  gl->DrawElements(GL_TRIANGLES, mesh->coarse_count > 0 ? mesh->coarse_count : mesh->index_count,
                   GL_UNSIGNED_INT, NULL);
  gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->indices);
}

void abbe_gpu_meshes_free(abbe_gpu_scene *scene) {
  for (size_t i = 0; i < scene->mesh_count; i++) abbe_gpu_mesh_free(scene, &scene->mesh[i]);
  free(scene->mesh);
  scene->mesh = NULL;
  scene->mesh_count = scene->mesh_bytes = 0;
}
