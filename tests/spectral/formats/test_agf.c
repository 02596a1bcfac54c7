#include "tests/check.h"
#include "tests/spectral/formats/agf_bk7.h"

#include "spectral/formats/agf_formula.h"
#include "spectral/formats/material_import.h"

static abbe_report report;

static abbe_material_table parse_bytes(const char *bytes, size_t size) {
  abbe_material_table table;
  abbe_report_free(&report);
  OK(abbe_agf_parse(bytes, size, "glass/maker.agf", &table, &report, &error));
  return table;
}

static abbe_material_table parse(const char *text) {
  return parse_bytes(text, strlen(text));
}

TEST(a_glass_is_read_whole) {
  OWNED(abbe_material_table, t) = parse("free text of the maker\nCC Maker, spring\n" BK7);
  assert_int_equal(t.count, 1);
  assert_string_equal(t.description, "Maker, spring");
  assert_string_equal(t.path, "glass/maker.agf");
  const abbe_material *m = &t.material[0];
  assert_string_equal(m->name, "N-BK7");
  assert_int_equal(m->line, 3);
  assert_int_equal(m->dispersion.model, ABBE_DISPERSION_SELLMEIER2);
  assert_near(abbe_dispersion_describe(&m->dispersion).n_d, 1.5168, 5e-6);
  assert_near(abbe_dispersion_describe(&m->dispersion).v_d, 64.17, 5e-3);
  assert_near(m->min_nm, 300, 0);
  assert_near(m->max_nm, 2500, 0);
  assert_near(m->temperature_c, 20, 0);
  assert_near(m->published_n_d, 1.5168, 0);
  assert_near(m->published_v_d, 64.17, 0);
  assert_string_equal(m->source, "Zemax catalogue maker.agf, N-BK7; Maker, spring");
  assert_string_equal(m->comment, "step 0.5 available");
  assert_string_equal(m->catalogue.code, "517642.251");
  assert_string_equal(m->catalogue.status, "preferred");
  assert_near(m->catalogue.melt_frequency, 1, 0);
  assert_near(m->catalogue.density_g_cm3, 2.51, 0);
  assert_near(m->catalogue.expansion_per_k[0], 7.1e-6, 0);
  assert_near(m->catalogue.dpgf, -0.0009, 0);
  assert_near(m->catalogue.thermal[5], 0.17, 0);
  assert_near(m->catalogue.ratings[0], 1, 0);
  assert_near(m->catalogue.ratings[1], -1, 0);
  assert_near(exp(-0.025 * abbe_material_attenuation(m, 400)), 0.992, 1e-15);
  assert_int_equal(report.count, 0);
}

/* LightPath's record. With lambda_tk squared g gains 140.7e-6 from 20 to 40 C in vacuum, with its
 * sign kept 111.0e-6. (With the index against air in the model's factor it is 140.68e-6; with that
 * in vacuum, which N-BK7's table has in all digits, 140.75e-6.) */
TEST(a_negative_resonance_is_kept_and_not_guessed_at) {
  OWNED(abbe_material_table, t) =
      parse("NM D-ZLAF52LA_M 1 810410 1.805881 40.888056 0 0 0\n"
            "CD 3.171708100E+000 -1.370844800E-002 2.962902600E-002 1.115009500E-003 "
            "-5.557660600E-005 5.694112200E-006\n"
            "TD 5.350000000E-006 1.852600000E-008 -7.872000000E-011 7.151500000E-007 "
            "1.264800000E-010 -2.313800000E-001 2.000000000E+001\n"
            "LD 3.60000000E-001 1.55000000E+000\n");
  const abbe_conditions warm = {40, 0};
  abbe_material m = t.material[0];
  double n[2];
  assert_near(m.catalogue.thermal[5], -0.23138, 0);
  REFUSED(ABBE_UNSUPPORTED, "lambda_tk is negative", abbe_material_place(&m, &warm, &error));
  m.catalogue.thermal[5] = 0.23138;
  OK(abbe_material_n_absolute(&m, 435.8343, &n[0], &error));
  OK(abbe_material_place(&m, &warm, &error));
  OK(abbe_material_n_absolute(&m, 435.8343, &n[1], &error));
  assert_near(1e6 * (n[1] - n[0]), 140.75, 0.01);
}

