/* Checkpoints whose hash is right and whose content is not: of other processors, or forged. */
#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/tracer_state.h"

#include <unistd.h>

static char folder[64], path[80];
static abbe_scene scene;
static const abbe_trace_desc small = {
    .width = 6, .height = 5, .map_width = 6, .photons = 500, .threads = 1};

static void setup(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-forged-XXXXXX");
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/run.checkpoint", folder);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BEADS("crown"));
}

static void teardown(void) {
  unlink(path);
  abbe_scene_free(&scene);
  assert_false(rmdir(folder));
}

/* The file of a run of that many passes; malloc'd. */
static char *saved(size_t passes, size_t *size) {
  char *data = NULL;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  run_passes(tracer, passes);
  OK(abbe_checkpoint_save(tracer, path, &error));
  OK(abbe_file_read(path, 1 << 24, &data, size, &error));
  return data;
}

/* Written anew with the hash that goes with it, as whoever forges a file can do. */
static void write_forged(char *data, size_t size) {
  uint64_t h = 14695981039346656037u;
  for (size_t i = 0; i < size - sizeof h; i++) h = (h ^ (unsigned char)data[i]) * 1099511628211u;
  memcpy(data + size - sizeof h, &h, sizeof h);
  OK(abbe_file_write(path, data, size, &error));
}

GROUP(setup, teardown);

/* Sums that no passes have would overflow with the next ones, and such numbers of passes too. */
TEST(forged_numbers_are_told) {
  abbe_error why = {0};
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  size_t size = 0;
  FREED char *data = saved(2, &size);
  write_forged(data, size);
  OK(abbe_checkpoint_load(tracer, path, &error));
  abbe_tracer_free(tracer);
  tracer = make_tracer(&scene, &small);
  /* the last sum's highest byte: just within what two passes can have, and beyond it */
  char *const high = data + size - 8 - 1;
  static const struct {
    signed char value;
    abbe_result result;
  } bytes[] = {{0x7f, ABBE_PARSE}, {-128, ABBE_PARSE}, {1, ABBE_PARSE}, {0, ABBE_OK}};
  for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++) {
    const char was = *high;
    *high = (char)bytes[i].value;
    write_forged(data, size);
    *high = was;
    assert_int_equal(abbe_checkpoint_load(tracer, path, &why), bytes[i].result);
    if (bytes[i].result != ABBE_OK) assert_contains(why.text, "damaged");
  }
  run_passes(tracer, 1);
  assert_int_equal(abbe_tracer_passes(tracer), 3);
  abbe_tracer_free(tracer);
  tracer = make_tracer(&scene, &small);
  /* first, end and step of the passes */
  static const uint64_t passes[][3] = {
      {2, 0, 1},          {0, 2, 0},          {0, 3, 2},          {0, 1 << 21, 1},
      {UINT64_MAX, 0, 1}, {0, UINT64_MAX, 1}, {0, 2, UINT64_MAX}, {1 << 20, 1 << 20 | 1, 1}};
  char *const numbers = strstr(data, "\n\n") + 2;
  for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
    memcpy(numbers, passes[i], sizeof passes[i]);
    write_forged(data, size);
    REFUSED(ABBE_PARSE, "checkpoint is cut off or damaged",
            abbe_checkpoint_load(tracer, path, &error));
    assert_int_equal(abbe_tracer_passes(tracer), 0);
  }
}

/* Sums and counts that are as large as all passes but the last can make them; the file of one pass
 * is changed so. */
static abbe_pass_counts fill(char *data, size_t size) {
  const uint64_t passes = ABBE_WHOLE_SUM_MOST_PASSES - 1, most = passes * ABBE_PASS_COUNTS_MOST;
  const abbe_pass_counts full = {.end = passes,
                                 .step = 1,
                                 .photons = most,
                                 .light_rays = most,
                                 .eye_rays = most,
                                 .cuts = most};
  abbe_whole_sum sum = (abbe_whole_sum)passes << (ABBE_WHOLE_SUM_BITS + 2);
  char *const numbers = strstr(data, "\n\n") + 2;
  memcpy(numbers, &full, sizeof full);
  for (char *at = numbers + sizeof full; at < data + size - 8; at += sizeof sum, sum = -sum)
    memcpy(at, &sum, sizeof sum);
  write_forged(data, size);
  return full;
}

