#include "scenes/cuts/cut_file.h"

#include "tests/scenes/cuts/designs.h"

typedef struct file {
  char *data;
  size_t size;
} file;

static file written(const abbe_cut *cut) {
  file f = {0};
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(cut, 0, &p, &error));
  FILE *to = open_memstream(&f.data, &f.size);
  OK(abbe_cut_gem_write(cut, &p, to, NULL, &error));
  fclose(to);
  return f;
}

TEST(what_is_written_reads_back) {
  const char *const designs[] = {design_a, design_b, design_c, design_d};
  for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i]);
    file f = written(&cut);
    MADE(abbe_cut, back, abbe_cut_gem_parse(f.data, f.size, "x.gem", &back, NULL, &error));
    assert_int_equal(back.gear, cut.gear);
    assert_near(back.offset, cut.offset, 0);
    assert_int_equal(back.folds, cut.folds);
    assert_int_equal(back.mirror, cut.mirror);
    assert_near(back.refractive_index, cut.refractive_index, 0);
    assert_int_equal(back.facet_count, cut.facet_count);
    assert_int_equal(back.tier_count, cut.tier_count);
    for (size_t k = 0; k < cut.facet_count; k++) {
      for (int axis = 0; axis < 3; axis++)
        assert_near(back.facet[k].n[axis], cut.facet[k].n[axis], 4e-16);
      assert_near(back.facet[k].d, cut.facet[k].d, 1e-15);
      const bool flat = cut.tier[cut.facet[k].tier].angle_deg == 0;
      if (!flat) assert_near(back.facet[k].index, cut.facet[k].index, 1e-9);
      assert_string_equal(abbe_cut_facet_name(&back, k), abbe_cut_facet_name(&cut, k));
    }
    for (size_t t = 0; t < cut.tier_count; t++) {
      assert_near(back.tier[t].angle_deg, cut.tier[t].angle_deg, 1e-12);
      assert_int_equal(!signbit(back.tier[t].angle_deg), !signbit(cut.tier[t].angle_deg));
      assert_int_equal(back.tier[t].count, cut.tier[t].count);
      if (cut.tier[t].instruction)
        assert_string_equal(back.tier[t].instruction, cut.tier[t].instruction);
    }
    if (cut.heading[0]) assert_string_equal(back.heading[0], cut.heading[0]);
    free(f.data);
  }
}

/* The layout to the byte: a facet's plane is n / d, its tier from 1, its name, its corners. */
TEST(the_layout_is_gemcads) {
  OWNED(abbe_cut, cut) =
      design_parse("g 96 0\nI 1.5\nH Box\na 90 2 96 n G 24 48 72 G Cut\na 0 1\na -0 1\n");
  file f = written(&cut);
  const unsigned char *at = (const unsigned char *)f.data;
  double p[3];
  memcpy(p, at, sizeof p);
  assert_near(p[0], 0, 0);
  assert_near(p[1], 0.5, 0);
  assert_memory_equal(at + 24, "\1\0\0\0\5G\tCut\1\0\0\0", 14);
  const size_t facet = 24 + 4 + 6 + 4 * 28 + 4, plain = 24 + 4 + 2 + 4 * 28 + 4;
  const size_t trailer = facet + 3 * (plain + 3) + 2 * plain;
  double end;
  memcpy(&end, at + trailer, sizeof end);
  assert_near(end, -99999, 0);
  assert_memory_equal(at + trailer + 8, "\0\0\0\0\0\0\0\0\x60\0\0\0", 12);
  assert_memory_equal(at + trailer + 28, "\xff\x7f\0\0", 4);
  assert_int_equal(f.size, trailer + 8 + 12 + 8 + 4 + 8 + 8 + 3);
  free(f.data);
}

TEST(every_truncation_is_refused) {
  OWNED(abbe_cut, cut) = design_parse(design_d);
  abbe_cut back;
  file f = written(&cut);
  for (size_t size = 0; size < f.size; size++) {
    FREED char *part =
        malloc(size + 1); /* of its own size, so that a sanitizer sees what is beyond */
    memcpy(part, f.data, size);
    REFUSED(ABBE_PARSE, "the file ends within",
            abbe_cut_gem_parse(part, size, "x.gem", &back, NULL, &error));
    assert_contains(last_error.text, "x.gem: byte ");
    assert_null(back.facet);
  }
  free(f.data);
}

static void refuse(const file *f, size_t at, const void *bytes, size_t count, const char *part) {
  abbe_cut back;
  abbe_error error = {0};
  FREED char *bad = malloc(f->size);
  memcpy(bad, f->data, f->size);
  memcpy(bad + at, bytes, count);
  const abbe_result result = abbe_cut_gem_parse(bad, f->size, "x.gem", &back, NULL, &error);
  assert_true(result == ABBE_PARSE || result == ABBE_SCHEMA);
  assert_contains(error.text, part);
  assert_null(back.facet);
}