TEST(commas_part_numbers_or_begin_their_decimals) {
  OWNED(abbe_material_table, t) =
      parse("NM A 2 517642 1,5168 64,17\nCD 1,03961212E+00 6,00069867E-03 2,31792344e-1 "
            "0,0200179144\n1,01046945 103,560653\nLD 0,3 2,5\n"
            "IT 0,4 0,992 25\n"
            "NM B 2 517642,1.5168,64.17\nCD 1.03961212,0.00600069867,0.231792344, "
            "0.0200179144,1.01046945,103.560653,0,0\nLD 0.3,2.5\n");
  assert_int_equal(t.count, 2);
  for (size_t i = 0; i < 2; i++) {
    assert_near(abbe_dispersion_describe(&t.material[i].dispersion).n_d, 1.5168, 5e-6);
    assert_near(t.material[i].min_nm, 300, 0);
    assert_near(t.material[i].max_nm, 2500, 0);
  }
  assert_near(t.material[0].published_v_d, 64.17, 0);
  assert_near(exp(-0.025 * abbe_material_attenuation(&t.material[0], 400)), 0.992, 1e-15);
  assert_int_equal(report.count, 1);
  assert_contains(report.note[0].text, "decimal commas");
}

/* Chemists number the places of a molecule so. */
TEST(a_name_may_hold_commas) {
#define CD "\nCD 1.03961212 0.00600069867\nLD 0.3 2.5\n"
  OWNED(abbe_material_table, t) =
      parse("NM OCTANE-1,6 2 0 1.4 60" CD "NM DECANE-1,10,12 2 0.0 1.4 60" CD
            "NM A, 2, 517642, 1.4, 60" CD "NM B,2,517642 1.4 60" CD "NM C,2 517642,1.4,60" CD);
  const char *const names[] = {"OCTANE-1,6", "DECANE-1,10,12", "A", "B", "C"};
  assert_int_equal(t.count, 5);
  for (size_t i = 0; i < 5; i++) {
    assert_string_equal(t.material[i].name, names[i]);
    assert_int_equal(t.material[i].dispersion.model, ABBE_DISPERSION_SELLMEIER2);
    assert_near(t.material[i].published_n_d, 1.4, 0);
  }
#undef CD
}

/* Catalogues begin with a page of text; a source is a line. */
TEST(a_long_title_is_cut_at_a_word) {
  OWNED(abbe_material_table, t) = parse("CC Maker, all glasses of spring 2017 with melt data, for "
                                        "designers only, see our terms of use\n" BK7);
  assert_string_equal(
      t.material[0].source,
      "Zemax catalogue maker.agf, N-BK7; Maker, all glasses of spring 2017 with melt data, for…");
  assert_contains(t.description, "see our terms of use");
}

/* As one maker prints them. */
TEST(wrapped_lines_are_joined) {
  OWNED(abbe_material_table, t) =
      parse("CC  Updated\nNM J-FK5 13 1 1.487490 70.318793 0 0 1\nGC \n"
            "ED 8.900000000E+000 0.000000000E+000 2.450000000E+000 2.700000000E-003 0 0\n"
            "CD 2.188268550E+000 -9.190447240E-003 -1.116210710E-004 9.263728150E-003 \n"
            "7.349007330E-005 4.197242420E-006 -1.154122030E-007 0.000000000E+000 \n"
            "0.000000000E+000 0.000000000E+000\n"
            "TD -8.080000000E-006 1.810000000E-008 -1.840000000E-012 3.750000000E-007 \n"
            "3.020000000E-010 1.690000000E-001 2.300000000E+001\n"
            "OD -1.00000 -1.00000 -1.00000 -1.00000 -1.00000 3.00000\n"
            "LD 3.65015000E-001 2.05809000E+000\nIT 2.80000E-001 1.90000E-001 1.00000E+001\n");
  const abbe_material *m = &t.material[0];
  assert_near(abbe_dispersion_describe(&m->dispersion).n_d, 1.48749, 5e-7);
  assert_near(abbe_dispersion_describe(&m->dispersion).v_d, 70.318793, 5e-4);
  assert_near(m->temperature_c, 23, 0);
  assert_near(m->catalogue.thermal[4], 3.02e-10, 0);
  assert_near(m->min_nm, 365.015, 0);
  assert_null(m->catalogue.code);
  assert_null(m->comment);
}

