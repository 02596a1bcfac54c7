/* Stretches of light added up over cells: what one leaves, what leaves through shells, what a beam
 * alone leaves as the method was printed. */
#include "tests/check.h"

#include "base/maths.h"
#include "tests/random.h"
#include "tests/validation/trace_scene.h"
#include "validation/lab/volume_fill.h"
#include "validation/lab/volume_sums.h"

static void make_region(abbe_region_desc desc, abbe_volume_region *out) {
  OK(abbe_volume_region_make(&desc, out, &error));
}

/* Along x through a row of a grid: flux times length by the cell's volume, and by its space. */
TEST(one_stretch) {
  OWNED(abbe_volume_region, r);
  float space[64];
  make_region((abbe_region_desc){.kind = ABBE_REGION_GRID, .side = 4, .outer = 2}, &r);
  for (int i = 0; i < 64; i++) space[i] = i == 2 ? 0.5f : i == 3 ? 0.01f : 1;
  MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, false, space, NULL, 1, &s, &error));
  const double o[3] = {-1.25, -1.5, -1.5}, d[3] = {1, 0, 0};
  const float flux[3] = {1, 2, 3};
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i <= pass; i++) abbe_volume_sums_add(&s, 0, o, d, 3, flux);
    abbe_accumulator_end_pass(&s.sums);
  }
  /* once and twice: a mean of 1.5 with a standard error of 0.5 */
  static const double length[4] = {0.25, 1, 2, 0};
  for (size_t cell = 0; cell < 64; cell++)
    for (size_t c = 0; c < 9; c++) {
      const double one = cell < 4 && c % 3 == 0 ? length[cell] * (double)(c / 3 + 1) : 0;
      assert_near(abbe_volume_sums_mean(&s, cell, c), 1.5 * one, 1e-6);
      assert_near(abbe_volume_sums_error(&s, cell, c), 0.5 * one, 1e-6);
    }
  assert_near(abbe_volume_sums_relative_error(&s), 1.0 / 3, 1e-6);
}

/* Whatever starts within and goes out passes every shell: all have the same flux. */
TEST(every_shell_has_the_flux_that_leaves) {
  static const abbe_region_desc regions[] = {
      {.kind = ABBE_REGION_GEODESIC, .levels = 4, .shells = 6, .inner = 1, .outer = 3},
      {.kind = ABBE_REGION_OCTAHEDRAL, .side = 64, .shells = 6, .inner = 1, .outer = 3}};
  for (int i = 0; i < 2; i++) {
    uint64_t seed = 9;
    FILLED(abbe_volume_region, r, make_region(regions[i], &r));
    MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, false, NULL, NULL, 1, &s, &error));
    for (int n = 0; n < 40000; n++) {
      double o[3], d[3];
      const float flux[3] = {0, 0.25f, 0};
      random_unit(&seed, o);
      for (int k = 0; k < 3; k++) o[k] *= 0.9 * random_between(&seed, 0, 1);
      random_unit(&seed, d);
      abbe_volume_sums_add(&s, 0, o, d, INFINITY, flux);
    }
    abbe_accumulator_end_pass(&s.sums);
    /* radial parts are taken in the cells' middles */
    for (size_t shell = 0; shell < r.rows; shell++)
      assert_near(abbe_volume_sums_outflow(&s, shell) / 10000, 1, 0.003);
  }
}

/* Nothing ends or begins in a shell that light crosses both ways: what comes in goes out. */
TEST(what_comes_in_goes_out) {
  OWNED(abbe_volume_region, r);
  uint64_t seed = 10;
  make_region(
      (abbe_region_desc){
          .kind = ABBE_REGION_GEODESIC, .levels = 4, .shells = 4, .inner = 1, .outer = 3},
      &r);
  MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, false, NULL, NULL, 1, &s, &error));
  for (int n = 0; n < 40000; n++) {
    double o[3], d[3];
    const float flux[3] = {0, 0.25f, 0};
    random_unit(&seed, d);
    for (int k = 0; k < 3; k++) o[k] = random_between(&seed, -0.8, 0.8) - 5 * d[k];
    abbe_volume_sums_add(&s, 0, o, d, INFINITY, flux);
  }
  abbe_accumulator_end_pass(&s.sums);
  for (size_t shell = 0; shell < r.rows; shell++)
    assert_near(abbe_volume_sums_outflow(&s, shell) / 10000, 0, 0.003);
}

