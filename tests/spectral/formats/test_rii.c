#include "tests/check.h"

#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

static abbe_report report;

static abbe_material parse_as(const char *text, const char *path, const char *name) {
  abbe_material m;
  abbe_report_free(&report);
  OK(abbe_rii_parse(text, strlen(text), path, name, &m, &report, &error));
  return m;
}

/* As the database has a maker's glass [RefractiveIndexInfo]. */
static const char bk7[] =
    "# this file is part of refractiveindex.info database\n\n"
    "REFERENCES: |\n"
    "    <a href=\"https://x/schott_2017-01-20b.agf\">SCHOTT Zemax catalog 2017-01-20b</a>\n"
    "    (obtained from <a href=\"https://www.schott.com\">http://www.schott.com</a>)<br>\n"
    "    See also <a href=\"https://x.pdf\">SCHOTT glass data sheets</a>\n"
    "COMMENTS: |\n    step 0.5 available\n"
    "DATA:\n"
    "  - type: formula 2\n"
    "    wavelength_range: 0.3 2.5\n"
    "    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n"
    "  - type: tabulated k\n"
    "    data: |\n"
    "        0.300 2.8607E-06\n        0.400 1.0227E-08\n        0.500 9.5781E-09\n"
    "        2.500 8.1300E-06\n"
    "CONDITIONS:\n    temperature: 293\n"
    "PROPERTIES:\n"
    "    thermal_dispersion:\n      - type: formula A\n"
    "        coefficients: 1.86e-06 1.31e-08 -1.37e-11 4.34e-07 6.27e-10 0.17\n"
    "    nd: 1.5168\n    Vd: 64.17\n    glass_code: 517642.251\n    glass_status: standard\n"
    "    density:\n      - value: 2510\n"
    "    thermal_expansion:\n      - temperature_range: 243 343\n        value: 7.1e-06\n"
    "      - temperature_range: 293 573\n        value: 8.3e-06\n"
    "    dPgF: -0.0009\n"
    "    resistance:\n        climatic: 1.0\n        stain: 0.0\n        acid: 1.0\n"
    "        alkali: 2.3\n        phosphate: 2.3\n";

TEST(a_makers_glass_is_read_whole) {
  OWNED(abbe_material, m) = parse_as(bk7, "database/data/specs/schott/optical/N-BK7.yml", NULL);
  assert_string_equal(m.name, "N-BK7");
  assert_string_equal(m.source, "SCHOTT Zemax catalog 2017-01-20b (obtained from "
                                "http://www.schott.com) See also SCHOTT glass data sheets");
  assert_string_equal(m.comment, "step 0.5 available");
  assert_int_equal(m.dispersion.model, ABBE_DISPERSION_SELLMEIER2);
  assert_near(abbe_dispersion_describe(&m.dispersion).n_d, 1.5168, 5e-6);
  assert_near(m.min_nm, 300, 0);
  assert_near(m.max_nm, 2500, 0);
  assert_near(m.temperature_c, 20, 0); /* 293 K of a copy of Schott's */
  assert_near(m.published_n_d, 1.5168, 0);
  assert_near(m.published_v_d, 64.17, 0);
  assert_near(abbe_material_attenuation(&m, 400), 4 * acos(-1) * 1.0227e-8 / 400e-9, 1e-12);
  assert_string_equal(m.catalogue.code, "517642.251");
  assert_string_equal(m.catalogue.status, "standard");
  assert_near(m.catalogue.density_g_cm3, 2.51, 0);
  assert_near(m.catalogue.expansion_per_k[1], 8.3e-6, 0);
  assert_true(m.catalogue.expansion_range_k[0] == 0 && m.catalogue.expansion_range_k[1] == 0);
  assert_true(m.catalogue.expansion_range_k[2] == 293 && m.catalogue.expansion_range_k[3] == 573);
  assert_near(m.catalogue.thermal[0], 1.86e-6, 0);
  assert_near(m.catalogue.dpgf, -0.0009, 0);
  assert_near(m.catalogue.ratings[5], 2.3, 0);
  assert_near(m.catalogue.ratings[0], -1, 0);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED] + report.kinds[ABBE_NOTE_LOST], 0);
}

