/* Checkpoints of a caustic volume of rays, which hold a table of sequences of facets. Input:
 * choices and edits of a whole one (edits.h). How much of each cell the object leaves free is not
 * measured, which would be nearly all of the time.
 */
#include "tests/brick.h"
#include "tests/fuzz/edits.h"
#include "tests/fuzz/memory_file.h"

#include "scenes/import/scene_file.h"
#include "validation/lab/exit_fill.h"
#include "validation/lab/volume_fill.h"

const char *const fuzz_words[] = {
    "\x02\x10", "\x03\x30", "\x03\x38", "abbe volume 1\n", "\x03\x40\x40\x00\x01", NULL};

static const char place[] = "fuzz_volume_checkpoint.whole";
static abbe_scene scene;
static edited kept;
static abbe_volume_fill_desc desc = {.object = 1,
                                     .nodes = 12,
                                     .exits = 8,
                                     .asymmetric = true,
                                     .region = {.kind = ABBE_REGION_GRID, .side = 2},
                                     .threads = 1,
                                     .checkpoint = place,
                                     .checkpoint_s = 1000};

abbe_result __wrap_abbe_volume_space_measure(const abbe_geometry *geometry,
                                             const abbe_volume_region *region,
                                             const double centre[3], double radius, size_t lines,
                                             float *share, abbe_error *error);
abbe_result __wrap_abbe_volume_space_measure(const abbe_geometry *geometry,
                                             const abbe_volume_region *region,
                                             const double centre[3], double radius, size_t lines,
                                             float *share, abbe_error *error) {
  (void)geometry, (void)centre, (void)radius, (void)lines, (void)error;
  for (size_t i = 0; i < region->cells; i++) share[i] = 1;
  return ABBE_OK;
}

static bool stop_halfway(void *user, double done) {
  (void)user;
  return done < 0.5;
}

static void prepare(void) {
  abbe_error error = {0};
  abbe_caustic_volume volume;
  abbe_volume_fill_statistics statistics;
  FUZZ_PROMISE(abbe_scene_parse(brick_scene, sizeof brick_scene - 1,
                                ABBE_SOURCE_DIR "/tests/fuzz/parts/f.yaml", NULL, &scene,
                                &error) == ABBE_OK);
  desc.progress = stop_halfway;
  FUZZ_PROMISE(abbe_volume_fill(&scene, &desc, &volume, &statistics, &error) == ABBE_CANCELLED);
  desc.progress = NULL;
  desc.resume = true;
  edits_begin(&kept, place);
}

int fuzz_input(const uint8_t *data, size_t size) {
  if (kept.whole_size == 0) prepare();
  if (size == 0) return 0;
  abbe_error error = {0};
  abbe_caustic_volume volume;
  abbe_volume_fill_statistics statistics;
  edits_make(&kept, data, size);
  desc.checkpoint = memory_file(kept.file, kept.size);
  if (FUZZED(abbe_volume_fill(&scene, &desc, &volume, &statistics, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0');
    return 0;
  }
  FUZZ_PROMISE((data[0] & 2) != 0 || !edits_changed(&kept));
  FUZZ_PROMISE(statistics.sequences <= ABBE_EXIT_MOST_FACETS);
  abbe_caustic_volume_free(&volume);
  return 0;
}
