/* Volumes put aside: what was kept comes back, what is broken or another's is told, and a fill that
 * was stopped goes on to the same bits. */
#include "tests/validation/trace_scene.h"

#include "validation/lab/volume_checkpoint.h"
#include "validation/lab/volume_fill.h"

static const char path[] = "volume-checkpoint-test";

TEST(bytes_come_back) {
  double numbers[3] = {1, -2, 0.1}, back[3] = {0};
  char word[5] = "node", read[5] = "";
  const abbe_kept_bytes from[] = {{numbers, sizeof numbers}, {word, sizeof word}},
                        to[] = {{back, sizeof back}, {read, sizeof read}};
  uint64_t nodes = 0;
  OK(abbe_volume_checkpoint_save(path, 77, 12, from, 2, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, path,
          abbe_volume_checkpoint_load(path, 78, &nodes, to, 2, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_volume_checkpoint_load(path, 77, &nodes, to, 1, NULL, &error));
  assert_near(back[0], 0, 0);
  OK(abbe_volume_checkpoint_load(path, 77, &nodes, to, 2, NULL, &error));
  assert_int_equal(nodes, 12);
  assert_memory_equal(back, numbers, sizeof back);
  assert_string_equal(read, "node");
  unlink(path);
  REFUSED(ABBE_IO, "", abbe_volume_checkpoint_load(path, 77, &nodes, to, 2, NULL, &error));
}

TEST(broken_files_are_told) {
  FREED char *data = NULL;
  size_t size;
  double number = 3;
  const abbe_kept_bytes part = {&number, sizeof number};
  uint64_t nodes;
  OK(abbe_volume_checkpoint_save(path, 1, 2, &part, 1, &error));
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  for (size_t cut = 0; cut < size; cut += 7) {
    OK(abbe_file_write(path, data, cut, &error));
    assert_int_equal(abbe_volume_checkpoint_load(path, 1, &nodes, &part, 1, NULL, NULL),
                     ABBE_PARSE);
  }
  for (size_t i = 0; i < size; i += 5) {
    data[i] ^= 1;
    OK(abbe_file_write(path, data, size, &error));
    assert_int_equal(abbe_volume_checkpoint_load(path, 1, &nodes, &part, 1, NULL, NULL),
                     ABBE_PARSE);
    data[i] ^= 1;
  }
  unlink(path);
}

/* Of 12 nodes around the brick: values, or rays. */
static abbe_volume_fill_desc request(bool exits) {
  return (abbe_volume_fill_desc){.object = 1,
                                 .nodes = 12,
                                 .exits = exits ? 200 : 0,
                                 .region = {.kind = ABBE_REGION_GRID, .side = 4},
                                 .photons = 2000,
                                 .passes = 2,
                                 .threads = 2};
}

static bool stop_halfway(void *user, double done) {
  (void)user;
  return done < 0.5;
}

/* Stopped after half the nodes, and gone on with: what an unbroken run makes. */
TEST(fills_go_on_to_the_same_bits) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR BRICK("crown"));
  for (int exits = 0; exits < 2; exits++) {
    OWNED(abbe_caustic_volume, part);
    abbe_volume_fill_statistics once, twice;
    abbe_volume_fill_desc d = request(exits);
    MADE(abbe_caustic_volume, whole, abbe_volume_fill(&scene, &d, &whole, &once, &error));
    d.checkpoint = path;
    d.checkpoint_s = 1000;
    d.progress = stop_halfway;
    REFUSED(ABBE_CANCELLED, "", abbe_volume_fill(&scene, &d, &part, &twice, &error));
    d.progress = NULL;
    d.resume = true;
    d.seed = 1;
    REFUSED(ABBE_INVALID_ARGUMENT, path, abbe_volume_fill(&scene, &d, &part, &twice, &error));
    d.seed = 0;
    OK(abbe_volume_fill(&scene, &d, &part, &twice, &error));
    assert_int_equal(once.photons, twice.photons);
    if (exits)
      assert_memory_equal(whole.exits.exit, part.exits.exit,
                          whole.exits.count * sizeof *whole.exits.exit);
    else
      assert_memory_equal(whole.value, part.value, 12 * 64 * 9 * sizeof *whole.value);
    assert_near(once.error, twice.error, 0);
    unlink(path);
  }
}