TEST(names_come_from_the_path) {
  static const char text[] =
      "DATA:\n- {type: formula 5, wavelength_range: 0.4 0.7, coefficients: 2}\n";
  const struct {
    const char *path, *name;
  } rows[] = {{"a/main/SiO2/nk/Malitson.yml", "SiO2-Malitson"},
              {"nk/Malitson.yml", "Malitson"},
              {"Daimon-20.0C.yml", "Daimon-20.0C"},
              {"/x/optical/N-BK7.yml", "N-BK7"},
              {"a.b/bare", "bare"},
              {"nk/.hidden", ".hidden"},
              {"bare", "bare"}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    OWNED(abbe_material, m) = parse_as(text, rows[i].path, NULL);
    assert_string_equal(m.name, rows[i].name);
  }
  char deep[400];
  memset(deep, 'a', sizeof deep - 1);
  deep[399] = '\0';
  abbe_material none; /* a name may have 80 letters: the book is left out, and then it is refused */
  OWNED(abbe_material, fits) = parse_as(text, printed("%.70s/nk/%.70s.yml", deep, deep), NULL);
  assert_string_equal(fits.name, printed("%.70s", deep));
  REFUSED(ABBE_SCHEMA, "is not a name",
          abbe_rii_parse(text, strlen(text), deep, NULL, &none, NULL, &error));
  OWNED(abbe_material, m) = parse_as(text, "x.yml", "mine");
  assert_string_equal(m.name, "mine");
  assert_int_equal(m.dispersion.model, ABBE_DISPERSION_CONSTANT);
  assert_contains(m.source, "without references, x.yml");
}

/* Formula by formula: published n, of the material that the database has for it. */
TEST(every_formula_is_read) {
  const struct {
    const char *type, *range, *c;
    abbe_dispersion_model model;
    double lambda_nm, n, within;
  } rows[] = {
      {"formula 1", "0.21 6.7", "0 0.6961663 0.0684043 0.4079426 0.1162414 0.8974794 9.896161",
       ABBE_DISPERSION_SELLMEIER, 587.5618, 1.458464, 5e-7},
      {"formula 3", "0.4 0.7",
       "2.259379 0.009090504 2 0.02633942 -2 -0.003777418 -4 0.0005228702 -6 -2.629182e-05 -8",
       ABBE_DISPERSION_POLYNOMIAL, 587.5618, 1.52249, 5e-7},
      {"formula 4", "0.43 1.53", "5.913 0.2441 0 0.0803 1 0 0 0 1", ABBE_DISPERSION_RII4, 587.5618,
       2.614265, 5e-7},
      {"formula 4", "0.43 1.53", "5.913 0.2441 0 0.0803 1", ABBE_DISPERSION_RII4, 587.5618,
       2.614265, 5e-7},
      {"formula 5", "0.4 0.7", "1.5046 0.0042 -2", ABBE_DISPERSION_CAUCHY, 500, 1.5214, 1e-15},
      {"formula 5", "0.4 0.7", "1.5 0.01 -1", ABBE_DISPERSION_POWERS, 500, 1.52, 1e-15},
      {"formula 5", "[0.4, 0.7]", "[1.5, 0.01, -1]", ABBE_DISPERSION_POWERS, 500, 1.52, 1e-15},
      {"formula 5", "1e-4 2e3", "1.5 0.01 -1", ABBE_DISPERSION_POWERS, 500, 1.52, 1e-15},
      {"formula 5", "0.4 2e3", "1.5 0.01 -1", ABBE_DISPERSION_POWERS, 500, 1.52, 1e-15},
      {"formula 6", "0.23 1.69", "0 0.05792105 238.0185 0.00167917 57.362", ABBE_DISPERSION_RII6,
       589.3, 1.000277, 5e-7},
      {"formula 7", "2.4373 25", "3.41983 0.159906 -0.123109 1.26878e-6 -1.95104e-9",
       ABBE_DISPERSION_HERZBERGER, 5000, 3.4261, 5e-5},
      {"formula 8", "0.495 0.67", "0.452505 0.09939 0.070537 -0.00015", ABBE_DISPERSION_RII8, 589.3,
       2.253, 5e-3},
      {"formula 9", "0.3 1.06", "2.51527 0.0240 0.0300 0.0202 1.52 0.8771", ABBE_DISPERSION_RII9,
       1050, 1.59, 1e-2},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    OWNED(abbe_material, m) =
        parse_as(printed("REFERENCES: r\nDATA:\n  - type: %s \n    wavelength_range: %s\n"
                         "    coefficients: %s\n",
                         rows[i].type, rows[i].range, rows[i].c),
                 "x.yml", NULL);
    assert_int_equal(m.dispersion.model, rows[i].model);
    assert_near(abbe_dispersion_n(&m.dispersion, rows[i].lambda_nm), rows[i].n, rows[i].within);
    const bool cut = strstr(rows[i].range, "2e3") != NULL; /* to 1 nm to 1 mm */
    assert_int_equal(report.kinds[ABBE_NOTE_LOST], cut);
    assert_int_equal(report.count, cut);
  }
}

