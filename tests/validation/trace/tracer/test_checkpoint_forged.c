/* Checkpoints whose hash is right and whose content is not: of other processors, or forged. */
#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/checkpoint.h"

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
