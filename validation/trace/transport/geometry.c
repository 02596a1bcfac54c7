#include "validation/trace/transport/geometry.h"

#include "base/maths.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the frame ---- */

/* Bounds of what refracts or mirrors; false where nothing does. */
static bool bound_specular(const abbe_scene *scene, double min[3], double max[3]) {
  bool any = false;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (abbe_object_kind_of(o) == ABBE_OBJECT_RECEIVER) continue;
    for (int k = 0; k < 3; k++) {
      min[k] = any ? fmin(min[k], o->min[k]) : o->min[k];
      max[k] = any ? fmax(max[k], o->max[k]) : o->max[k];
    }
    any = true;
  }
  return any;
}

static void choose_frame(abbe_geometry *g) {
  double min[3], max[3], half[3];
  if (!bound_specular(g->scene, min, max)) abbe_scene_bounds(g->scene, true, true, min, max);
  for (int k = 0; k < 3; k++) {
    g->origin[k] = 0.5 * (min[k] + max[k]);
    half[k] = 0.5 * (max[k] - min[k]);
  }
  g->unit = abbe_vector_length(half);
  if (!(g->unit > 0)) g->unit = 1;
}

void abbe_geometry_to_frame(const abbe_geometry *g, const double world[3], float frame[3]) {
  for (int k = 0; k < 3; k++) frame[k] = (float)((world[k] - g->origin[k]) / g->unit);
}

void abbe_geometry_to_world(const abbe_geometry *g, const float frame[3], double world[3]) {
  for (int k = 0; k < 3; k++) world[k] = g->origin[k] + g->unit * (double)frame[k];
}

/* ---- surfaces ---- */

static bool same_normals(const abbe_mesh *mesh) {
  for (size_t i = 0; i < mesh->face_count; i++) {
    const uint32_t *f = mesh->face[i];
    for (int c = 1; c < 3; c++)
      for (int k = 0; k < 3; k++)
        if (fabs(mesh->normal[f[c]][k] - mesh->normal[f[0]][k]) > 1e-12) return false;
  }
  return true;
}

static void face_normal(const abbe_mesh *mesh, size_t face, float out[3]) {
  const uint32_t *f = mesh->face[face];
  double n[3];
  abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], n);
  bool known = abbe_vector_normalise(n);
  for (int k = 0; k < 3; k++) out[k] = (float)(known ? n[k] : mesh->normal[f[0]][k]);
}

static void make_plane(const abbe_surface *s, size_t face, abbe_plane_face *p) {
  const uint32_t *f = s->face[face];
  for (int k = 0; k < 3; k++) {
    p->corner[k] = s->position[f[0]][k];
    p->second[k] = s->position[f[1]][k] - p->corner[k];
    p->third[k] = s->position[f[2]][k] - p->corner[k];
  }
}

static void make_bend(const abbe_surface *s, size_t face, abbe_bent_face *b) {
  const uint32_t *f = s->face[face];
  for (int k = 0; k < 3; k++) {
    b->corner[k] = s->normal[f[0]][k];
    b->second[k] = s->normal[f[1]][k] - b->corner[k];
    b->third[k] = s->normal[f[2]][k] - b->corner[k];
  }
}

static bool make_faces(const abbe_mesh *mesh, abbe_surface *s) {
  const size_t room = mesh->face_count + 1;
  s->plane = aligned_alloc(64, room * sizeof *s->plane);
  s->bent = s->flat ? NULL : aligned_alloc(64, room * sizeof *s->bent);
  if (s->plane == NULL || (!s->flat && s->bent == NULL)) return false;
  for (size_t i = 0; i < mesh->face_count; i++) {
    s->plane[i] = (abbe_plane_face){0};
    make_plane(s, i, &s->plane[i]);
    if (s->flat) {
      memcpy(s->plane[i].normal, s->normal[i], sizeof s->normal[i]);
    } else {
      face_normal(mesh, i, s->plane[i].normal);
      s->bent[i] = (abbe_bent_face){0};
      make_bend(s, i, &s->bent[i]);
    }
  }
  return true;
}

/* Triangles of one plane of a convex solid have its normal, as thin ones may be off it. Embree
 * reads 16 bytes at the last vertex: one more than there are is kept. */