TEST(tables_are_read_and_put_in_order) {
  OWNED(abbe_material, m) =
      parse_as("REFERENCES: r\nDATA:\n  - type: tabulated nk\n    data: |\n"
               "        0.6 1.45 0.02\n        0.5 1.5 0.01\n        0.7 1.4 0\n"
               "        0.7 1.3 0\n        oops\n        0.8 -1 0\n",
               "x.yml", NULL);
  double n = 0;
  assert_int_equal(abbe_spectrum_count(m.dispersion.table), 3);
  OK(abbe_material_n(&m, 600, &n, &error));
  assert_near(n, 1.45, 1e-15);
  assert_near(m.min_nm, 500, 0);
  assert_near(m.max_nm, 700, 0);
  assert_near(abbe_material_attenuation(&m, 500), 4 * acos(-1) * 0.01 / 500e-9, 1e-6);
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 2);
  abbe_material_free(&m);
  m = parse_as("REFERENCES: r\nDATA:\n  - type: tabulated n\n    data: |\n        0.5 1.5\n"
               "        0.6 1.4\n  - type: tabulated k\n    data: |\n        0.5 0\n        0.6 0\n"
               "  - type: tabulated n2\n    data: 0.5 1\n  - type: formula 2\n",
               "x.yml", NULL);
  assert_null(m.attenuation); /* k of 0 throughout is clear */
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 2);
}

/* Rows that are none of a table, and numbers beyond what a table holds: counted in one note. */
TEST(rows_beyond_a_table_are_left_out) {
  static const char *const rows[] = {"0.0001 1.5 0.1", "2000 1.5 0.1", "0.5 1.5 2000",
                                     "0.5 1.5 -1",     "0.5 2000 0.1", "0.5 1e-4 0.1",
                                     "0.5 1.5",        "0.5 1.5 0 1",  "0.5 1.5 1e999",
                                     "0.5 1.5x 0",     "0.5 1.5 x"};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_material, m) = parse_as(
        printed("REFERENCES: r\nDATA:\n  - type: tabulated nk\n    data: |\n        # a remark\n\n"
                "        [0.4, 1.5,\t0.01]\n        %s\n        0.6 1.4 0.02\n",
                rows[i]),
        "x.yml", NULL);
    const size_t n_alone = i == 2 || i == 3, k_alone = i == 4 || i == 5;
    assert_int_equal(abbe_spectrum_count(m.dispersion.table), 2 + n_alone);
    assert_near(m.min_nm, 400, 0);
    assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1);
    assert_contains(report.note[0].text, "1 lines of its table are not 3 numbers");
    (void)k_alone;
  }
  OWNED(abbe_material, m) = parse_as(
      printed("REFERENCES: r\nDATA:\n  - type: tabulated n\n    data: |\n        0.4 1.5%300s\n"
              "        0.6 1.4\n",
              ""),
      "x.yml", NULL);
  assert_int_equal(abbe_spectrum_count(m.dispersion.table), 2);
}

