#include "tests/random.h"
#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"

static abbe_material_table reread(const abbe_material_table *table, abbe_report *report) {
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  abbe_error why = {0};
  OK(abbe_agf_write(table, to, report, &error));
  fclose(to);
  abbe_material_table back;
  OWNED(abbe_report, notes) = {0};
  if (abbe_agf_parse(text, size, "back.agf", &back, &notes, &why) != ABBE_OK)
    fail_msg("%s\n%s", why.text, text);
  assert_int_equal(notes.kinds[ABBE_NOTE_SKIPPED], 0);
  return back;
}

static bool noted(const abbe_report *report, const char *part) {
  for (size_t i = 0; i < report->count; i++)
    if (strstr(report->note[i].text, part) != NULL) return true;
  return false;
}

/* n and the attenuation of every shipped row are those of the row, and what is lost is said. */
TEST(the_shipped_table_becomes_a_catalogue) {
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_material_table, back) = reread(&table, &report);
  size_t glasses = 0;
  for (size_t i = 0; i < table.count; i++) {
    if (abbe_material_is_conductor(&table.material[i])) continue;
    assert_true(glasses < back.count);
    const abbe_material *a = &table.material[i], *b = &back.material[glasses++];
    assert_string_equal(a->name, b->name);
    assert_string_equal(a->source, b->source);
    assert_near(a->min_nm, b->min_nm, 0);
    assert_near(a->max_nm, b->max_nm, 0);
    for (double l = a->min_nm; l < a->max_nm; l *= 1.05) {
      double n = abbe_dispersion_n(&a->dispersion, l);
      assert_near(abbe_dispersion_n(&b->dispersion, l), n, 2e-15 * n);
      const double per_m = a->fluorescence.excitation != NULL
                               ? 0 /* AGF has no place for it */
                               : abbe_material_attenuation_along(a, 0, l); /* the ordinary wave's */
      assert_near(abbe_material_attenuation(b, l), per_m, 1e-10 * per_m + 1e-12);
    }
    double n_d = abbe_dispersion_describe(&a->dispersion).n_d;
    assert_near(b->published_n_d, n_d > 1 ? n_d : 0, 5e-6); /* 1 is how catalogues say nothing */
  }
  assert_int_equal(back.count, glasses);
  assert_true(noted(&report, printed("no place for a description (%zu materials: ", glasses)));
  assert_true(noted(&report, "no place for a warning"));
  assert_true(noted(&report, "no place for recorded fits"));
  assert_true(noted(&report, "cannot allow use outside"));
  assert_true(noted(&report, "no place for fluorescence"));
  assert_true(noted(&report, "it is a conductor"));
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], table.count - glasses);
}

/* A table that came from a catalogue goes back to one and comes again, the same in all that both
 * can say. */
TEST(a_catalogue_survives_the_way_through_a_table) {
  srand(5);
  OWNED(abbe_material_table, table) = {0};
  for (size_t i = 0; i < 400; i++) {
    abbe_material m = random_material(i);
    free(m.comment);
    m.comment = rand() % 2 ? strdup("a remark, 25 C") : NULL;
    OK(abbe_material_table_append(&table, &m, &error));
  }
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_material_table, once) = reread(&table, &report), twice = reread(&once, NULL);
  assert_int_equal(once.count + report.kinds[ABBE_NOTE_SKIPPED], table.count);
  assert_int_equal(twice.count, once.count);
  for (size_t i = 0; i < once.count; i++) {
    assert_carried(&once.material[i], &twice.material[i], 1e-9);
    assert_near(once.material[i].published_n_d, twice.material[i].published_n_d, 0);
  }
  /* what the first step carries, of those that it did not leave out */
  for (size_t i = 0, j = 0; i < once.count; i++, j++) {
    while (strcmp(table.material[j].name, once.material[i].name) != 0) j++;
    const abbe_material *a = &table.material[j], *b = &once.material[i];
    assert_string_equal(a->source, b->source);
    assert_true(same_text(a->comment, b->comment));
    memset(table.material[j].catalogue.expansion_range_k, 0, sizeof(double[4]));
    assert_true(same_catalogue(&a->catalogue, &b->catalogue));
    assert_true(same_number(a->temperature_c, b->temperature_c, 0));
  }
  assert_true(noted(&report, "no place for the temperatures of expansions"));
}

/* The lines of `text` that begin with IT, each number in its shortest form. */
static size_t transmittances(const char *text, char lines[][80], size_t most) {
  size_t count = 0;
  for (const char *at = text; (at = strstr(at, "IT ")) != NULL; at += 3) {
    double lambda, share, thickness;
    assert_int_equal(sscanf(at, "IT %lf %lf %lf", &lambda, &share, &thickness), 3);
    assert_true(count < most);
    snprintf(lines[count++], 80, "%.17g %.17g %.17g", lambda, share, thickness);
  }
  return count;
}

