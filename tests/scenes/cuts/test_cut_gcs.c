#include "scenes/cuts/cut_file.h"

#include "scenes/cuts/cut_polyhedron.h"
#include "tests/scenes/cuts/designs.h"

#include <limits.h>

/* A pyramid: a table, four mains of 45 degrees below, cut off by four girdle facets. */
#define HEAD                                                                                       \
  "<GemCutStudio version=\"1000\">\n<index gear=\"80\" base=\"5\" symmetry=\"4\" mirror=\"1\"/>\n"
#define FACETS(z, by)                                                                              \
  "<facet nx=\"0\" ny=\"-" by "\" nz=\"" z "\" index_angle=\"0\"/>"                                \
  "<facet nx=\"" by "\" ny=\"0\" nz=\"" z "\" index_angle=\"270\"/>"                               \
  "<facet nx=\"0\" ny=\"" by "\" nz=\"" z "\" index_angle=\"180\"/>"                               \
  "<facet nx=\"-" by "\" ny=\"0\" nz=\"" z "\" index_angle=\"90\"/>"
#define TABLE                                                                                      \
  "<tier angle=\"0\" name=\"T\"><facet nx=\"0\" ny=\"0\" nz=\"1\" index_angle=\"33\">\n"           \
  "<vertex x=\"1\" y=\"1\" z=\"0.5\"/></facet></tier>\n"
#define REST                                                                                       \
  "<tier angle=\"90\" depth=\"1\" name=\"G\" instructions=\"Set&#10;size \xb0\" "                  \
  "visible=\"true\">" FACETS(                                                                      \
      "0", "1") "</tier>\n"                                                                        \
                "<tier angle=\"135\" depth=\"0.8\" name=\"P1\">" FACETS(                           \
                    "-1", "1") "</tier>\n"                                                         \
                               "<render material=\"x\" refractive_index=\"1.76\" "                 \
                               "dispersion=\"0.018\"><color r=\"1\"/></render>\n"                  \
                               "<info title=\"Box &amp; point\" author=\"A\" "                     \
                               "footer1=\"f\"/>\n</GemCutStudio>\n"

static abbe_cut read(const char *text) {
  abbe_cut cut;
  OK(abbe_cut_gcs_parse(text, strlen(text), "x.gcs", &cut, NULL, &error));
  return cut;
}

TEST(a_design_is_read) {
  OWNED(abbe_cut, cut) = read(HEAD TABLE REST);
  assert_int_equal(cut.gear, 80);
  assert_int_equal(cut.folds, 4);
  assert_true(cut.mirror);
  assert_near(cut.refractive_index, 1.76, 0);
  assert_string_equal(cut.heading[0], "Box & point");
  assert_string_equal(cut.footnote[0], "f");
  assert_int_equal(cut.tier_count, 3);
  assert_near(cut.tier[0].angle_deg, 0, 0);
  assert_near(cut.tier[0].distance, 0.5, 1e-15); /* by its corner */
  assert_near(fabs(cut.tier[1].angle_deg), 90, 1e-12);
  assert_near(cut.tier[2].angle_deg, -45, 1e-12);
  assert_string_equal(cut.tier[1].instruction, "Set size \xc2\xb0");
  assert_string_equal(abbe_cut_facet_name(&cut, 8), "P1");
  assert_near(cut.facet[5].n[1], sqrt(0.5), 1e-15); /* its index 0 is in the direction of y */
  assert_near(cut.facet[5].index, 80, 0);
  assert_near(cut.facet[8].index, 20, 0);
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  assert_int_equal(p.vertex_count, 9);
  assert_int_equal(p.face_count, 9);
  assert_near(p.min[2], -0.8 * sqrt(2), 1e-12);
}

