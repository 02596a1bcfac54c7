/* Checkpoints of a trace. Input: a byte of choices, then edits of a whole checkpoint, four bytes
 * each: where (two, from the end if the choice 1 is set), what to do (0 flips bits, 1 cuts there, 2
 * repeats from there), and the bits. Choice 2 hashes the file anew, so that what is behind the hash
 * is met as well; choice 4 takes the input itself as the file.
 */
#include "tests/fuzz/memory_file.h"

#include "scenes/import/scene_file.h"
#include "validation/tracer/checkpoint.h"
#include "validation/tracer/tracer.h"

#include <string.h>

const char *const fuzz_words[] = {"\x02\x10", "\x03\x08", "abbe checkpoint 8\n", "\n\n", "scene ",
                                  "physics ", NULL};

enum { MOST = 1 << 16 };

static abbe_scene scene;
static abbe_tracer *tracer;
static uint8_t whole[MOST], file[2 * MOST];
static size_t whole_size;

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
  FILE *from = fopen(path, "rb");
  FUZZ_PROMISE(from != NULL);
  whole_size = fread(whole, 1, sizeof whole, from);
  fclose(from);
  unlink(path);
  FUZZ_PROMISE(whole_size > 100 && whole_size < MOST);
}

static size_t edit(const uint8_t *data, size_t size, int from_end) {
  size_t length = whole_size;
  memcpy(file, whole, length);
  for (; size >= 4 && length > 0; data += 4, size -= 4) {
    size_t at = ((size_t)data[0] | (size_t)data[1] << 8) % length;
    if (from_end) at = length - 1 - at;
    if (data[2] % 4 == 1) length = at;
    if (data[2] % 4 == 2 && length + (length - at) <= MOST) {
      memcpy(file + length, file + at, length - at);
      length += length - at;
    }
    if (data[2] % 4 == 0 || data[2] % 4 == 3) file[at] ^= data[3];
  }
  return length;
}

static void hash_anew(size_t length) {
  uint64_t h = 14695981039346656037u;
  if (length < sizeof h) return;
  for (size_t i = 0; i < length - sizeof h; i++) h = (h ^ file[i]) * 1099511628211u;
  memcpy(file + length - sizeof h, &h, sizeof h);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (tracer == NULL) prepare();
  if (size == 0) return 0;
  const unsigned choices = data[0];
  size_t length = size - 1;
  if ((choices & 4) != 0 && length <= MOST)
    memcpy(file, data + 1, length);
  else
    length = edit(data + 1, size - 1, choices & 1);
  if (choices & 2) hash_anew(length);
  abbe_error error = {0};
  const size_t passes = abbe_tracer_passes(tracer);
  if (abbe_checkpoint_load(tracer, memory_file(file, length), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && abbe_tracer_passes(tracer) == passes);
    return 0;
  }
  FUZZ_PROMISE((choices & 2) != 0 || (length == whole_size && memcmp(file, whole, length) == 0));
  abbe_image image;
  FUZZ_PROMISE(abbe_tracer_picture(tracer, &image, &error) == ABBE_OK);
  abbe_image_free(&image);
  abbe_tracer_pass(tracer, NULL, &error); /* there may be no pass behind the file's */
  FUZZ_PROMISE(abbe_checkpoint_load(tracer, memory_file(whole, whole_size), &error) == ABBE_OK);
  return 0;
}
