/* glTF 2.0: the triangles of a scene's nodes and of their instances, quantised or not. */
#include "scenes/geometry/transform.h"
#include "scenes/import/mesh/gltf_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nodes below one another. */
enum { DEEPEST = 1000 };

/* ---- what is asked of a reader ---- */

/* Whether an extension leaves the triangles as they are, or is read. */
static bool is_known(const char *name) {
  static const char *const begins[] = {"KHR_materials_",
                                       "EXT_materials_",
                                       "MSFT_texture_",
                                       "KHR_texture_",
                                       "EXT_texture_",
                                       "KHR_lights_",
                                       "EXT_lights_",
                                       "KHR_xmp",
                                       "KHR_techniques_webgl",
                                       "KHR_mesh_quantization",
                                       "EXT_mesh_gpu_instancing"};
  for (size_t i = 0; i < sizeof begins / sizeof *begins; i++)
    if (strncmp(name, begins[i], strlen(begins[i])) == 0) return true;
  return false;
}

static abbe_result check_extensions(const abbe_gltf *g) {
  const cJSON *item, *asset = cJSON_GetObjectItemCaseSensitive(g->json.root, "asset");
  if (!cJSON_IsString(cJSON_GetObjectItemCaseSensitive(asset, "version")))
    return abbe_gltf_fail(g, ABBE_SCHEMA,
                          "it does not say its version ('version' of 'asset'); version 2 is read");
  cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(g->json.root, "extensionsRequired")) {
    const char *name = cJSON_GetStringValue(item);
    if (name == NULL || !is_known(name))
      return abbe_gltf_fail(
          g, ABBE_UNSUPPORTED,
          "it requires the extension '%.80s', which is not read; write it without",
          name != NULL ? name : "?");
  }
  return ABBE_OK;
}

static bool has_weight(const cJSON *weights) {
  const cJSON *item;
  cJSON_ArrayForEach(item, weights) if (item->valuedouble != 0) return true;
  return false;
}

/* A node's own weights go before its mesh's. */
static abbe_result check_morphs(abbe_gltf *g, const cJSON *node, const cJSON *mesh,
                                const cJSON *primitive) {
  const cJSON *own = cJSON_GetObjectItemCaseSensitive(node, "weights");
  const cJSON *weights = own ? own : cJSON_GetObjectItemCaseSensitive(mesh, "weights");
  if (cJSON_GetObjectItemCaseSensitive(primitive, "targets") == NULL) return ABBE_OK;
  /* many nodes and primitives may use one long list */
  ABBE_TRY(abbe_gltf_charge(g, (size_t)cJSON_GetArraySize(weights), 1));
  if (!has_weight(weights)) return ABBE_OK;
  return abbe_gltf_fail(g, ABBE_UNSUPPORTED,
                        "a mesh is morphed (its 'targets' have 'weights' that are not 0), which is "
                        "not read; apply them where the mesh was made");
}

static abbe_result check_node(const abbe_gltf *g, const cJSON *node) {
  if (cJSON_GetObjectItemCaseSensitive(node, "skin") == NULL) return ABBE_OK;
  return abbe_gltf_fail(g, ABBE_UNSUPPORTED,
                        "a mesh has a 'skin', whose joints place it, which is not read; apply it "
                        "where the mesh was made");
}

/* ---- primitives ---- */

typedef struct primitive {
  double *point, *normal, *uv, *index; /* normal, uv and index may be NULL */
  size_t points, indices, mode;
} primitive;

static void primitive_free(primitive *p) {
  free(p->point);
  free(p->normal);
  free(p->uv);
  free(p->index);
}