/* Facets without normals have them from the angle and their index. */
TEST(a_missing_normal_is_found) {
  OWNED(abbe_cut, with) = read(HEAD TABLE REST);
  OWNED(abbe_cut, without) =
      read(HEAD TABLE
           "<tier angle='90' depth='1'><facet index_angle='0'/><facet index_angle='270'/><facet "
           "index_angle='180'/><facet index_angle='90'/></tier><tier angle='135' "
           "depth='0.8'><facet index_angle='0'/><facet index_angle='270'/><facet "
           "index_angle='180'/><facet index_angle='90'/></tier></GemCutStudio>");
  for (size_t i = 0; i < 9; i++)
    for (int axis = 0; axis < 3; axis++)
      assert_near(without.facet[i].n[axis], with.facet[i].n[axis], 1e-15);
}

TEST(indices_and_mirrors_are_heeded) {
  OWNED(abbe_cut, cut) = read("<GemCutStudio><index gear='80' symmetry='4' mirror='true'/>"
                              "<info title=''/>" TABLE REST);
  assert_true(cut.mirror && cut.folds == 4);
  abbe_cut_free(&cut);
  cut = read(printed("%.*s<render refractive_index='200'/></GemCutStudio>",
                     (int)(strstr(HEAD TABLE REST, "<render") - HEAD TABLE REST), HEAD TABLE REST));
  assert_near(cut.refractive_index, 0, 0);
}

/* Facets of one tier at two depths say them by their corners; letters that XML has for itself are
 * written as numbers; a plane beyond the axis' middle cannot be said. */
TEST(what_only_some_designs_have_is_written) {
  OWNED(abbe_cut, cut) = design_parse("g 96 0\na 90 1 96 24 48 72\na 0 1\na -0 1\na 45 9 96\n"
                                      "F one\nF two\nF three\n");
  OWNED(abbe_report, report) = {0};
  cut.facet[1].d = 1.25;
  cut.heading[0] = strdup("a<b>&\"c\"\td");
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  OK(abbe_cut_gcs_write(&cut, &p, to, &report, &error));
  assert_int_equal(fclose(to), 0);
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1); /* the third line at the foot */
  assert_contains(text, "<tier angle=\"90\">");
  OWNED(abbe_cut, back) = read(text);
  assert_int_equal(back.facet_count, 6); /* what cuts nothing has no corners to say it by */
  assert_string_equal(back.heading[0], "a<b>&\"c\" d");
  abbe_cut_polyhedron_free(&p);
  abbe_cut_free(&cut);
  cut = design_parse("g 96 0\na 90 1 96 24 48 72\na 0 0.1 96\na -30 0.1 96\n");
  OK(abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  REFUSED(ABBE_GEOMETRY, "write .asc", abbe_cut_gcs_write(&cut, &p, stderr, NULL, &error));
}

/* The symmetry tells people something, and stones nothing. */
TEST(a_strange_symmetry_is_passed_over) {
  static const char *const said[] = {"symmetry='-1'", "symmetry='2.5'", "symmetry='round'",
                                     "symmetry='99999999'", "mirror='0'"};
  for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
    OWNED(abbe_report, report) = {0};
    const char *text = printed("<GemCutStudio><index gear='80' %s/>" TABLE REST, said[i]);
    MADE(abbe_cut, cut, abbe_cut_gcs_parse(text, strlen(text), "x.gcs", &cut, &report, &error));
    assert_int_equal(cut.folds, 0);
    assert_false(cut.mirror);
    assert_int_equal(report.count, i < 4);
  }
}

static void refuse(const char *text, abbe_result code, const char *part) {
  abbe_cut cut;
  REFUSED(code, part, abbe_cut_gcs_parse(text, strlen(text), "x.gcs", &cut, NULL, &error));
  assert_null(cut.facet);
  assert_null(cut.tier);
}