/* The first index and the first k are read; what is written beside them is said to be lost. */
TEST(the_first_of_each_is_read) {
  OWNED(abbe_material, m) =
      parse_as("REFERENCES: r\nDATA:\n- {type: tabulated k, data: \"0.4 0.02\\n0.6 0.02\"}\n"
               "- {type: tabulated k, data: \"0.4 0.5\\n0.6 0.5\"}\n"
               "- {type: tabulated nk, data: \"0.4 1.5 0.9\\n0.6 1.4 0.9\"}\n",
               "x.yml", NULL);
  assert_near(abbe_material_attenuation(&m, 400), 4 * acos(-1) * 0.02 / 400e-9, 1e-6);
  assert_near(abbe_dispersion_n(&m.dispersion, 400), 1.5, 1e-12);
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1);
}

#define GLASS "DATA:\n- {type: formula 5, wavelength_range: 0.4 0.7, coefficients: 1.5}\n"

/* Whole kelvin are makers' 20, 23 and 25 C; what is no temperature is none. */
TEST(conditions) {
  static const struct {
    const char *text;
    double celsius;
    const char *warning; /* NULL: none */
  } rows[] = {{"CONDITIONS: {temperature: 293}\n", 20, NULL},
              {"CONDITIONS: {temperature: 296}\n", 23, NULL},
              {"CONDITIONS: {temperature: 298}\n", 25, NULL},
              {"CONDITIONS: {temperature: 300.15}\n", 27, NULL},
              {"CONDITIONS: {temperature: -1}\n", NAN, NULL},
              {"CONDITIONS: {temperature: 1e5}\n", NAN, NULL},
              {"CONDITIONS: 3\n", NAN, NULL},
              {"SPECS: {n_is_absolute: True}\n", NAN, "The index is relative to vacuum"},
              {"SPECS: {n_is_absolute: false}\n", NAN, NULL},
              {"SPECS: {wavelength_is_vacuum: true}\n", NAN, "Wavelengths are those in vacuum"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_material, m) = parse_as(printed(GLASS "%s", rows[i].text), "x.yml", NULL);
    assert_true(isnan(rows[i].celsius) ? isnan(m.temperature_c)
                                       : fabs(m.temperature_c - rows[i].celsius) < 1e-9);
    assert_int_equal(m.warning != NULL, rows[i].warning != NULL);
    if (m.warning == NULL) continue;
    assert_true(strncmp(m.warning, rows[i].warning, strlen(rows[i].warning)) == 0);
    assert_int_equal(m.n_absolute, i == 7);
  }
}