/* The last pass there can be adds to full sums what it adds to empty ones; no other follows. */
TEST(the_last_pass_is_added_whole) {
  const size_t last = ABBE_WHOLE_SUM_MOST_PASSES - 1;
  size_t size = 0;
  FREED char *data = saved(1, &size);
  const abbe_pass_counts full = fill(data, size);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  HELD(abbe_tracer, alone) = make_tracer(&scene, &small);
  OK(abbe_checkpoint_load(tracer, path, &error));
  OK(abbe_tracer_begin_at(alone, last, 1, &error));
  run_passes(tracer, 1);
  run_passes(alone, 1);
  abbe_pass_counts c, more;
  abbe_pass_counts_get(tracer, &c);
  abbe_pass_counts_get(alone, &more);
  assert_true(more.photons > 0 && more.light_rays > 0 && more.eye_rays > 0);
  assert_int_equal(c.end, last + 1);
  assert_int_equal(c.photons, full.photons + more.photons);
  assert_int_equal(c.light_rays, full.light_rays + more.light_rays);
  assert_int_equal(c.eye_rays, full.eye_rays + more.eye_rays);
  assert_int_equal(c.cuts, full.cuts + more.cuts);
  abbe_whole_sum was = (abbe_whole_sum)last << (ABBE_WHOLE_SUM_BITS + 2);
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS], own[ABBE_PASS_SUMS_PARTS];
  abbe_pass_sums_spans(tracer, span);
  abbe_pass_sums_spans(alone, own);
  size_t changed = 0;
  for (int k = 0; k < ABBE_PASS_SUMS_PARTS; k++)
    for (size_t i = 0; i < span[k].count; i++, was = -was) {
      assert_true(span[k].sum[i] == was + own[k].sum[i]);
      changed += own[k].sum[i] != 0;
    }
  assert_true(changed > 50);
  REFUSED(ABBE_INVALID_ARGUMENT, "no more than 1048576 passes",
          abbe_tracer_pass(tracer, NULL, &error));
  OK(abbe_checkpoint_save(tracer, path, &error));
  OK(abbe_checkpoint_load(tracer, path, &error));
  assert_int_equal(abbe_tracer_passes(tracer), last + 1);
}

/* More photons, rays or cuts than the passes can have. */
TEST(forged_counts_are_told) {
  size_t size = 0;
  FREED char *data = saved(1, &size);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  for (int k = 0; k < 4; k++) {
    abbe_pass_counts c = fill(data, size);
    uint64_t *const count[] = {&c.photons, &c.light_rays, &c.eye_rays, &c.cuts};
    ++*count[k];
    memcpy(strstr(data, "\n\n") + 2, &c, sizeof c);
    write_forged(data, size);
    REFUSED(ABBE_PARSE, "checkpoint is cut off or damaged",
            abbe_checkpoint_load(tracer, path, &error));
  }
}

/* A file of a processor on which Embree takes other instructions. */
TEST(other_instructions_are_told) {
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  size_t size = 0;
  FREED char *data = saved(1, &size);
  char *const line = strstr(data, "instructions ");
  assert_non_null(line);
  const char *ours = printed("%.*s", (int)strcspn(line, "\n"), line);
  line[strlen("instructions ")] = 'z';
  write_forged(data, size);
  REFUSED(ABBE_INVALID_ARGUMENT, "instructions z", abbe_checkpoint_load(tracer, path, &error));
  assert_contains(last_error.text, ours);
  const char *const paths[] = {path};
  REFUSED(ABBE_INVALID_ARGUMENT, "put parts together",
          abbe_checkpoint_merge(tracer, paths, 1, NULL, &error));
}