static abbe_result read_primitive(abbe_gltf *g, const cJSON *item, primitive *p) {
  const cJSON *attributes = cJSON_GetObjectItemCaseSensitive(item, "attributes"), *places;
  size_t normals = 0, uvs = 0;
  ABBE_TRY(abbe_gltf_reference(g, attributes, "POSITION", "a primitive", &g->accessors, &places));
  if (places != NULL && cJSON_GetObjectItemCaseSensitive(places, "bufferView") == NULL &&
      cJSON_GetObjectItemCaseSensitive(places, "sparse") == NULL)
    return abbe_gltf_fail(g, ABBE_UNSUPPORTED,
                          "the positions of a primitive have neither a 'bufferView' nor 'sparse' "
                          "values%s",
                          abbe_gltf_extension(item, "KHR_draco_mesh_compression") != NULL
                              ? ": they are compressed by KHR_draco_mesh_compression, which is not "
                                "read; write it without"
                              : "");
  ABBE_TRY(abbe_gltf_values(g, attributes, "POSITION", 3, &p->point, &p->points));
  ABBE_TRY(abbe_gltf_values(g, attributes, "NORMAL", 3, &p->normal, &normals));
  ABBE_TRY(abbe_gltf_values(g, attributes, "TEXCOORD_0", 2, &p->uv, &uvs));
  ABBE_TRY(abbe_gltf_values(g, item, "indices", 1, &p->index, &p->indices));
  if ((p->normal && normals != p->points) || (p->uv && uvs != p->points))
    return abbe_gltf_fail(g, ABBE_SCHEMA,
                          "a primitive has %zu positions, %zu normals and %zu texture coordinates; "
                          "all are as many",
                          p->points, normals, uvs);
  for (size_t i = 0; i < p->indices; i++)
    if (!(p->index[i] >= 0 && p->index[i] < (double)p->points))
      return abbe_gltf_fail(g, ABBE_GEOMETRY, "an index is %g, and its primitive has %zu vertices",
                            p->index[i], p->points);
  if (p->index == NULL) p->indices = p->points;
  return ABBE_OK;
}

/* ---- triangles ---- */

static size_t corner_at(const primitive *p, size_t i) {
  return p->index ? (size_t)p->index[i] : i;
}