/* Properties that are there in another form than the database's are not read. */
TEST(odd_properties_are_left_out) {
  static const char *const rows[] = {
      "thermal_dispersion: []",
      "thermal_dispersion: [3]",
      "thermal_dispersion: [{coefficients: 1 2 3 4 5 6}]",
      "thermal_dispersion: [{type: formula B, coefficients: 1 2 3 4 5 6}]",
      "thermal_dispersion: [{type: formula A, coefficients: 1 2 3}]",
      "thermal_dispersion: [{type: formula A, coefficients: [1, 2, 3, 4, 5, 6, 7]}]",
      "thermal_dispersion: [{type: formula A, coefficients: [1, 2, 3, 4, 5, [6]]}]",
      "thermal_dispersion: [{type: formula A, coefficients: [1, 2, 3, 4, 5, x]}]",
      "glass_code: \"\"",
      "glass_code: a text that is far too long to be the code of a glass",
      "nd: 1e9",
      "Vd: 1e9",
      "density: [3]",
      "thermal_expansion: {temperature_range: -5 300}"};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_material, m) =
        parse_as(printed(GLASS "PROPERTIES:\n    %s\n", rows[i]), "x.yml", NULL);
    assert_false(abbe_material_has_thermal(&m));
    assert_null(m.catalogue.code);
    assert_true(m.published_n_d == 0 && m.published_v_d == 0 && m.catalogue.density_g_cm3 == 0);
    assert_true(m.catalogue.expansion_range_k[0] == 0);
  }
  OWNED(abbe_material, m) = parse_as(GLASS "PROPERTIES:\n    thermal_expansion:\n"
                                           "      - {temperature_range: 243 350, value: 7e-6}\n"
                                           "      - {temperature_range: 500 400, value: 8e-6}\n",
                                     "x.yml", NULL);
  OWNED(abbe_material, lone) = parse_as(
      GLASS "PROPERTIES:\n    thermal_expansion: {temperature_range: 293 573, value: 8e-6}\n",
      "x.yml", NULL);
  assert_true(lone.catalogue.expansion_per_k[0] == 0 && lone.catalogue.expansion_per_k[1] == 8e-6);
  OWNED(abbe_material, cold) = parse_as(
      GLASS "PROPERTIES:\n    thermal_expansion: {temperature_range: -5 300, value: 8e-6}\n",
      "x.yml", NULL);
  assert_true(cold.catalogue.expansion_per_k[0] == 8e-6 &&
              cold.catalogue.expansion_range_k[0] == 0);
  assert_true(m.catalogue.expansion_range_k[0] == 243 && m.catalogue.expansion_range_k[1] == 350);
  assert_true(m.catalogue.expansion_range_k[2] == 0);
  abbe_material_free(&m);
  m = parse_as("REFERENCES: a < b\nCOMMENTS: <br>\n" GLASS, "x.yml", NULL);
  assert_string_equal(m.source, "a < b");
  assert_null(m.comment);
}

TEST(properties_beyond_a_table_are_left_out) {
  OWNED(abbe_material, m) =
      parse_as("REFERENCES: r\nDATA:\n  - type: formula 5\n    wavelength_range: 0.4 0.7\n"
               "    coefficients: 1.5 0.004 -2\nPROPERTIES:\n    nd: 1e-9\n    dPgF: 1e9\n"
               "    density:\n      - value: 1e12\n    thermal_expansion:\n"
               "      - value: 7.1e+206\n      - value: 8.3e-06\n",
               "a.yml", NULL);
  assert_true(m.published_n_d == 0 && m.catalogue.dpgf == 0 && m.catalogue.density_g_cm3 == 0);
  assert_true(m.catalogue.expansion_per_k[0] == 0);
  assert_near(m.catalogue.expansion_per_k[1], 8.3e-6, 0);
  assert_int_equal(report.count, 1);
  assert_contains(report.note[0].text, "too large");
}