static bool copy_mesh(const abbe_geometry *g, const abbe_object *object, abbe_surface *s) {
  const abbe_mesh *mesh = &object->mesh;
  s->flat = same_normals(mesh);
  size_t normals = s->flat ? mesh->face_count : mesh->vertex_count;
  s->position = calloc(mesh->vertex_count + 1, sizeof *s->position);
  s->normal = malloc(normals * sizeof *s->normal);
  s->face = malloc(mesh->face_count * sizeof *s->face);
  if (s->position == NULL || s->normal == NULL || s->face == NULL) return false;
  for (size_t i = 0; i < mesh->vertex_count; i++)
    abbe_geometry_to_frame(g, mesh->position[i], s->position[i]);
  memcpy(s->face, mesh->face, mesh->face_count * sizeof *s->face);
  for (size_t i = 0; i < normals; i++) {
    if (s->flat && object->exact.kind == ABBE_EXACT_CONVEX)
      for (int k = 0; k < 3; k++) s->normal[i][k] = (float)mesh->normal[mesh->face[i][0]][k];
    else if (s->flat)
      face_normal(mesh, i, s->normal[i]);
    else
      for (int k = 0; k < 3; k++) s->normal[i][k] = (float)mesh->normal[i][k];
  }
  s->uv = (const double(*)[2])mesh->uv;
  return make_faces(mesh, s);
}

static void attach(abbe_geometry *g, RTCGeometry geometry, unsigned id, unsigned mask) {
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(g->embree, geometry, id);
  rtcReleaseGeometry(geometry);
}

static bool add_sphere(abbe_geometry *g, const abbe_object *o, abbe_surface *s, unsigned id) {
  s->sphere = true;
  abbe_geometry_to_frame(g, o->exact.centre, s->centre);
  s->radius = (float)(o->exact.radius / g->unit);
  RTCGeometry geometry = rtcNewGeometry(g->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  float *v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                     4 * sizeof *v, 1);
  if (v != NULL) {
    memcpy(v, s->centre, sizeof s->centre);
    v[3] = s->radius;
  }
  attach(g, geometry, id, s->kind);
  return v != NULL;
}

static bool add_triangles(abbe_geometry *g, const abbe_object *o, abbe_surface *s, unsigned id) {
  if (!copy_mesh(g, o, s)) return false;
  RTCGeometry geometry = rtcNewGeometry(g->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s->position, 0,
                             sizeof *s->position, o->mesh.vertex_count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s->face, 0,
                             sizeof *s->face, o->mesh.face_count);
  attach(g, geometry, id, s->kind);
  return true;
}

static bool add_rectangle(abbe_geometry *g, const abbe_light *light, abbe_surface *s, unsigned id) {
  static const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  s->normal = malloc(sizeof *s->normal);
  RTCGeometry geometry = rtcNewGeometry(g->device, RTC_GEOMETRY_TYPE_QUAD);
  float *v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                     3 * sizeof *v, 4);
  unsigned *f = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                        4 * sizeof *f, 1);
  const bool made = v != NULL && f != NULL && s->normal != NULL;
  if (made) {
    abbe_geometry_to_frame(g, light->position, s->centre);
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++)
        v[3 * i + k] =
            s->centre[k] +
            (float)((corner[i][0] * light->edge[0][k] + corner[i][1] * light->edge[1][k]) /
                    g->unit);
    for (unsigned i = 0; i < 4; i++) f[i] = i;
    for (int k = 0; k < 3; k++) s->normal[0][k] = (float)light->direction[k];
  }
  attach(g, geometry, id, s->kind);
  return made;
}

static bool add_lamp(abbe_geometry *g, const abbe_light *light, abbe_surface *s, unsigned id) {
  s->normal = malloc(sizeof *s->normal);
  RTCGeometry geometry = rtcNewGeometry(g->device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  float *v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                     4 * sizeof *v, 1);
  float *n = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3,
                                     3 * sizeof *n, 1);
  bool made = v != NULL && n != NULL && s->normal != NULL;
  if (made) {
    abbe_geometry_to_frame(g, light->position, s->centre);
    s->radius = (float)(light->radius / g->unit);
    for (int k = 0; k < 3; k++) {
      v[k] = s->centre[k];
      n[k] = s->normal[0][k] = (float)light->direction[k];
    }
    v[3] = s->radius;
  }
  attach(g, geometry, id, s->kind);
  return made;
}

