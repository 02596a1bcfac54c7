#include "tests/check.h"

#include "spectral/dispersion/csv_points.h"

static abbe_csv_points parse(const char *text, const abbe_csv_options *options,
                             abbe_report *report) {
  abbe_csv_points points;
  abbe_error error = {0};
  if (abbe_csv_points_parse(text, strlen(text), "m.csv", options, &points, report, &error) !=
      ABBE_OK)
    fail_msg("%s", error.text);
  return points;
}

/* The same three points in every dress. */
TEST(many_dresses_hold_the_same_points) {
  const char *const dresses[] = {
      "486.1,1.5224\n587.6,1.5168\n656.3,1.5143\n",
      "wavelength_nm,n\r\n486.1,1.5224\r\n587.6,1.5168\r\n656.3,1.5143",
      "# mine\n\nwl (um); n\n0,6563;1,5143\n0,4861;1,5224\n0,5876;1,5168\n",
      "lambda [um]\tindex\n0.4861\t1.5224\n0.5876\t1.5168\n0.6563\t1.5143\n",
      "  0.4861   1.5224\n  0.5876   1.5168\n  0.6563   1.5143\n",
      "n,wavelength/nm\n1.5224,486.1\n1.5168,587.6\n1.5143,656.3\n",
      "wavelength (nm)   n\n486.1 1.5224\n587.6 1.5168\n656.3 1.5143\n",
      "\xce\xbb (\xc2\xb5m), n\n0.4861, 1.5224\n0.5876, 1.5168\n0.6563, 1.5143\n",
  };
  for (size_t i = 0; i < sizeof dresses / sizeof dresses[0]; i++) {
    OWNED(abbe_csv_points, p) = parse(dresses[i], NULL, NULL);
    assert_int_equal(p.n.count, 3);
    assert_int_equal(p.k.count, 0);
    assert_near(p.n.point[0].lambda_nm, 486.1, 1e-9);
    assert_near(p.n.point[1].value, 1.5168, 0);
    assert_near(p.n.point[2].lambda_nm, 656.3, 1e-9);
    assert_near(p.n.point[2].error, 0, 0);
  }
}

TEST(a_third_column_is_what_the_header_or_the_caller_says) {
  abbe_csv_points p = parse("nm,n,uncertainty\n500,1.5,2e-5\n", NULL, NULL);
  assert_near(p.n.point[0].error, 2e-5, 0);
  abbe_csv_points_free(&p);
  p = parse("nm,n,k\n500,1.5,2e-5\n", NULL, NULL);
  assert_near(p.n.point[0].error, 0, 0);
  assert_near(p.k.point[0].value, 2e-5, 0);
  abbe_csv_points_free(&p);
  const abbe_csv_third third[] = {ABBE_CSV_UNCERTAINTY, ABBE_CSV_K, ABBE_CSV_IGNORED};
  for (int i = 0; i < 3; i++) {
    const abbe_csv_options options = {.third = third[i]};
    p = parse("500,1.5,2e-5\n", &options, NULL);
    assert_near(p.n.point[0].error, i == 0 ? 2e-5 : 0, 0);
    assert_int_equal(p.k.count, i == 1);
    abbe_csv_points_free(&p);
  }
}

/* As refractiveindex.info's download has it. */
TEST(a_second_header_begins_a_block_of_k) {
  OWNED(abbe_csv_points, p) =
      parse("wl,n\n0.4,1.5\n0.5,1.4\n\nwl,k\n0.4,0.001\n0.6,0.002\n", NULL, NULL);
  assert_int_equal(p.n.count, 2);
  assert_int_equal(p.k.count, 2);
  assert_near(p.k.point[1].lambda_nm, 600, 1e-9);
  assert_near(p.k.point[1].value, 0.002, 0);
}

TEST(bad_lines_are_noted_and_passed_over) {
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_csv_points, p) =
      parse("400,1.5\n500,what\n-5,1.5\n600\n600,0\n700,1.4\n400,9\n800,1,-1\n", NULL, &report);
  assert_int_equal(p.n.count, 2);
  assert_near(p.n.point[0].value, 1.5, 0);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 5);
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1);
  assert_int_equal(report.note[0].line, 2);
  assert_contains(report.note[0].text, "not a number: 'what'");
}

static void refuses(const char *text, const abbe_csv_options *options, abbe_result code,
                    const char *part) {
  abbe_csv_points points;
  REFUSED(code, part,
          abbe_csv_points_parse(text, strlen(text), "m.csv", options, &points, NULL, &error));
  assert_null(points.n.point);
}

TEST(what_cannot_be_told_is_asked_for) {
  refuses("", NULL, ABBE_SCHEMA, "m.csv: holds no points");
  refuses("nm,n\n", NULL, ABBE_SCHEMA, "such as 587.6, 1.5168");
  refuses("60,1.5\n70,1.4\n", NULL, ABBE_PARSE,
          "m.csv:1: wavelengths from 60 to 70 are in no unit");
  refuses("0.4,1.5\n700,1.4\n", NULL, ABBE_PARSE, "name the column");
  refuses("nm,n\n0.5,1.5\n", NULL, ABBE_SCHEMA, "no point lies from 1 to 1e+06 nm");
  const abbe_csv_options um = {.unit_nm = 1000};
  abbe_csv_points p = parse("60,1.5\n70,1.4\n", &um, NULL);
  assert_near(p.n.point[0].lambda_nm, 60000, 1e-9);
  abbe_csv_points_free(&p);
  REFUSED(ABBE_IO, "", abbe_csv_points_load("/nowhere/x.csv", NULL, &p, NULL, &error));
}