TEST(encodings_and_line_ends_do_not_matter) {
  static const char text[] = "CC maker\n" BK7;
  char wide[2 * sizeof text + 2], returns[2 * sizeof text];
  size_t w = 0, r = 0;
  wide[w++] = '\xff';
  wide[w++] = '\xfe';
  for (size_t i = 0; i < sizeof text - 1; i++) {
    wide[w++] = text[i];
    wide[w++] = 0;
    if (text[i] == '\n') returns[r++] = '\r';
    returns[r++] = text[i];
  }
  const struct {
    const char *bytes;
    size_t size;
  } forms[] = {{text, sizeof text - 1}, {wide, w}, {wide + 2, w - 2}, {returns, r}};
  for (int i = 0; i < 4; i++) {
    OWNED(abbe_material_table, t) = parse_bytes(forms[i].bytes, forms[i].size);
    assert_int_equal(t.count, 1);
    assert_string_equal(t.material[0].name, "N-BK7");
    assert_near(t.material[0].dispersion.c[6], 103.560653, 0);
    assert_int_equal(t.material[0].line, 2);
  }
}

TEST(placeholders_and_missing_fields_are_no_values) {
  OWNED(abbe_material_table, t) =
      parse("NM CDS 2 1 1.000000 0.000000 0 0 0\nGC source:  Handbook of Optics\n"
            "CD 3.96582820 5.58036869E-02 1.811387400E-001 2.33146066E-01 0 0\n"
            "TD\nLD 5.1E-001 1.4\nIT 3.34E-001 1.0 25\nIT 5.0E-001 1.0 25\n"
            "NM BARE 2\n" BK7_CD "NM DASHES 2 - - - - - -\n" BK7_CD
            "LD 2.5 0.3\nIT 0.4 0.0 10\nIT 0.5 99 10\nIT 0.5 0.9 10\n"
            "IT 0.5 0.8 10\nIT 0.45 0.95\n");
  assert_int_equal(t.count, 3);
  const abbe_material *cds = &t.material[0], *bare = &t.material[1], *dashes = &t.material[2];
  assert_near(cds->published_n_d, 0, 0);
  assert_string_equal(cds->source, "Handbook of Optics");
  assert_null(cds->comment);
  assert_true(isnan(cds->temperature_c));
  assert_null(cds->attenuation); /* nothing but ones: nothing was measured */
  assert_int_equal(cds->dispersion.count, 5);
  assert_near(bare->min_nm, 404.66, 0);
  assert_null(bare->catalogue.status);
  assert_near(dashes->min_nm, 300, 0);
  assert_int_equal(abbe_spectrum_count(dashes->attenuation), 2);
  assert_near(abbe_material_attenuation(dashes, 400), -log(1e-6) / 0.01, 1e-9);
  assert_near(abbe_material_attenuation(dashes, 500), -log(0.9) / 0.01, 1e-12);
  assert_int_equal(report.kinds[ABBE_NOTE_ASSUMED], 2); /* a range, a transmittance of 0 */
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 2);    /* odd lines, a line twice */
  assert_int_equal(report.kinds[ABBE_NOTE_CHANGED], 1); /* the range was the wrong way round */
}

