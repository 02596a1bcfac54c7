/* Every allocation failing in turn while files are read: meshes of each kind, and scenes that
 * together have every key. */
#include "tests/faults/operations.h"

#include "base/file.h"
#include "scenes/import/scene_file.h"
#include "scenes/mesh/mesh.h"

#define FUZZ ABBE_SOURCE_DIR "/tests/fuzz/"

static void put(const char *name, const void *data, size_t size) {
  OK(abbe_file_write(operation_path(name), data, size, &error));
}

/* So many triangles that each list of theirs grows at each of their corners, a mesh with files
 * beside it, and one whose numbers are in a file. */
static void write_meshes(void) {
  enum { LONG = 256 };
  static char text[60000];
  static const float corner[4][3] = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  static const unsigned short face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  char *at = text, bytes[sizeof corner + sizeof face];
  at += sprintf(at,
                "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                "property float u\nproperty float v\nelement tristrips 1\n"
                "property list int int vertex_indices\nelement face 1\n"
                "property list int int vertex_indices\nproperty list int float texcoord\n"
                "end_header\n",
                LONG);
  for (int i = 0; i < LONG; i++) at += sprintf(at, "%d %d 0 0 0 1 0.%d 0\n", i, i % 2, i);
  at += sprintf(at, "%d", LONG);
  for (int i = 0; i < LONG; i++) at += sprintf(at, " %d", i);
  at += sprintf(at, "\n3 0 1 2 6 0 0 1 0 0 1\n");
  put("strip.ply", text, (size_t)(at - text));
  static const char obj[] = "mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\n"
                            "f 1/1/1 2/1/1 3/1/1\n";
  put("one.obj", obj, sizeof obj - 1);
  char wide[2 * sizeof obj] = "\xff\xfe";
  for (size_t i = 0; i + 1 < sizeof obj; i++) wide[2 + 2 * i] = obj[i], wide[3 + 2 * i] = '\0';
  put("wide.obj", wide, 2 * sizeof obj);
  /* the name of its file, what ends that, and what ends all of them, beyond the first 256 bytes */
  for (size_t i = 0; i < 3; i++) {
    const size_t length = 226 + i;
    at = text + sprintf(text, "mtllib ");
    memset(at, 'm', length);
    strcpy(at + length, strchr(obj, '\n'));
    put(printed("%zu.obj", i), text, strlen(text));
  }
  static const char gltf[] =
      "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"x%20.bin\",\"byteLength\":72}],"
      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
      "\"byteLength\":24}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,"
      "\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":"
      "\"SCALAR\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0},"
      "\"indices\":1}]}],\"nodes\":[{\"mesh\":0}]}";
  put("solid.gltf", gltf, sizeof gltf - 1);
  memcpy(bytes, corner, sizeof corner);
  memcpy(bytes + sizeof corner, face, sizeof face);
  put("x .bin", bytes, sizeof bytes);
}

static abbe_result mesh_files(abbe_error *error) {
  static const char *const names[] = {"strip.ply", "one.obj", "wide.obj",  "0.obj",
                                      "1.obj",     "2.obj",   "solid.gltf"};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 7 && result == ABBE_OK; i++) {
    OWNED(abbe_mesh, mesh) = {0};
    FREED char *others = NULL;
    result = abbe_mesh_load(operation_path(names[i]), ABBE_NORMALS_AUTO, &mesh, &others, error);
    if (result == ABBE_OK) digest(mesh.position, mesh.vertex_count * sizeof *mesh.position);
    digest_text(others);
  }
  return result;
}

/* Scenes that together have every key. */
static abbe_result parsed(const char *name, abbe_error *error) {
  static char path[512];
  FREED char *text = NULL;
  size_t size = 0;
  OWNED(abbe_scene, made) = {0};
  snprintf(path, sizeof path, FUZZ "%s/%s.yaml",
           strcmp(name, "water") == 0 ? "corpus/scene" : "parts/scenes", name);
  abbe_result result = abbe_file_read(path, 1 << 16, &text, &size, error);
  if (result == ABBE_OK)
    result = abbe_scene_parse(text, size, FUZZ "parts/f.yaml", NULL, &made, error);
  for (size_t i = 0; i < made.object_count && result == ABBE_OK; i++)
    digest(made.object[i].min, sizeof made.object[i].min);
  return result;
}

#define PARSED(name)                                                                               \
  static abbe_result parsed_##name(abbe_error *error) {                                            \
    return parsed(#name, error);                                                                   \
  }
PARSED(frame)
PARSED(eye)
PARSED(stones)
PARSED(rounded)
PARSED(pictured)
PARSED(water)

static abbe_result lights(abbe_error *error) {
  OWNED(abbe_scene, made) = {0};
  const char *path = operation_path("scene.yaml");
  abbe_result result = abbe_scene_load(path, NULL, &made, error);
  if (result == ABBE_OK) result = abbe_scene_load_lights(path, NULL, &made, error);
  if (result == ABBE_OK) digest(&made.light[0].power, sizeof made.light[0].power);
  return result;
}

static abbe_result stone(abbe_error *error) {
  OWNED(abbe_scene, made) = {0};
  const abbe_scene_options options = {.materials = FUZZ "parts/table.yaml", .stone = "flat"};
  const abbe_result result =
      abbe_scene_load(ABBE_SOURCE_DIR "/scenes/designs/step-square.asc", &options, &made, error);
  for (size_t i = 0; i < made.object_count && result == ABBE_OK; i++)
    digest(made.object[i].min, sizeof made.object[i].min);
  return result;
}

GROUP(operation_setup, operation_teardown);

TEST(files_of_meshes) {
  static const operation list[] = {{"files of meshes", mesh_files, 0}};
  write_meshes();
  operation_check_all(list, 1);
}

TEST(files_of_scenes) {
  static const operation list[] = {
      {"scene that is framed", parsed_frame, 30},
      {"scene of many keys", parsed_eye, 40},
      {"scene of stones", parsed_stones, 30},
      {"scene of rounded solids", parsed_rounded, 30},
      {"scene of a picture", parsed_pictured, 10},
      {"scene of water", parsed_water, 20},
      {"lights anew", lights, 30},
      {"file of a stone", stone, 20},
  };
  static const char scene[] =
      "materials: " FUZZ "parts/table.yaml\ncamera: {eye: [0, -1, 1], target: [0, 0, 0]}\n"
      "lights: [{kind: point, position: [0, 0, 2], intensity: 1}]\n"
      "objects: [{shape: rectangle, width: 1, height: 1, reflectance: 1}]\n";
  put("scene.yaml", scene, sizeof scene - 1);
  operation_check_all(list, sizeof list / sizeof *list);
}