/* What makes of a vector's components one of the world: sums of products, column by column. */
static void turn(const double columns[9], const double v[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = columns[k] * v[0] + columns[3 + k] * v[1] + columns[6 + k] * v[2];
}

static bool add_vertices(abbe_mesh_reading *to, const primitive *p, const double matrix[16]) {
  double columns[9] = {0};
  const bool normals = p->normal && abbe_transform_normal_matrix(matrix, columns);
  for (size_t i = 0; i < p->points; i++) {
    double at[3], normal[3] = {0};
    /* rows of pictures go downwards with v */
    const double uv[2] = {p->uv ? p->uv[2 * i] : 0, p->uv ? 1 - p->uv[2 * i + 1] : 0};
    abbe_transform_point(matrix, p->point + 3 * i, at);
    if (normals) turn(columns, p->normal + 3 * i, normal);
    if (!abbe_mesh_reading_point(to, at) ||
        !abbe_mesh_list_add(&to->normal, 1, sizeof normal, normal) ||
        !abbe_mesh_list_add(&to->uv, 1, sizeof uv, uv))
      return false;
  }
  return true;
}

static bool add_triangle(abbe_mesh_reading *to, const primitive *p, size_t first,
                         const size_t corner[3], bool mirrored) {
  for (int k = 0; k < 3; k++) {
    const uint32_t v = (uint32_t)(first + corner_at(p, corner[mirrored ? 2 - k : k]));
    const abbe_mesh_corner c = {v, p->uv ? v : ABBE_MESH_READING_NONE,
                                p->normal ? v : ABBE_MESH_READING_NONE};
    if (!abbe_mesh_reading_corner(to, c)) return false;
  }
  return abbe_mesh_reading_end_polygon(to);
}

/* Lists, strips, of which every second triangle is reversed, and fans. */
static abbe_result add_primitive(abbe_gltf *g, const primitive *p, const double matrix[16]) {
  enum { LIST = 4, STRIP = 5 };
  const size_t first = g->to->point.count, step = p->mode == LIST ? 3 : 1;
  const bool mirrored = abbe_transform_determinant3(matrix) < 0;
  ABBE_TRY(abbe_gltf_charge(g, p->points, 3));
  ABBE_TRY(abbe_gltf_charge(g, p->indices, 1));
  if (!add_vertices(g->to, p, matrix)) return abbe_mesh_reading_no_memory(g->to, g->error);
  for (size_t i = 0; i + 2 < p->indices; i += step) {
    const bool odd = p->mode == STRIP && i % 2 == 1;
    const size_t corner[3] = {p->mode > STRIP ? 0 : odd ? i + 1 : i, odd ? i : i + 1, i + 2};
    if (!add_triangle(g->to, p, first, corner, mirrored))
      return abbe_mesh_reading_no_memory(g->to, g->error);
  }
  return ABBE_OK;
}

/* ---- nodes ---- */

static void compose(const double t[3], const double q[4], const double s[3], double out[16]) {
  const double length = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const double k = length > 0 ? 2 / length : 0, x = q[0], y = q[1], z = q[2], w = q[3];
  const double m[16] = {s[0] * (1 - k * (y * y + z * z)),
                        s[0] * k * (x * y + z * w),
                        s[0] * k * (x * z - y * w),
                        0,
                        s[1] * k * (x * y - z * w),
                        s[1] * (1 - k * (x * x + z * z)),
                        s[1] * k * (y * z + x * w),
                        0,
                        s[2] * k * (x * z + y * w),
                        s[2] * k * (y * z - x * w),
                        s[2] * (1 - k * (x * x + y * y)),
                        0,
                        t[0],
                        t[1],
                        t[2],
                        1};
  memcpy(out, m, sizeof m);
}

static abbe_result read_numbers(const abbe_gltf *g, const cJSON *node, const char *key, int count,
                                double *out) {
  const cJSON *list = cJSON_GetObjectItemCaseSensitive(node, key), *item;
  int i = 0;
  if (list == NULL) return ABBE_OK;
  if (cJSON_GetArraySize(list) != count)
    return abbe_gltf_fail(g, ABBE_SCHEMA, "'%s' of a node is not %d numbers", key, count);
  cJSON_ArrayForEach(item, list) {
    if (!cJSON_IsNumber(item))
      return abbe_gltf_fail(g, ABBE_SCHEMA, "'%s' of a node is not %d numbers", key, count);
    out[i++] = item->valuedouble;
  }
  return ABBE_OK;
}

static abbe_result read_transform(const abbe_gltf *g, const cJSON *node, double out[16]) {
  double t[3] = {0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  ABBE_TRY(read_numbers(g, node, "translation", 3, t));
  ABBE_TRY(read_numbers(g, node, "rotation", 4, q));
  ABBE_TRY(read_numbers(g, node, "scale", 3, s));
  compose(t, q, s, out);
  return read_numbers(g, node, "matrix", 16, out);
}

/* Each has a place, a turn and a size of its own within the node; lists may lack. */
typedef struct instances {
  double *place, *rotation, *scale;
  size_t count;
} instances;

static void instances_free(instances *in) {
  free(in->place);
  free(in->rotation);
  free(in->scale);
}

static abbe_result read_instances(abbe_gltf *g, const cJSON *node, instances *out) {
  const cJSON *extension = abbe_gltf_extension(node, "EXT_mesh_gpu_instancing");
  const cJSON *attributes = cJSON_GetObjectItemCaseSensitive(extension, "attributes");
  size_t count[3] = {0};
  *out = (instances){.count = 1};
  if (extension == NULL) return ABBE_OK;
  ABBE_TRY(abbe_gltf_values(g, attributes, "TRANSLATION", 3, &out->place, &count[0]));
  ABBE_TRY(abbe_gltf_values(g, attributes, "ROTATION", 4, &out->rotation, &count[1]));
  ABBE_TRY(abbe_gltf_values(g, attributes, "SCALE", 3, &out->scale, &count[2]));
  const bool has[3] = {out->place != NULL, out->rotation != NULL, out->scale != NULL};
  out->count = has[0] ? count[0] : has[1] ? count[1] : count[2];
  for (int k = 0; k < 3; k++)
    if (has[k] && count[k] != out->count)
      return abbe_gltf_fail(g, ABBE_SCHEMA,
                            "EXT_mesh_gpu_instancing has %zu places, %zu rotations and %zu sizes; "
                            "all are as many",
                            count[0], count[1], count[2]);
  if (!has[0] && !has[1] && !has[2])
    return abbe_gltf_fail(g, ABBE_SCHEMA,
                          "EXT_mesh_gpu_instancing has none of TRANSLATION, ROTATION and SCALE");
  return ABBE_OK;
}

static void instance_matrix(const instances *in, size_t i, const double node[16], double out[16]) {
  static const double none[3] = {0}, turned[4] = {0, 0, 0, 1}, whole[3] = {1, 1, 1};
  double own[16];
  compose(in->place ? in->place + 3 * i : none, in->rotation ? in->rotation + 4 * i : turned,
          in->scale ? in->scale + 3 * i : whole, own);
  abbe_transform_multiply(node, own, out);
}

/* Whether the primitive is of the material that is to be read. */
static abbe_result is_wanted(const abbe_gltf *g, const cJSON *item, bool *wanted) {
  const cJSON *material;
  ABBE_TRY(abbe_gltf_reference(g, item, "material", "a primitive", &g->materials, &material));
  const char *name = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(material, "name"));
  *wanted = g->to->material == NULL || (name != NULL && strcmp(name, g->to->material) == 0);
  return ABBE_OK;
}

static abbe_result add_mesh(abbe_gltf *g, const cJSON *node, const cJSON *mesh,
                            const double matrix[16]) {
  const cJSON *item;
  instances in;
  ABBE_TRY(check_node(g, node));
  abbe_result result = read_instances(g, node, &in);
  cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(mesh, "primitives")) {
    enum { TRIANGLES = 4, FAN = 6 };
    primitive p = {0};
    bool wanted = false;
    if (result == ABBE_OK) result = abbe_gltf_charge(g, 1, ABBE_GLTF_VALUES_A_PRIMITIVE);
    if (result == ABBE_OK)
      result = abbe_gltf_whole(g, item, "mode", "a primitive", TRIANGLES, &p.mode);
    if (result == ABBE_OK) result = is_wanted(g, item, &wanted);
    if (result != ABBE_OK || p.mode < TRIANGLES || p.mode > FAN || !wanted) continue;
    result = check_morphs(g, node, mesh, item);
    if (result == ABBE_OK) result = read_primitive(g, item, &p);
    for (size_t i = 0; i < in.count && p.indices >= 3 && result == ABBE_OK; i++) {
      double own[16];
      instance_matrix(&in, i, matrix, own);
      result = add_primitive(g, &p, own);
    }
    primitive_free(&p);
  }
  instances_free(&in);
  return result;
}

