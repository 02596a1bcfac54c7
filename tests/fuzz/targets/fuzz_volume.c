/* Caustic volumes, as OpenEXR files. */
#include "tests/fuzz/memory_file.h"

#include "scenes/volume/caustic_volume.h"

#include <math.h>

const char *const fuzz_words[] = {"abbe:volume", "vector", "printed", "exits", "nodes ",
                                  "shells ",     "grid",   "nm",      "1e300", NULL};

static void check_look(const abbe_caustic_volume *v, const double to_light[3]) {
  abbe_volume_sight sight;
  double sum = 0;
  abbe_caustic_volume_look(v, abbe_caustic_volume_resolve(v, ABBE_VOLUME_LOOKUP_AUTO), to_light,
                           &sight);
  FUZZ_PROMISE(sight.count >= 1 && sight.count <= 3);
  for (size_t i = 0; i < sight.count; i++) {
    FUZZ_PROMISE(sight.node[i] < v->nodes.count);
    sum += sight.weight[i];
  }
  FUZZ_PROMISE(fabs(sum - 1) < 1e-6);
}

int fuzz_input(const uint8_t *data, size_t size) {
  static const double ways[3][3] = {{0, 0, 1}, {0.6, -0.8, 0}, {0, 0, -1}};
  abbe_caustic_volume volume;
  abbe_error error = {0};
  if (FUZZED(abbe_volume_file_read(memory_file(data, size), &volume, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && volume.value == NULL);
    return 0;
  }
  if (volume.kind != ABBE_VOLUME_EXITS) {
    fuzz_same(volume.value, volume.nodes.count * volume.region.cells *
                                abbe_caustic_volume_channels(&volume) * sizeof *volume.value);
    for (int i = 0; i < 3; i++) check_look(&volume, ways[i]);
  }
  FUZZ_PROMISE(abbe_caustic_volume_bytes(&volume) > 0);
  abbe_caustic_volume_free(&volume);
  return 0;
}