TEST(absolute_indices_get_a_warning) {
  OWNED(abbe_material, m) = parse_as(
      "REFERENCES: r\nDATA:\n- {type: formula 5, wavelength_range: 0.4 0.7, coefficients: "
      "1.5}\nCONDITIONS: {n_absolute: true, wavelength_vacuum: true, temperature: 293.15}\n",
      "x.yml", NULL);
  assert_contains(m.warning, "relative to vacuum");
  assert_contains(m.warning, "Wavelengths are those in vacuum");
  assert_near(m.temperature_c, 20, 0);
  /* in vacuum it is what it is, and in air lower */
  double n, absolute;
  const abbe_conditions vacuum = {NAN, 0}, air = {NAN, 1};
  OK(abbe_material_n_absolute(&m, 550, &absolute, &error));
  assert_near(absolute, 1.5, 0);
  OK(abbe_material_place(&m, &vacuum, &error));
  OK(abbe_material_n(&m, 550, &n, &error));
  assert_near(n, 1.5, 1e-15);
  OK(abbe_material_place(&m, &air, &error));
  OK(abbe_material_n(&m, 550, &n, &error));
  OK(abbe_material_n_absolute(&m, 550, &absolute, &error));
  assert_near(n, 1.5 / abbe_air_n(550, 20, 1), 1e-12);
  assert_near(absolute, 1.5, 1e-12);
}

static void refuses(const char *text, abbe_result code, const char *part) {
  abbe_material m;
  REFUSED(code, part, abbe_rii_parse(text, strlen(text), "x.yml", NULL, &m, NULL, &error));
  assert_null(m.name);
}

TEST(what_holds_no_index_is_refused) {
  refuses("", ABBE_PARSE, "x.yml");
  refuses("materials: []\n", ABBE_SCHEMA, "x.yml:1: has no list 'DATA'");
  refuses("DATA: []\n", ABBE_SCHEMA, "holds no index");
  refuses("DATA:\n- {type: tabulated n2, data: 0.5 1}\n", ABBE_SCHEMA, "only a nonlinear one");
  refuses("DATA:\n- {type: tabulated k, data: 0.5 1}\n", ABBE_SCHEMA, "a material needs n as well");
  refuses("DATA:\n- {type: formula 12}\n", ABBE_SCHEMA, "x.yml:2: there is no formula 12");
  refuses("DATA:\n- {type: formula 99999999999999999999}\n", ABBE_SCHEMA, "no formula 9999");
  refuses("DATA:\n- {type: formula 2}\n", ABBE_SCHEMA, "wants its 'coefficients'");
  refuses("DATA:\n- {type: formula 2, coefficients: 0 1 2}\n", ABBE_SCHEMA, "'wavelength_range'");
  static const char *const ranges[] = {"1", "1 2 3", "0 1", "2 1", "1 2x", "1 1e999"};
  for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
    refuses(printed("DATA:\n- {type: formula 2, coefficients: 0 1 0.01, wavelength_range: %s}\n",
                    ranges[i]),
            ABBE_SCHEMA, "'wavelength_range'");
  refuses("DATA:\n- {type: formula 0}\n", ABBE_SCHEMA, "there is no formula 0");
  refuses("DATA:\n- {type: formula 2x}\n", ABBE_SCHEMA, "only other data");
  refuses("DATA:\n- {type: formula x}\n", ABBE_SCHEMA, "only other data");
  refuses("DATA:\n- {type: formula 2, coefficients: {}}\n", ABBE_SCHEMA, "'coefficients'");
  refuses("DATA:\n- 3\n- {type: formula 2}\n", ABBE_SCHEMA, "wants a 'type'");
  refuses("DATA:\n- {type: tabulated n, data: [1, 2]}\n", ABBE_SCHEMA, "wants its 'data'");
  refuses("DATA:\n- {type: formula 2, coefficients: 0 1, wavelength_range: 1 2}\n", ABBE_SCHEMA,
          "odd number");
  refuses("DATA:\n- {type: formula 2, coefficients: 0 1 x, wavelength_range: 1 2}\n", ABBE_SCHEMA,
          "1 to 32 numbers");
  refuses("DATA:\n- {type: formula 2, coefficients: 0 1 0.16, wavelength_range: 0.3 2}\n",
          ABBE_SCHEMA, "no real index at 300 nm");
  refuses("DATA:\n- {type: formula 4, wavelength_range: 46.5 999.9,\n"
          "   coefficients: 0 6.1 2 44.5 2 -4100 0 44.5}\n",
          ABBE_SCHEMA, "formula 4: the model rii4 wants 1, 5, 9, or 9 and further pairs");
  refuses("DATA:\n- {type: formula 4, wavelength_range: 0.4 1, coefficients: 2 0.1}\n", ABBE_SCHEMA,
          "not 2");
  refuses("DATA:\n- {type: formula 4, wavelength_range: 0.4 1,\n"
          "   coefficients: 2 0.1 0 0.08 1 0 0 0 1 0.1}\n",
          ABBE_SCHEMA, "not 10");
  refuses("DATA:\n- {type: formula 8, wavelength_range: 0.4 1, coefficients: 0.4 0.1 0.07}\n",
          ABBE_SCHEMA, "the model rii8 wants 4");
  refuses(
      "DATA:\n- {type: formula 9, wavelength_range: 0.3 1, coefficients: 2.5 0.02 0.03 0.02 1.5}\n",
      ABBE_SCHEMA, "the model rii9 wants 6");
  refuses("DATA:\n- {type: formula 7, wavelength_range: 2 3, coefficients: 3 0 0 0 0 0 0}\n",
          ABBE_SCHEMA, "the model herzberger wants 6");
  refuses("DATA:\n- {type: tabulated n}\n", ABBE_SCHEMA, "wants its 'data', 2 numbers a line");
  refuses("DATA:\n- {type: tabulated n, data: nothing}\n", ABBE_SCHEMA, "no usable line");
  refuses("DATA:\n- 3\n", ABBE_SCHEMA, "wants a 'type'");
}

