/* Materials of glTF files: the first byte picks .gltf or .glb and whether a material is named, the
 * rest is the file. */
#include "tests/fuzz/keeps.h"
#include "tests/fuzz/memory_file.h"

#include "scenes/import/mesh/gltf_material.h"

#include <errno.h>

const char *const fuzz_words[] = {"{\"materials\":[",
                                  "\"extensions\":{",
                                  "\"KHR_materials_transmission\":{\"transmissionFactor\":1}",
                                  "\"KHR_materials_volume\":{\"thicknessFactor\":0.01}",
                                  "\"KHR_materials_ior\":{\"ior\":1.5}",
                                  "\"KHR_materials_dispersion\":{\"dispersion\":0.36}",
                                  "\"attenuationDistance\":0.02",
                                  "\"attenuationColor\":[0.5,0.25,0]",
                                  "\"pbrMetallicRoughness\":{",
                                  "\"baseColorFactor\":[1,1,1,1]",
                                  "\"roughnessFactor\":0",
                                  "\"name\":\"stone\"",
                                  "\\u0000",
                                  "[[[[[[[[[[[[[[[[",
                                  "}]}",
                                  "null",
                                  NULL};

/* Of a name with the ending that the reader goes by. */
static const char *link_named(const char *target, const char *kind) {
  static char name[64];
  snprintf(name, sizeof name, "fuzz_gltf_material.%ld.%s", (long)getpid(), kind);
  FUZZ_PROMISE(symlink(target, name) == 0 || errno == EEXIST);
  return name;
}

/* What was read is a material that a table can keep. */
static void check(abbe_material *material) {
  abbe_error error = {0};
  double n = 0;
  FUZZ_PROMISE(abbe_material_check(material, &error) == ABBE_OK);
  FUZZ_PROMISE(abbe_material_n(material, 550, &n, &error) == ABBE_OK && n >= 1);
  FUZZ_PROMISE(abbe_material_attenuation(material, 550) >= 0);
  const abbe_material_table table = {.material = material, .count = 1};
  fuzz_keeps(&table);
}

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_material material;
  abbe_error error = {0};
  char *name = NULL;
  if (size == 0) return 0;
  const char *path = link_named(memory_file(data + 1, size - 1), data[0] & 1 ? "glb" : "gltf");
  const abbe_result result =
      FUZZED(abbe_gltf_material_load(path, data[0] & 2 ? "stone" : NULL, &material, &name, &error),
             &error);
  if (result == ABBE_OK) {
    check(&material);
    abbe_material_free(&material);
    free(name);
  } else {
    FUZZ_PROMISE(error.text[0] != '\0' && name == NULL);
  }
  unlink(path);
  return 0;
}