/* ---- make and free ---- */

static abbe_result count_objects(const abbe_scene *scene, abbe_geometry *g, abbe_error *error) {
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object_kind kind = abbe_object_kind_of(&scene->object[i]);
    g->refractor_count += kind == ABBE_OBJECT_REFRACTOR;
    g->receiver_count += kind == ABBE_OBJECT_RECEIVER;
    g->mirror_count += kind == ABBE_OBJECT_MIRROR;
  }
  if (g->refractor_count > ABBE_GEOMETRY_MAX_REFRACTORS)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "%s has %zu refractors; the tracer follows at most %d: join some into one "
        "mesh",
        scene->path ? scene->path : "the scene", g->refractor_count, ABBE_GEOMETRY_MAX_REFRACTORS);
  g->surface_count = scene->object_count;
  for (size_t i = 0; i < scene->light_count; i++)
    g->surface_count += abbe_light_has_size(&scene->light[i]);
  g->surface = calloc(g->surface_count + 1, sizeof *g->surface);
  g->refractor_object = calloc(g->refractor_count + 1, sizeof *g->refractor_object);
  g->mirror_object = calloc(g->mirror_count + 1, sizeof *g->mirror_object);
  if (g->surface == NULL || g->refractor_object == NULL || g->mirror_object == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu surfaces", g->surface_count);
  return ABBE_OK;
}

/* A ray that starts beyond the face behind the one that it leaves is lost: at the rim of a lens of
 * eight such steps it is half a percent of them. */
static abbe_result check_thickness(const abbe_geometry *g, abbe_error *error) {
  static const double least_steps = 8;
  for (size_t i = 0; i < g->scene->object_count; i++) {
    const abbe_object *o = &g->scene->object[i];
    if (abbe_object_kind_of(o) != ABBE_OBJECT_REFRACTOR) continue;
    const double thick = abbe_object_thickness(o);
    double far = 0;
    for (int k = 0; k < 3; k++)
      far = fmax(far, fmax(fabs(o->min[k] - g->origin[k]), fabs(o->max[k] - g->origin[k])));
    const double least = least_steps * ABBE_GEOMETRY_OFFSET * far;
    if (thick < least)
      return abbe_error_set(
          error, ABBE_UNSUPPORTED,
          "the refractor '%s' is %.3g m thin and reaches %.3g m from the middle of "
          "all refractors: the tracer's single precision does not tell its front "
          "from its back; make it at least %.2g m thick, or leave it out",
          o->name, thick, far, least);
  }
  return ABBE_OK;
}

static bool add_objects(abbe_geometry *g) {
  size_t refractors = 0, receivers = 0, mirrors = 0;
  bool added = true;
  for (size_t i = 0; i < g->scene->object_count && added; i++) {
    const abbe_object *o = &g->scene->object[i];
    abbe_surface *s = &g->surface[i];
    s->object = (uint32_t)i;
    switch (abbe_object_kind_of(o)) {
    case ABBE_OBJECT_REFRACTOR:
      s->kind = ABBE_GEOMETRY_REFRACTORS;
      s->index = (uint32_t)refractors;
      g->refractor_object[refractors++] = (uint32_t)i;
      break;
    case ABBE_OBJECT_MIRROR:
      s->kind = ABBE_GEOMETRY_MIRRORS;
      s->index = (uint32_t)mirrors;
      g->mirror_object[mirrors++] = (uint32_t)i;
      break;
    case ABBE_OBJECT_RECEIVER:
      s->kind = ABBE_GEOMETRY_RECEIVERS;
      s->index = (uint32_t)receivers++;
      break;
    }
    added = o->exact.kind == ABBE_EXACT_SPHERE ? add_sphere(g, o, s, (unsigned)i)
                                               : add_triangles(g, o, s, (unsigned)i);
  }
  size_t id = g->scene->object_count;
  for (size_t i = 0; i < g->scene->light_count && added; i++) {
    const abbe_light *light = &g->scene->light[i];
    if (!abbe_light_has_size(light)) continue;
    abbe_surface *s = &g->surface[id];
    *s = (abbe_surface){.kind = ABBE_GEOMETRY_LAMPS, .index = (uint32_t)i, .object = (uint32_t)i};
    added = light->kind == ABBE_LIGHT_DISK ? add_lamp(g, light, s, (unsigned)id++)
                                           : add_rectangle(g, light, s, (unsigned)id++);
  }
  return added;
}