TEST(bad_files_are_refused) {
  refuse("", ABBE_PARSE, "x.gcs:1: this is no well-formed XML");
  refuse("GemCad 5.0\n", ABBE_PARSE, "no well-formed XML");
  refuse("<html><p>not here</p></html>", ABBE_PARSE, "begins with <html>");
  refuse(HEAD TABLE, ABBE_PARSE, "no well-formed XML");
  refuse(HEAD "</GemCutStudio>", ABBE_SCHEMA, "0 facets enclose nothing");
  refuse(HEAD "<tier name='x'/></GemCutStudio>", ABBE_SCHEMA, "x.gcs:3: a tier's 'angle'");
  refuse(HEAD "<tier angle='200'/></GemCutStudio>", ABBE_SCHEMA, "from 0 (table) to 180");
  refuse(HEAD "<tier angle='nan'/></GemCutStudio>", ABBE_SCHEMA, "'angle' is a number, not 'nan'");
  refuse(HEAD "<tier angle='45' depth='0'><facet index_angle='0'/></tier></GemCutStudio>",
         ABBE_SCHEMA, "0 from the centre");
  refuse(HEAD "<tier angle='45'><facet index_angle='0'/></tier></GemCutStudio>", ABBE_SCHEMA,
         "without 'depth' wants facets with vertices");
  refuse(HEAD "<tier angle='45' depth='1'><facet/></tier></GemCutStudio>", ABBE_SCHEMA,
         "no direction");
  refuse(HEAD
         "<tier angle='45'><facet index_angle='0'><vertex x='1'/></facet></tier></GemCutStudio>",
         ABBE_SCHEMA, "a 'vertex' has x, y and z");
  refuse("<GemCutStudio><index gear='0'/></GemCutStudio>", ABBE_SCHEMA, "a gear has 1 to");
  refuse("<GemCutStudio><index gear='2.5'/></GemCutStudio>", ABBE_SCHEMA, "a gear has 1 to");
  refuse("<GemCutStudio><index gear='1e9'/></GemCutStudio>", ABBE_SCHEMA, "a gear has 1 to");
  refuse(HEAD "<tier angle='45'><facet index_angle='0'><vertex x='a' y='b'/></facet></tier>",
         ABBE_SCHEMA, "'x' is a number, not 'a'");
  refuse(HEAD "<tier angle='45' depth='1e9 '><facet nx='0' ny='0' nz='0' index_angle='0'/></tier>",
         ABBE_SCHEMA, "1e+09 from the centre");
  refuse(HEAD "<tier angle='45'><facet><vertex x='1' y='1' z='1'/></facet></tier>", ABBE_SCHEMA,
         "no direction");
  refuse("<?xml version=\"1.0\" encoding=\"windows-1252-and-more\"?><GemCutStudio/>", ABBE_PARSE,
         "unknown encoding");
  abbe_cut cut;
  REFUSED(ABBE_PARSE, "no design is as long",
          abbe_cut_gcs_parse("", (size_t)INT_MAX + 1, "x.gcs", &cut, NULL, &error));
}

TEST(too_many_facets_are_refused) {
  FREED char *text = calloc(1, 64 + 4097 * 32);
  char *at = text + sprintf(text, HEAD "<tier angle='45' depth='1'>");
  for (int i = 0; i < 4097; i++) at += sprintf(at, "<facet index_angle='%d'/>", i);
  strcpy(at, "</tier>");
  refuse(text, ABBE_UNSUPPORTED, "more than 4096 facets");
}

/* Both orders of the bytes of UTF-16, told by its mark. */
TEST(utf_16_is_read) {
  const char *text = "<GemCutStudio>" TABLE REST;
  for (int big = 0; big < 2; big++) {
    char wide[8192];
    size_t size = 0;
    for (const char *c = printed("%c%s", 1, text); *c != '\0'; c++, size += 2) {
      wide[size + (size_t)big] = (char)(*c == 1 ? 0xff : *c);
      wide[size + 1 - (size_t)big] = (char)(*c == 1 ? 0xfe : 0);
    }
    if (big) wide[0] = (char)0xfe, wide[1] = (char)0xff;
    MADE(abbe_cut, cut, abbe_cut_gcs_parse(wide, size, "x.gcs", &cut, NULL, &error));
    assert_int_equal(cut.facet_count, 9);
  }
}

