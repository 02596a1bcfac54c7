/* Checkpoints of a trace. Input: choices and edits of a whole one (edits.h). */
#include "tests/brick.h"
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

static void prepare(void) {
  abbe_error error = {0};
  const abbe_trace_desc desc = {
      .width = 3, .height = 2, .map_width = 4, .map_height = 4, .photons = 64, .threads = 1};
  static const char path[] = "fuzz_checkpoint.whole";
  FUZZ_PROMISE(abbe_scene_parse(brick_scene, sizeof brick_scene - 1,
                                ABBE_SOURCE_DIR "/tests/fuzz/parts/f.yaml", NULL, &scene,
                                &error) == ABBE_OK);
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