/* Rays by sixteen take AVX-512, and by eight AVX, whose bits are those of SSE, or AVX2. */
static const char *processor_instructions(RTCDevice device) {
#ifdef __x86_64__
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0)
    return "avx512";
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0 &&
                 __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
             ? "avx2"
             : "sse";
#else
  (void)device;
  return "other";
#endif
}

static void describe_arithmetic(abbe_geometry *g) {
  const long version = (long)rtcGetDeviceProperty(g->device, RTC_DEVICE_PROPERTY_VERSION);
  snprintf(g->instructions, sizeof g->instructions, "%s, Embree %ld.%ld.%ld",
           processor_instructions(g->device), version / 10000, version / 100 % 100, version % 100);
}

/* One thread builds the hierarchy: its shape, and so the winner of a tie at an edge, is the same
 * on every run. */
abbe_result abbe_geometry_make(const abbe_scene *scene, abbe_geometry *out, abbe_error *error) {
  abbe_geometry g = {.scene = scene};
  *out = g;
  abbe_result result = count_objects(scene, &g, error);
  choose_frame(&g);
  if (result == ABBE_OK) result = check_thickness(&g, error);
  if (result == ABBE_OK) {
    g.device = rtcNewDevice("threads=1,set_affinity=0,ignore_config_files=1");
    if (g.device != NULL) g.embree = rtcNewScene(g.device);
    if (g.device != NULL) describe_arithmetic(&g);
    bool made = g.embree != NULL;
    if (made) {
      rtcSetSceneFlags(g.embree, RTC_SCENE_FLAG_ROBUST);
      rtcSetSceneBuildQuality(g.embree, RTC_BUILD_QUALITY_HIGH);
      made = add_objects(&g);
      rtcCommitScene(g.embree);
      made = made && rtcGetDeviceError(g.device) == RTC_ERROR_NONE;
    }
    if (!made)
      result = abbe_error_set(error, ABBE_NO_MEMORY,
                              "Embree could not build its hierarchy over the scene's surfaces");
  }
  if (result == ABBE_OK) result = abbe_solids_make(&g, &g.solid, error);
  if (result != ABBE_OK) {
    abbe_geometry_free(&g);
    return result;
  }
  *out = g;
  return ABBE_OK;
}

void abbe_geometry_free(abbe_geometry *g) {
  if (g == NULL) return;
  if (g->embree != NULL) rtcReleaseScene(g->embree);
  if (g->device != NULL) rtcReleaseDevice(g->device);
  for (size_t i = 0; g->surface != NULL && i < g->surface_count; i++) {
    free(g->surface[i].position);
    free(g->surface[i].normal);
    free(g->surface[i].face);
    free(g->surface[i].plane);
    free(g->surface[i].bent);
  }
  abbe_solids_free(g->solid, g->refractor_count);
  free(g->surface);
  free(g->refractor_object);
  free(g->mirror_object);
  *g = (abbe_geometry){0};
}

/* ---- single rays ---- */

static struct RTCRay ray_of(unsigned mask, const float o[3], const float d[3], float limit) {
  return (struct RTCRay){.org_x = o[0],
                         .org_y = o[1],
                         .org_z = o[2],
                         .dir_x = d[0],
                         .dir_y = d[1],
                         .dir_z = d[2],
                         .tnear = 0,
                         .tfar = limit,
                         .mask = mask};
}

bool abbe_geometry_hit(const abbe_geometry *g, unsigned mask, const float o[3], const float d[3],
                       float limit, abbe_hit *hit) {
  struct RTCRayHit r = {.ray = ray_of(mask, o, d, limit)};
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  abbe_embree_intersect(g->embree, &r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  abbe_geometry_place(&g->surface[r.hit.geomID], r.hit.primID, r.hit.u, r.hit.v, o, d, r.ray.tfar,
                      hit);
  return true;
}

bool abbe_geometry_occluded(const abbe_geometry *g, unsigned mask, const float o[3],
                            const float d[3], float limit) {
  struct RTCRay r = ray_of(mask, o, d, limit);
  abbe_embree_occluded(g->embree, &r);
  return r.tfar < 0;
}