/* Numbers that nothing uses may be anything, and must not make a table that cannot be read. */
TEST(numbers_beyond_a_table_are_left_out) {
  OWNED(abbe_material_table, t) =
      parse("NM A 2 0 1.5168 64.17 0 1 1e9\nED 1e300 8.3 1e4 1e5 0\n" BK7_CD
            "TD 1e-6 1e200 0 0 0 0.17 20\nOD 1 2 3 4 5 1e13\n"
            "LD 0.3 2.5\n");
  const abbe_material_catalogue *c = &t.material[0].catalogue;
  assert_true(c->melt_frequency == 0 && c->density_g_cm3 == 0 && c->dpgf == 0);
  assert_true(c->expansion_per_k[0] == 0 && c->thermal[1] == 0 && c->ratings[5] == -1);
  assert_near(c->expansion_per_k[1], 8.3e-6, 1e-20);
  assert_near(c->thermal[0], 1e-6, 0);
  assert_near(c->ratings[4], 5, 0);
  assert_int_equal(report.count, 1);
  assert_contains(report.note[0].text, "6 of its numbers");
}

TEST(one_bad_glass_does_not_stop_the_rest) {
  OWNED(abbe_material_table, t) =
      parse("NM A 99 0 1.5 60\n" BK7_CD "NM B 2 0 1.5 60\nLD 0.3 2\n"
            "NM C 2 0 1.5 60\nCD 1 what 2\nLD 0.3 2\n"
            "NM D 2 0 1.5 60\nCD 0 0 0\nLD 0.3 2\n"
            "NM E 2 0 1.5 60\nCD 1 0.16\nLD 0.3 2\n" BK7 "NM n-bk7 2 0 1.5 60\n" BK7_CD "LD 0.3 2\n"
            "NM F\n" BK7_CD "NM\n" BK7_CD);
  assert_int_equal(t.count, 1);
  const struct {
    size_t line;
    const char *name, *part;
  } notes[] = {{1, "A", "its formula is '99'; a catalogue's are 1 to 13"},
               {3, "B", "no CD line"},
               {5, "C", "no number"},
               {8, "D", "coefficients are 0"},
               {11, "E", "no real index at 300 nm, inside its range"},
               {0, NULL, NULL}};
  for (size_t i = 0; notes[i].name != NULL; i++) {
    assert_int_equal(report.note[i].kind, ABBE_NOTE_SKIPPED);
    assert_int_equal(report.note[i].line, notes[i].line);
    assert_string_equal(report.note[i].name, notes[i].name);
    assert_contains(report.note[i].text, notes[i].part);
  }
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 8);
  assert_contains(report.note[report.count - 1].text, "was there before, on line 14");
}

static void refuses(const char *text, abbe_result code, const char *part) {
  abbe_material_table table;
  OWNED(abbe_report, mine) = {0};
  REFUSED(code, part, abbe_agf_parse(text, strlen(text), "x.agf", &table, &mine, &error));
  assert_null(table.material);
}

TEST(what_is_no_catalogue_is_refused) {
  refuses("", ABBE_PARSE, "x.agf: has no NM line");
  refuses("materials:\n- name: x\n", ABBE_PARSE, "no Zemax glass catalogue");
  refuses("NM A 99\n", ABBE_SCHEMA, "none of its 1 glasses can be used; the first: its formula");
  refuses("NM A 14\n", ABBE_SCHEMA, "its formula is '14'");
  /* a note of another kind comes first */
  refuses("NM A 14 0 1.5 60 0 1 1e99\n", ABBE_SCHEMA, "the first: its formula is '14'");
  abbe_material_table table;
  REFUSED(ABBE_SCHEMA, "none of its 1 glasses can be used",
          abbe_agf_parse("NM A 14", 7, "x.agf", &table, NULL, &error));
}

