/* Files of presets. */
#include "tests/fuzz/memory_file.h"

#include "gl/accuracy/preset.h"

const char *const fuzz_words[] = {"error: ",  "fronts:\n", "  - class: ", "points:\n",
                                  "named: {", "draft: ",   "scenes: ",    "spheres",
                                  "meshes",   "&a ",       "*a",          NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_presets presets;
  abbe_error error = {0};
  const char *path = memory_file(data, size);
  if (FUZZED(abbe_presets_load(path, &presets, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && presets.count == 0);
    return 0;
  }
  FUZZ_PROMISE(presets.count <= ABBE_PRESET_CLASS_COUNT);
  for (size_t i = 0; i < presets.count; i++) {
    const abbe_preset_front *f = &presets.front[i];
    const abbe_preset_speed speed = {.light = 1, .eye = 1};
    bool kept;
    FUZZ_PROMISE(f->count >= 1 && f->count <= ABBE_PRESET_MAX_POINTS);
    for (int k = 0; k < ABBE_PRESET_COUNT; k++) FUZZ_PROMISE(f->named[k] <= f->count);
    FUZZ_PROMISE(abbe_preset_for_error(f, 0.01, &kept) < f->count);
    FUZZ_PROMISE(abbe_preset_for_time(f, &speed, 10, &kept) < f->count);
  }
  abbe_presets_free(&presets);
  return 0;
}