static void end(void) {
  abbe_report_free(&report);
}

GROUP(NULL, end);

static abbe_material reread(const abbe_material *m, abbe_report *notes) {
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  abbe_error why = {0};
  OK(abbe_rii_write(m, to, notes, &error));
  fclose(to);
  abbe_material back;
  if (abbe_rii_parse(text, size, "x.yml", m->name, &back, NULL, &why) != ABBE_OK)
    fail_msg("%s\n%s", why.text, text);
  return back;
}

TEST(shipped_rows_come_back_the_same) {
  const char *const tables[] = {"default", "thesis"};
  for (int t = 0; t < 2; t++) {
    MADE(abbe_material_table, table, abbe_material_table_load(tables[t], &table, &error));
    for (size_t i = 0; i < table.count; i++) {
      OWNED(abbe_material, back) = reread(&table.material[i], NULL);
      assert_carried(&table.material[i], &back, 1e-14);
    }
  }
}

/* What the database does not carry is left out of the record, the rest comes back; and what was
 * left out is noted. */
TEST(random_records_come_back_the_same) {
  srand(3);
  for (size_t i = 0; i < 400; i++) {
    OWNED(abbe_material, m) = random_material(i);
    free(m.source);
    free(m.comment);
    m.source = strdup("A. Author, \"Title\" & <more>, 2001: p. 3");
    m.comment = i % 2 ? strdup("20 \xc2\xb0\x43 # not a comment") : NULL;
    OWNED(abbe_report, notes) = {0};
    OWNED(abbe_material, back) = reread(&m, &notes);
    bool lost = m.description != NULL || m.warning != NULL || m.fit[0].terms > 0 || m.extrapolate ||
                abbe_material_is_uniaxial(&m);
    assert_true(!lost || notes.kinds[ABBE_NOTE_LOST] > 0);
    m.catalogue.melt_frequency = 0;
    m.catalogue.ratings[0] = -1;
    bool rated = false;
    for (int k = 0; k < 6; k++) rated = rated || m.catalogue.ratings[k] >= 0;
    if (!rated) m.catalogue.rating_count = 0;
    assert_true(same_catalogue(&m.catalogue, &back.catalogue));
    assert_string_equal(m.source, back.source);
    assert_true(same_text(m.comment, back.comment));
    assert_true(same_number(m.temperature_c, back.temperature_c, 1e-12));
    assert_true(m.n_absolute == back.n_absolute);
    assert_true(m.published_n_d == back.published_n_d && m.published_v_d == back.published_v_d);
    if (m.dispersion.table == NULL) {
      bool constant = m.dispersion.count == 1 && back.dispersion.model == ABBE_DISPERSION_CONSTANT;
      /* n = c0 + c1 L^-2 is of both forms */
      bool squares = m.dispersion.model == ABBE_DISPERSION_POWERS &&
                     back.dispersion.model == ABBE_DISPERSION_CAUCHY;
      assert_true(constant || squares || same_dispersion(&m.dispersion, &back.dispersion));
      for (double l = 350; l < 901 && squares; l += 50)
        assert_near(abbe_dispersion_n(&back.dispersion, l), abbe_dispersion_n(&m.dispersion, l), 0);
      assert_near(m.min_nm, back.min_nm, 0);
      assert_near(m.max_nm, back.max_nm, 0);
    } else {
      size_t count = abbe_spectrum_count(m.dispersion.table);
      assert_int_equal(abbe_spectrum_count(back.dispersion.table), count);
      assert_true(same_numbers(abbe_spectrum_value(m.dispersion.table),
                               abbe_spectrum_value(back.dispersion.table), count, 0));
    }
    for (double l = 300; l < 900; l += 50)
      if (m.attenuation == NULL ||
          abbe_spectrum_interpolation(m.attenuation) == ABBE_INTERPOLATION_LINEAR)
        assert_near(abbe_material_attenuation(&back, l), abbe_material_attenuation_along(&m, 0, l),
                    1e-11 * abbe_material_attenuation_along(&m, 0, l));
  }
}