/* A thousand glasses with 33 transmittances each, as a maker's catalogue has. */
TEST(a_whole_catalogue_is_read) {
  enum { GLASSES = 1000, EACH = 2200 };
  FREED char *text = malloc(GLASSES * EACH);
  assert_non_null(text);
  size_t used = (size_t)sprintf(text, "CC big\n");
  for (int i = 0; i < GLASSES; i++) {
    used += (size_t)sprintf(text + used, "NM G%d 2 517642.251 1.5168 64.17 0 1 1\n" BK7_CD, i);
    used += (size_t)sprintf(text + used, "LD 0.3 2.5\n");
    for (int k = 0; k < 33; k++)
      used += (size_t)sprintf(text + used, "IT %.5E 9.95000E-001 1.00000E+001\n", 0.3 + 0.05 * k);
  }
  OWNED(abbe_material_table, t) = parse(text);
  assert_int_equal(t.count, GLASSES);
  assert_int_equal(report.count, 0);
}

static void end(void) {
  abbe_report_free(&report);
}

GROUP(NULL, end);

/* n_d as real catalogues print it beside the coefficients; what no catalogue prints is evaluated by
 * hand from the formula as Zemax's manual has it. */
TEST(every_formula_gives_its_catalogues_index) {
  const struct {
    abbe_agf_formula f;
    double lambda_nm, n, within;
  } rows[] = {
      /* acrylic and zinc-crown of a catalogue of the first formula */
      {{1, {2.16330492, 1.36580764e-2, 2.56700975e-2, -2.80976174e-3, 2.842279e-4, -9.02124935e-6}},
       587.5618,
       1.491668,
       5e-7},
      {{1,
        {2.29204125, -9.69577254e-3, 9.93599131e-3, 1.29959077e-3, -1.70602096e-4, 1.01977907e-5}},
       587.5618,
       1.524779,
       5e-7},
      {{2, {1.03961212, 6.00069867e-3, 0.231792344, 2.00179144e-2, 1.01046945, 103.560653}},
       587.5618,
       1.5168,
       5e-6},
      {{2, {0.5675888, 2.52643e-3, 0.4710914, 1.0078333e-2, 3.8484723, 1200.556}},
       587.5618,
       1.433849,
       5e-7},
      {{3, {3.41983, 0.159906, -0.123109, 1.26878e-6, -1.95104e-9, 0}}, 5000, 3.4261, 5e-5},
      {{4, {1, 1.2, 0.1, 0.02, 0.2}},
       500, /* 1 + 1 + 1.2/0.96 + 0.02/0.21 */
       1.8289992,
       5e-7},
      {{5, {1.57410327, 1.39786149e-2, 8.3004511e-4}}, 587.5618, 1.603233, 5e-7},
      {{5, {1.5, 0, 1e-3}}, 500, /* 1.5 + 1e-3 * 2^3.5 */ 1.5113137, 5e-7},
      {{6,
        {1.03961212, 6.00069867e-3, 0.231792344, 2.00179144e-2, 1.01046945, 103.560653, 0.25, 0}},
       587.5618,
       1.5970856,
       5e-7}, /* sqrt(1.5168000^2 + 0.25) */
      {{7, {2.7405, 1.84e-2, 1.79e-2, 1.55e-2}}, 587.5618, 1.670737, 5e-7},
      {{8, {2, 0.5, 0.01, 0.02}}, 500, /* 2 + 0.5*0.25/0.24 - 0.005 */ 1.5861379, 5e-7},
      {{9, {3.1399, 1.3786, 2.941e-2, 3.861, 225.9009}}, 587.5618, 2.154291, 5e-7},
      {{10, {2, 0, 0, 0, 0, 0, 1e-4, 1e-5}}, 500, /* 2 + 0.1024 + 0.04096 */ 1.4640219, 5e-7},
      {{11,
        {1.03961212, 6.00069867e-3, 0.231792344, 2.00179144e-2, 0.5, 103.560653, 0.5, 103.560653,
         0.01046945, 103.560653}},
       587.5618,
       1.5168,
       5e-6},
      {{12, {2, 0, 0, 0, 0, 0, 0.16, 0.64}}, 500, /* 2 + 0.01 + 0.01 */ 1.4212670, 5e-7},
      {{13,
        {2.18826855, -9.19044724e-3, -1.11621071e-4, 9.26372815e-3, 7.34900733e-5, 4.19724242e-6,
         -1.15412203e-7}},
       587.5618,
       1.48749,
       5e-7},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_dispersion d;
    assert_int_equal(abbe_agf_formula_read(&rows[i].f, &d, NULL), ABBE_OK);
    assert_int_equal(abbe_dispersion_check(&d, NULL), ABBE_OK);
    assert_near(abbe_dispersion_n(&d, rows[i].lambda_nm), rows[i].n, rows[i].within);
    /* and back, to the same n */
    abbe_agf_formula again;
    abbe_agf_fidelity fidelity;
    double error = 1;
    abbe_dispersion twice;
    assert_int_equal(abbe_agf_formula_write(&d, 400, 700, &again, &fidelity, &error, NULL),
                     ABBE_OK);
    assert_int_not_equal(fidelity, ABBE_AGF_FITTED);
    assert_int_equal(abbe_agf_formula_read(&again, &twice, NULL), ABBE_OK);
    assert_near(abbe_dispersion_n(&twice, rows[i].lambda_nm),
                abbe_dispersion_n(&d, rows[i].lambda_nm), 1e-15);
    assert_near(error, 0, 0);
    assert_non_null(abbe_agf_formula_name(rows[i].f.number));
  }
}