/* The same light in every dress. */
TEST(a_lights_spectrum_is_read_by_the_same_rules) {
  const char *const dresses[] = {
      "400 1.5\n500 0\n600 2\n",
      "\xef\xbb\xbf"
      "400,1.5\r\n500,0\r\n600,2",
      "# lamp\nwavelength_nm,power\n400,1.5 # a line\n500,0\n600,2\n",
      "Wellenl\xe4nge [\xb5m];Leistung\n0,4;1,5\n0,5;0\n0,6;2,0\n",
      "lambda (nm)\tS(lambda) (W/nm)\n600\t2\n400\t1.5\n500\t0\n",
      "Spectrometer: number 7, dark 0.1\nnm,counts per nm\n400,1.5\n500,0\n600,2\n",
      "power,\xce\xbb/um\n1.5,0.4\n0,0.5\n2,0.6\n",
      "\"400\",\"1.5\"\n\"500\",\"0\"\n\"600\",\"2\"\n",
  };
  const abbe_csv_options light = {.quantity = ABBE_CSV_POWER};
  for (size_t i = 0; i < sizeof dresses / sizeof dresses[0]; i++) {
    OWNED(abbe_csv_points, p) = parse(dresses[i], &light, NULL);
    assert_int_equal(p.power.count, 3);
    assert_int_equal(p.n.count + p.k.count, 0);
    const double power[] = {1.5, 0, 2};
    for (size_t k = 0; k < 3; k++) {
      assert_near(p.power.point[k].lambda_nm, 400 + 100.0 * (double)k, 1e-9);
      assert_near(p.power.point[k].value, power[k], 0);
    }
  }
}

/* A light without one of its lines would be another light. */
TEST(a_lights_spectrum_loses_no_line) {
  const struct {
    const char *text, *part;
    abbe_result code;
  } rows[] = {
      {"", "m.csv: holds no points; a line wants a wavelength and a power, such as 380, 49.98",
       ABBE_SCHEMA},
      {"400 1\n500 x\n", "m.csv:2: this is not a number: 'x'", ABBE_PARSE},
      {"400 1\n500\n", "m.csv:2: ", ABBE_PARSE},
      {"400 1 2\n", "m.csv:1: a line wants two numbers, a wavelength and a power", ABBE_PARSE},
      {"400 1\n500 -1\n", "m.csv:2: a power is 0 or more: '-1'", ABBE_SCHEMA},
      {"400 1\n500 1e999\n", "m.csv:2: ", ABBE_PARSE},
      {"400 1\n0 1\n", "m.csv:2: a wavelength is above 0: '0'", ABBE_SCHEMA},
      {"400 1\n500 1\n500 2\n", "m.csv:3: a wavelength stands here again: '500'", ABBE_SCHEMA},
      {"400 1\n500 1\n400 2\n", "m.csv: 1 point of power at a wavelength that was there before",
       ABBE_SCHEMA},
      {"400 1\nnm power\n500 1\n", "m.csv:2: this is not a number: 'nm'", ABBE_PARSE},
      {"400 1\n2e6 1\n", "m.csv: 1 point of power outside 1 to 1e+06 nm", ABBE_SCHEMA}};
  const abbe_csv_options light = {.quantity = ABBE_CSV_POWER};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
    refuses(rows[i].text, &light, rows[i].code, rows[i].part);
}

/* One column of several, by the name that the header gives it. */
TEST(a_named_column_is_read) {
  const char *const dresses[] = {
      "wavelength_nm,dark skin,Blue Sky\n400,0.1,0.2\n500,0.3,0.4\n",
      "\xef\xbb\xbfWellenlaenge [um];Blue Sky;dark skin\r\n0,4;0,2;0,1\r\n0,5;0,4;0,3\r\n",
      "a chart\nblue sky\tx\tnm\n0.4\t9\t500\n0.2\t9\t400\n"};
  const abbe_csv_options options = {.quantity = ABBE_CSV_REFLECTANCE, .column = "blue sky"};
  for (size_t i = 0; i < sizeof dresses / sizeof *dresses; i++) {
    OWNED(abbe_csv_points, p) = parse(dresses[i], &options, NULL);
    assert_int_equal(p.power.count, 2);
    assert_near(p.power.point[0].lambda_nm, 400, 1e-9);
    assert_near(p.power.point[0].value, 0.2, 0);
    assert_near(p.power.point[1].value, 0.4, 0);
  }
  refuses("nm,a,b\n400,1,2\n", &options, ABBE_SCHEMA, "the column 'blue sky'");
  refuses("nm,blue sky\n400,-1\n", &options, ABBE_SCHEMA, "m.csv:2: a reflectance is 0 or more");
  refuses("nm,blue sky\n400,\n", &options, ABBE_SCHEMA, "m.csv:2:");
  const abbe_csv_options two = {.quantity = ABBE_CSV_REFLECTANCE};
  refuses("nm,a,b\n400,1,2\n", &two, ABBE_PARSE, "name one");
}
