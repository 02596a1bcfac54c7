/* Checkpoints of a trace. Input: choices and edits of a whole one (edits.h). */
#include "tests/fuzz/edits.h"
#include "tests/fuzz/memory_file.h"

#include "scenes/import/scene_file.h"
#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/tracer.h"

const char *const fuzz_words[] = {"\x02\x10", "\x03\x08", "abbe checkpoint 10\n", "\n\n", "scene ",
                                  "physics ", NULL};

static abbe_scene scene;
static abbe_tracer *tracer;
static edited kept;

static const char text[] =
    "materials: table.yaml\n"
    "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], size: [3, 2]}\n"
    "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"
    "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
    "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], transform: [{translate: [0, 0, 0.2]}],\n"
    "   material: crown}\n";

static void prepare(void) {
  abbe_error error = {0};
  const abbe_trace_desc desc = {
      .width = 3, .height = 2, .map_width = 4, .map_height = 4, .photons = 64, .threads = 1};
  static const char path[] = "fuzz_checkpoint.whole";
  FUZZ_PROMISE(abbe_scene_parse(text, sizeof text - 1, ABBE_SOURCE_DIR "/tests/fuzz/parts/f.yaml",
                                NULL, &scene, &error) == ABBE_OK);
  FUZZ_PROMISE(abbe_tracer_make(&scene, &desc, &tracer, &error) == ABBE_OK);
  FUZZ_PROMISE(abbe_tracer_pass(tracer, NULL, &error) == ABBE_OK);
  FUZZ_PROMISE(abbe_checkpoint_save(tracer, path, &error) == ABBE_OK);
  edits_begin(&kept, path);
}

int fuzz_input(const uint8_t *data, size_t size) {
  if (tracer == NULL) prepare();
  if (size == 0) return 0;
  edits_make(&kept, data, size);
  abbe_error error = {0};
  const char *path = memory_file(kept.file, kept.size);
  const size_t passes = abbe_tracer_passes(tracer);
  if (FUZZED(abbe_checkpoint_load(tracer, path, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && abbe_tracer_passes(tracer) == passes);
    return 0;
  }
  FUZZ_PROMISE((data[0] & 2) != 0 || !edits_changed(&kept));
  abbe_image image;
  FUZZ_PROMISE(abbe_tracer_picture(tracer, &image, &error) == ABBE_OK);
  abbe_image_free(&image);
  abbe_tracer_pass(tracer, NULL, &error); /* there may be no pass behind the file's */
  FUZZ_PROMISE(abbe_checkpoint_load(tracer, memory_file(kept.whole, kept.whole_size), &error) ==
               ABBE_OK);
  return 0;
}