static double uniform(double low, double high) {
  return low + (high - low) * rand() / RAND_MAX;
}

/* Random coefficients of every formula come back as the same formula with the same coefficients,
 * and where they were given zeros, as one that computes the same. */
TEST(formulas_survive_a_round_trip) {
  static const int used[] = {0, 6, 6, 6, 5, 3, 8, 4, 4, 5, 8, 10, 8, 9};
  srand(7);
  for (int i = 0; i < 2600; i++) {
    abbe_agf_formula f = {.number = 1 + i % 13}, back;
    for (int k = 0; k < used[f.number]; k++) f.c[k] = uniform(0.1, 2);
    abbe_dispersion d, twice;
    abbe_agf_fidelity fidelity;
    double error;
    assert_int_equal(abbe_agf_formula_read(&f, &d, NULL), ABBE_OK);
    assert_int_equal(abbe_agf_formula_write(&d, 400, 700, &back, &fidelity, &error, NULL), ABBE_OK);
    assert_int_equal(back.number, f.number);
    for (int k = 0; k < ABBE_AGF_COEFFICIENTS; k++) assert_near(back.c[k], f.c[k], 1e-14);
    assert_int_equal(abbe_agf_formula_read(&back, &twice, NULL), ABBE_OK);
    double n = abbe_dispersion_n(&d, 550), m = abbe_dispersion_n(&twice, 550);
    assert_true((isnan(n) && isnan(m)) || fabs(n - m) < 1e-12 * n);
  }
}