TEST(hostile_values_are_refused) {
  OWNED(abbe_cut, cut) = design_parse("g 96 0\nI 1.5\na 90 1 96 24 48 72\na 0 1\na -0 1\n");
  file f = written(&cut);
  const double zero[3] = {0}, none[3] = {NAN, 0, 0}, far[3] = {1e300, 0, 0};
  refuse(&f, 0, zero, sizeof zero, "x.gem: byte 0: facet 1 has no plane");
  refuse(&f, 0, none, sizeof none, "facet 1 has no plane");
  refuse(&f, 0, far, sizeof far, "facet 1 has no plane");
  refuse(&f, 30, "\7\0\0\0", 4, "byte 30: a facet's corners are each announced by 1");
  const size_t trailer = 6 * (24 + 4 + 2 + 4 * 28 + 4) + 8;
  refuse(&f, trailer + 8, "\0\0\0\0", 4, "a gear has 1 to 10000 teeth");
  refuse(&f, trailer + 8, "\0\0\0\x80", 4, "a gear has 1 to 10000 teeth");
  refuse(&f, trailer + 24, none, 8, "the gear's offset");
  const double end = -99999;
  refuse(&f, 0, &end, sizeof end, "byte");
  OWNED(abbe_report, report) = {0};
  FREED char *longer = calloc(1, f.size + 8);
  memcpy(longer, f.data, f.size);
  memcpy(longer + f.size, "\7preform", 8);
  MADE(abbe_cut, back, abbe_cut_gem_parse(longer, f.size + 8, "x.gem", &back, &report, &error));
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1);
  free(f.data);
}

/* A table and a culet under one key are two tiers, as are two distances; more facets than a stone
 * has are refused; folds and indices that no stone has are left out. */
TEST(odd_files_are_met) {
  OWNED(abbe_cut, cut) = design_parse("g 96 0\nI 1.5\na 90 1 96 24 48 72\na 0 1\na -0 1\n");
  file f = written(&cut);
  const size_t sides = 4 * (24 + 4 + 2 + 4 * 28 + 4), record = 24 + 4 + 2 + 4 * 28 + 4;
  const double half = 2, index = 200;
  memcpy(f.data + sides + 24, "\3\0\0\0", 4);
  memcpy(f.data + sides + record + 24, "\3\0\0\0", 4);
  for (int k = 0; k < 3; k++) {
    double p;
    memcpy(&p, f.data + 8 * k, sizeof p);
    p *= half;
    memcpy(f.data + 8 * k, &p, sizeof p);
  }
  memcpy(f.data + 6 * record + 8, "\xd0\7\0\0", 4);
  memcpy(f.data + 6 * record + 20, &index, 8);
  MADE(abbe_cut, back, abbe_cut_gem_parse(f.data, f.size, "x.gem", &back, NULL, &error));
  assert_int_equal(back.tier_count, 4);
  assert_near(back.tier[0].distance, 0.5, 1e-12);
  assert_int_equal(back.folds, 0);
  assert_near(back.refractive_index, 0, 0);
  FREED char *few = malloc(f.size);
  memcpy(few, f.data + 3 * record, f.size - 3 * record);
  abbe_cut none;
  REFUSED(ABBE_SCHEMA, "x.gem: 3 facets enclose nothing",
          abbe_cut_gem_parse(few, f.size - 3 * record, "x.gem", &none, NULL, &error));
  FREED char *many = malloc(4097 * record);
  for (size_t i = 0; i < 4097; i++) memcpy(many + i * record, f.data, record);
  REFUSED(ABBE_UNSUPPORTED, "more than 4096 facets",
          abbe_cut_gem_parse(many, 4097 * record, "x.gem", &none, NULL, &error));
  free(f.data);
}

/* A facet that cuts nothing, at the end, has no corners. */
TEST(dead_facets_are_kept) {
  OWNED(abbe_cut, cut) = design_parse("g 96 0\na 90 1 96 24 48 72\na 0 1\na -0 1\na 45 9 96\n");
  file f = written(&cut);
  MADE(abbe_cut, back, abbe_cut_gem_parse(f.data, f.size, "x.gem", &back, NULL, &error));
  assert_int_equal(back.facet_count, 7);
  free(f.data);
}

/* A name alone is as long as a name may be, or cut. */
TEST(long_names_are_cut_and_told) {
  char text[700] = "g 96 0\nH ";
  memset(text + strlen(text), 'h', 300);
  strcat(text, "\na 0 1 n ");
  memset(text + strlen(text), 'x', 300);
  strcat(text, "\na 90 1 96 24 48 72\na -0 1\n");
  OWNED(abbe_cut, cut) = design_parse(text);
  file f = written(&cut);
  MADE(abbe_cut, back, abbe_cut_gem_parse(f.data, f.size, "x.gem", &back, NULL, &error));
  assert_int_equal(strlen(back.facet[0].name), 254);
  assert_int_equal(strlen(back.heading[0]), 255);
  free(f.data);
}

TEST(long_texts_are_cut_and_told) {
  char text[700] = "g 96 0\na 0 1 n K G ";
  memset(text + strlen(text), 'x', 400);
  strcat(text, "\na 90 1 96 24 48 72\na -0 1\n");
  OWNED(abbe_cut, cut) = design_parse(text);
  file f = {0};
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  FILE *to = open_memstream(&f.data, &f.size);
  MADE(abbe_report, report, abbe_cut_gem_write(&cut, &p, to, &report, &error));
  fclose(to);
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1);
  MADE(abbe_cut, back, abbe_cut_gem_parse(f.data, f.size, "x.gem", &back, NULL, &error));
  assert_int_equal(strlen(back.tier[0].instruction), 253);
  assert_string_equal(back.facet[0].name, "K");
  free(f.data);
}