/* Printed transmittances come back as they were, at the thickness at which they were measured. */
TEST(transmittances_come_back_to_the_last_digit) {
  static const char text[] =
      "CC maker\n"
      "NM A 2 0 1.5168 64.17\nCD 1.03961212 0.00600069867 0 0 0 0\nLD 0.3 2.5\n"
      "IT 3.10000E-01 5.74000E-01 2.50000E+01\nIT 3.20000E-01 7.72000E-01 2.50000E+01\n"
      "IT 3.34000E-01 9.05000E-01 2.50000E+01\nIT 0.35 0.967 25\nIT 0.5 1 25\nIT 0.7 0.9998 25\n"
      "NM B 2 0 1.5168 64.17\nCD 1.03961212 0.00600069867 0 0 0 0\nLD 0.3 2.5\n"
      "IT 0.3 0.0001 3\nIT 0.31 0.17 3\nIT 0.32 0.5012345 10\nIT 0.33 0.77 10\nIT 0.4 1 10\n"
      "IT 0.5 0.999 10\nIT 0.6 0.99 10\nIT 0.7 0.97 10\nIT 0.8 0.3 1\nIT 0.9 0.012 2\n"
      "NM C 2 0 1.5168 64.17\nCD 1.03961212 0.00600069867 0 0 0 0\nLD 0.3 2.5\n"
      "IT 0.4 0.91 1.9\nIT 0.5 0.93 1.9\nIT 0.6 1 1.9\n";
  MADE(abbe_material_table, table,
       abbe_agf_parse(text, strlen(text), "m.agf", &table, NULL, &error));
  assert_int_equal(table.count, 3);
  FREED char *written = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&written, &size);
  OK(abbe_agf_write(&table, to, NULL, &error));
  fclose(to);
  static char before[24][80], after[24][80];
  size_t count = transmittances(text, before, 24);
  assert_int_equal(count, 19);
  assert_int_equal(transmittances(written, after, 24), count);
  for (size_t i = 0; i < count; i++) assert_string_equal(after[i], before[i]);
}

/* Whatever absorbs, and however much: not a bit of it changes. */
TEST(absorption_is_carried_to_the_last_bit) {
  enum { COUNT = 4000 };
  static double lambda_nm[COUNT], attenuation[COUNT];
  uint64_t random = 7;
  for (int i = 0; i < COUNT; i++) {
    lambda_nm[i] = 400 + 0.05 * i;
    attenuation[i] = i % 50 == 0 ? 0 : pow(10, random_between(&random, -5, 9));
  }
  abbe_material m =
      FIELDS(.name = (char[]){"m"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .temperature_c = NAN,
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}});
  OK(abbe_spectrum_make(lambda_nm, attenuation, COUNT, ABBE_INTERPOLATION_LINEAR, &m.attenuation,
                        &error));
  const abbe_material_table table = {.count = 1, .material = &m};
  OWNED(abbe_material_table, back) = reread(&table, NULL);
  const double *now = abbe_spectrum_value(back.material[0].attenuation);
  size_t changed = 0;
  for (int i = 0; i < COUNT; i++) changed += now[i] != attenuation[i];
  assert_int_equal(changed, 0);
  abbe_spectrum_free(m.attenuation);
}

/* A comma at a name's end would part it from what follows; a status that no catalogue has, and a
 * frequency without one. */
TEST(odd_fields_come_back) {
  abbe_material list[2] = {
      FIELDS(.name = (char[]){"glass,"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}}),
      FIELDS(.name = (char[]){"other"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.6}})};
  list[0].catalogue.status = (char[]){"withdrawn"};
  list[0].catalogue.melt_frequency = 3;
  list[1].fit[1] = (abbe_material_fit){.terms = 3, .c = {1.6}, .min_nm = 400, .max_nm = 700};
  const abbe_material_table table = {.count = 2, .material = list};
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_material_table, back) = reread(&table, &report);
  assert_string_equal(back.material[0].name, "glass_");
  assert_null(back.material[0].catalogue.status);
  assert_near(back.material[0].catalogue.melt_frequency, 3, 0);
  assert_true(noted(&report, "no place for recorded fits (1 material: other)"));
}

/* The strongest and the weakest attenuation that a table takes have a thickness that shows them. */
TEST(extreme_attenuation_comes_back) {
  static const double nm[] = {400, 500, 600, 700};
  static const double per_m[] = {1e-6, 3.3e8, 1e9, 1e12}; /* the last is more than AGF can say */
  abbe_material m =
      FIELDS(.name = (char[]){"x"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}});
  OK(abbe_spectrum_make(nm, per_m, 4, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  const abbe_material_table table = {.count = 1, .material = &m};
  OWNED(abbe_material_table, back) = reread(&table, NULL);
  for (int i = 0; i < 3; i++)
    assert_near(abbe_material_attenuation(&back.material[0], nm[i]) / per_m[i], 1, 1e-12);
  assert_true(abbe_material_attenuation(&back.material[0], 700) > per_m[2]);
  abbe_spectrum_free(m.attenuation);
}

TEST(names_and_failures_are_told) {
  abbe_material list[2] = {
      FIELDS(.name = (char[]){"two words, more"}, .source = (char[]){"line\nbreak"}, .min_nm = 400,
             .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}}),
      FIELDS(.name = (char[]){"bad"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {-1}})};
  abbe_material_table table = {.count = 2, .material = list};
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_material_table, back) = reread(&table, &report);
  assert_int_equal(back.count, 1);
  assert_string_equal(back.material[0].name, "two_words,_more");
  assert_string_equal(back.material[0].source, "line break");
  assert_int_equal(back.material[0].dispersion.model, ABBE_DISPERSION_CONSTANT);
  assert_true(noted(&report, "become '_' (1 material: two words, more)"));
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
  for (int buffered = 0; buffered < 2; buffered++) {
    FILE *full = fopen("/dev/full", "w");
    if (!buffered) setvbuf(full, NULL, _IONBF, 0);
    assert_int_equal(abbe_agf_write(&table, full, NULL, NULL), ABBE_IO);
    fclose(full);
  }
}