/* Cauchy forms are squared, squared poles are multiplied out, a constant term is a pole at 0. */
TEST(other_forms_keep_their_index) {
  const abbe_dispersion forms[] = {
      {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {1.5}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5046, 0.0042}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 3, .c = {1.5040873, 0.0044473, -2.7078e-5}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 4, .c = {1.5, 0.004, 1e-5, -1e-6}},
      {.model = ABBE_DISPERSION_SELLMEIER, .count = 5, .c = {0, 0.3306, 0.175, 4.3356, 0.106}},
      {.model = ABBE_DISPERSION_SELLMEIER2,
       .count = 5,
       .c = {0.28604141, 1.07044083, 0.0100585997, 1.10202242, 100}},
      {.model = ABBE_DISPERSION_RII4, .count = 9, .c = {5.913, 0.2441, 0, 0.0803, 1, 0, 0, 0, 1}},
      {.model = ABBE_DISPERSION_SELLMEIER2, .count = 7, .c = {0, 1.04, 0.006, 0, 0.3, 1.01, 103}},
      {.model = ABBE_DISPERSION_POLYNOMIAL,
       .count = 11,
       .c = {2.27, 0.012, -2, -0.01, 2, 1e-4, -4, 1e-5, -6, 1e-6, -8}},
  };
  for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
    abbe_agf_formula f;
    abbe_agf_fidelity fidelity;
    abbe_dispersion d;
    double error;
    assert_int_equal(abbe_agf_formula_write(&forms[i], 400, 700, &f, &fidelity, &error, NULL),
                     ABBE_OK);
    assert_int_not_equal(fidelity, ABBE_AGF_FITTED);
    assert_int_equal(abbe_agf_formula_read(&f, &d, NULL), ABBE_OK);
    for (double l = 380; l < 780; l += 7)
      assert_near(abbe_dispersion_n(&d, l), abbe_dispersion_n(&forms[i], l), 1e-14);
  }
}

/* The error that is stated is the error that is made. */
TEST(what_has_no_formula_is_fitted_with_its_error) {
  const abbe_dispersion moissanite = {
      .model = ABBE_DISPERSION_RII4,
      .count = 11,
      .c = {6.57232, 0.1401, 0, 0.03178, 1, 0.01, 2, 0.2, 1, -0.02153, 2}};
  abbe_agf_formula f;
  abbe_agf_fidelity fidelity;
  abbe_dispersion d;
  double error = 0, worst = 0;
  assert_int_equal(abbe_agf_formula_write(&moissanite, 500, 700, &f, &fidelity, &error, NULL),
                   ABBE_OK);
  assert_int_equal(fidelity, ABBE_AGF_FITTED);
  assert_int_equal(f.number, 10);
  assert_int_equal(abbe_agf_formula_read(&f, &d, NULL), ABBE_OK);
  for (double l = 500; l <= 700; l += 1)
    worst = fmax(worst, fabs(abbe_dispersion_n(&d, l) - abbe_dispersion_n(&moissanite, l)));
  assert_near(worst, error, 1e-12);
  assert_true(error > 0 && error < 1e-3);
  assert_int_equal(abbe_agf_formula_write(&moissanite, 700, 500, &f, &fidelity, &error, NULL),
                   ABBE_INVALID_ARGUMENT);
  const abbe_dispersion many[] = {
      {.model = ABBE_DISPERSION_CAUCHY, .count = 5, .c = {1.5, 0.004, 1e-5, 1e-7, 1e-8}},
      {.model = ABBE_DISPERSION_SELLMEIER2,
       .count = 13,
       .c = {0, 0.3, 0.006, 0.3, 0.007, 0.3, 0.008, 0.1, 0.009, 0.1, 0.01, 0.1, 0.011}}};
  for (int i = 0; i < 2; i++) {
    assert_int_equal(abbe_agf_formula_write(&many[i], 400, 700, &f, &fidelity, &error, NULL),
                     ABBE_OK);
    assert_int_equal(fidelity, ABBE_AGF_FITTED);
    assert_true(error < 1e-4);
  }
}

TEST(wrong_formulas_are_named) {
  abbe_dispersion d;
  const abbe_agf_formula none = {14, {1}}, zero = {2, {0}}, infinite = {1, {1, INFINITY}};
  REFUSED(ABBE_INVALID_ARGUMENT, "no formula 14; a catalogue's are 1 to 13",
          abbe_agf_formula_read(&none, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "are 0", abbe_agf_formula_read(&zero, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "coefficient 1 is inf",
          abbe_agf_formula_read(&infinite, &d, &error));
  assert_null(abbe_agf_formula_name(0));
  assert_string_equal(abbe_agf_formula_name(13), "Extended 3");
}