/* A beam with nothing in it brings every cell the cosine to where it lies, behind the middle. */
TEST(a_printed_beam) {
  enum { SIDE = 2000 };
  static const double d[3] = {0.48, 0.6, 0.64}, x[3] = {0.8, 0, -0.6}, y[3] = {-0.36, 0.8, -0.48};
  OWNED(abbe_volume_region, r);
  make_region((abbe_region_desc){.kind = ABBE_REGION_GRID, .side = 6, .outer = 3}, &r);
  MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, true, NULL, d, 1, &s, &error));
  const float each = (float)(144.0 / SIDE / SIDE), flux[3] = {each, each, 2 * each};
  for (int n = 0; n < SIDE * SIDE; n++) {
    const double u = ((n % SIDE + 0.5) / SIDE - 0.5) * 12, v = ((n / SIDE + 0.5) / SIDE - 0.5) * 12;
    double o[3];
    for (int k = 0; k < 3; k++) o[k] = u * x[k] + v * y[k] - 8 * d[k];
    abbe_volume_sums_add(&s, 0, o, d, INFINITY, flux);
  }
  abbe_accumulator_end_pass(&s.sums);
  for (size_t cell = 0; cell < r.cells; cell++) {
    double p[3];
    abbe_volume_region_middle(&r, cell, p);
    const double cosine = fmax(abbe_vector_dot(p, d) / abbe_vector_length(p), 0);
    assert_near(abbe_volume_sums_mean(&s, cell, 1), cosine, 0.003);
    assert_near(abbe_volume_sums_mean(&s, cell, 2), 2 * cosine, 0.006);
  }
}

/* Volumes put aside: what was kept comes back, what is broken or another's is told, and a fill that
 * was stopped goes on to the same bits. */

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

/* Numbers of a fill that none can have; each alone. */
TEST(forged_statistics_are_refused) {
  typedef abbe_volume_fill_statistics statistics;
  const double beyond = INFINITY, below = -1, zero = 0;
  const size_t few = 2, many = 9999;
  const uint16_t half = 0x3800, over = 0x5c01, minus = 0xbc00; /* 0.5, 256.25, -1 */
  const struct {
    bool printed_alone;
    size_t at; /* SIZE_MAX: the first value; else in the statistics, behind the byte */
    const void *bytes;
    size_t count;
  } cases[] = {{false, offsetof(statistics, error), &beyond, 8},
               {false, offsetof(statistics, error), &below, 8},
               {false, offsetof(statistics, outflow), &beyond, 8},
               {false, offsetof(statistics, ledger.reached), &beyond, 8},
               {false, offsetof(statistics, passes), &few, sizeof few},
               {false, offsetof(statistics, passes), &many, sizeof many},
               {false, offsetof(statistics, photons), &many, sizeof many},
               {false, (size_t)-8, &below, 8},
               {true, (size_t)-8, &zero, 8},
               {true, SIZE_MAX, &half, 2},
               {true, SIZE_MAX, &over, 2},
               {true, SIZE_MAX, &minus, 2}};
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR BRICK("crown"));
  for (int printed = 0; printed < 2; printed++) {
    OWNED(abbe_caustic_volume, part);
    statistics done;
    abbe_volume_fill_desc d = request(false);
    FREED char *data = NULL;
    size_t size;
    d.kind = printed ? ABBE_VOLUME_PRINTED : ABBE_VOLUME_VECTOR;
    d.checkpoint = path;
    d.checkpoint_s = 1000;
    d.progress = stop_halfway;
    assert_int_equal(abbe_volume_fill(&scene, &d, &part, &done, NULL), ABBE_CANCELLED);
    d.progress = NULL;
    d.resume = true;
    OK(abbe_file_read(path, 1 << 24, &data, &size, &error));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
      const size_t from_end =
          cases[i].at == SIZE_MAX ? size - HEAD : TAIL + sizeof(statistics) - cases[i].at;
      if (printed || !cases[i].printed_alone)
        forge(&scene, &d, data, size, from_end, cases[i].bytes, cases[i].count);
    }
    write_forged(data, size);
    OK(abbe_volume_fill(&scene, &d, &part, &done, &error));
    unlink(path);
  }
}