static abbe_result walk(abbe_gltf *g, size_t index, const double above[16], int depth,
                        bool *visited) {
  const cJSON *mesh, *child;
  double matrix[16];
  if (index >= g->nodes.count)
    return abbe_gltf_fail(g, ABBE_SCHEMA, "node %zu is named, and the file has %zu", index,
                          g->nodes.count);
  if (visited[index] || depth > DEEPEST)
    return abbe_gltf_fail(g, ABBE_SCHEMA, "node %zu %s", index,
                          visited[index] ? "is below two nodes, or below itself"
                                         : "is too deep below others");
  visited[index] = true;
  const cJSON *node = g->nodes.item[index];
  abbe_result result = read_transform(g, node, matrix);
  abbe_transform_multiply(above, matrix, matrix);
  if (result == ABBE_OK) result = abbe_gltf_reference(g, node, "mesh", "a node", &g->meshes, &mesh);
  if (result == ABBE_OK && mesh != NULL) result = add_mesh(g, node, mesh, matrix);
  cJSON_ArrayForEach(child, cJSON_GetObjectItemCaseSensitive(node, "children")) {
    if (result != ABBE_OK) break;
    const double at = cJSON_IsNumber(child) ? child->valuedouble : -1;
    result = walk(g, at >= 0 && at < 1e9 ? (size_t)at : SIZE_MAX, matrix, depth + 1, visited);
  }
  return result;
}