TEST(what_reaches_outside_is_refused) {
  refuse("<!DOCTYPE GemCutStudio [<!ENTITY x SYSTEM "
         "\"/etc/hostname\">]>\n<GemCutStudio>&x;</GemCutStudio>",
         ABBE_PARSE, "no document type");
  refuse("<!DOCTYPE x [<!ENTITY a \"aaaa\"><!ENTITY b "
         "\"&a;&a;&a;\">]><GemCutStudio>&b;</GemCutStudio>",
         ABBE_PARSE, "no document type");
  char deep[4096] = "<GemCutStudio>";
  for (int i = 0; i < 100; i++) strcat(deep, "<tier angle='1' depth='1'>");
  refuse(deep, ABBE_PARSE, "nested deeper");
}

TEST(names_of_encodings_are_heeded) {
  static const struct {
    const char *head, *title, *read;
  } rows[] = {{"<?xml version=\"1.0\" encoding=\"UTF-8\"?>", "\xc3\xa9", "\xc3\xa9"},
              {"<?xml version=\"1.0\" encoding=\"CP1252\"?>", "\x80\xe9", "\xe2\x82\xac\xc3\xa9"},
              {"<?xml version=\"1.0\" encoding=\"Windows-1252\"?>", "\x85", "\xe2\x80\xa6"},
              {"\xef\xbb\xbf", "\xc3\xa9", "\xc3\xa9"},
              {"", "\x93", "\xe2\x80\x9c"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_cut, cut) =
        read(printed("%s<GemCutStudio><info title=\"%s\"/><tier angle='45' depth='1'><facet "
                     "index_angle='0'/><facet index_angle='1'/><facet index_angle='2'/><facet "
                     "index_angle='3'/></tier></GemCutStudio>",
                     rows[i].head, rows[i].title));
    assert_string_equal(cut.heading[0], rows[i].read);
    assert_int_equal(cut.gear, 96);
  }
  refuse("<?xml version=\"1.0\" encoding=\"koi8-q\"?><GemCutStudio/>", ABBE_PARSE,
         "unknown encoding");
}

/* What is written has the same planes, but for size and height, and is read back as the same stone.
 */
TEST(what_is_written_is_read_back) {
  const char *const designs[] = {design_a, design_b, design_c, design_d};
  for (int k = 0; k < 4; k++) {
    OWNED(abbe_cut, cut) = design_parse(designs[k]);
    FREED char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
    OK(abbe_cut_gcs_write(&cut, &p, to, NULL, &error));
    assert_int_equal(fclose(to), 0);
    OWNED(abbe_cut, back) = read(text);
    MADE(abbe_cut_polyhedron, q, abbe_cut_polyhedron_make(&back, 0, &q, &error));
    assert_int_equal(q.vertex_count, p.vertex_count);
    assert_int_equal(q.edge_count, p.edge_count);
    assert_int_equal(q.face_count, p.face_count);
    assert_int_equal(back.gear, cut.gear);
    assert_int_equal(back.folds, cut.folds);
    assert_int_equal(back.mirror, cut.mirror);
    const double scale = q.max[0] / p.max[0];
    assert_near(fmax(fmax(q.max[0], -q.min[0]), fmax(q.max[1], -q.min[1])), 1, 1e-9);
    assert_near(q.max[2] + q.min[2], 0, 1e-9);
    assert_near(q.volume / (scale * scale * scale * p.volume), 1, 1e-9);
    for (size_t i = 0; i < p.face_count; i++) {
      const abbe_cut_facet *f = &cut.facet[p.face[i].facet];
      double nearest = 3;
      for (size_t j = 0; j < q.face_count; j++) {
        const double *n = back.facet[q.face[j].facet].n;
        nearest = fmin(nearest, fabs(n[0] - f->n[0]) + fabs(n[1] - f->n[1]) + fabs(n[2] - f->n[2]));
      }
      assert_near(nearest, 0, 1e-12);
    }
  }
}