/* What the database has no place for is said, each by itself. */
TEST(single_losses_are_said) {
  static const double nm[] = {400, 500, 600, 700}, n[] = {1.5, 1.49, 1.48, 1.47};
  abbe_material m = FIELDS(.name = (char[]){"x"}, .source = (char[]){"s"}, .min_nm = 400,
                           .max_nm = 700, .temperature_c = NAN, .comment = (char[]){""},
                           .dispersion = {.model = ABBE_DISPERSION_TABULATED});
  OK(abbe_spectrum_make(nm, n, 4, ABBE_INTERPOLATION_MONOTONE, &m.dispersion.table, &error));
  for (int i = 0; i < 5; i++) {
    OWNED(abbe_report, notes) = {0};
    m.min_nm = i == 1 ? 450 : 400;
    m.max_nm = i == 2 ? 650 : 700;
    m.fit[1].terms = i == 3 ? 3 : 0;
    m.catalogue.rating_count = i == 4 ? 6 : 0;
    for (int k = 0; k < 6; k++) m.catalogue.ratings[k] = k;
    OWNED(abbe_material, back) = reread(&m, &notes);
    assert_int_equal(notes.count, i != 0);
    static const char *const says[] = {"range is that of its points", "range is that of its points",
                                       "recorded fits", "a glass's cost"};
    if (i > 0) assert_contains(notes.note[0].text, says[i - 1]);
    assert_null(back.comment);
    if (i == 4) assert_near(back.catalogue.ratings[3], 3, 0);
  }
  abbe_dispersion_free(&m.dispersion);
}

TEST(failures_are_told) {
  abbe_material m =
      FIELDS(.name = (char[]){"x"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {1.5}});
  for (int buffered = 0; buffered < 2; buffered++) {
    FILE *full = fopen("/dev/full", "w");
    if (!buffered) setvbuf(full, NULL, _IONBF, 0);
    m.max_nm = 700;
    assert_int_equal(abbe_rii_write(&m, full, NULL, NULL), ABBE_IO);
    m.max_nm = 300;
    assert_int_equal(abbe_rii_write(&m, full, NULL, NULL), ABBE_INVALID_ARGUMENT);
    fclose(full);
  }
}