/* Nodes that are nobody's children, where no scene says which. */
static void mark_children(const abbe_gltf *g, bool *below) {
  for (size_t i = 0; i < g->nodes.count; i++) {
    const cJSON *child;
    cJSON_ArrayForEach(child, cJSON_GetObjectItemCaseSensitive(g->nodes.item[i], "children")) {
      const double at = cJSON_IsNumber(child) ? child->valuedouble : -1;
      if (at >= 0 && at < (double)g->nodes.count) below[(size_t)at] = true;
    }
  }
}

/* In glTF y is up, here z. */
static abbe_result walk_scene(abbe_gltf *g, bool *visited, bool *below) {
  static const double y_up[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
  const cJSON *scenes = cJSON_GetObjectItemCaseSensitive(g->json.root, "scenes"), *item;
  double matrix[16];
  size_t which;
  abbe_result result = abbe_gltf_whole(g, g->json.root, "scene", "the file", 0, &which);
  const cJSON *scene = which <= INT32_MAX ? cJSON_GetArrayItem(scenes, (int)which) : NULL;
  memcpy(matrix, y_up, sizeof matrix);
  if (result == ABBE_OK && scene == NULL && (which > 0 || scenes != NULL))
    return abbe_gltf_fail(g, ABBE_SCHEMA, "'scene' of the file is %zu, and it has %d of them",
                          which, cJSON_GetArraySize(scenes));
  cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(scene, "nodes")) {
    if (result != ABBE_OK) break;
    const double at = cJSON_IsNumber(item) ? item->valuedouble : -1;
    result = walk(g, at >= 0 && at < 1e9 ? (size_t)at : SIZE_MAX, matrix, 0, visited);
  }
  if (scene == NULL) mark_children(g, below);
  for (size_t i = 0; i < g->nodes.count && scene == NULL && result == ABBE_OK; i++)
    if (!below[i]) result = walk(g, i, matrix, 0, visited);
  return result;
}

static abbe_result make_lists(abbe_gltf *g) {
  abbe_gltf_list *const lists[] = {&g->nodes,     &g->meshes, &g->materials,
                                   &g->accessors, &g->views,  &g->buffers};
  static const char *const names[] = {"nodes",     "meshes",      "materials",
                                      "accessors", "bufferViews", "buffers"};
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    ABBE_TRY(abbe_gltf_list_make(g, g->json.root, names[i], lists[i]));
  g->buffer = calloc(g->buffers.count + 1, sizeof *g->buffer);
  return g->buffer != NULL ? ABBE_OK : abbe_mesh_reading_no_memory(g->to, g->error);
}

abbe_result abbe_gltf_read(abbe_mesh_reading *to, const char *data, size_t size,
                           abbe_error *error) {
  ABBE_OWNED(abbe_gltf, g) = {.to = to, .loaded = size, .error = error};
  ABBE_TRY(abbe_gltf_json_parse(to->path, data, size, &g.json, error));
  ABBE_TRY(check_extensions(&g));
  ABBE_TRY(make_lists(&g));
  ABBE_FREED bool *visited = calloc(2 * g.nodes.count + 1, sizeof *visited);
  if (visited == NULL) return abbe_mesh_reading_no_memory(to, error);
  return walk_scene(&g, visited, visited + g.nodes.count);
}