/* ---- files with a right hash that no fill has written ---- */

enum { HEAD = 32, TAIL = 8, NODES = 24 };
/* From the file's end: what follows the exits are numbers of sequences, their count, and rays,
 * carried, alone, sequences and maps. */
enum { STATISTICS = TAIL + 40, COUNT = STATISTICS + 8, NUMBERS = COUNT + 2 * 8192 };

static void write_forged(char *data, size_t size) {
  const uint64_t h = abbe_volume_key(ABBE_VOLUME_KEY, data, size - TAIL);
  memcpy(data + size - TAIL, &h, sizeof h);
  OK(abbe_file_write(path, data, size, &error));
}

static void assert_refused(const abbe_scene *scene, const abbe_volume_fill_desc *d) {
  abbe_caustic_volume volume;
  abbe_volume_fill_statistics statistics;
  REFUSED(ABBE_PARSE, "is damaged: start anew without --resume",
          abbe_volume_fill(scene, d, &volume, &statistics, &error));
}

/* Bytes `from_end` of the file's end become these; the file is refused, and whole again. */
static void forge(const abbe_scene *scene, const abbe_volume_fill_desc *d, char *data, size_t size,
                  size_t from_end, const void *bytes, size_t count) {
  FREED char *kept = malloc(size);
  memcpy(kept, data, size);
  memcpy(data + size - from_end, bytes, count);
  write_forged(data, size);
  assert_refused(scene, d);
  memcpy(data, kept, size);
}

TEST(forged_files_are_refused) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR BRICK("crown"));
  for (int exits = 0; exits < 2; exits++) {
    OWNED(abbe_caustic_volume, part);
    abbe_volume_fill_statistics once, twice;
    abbe_volume_fill_desc d = request(exits);
    FREED char *data = NULL;
    size_t size;
    MADE(abbe_caustic_volume, whole, abbe_volume_fill(&scene, &d, &whole, &once, &error));
    d.checkpoint = path;
    d.checkpoint_s = 1000;
    d.progress = stop_halfway;
    assert_int_equal(abbe_volume_fill(&scene, &d, &part, &twice, NULL), ABBE_CANCELLED);
    d.progress = NULL;
    d.resume = true;
    OK(abbe_file_read(path, 1 << 24, &data, &size, &error));
    const uint64_t nodes[] = {0, 6, 12, 13, UINT64_MAX}; /* there are 5 */
    for (int i = 0; i < 5; i++)
      forge(&scene, &d, data, size, size - NODES, &nodes[i], sizeof nodes[i]);
    const uint16_t infinite = 0x7c00, negative = 0xbc00;
    forge(&scene, &d, data, size, size - HEAD, &infinite, sizeof infinite);
    if (exits) {
      uint16_t full[8192];
      for (int i = 0; i < 8192; i++) full[i] = (uint16_t)(1 + i % 2047);
      forge(&scene, &d, data, size, NUMBERS, full, sizeof full);
      const uint64_t many = 4000, rays = 3;
      forge(&scene, &d, data, size, COUNT, &many, sizeof many);
      forge(&scene, &d, data, size, STATISTICS, &rays, sizeof rays);
      forge(&scene, &d, data, size, size - HEAD - 2 * ABBE_EXIT_FACETS, &negative, sizeof negative);
    }
    /* what is there of the last node, which is not done, is of no matter */
    const size_t bytes =
        exits ? whole.exits.count * sizeof *whole.exits.exit : 12 * 64 * 9 * sizeof *whole.value;
    memset(data + HEAD + bytes - 16, 0x55, 16);
    write_forged(data, size);
    OK(abbe_volume_fill(&scene, &d, &part, &twice, &error));
    assert_memory_equal(exits ? (void *)whole.exits.exit : whole.value,
                        exits ? (void *)part.exits.exit : part.value, bytes);
    unlink(path);
  }
}
