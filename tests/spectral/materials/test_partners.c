#include "tests/spectral/shipped_table.h"

#include "spectral/materials/partners.h"

#include <math.h>
#include <string.h>

#define GLASS(name, coefficients)                                                                  \
  "- {name: " name ", model: sellmeier2, range_nm: [300, 2500], source: Schott's data sheet,\n"    \
  "   coefficients: [0, " coefficients "]}\n"

static const char text[] = "materials:\n" GLASS(
    "n-bk7", "1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653")
    GLASS("bk7", "1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653")
        GLASS("n-sf5", "1.52481889, 0.011254756, 0.187085527, 0.0588995392, 1.42729015, 129.141675")
            GLASS("f2",
                  "1.34533359, 0.00997743871, 0.209073176, 0.0470450767, 0.937357162, 111.886764")
                GLASS("f2-again", "1.34533359, 0.00997743871, 0.209073176, 0.0470450767, "
                                  "0.937357162, 111.886764")
                    GLASS("n-fk51a", "0.971247817, 0.00472301995, 0.216901417, 0.0153575612, "
                                     "0.904651666, 168.68133") GLASS(
                        "n-kzfs11",
                        "1.3322245, 0.0084029848, 0.28924161, 0.034423972, 1.15161734, 88.4310532")
                        GLASS("n-sf6",
                              "1.77931763, 0.0133714182, 0.338149866, 0.0617533621, 2.08734474, "
                              "174.01759") "- {name: plain, model: constant, coefficients: [1.5], "
                                           "source: made up}\n"
                                           "- {name: two-terms, model: cauchy, coefficients: [1.5, "
                                           "0.004], range_nm: [300, 900], source: made up}\n";

static abbe_material_table table;

static void load(void) {
  OK(abbe_material_table_parse(text, strlen(text), "glasses", &table, &error));
}

static void unload(void) {
  abbe_material_table_free(&table);
}

GROUP(load, unload);

static abbe_glass_partner partner_of(const char *name, const char *partner, const char *third) {
  const abbe_material *with = third != NULL ? find_material(&table, third) : NULL;
  MADE(abbe_glass_partners, p,
       abbe_glass_partners_find(&table, find_material(&table, name), with, 100, &p, &error));
  abbe_glass_partner found = {0};
  for (size_t i = 0; i < p.count; i++)
    if (strcmp(p.partner[i].material->name, partner) == 0) found = p.partner[i];
  assert_non_null(found.material);
  return found;
}

TEST(pairs_have_their_powers_and_secondary_spectra) {
  const struct {
    const char *name, *partner;
    double power[2], f_mm[2], secondary_mm;
  } known[] = {{"n-bk7", "n-sf5", {2.010498, -1.010498}, {49.7389, -98.9611}, 0.199340},
               {"n-bk7", "f2", {2.308107, -1.308107}, {43.3255, -76.4463}, 0.172628},
               {"n-fk51a", "n-kzfs11", {2.008378, -1.008378}, {49.7914, -99.1692}, 0.058574}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const abbe_glass_partner p = partner_of(known[i].name, known[i].partner, NULL);
    for (int k = 0; k < 2; k++) {
      assert_near(p.power[k], known[i].power[k], 5e-7);
      assert_near(100 / p.power[k], known[i].f_mm[k], 5e-5);
    }
    assert_near(p.power[2], 0, 0);
    assert_near(p.power_sum, known[i].power[0] - known[i].power[1], 1e-6);
    assert_near(100 * p.secondary, known[i].secondary_mm, 5e-7);
  }
}

TEST(a_triplet_has_f_c_and_g_in_one_focus) {
  const abbe_glass_partner p = partner_of("n-bk7", "n-kzfs11", "n-sf6");
  const double known[3] = {4.629327, -4.476604, 0.847278};
  for (int i = 0; i < 3; i++) assert_near(p.power[i], known[i], 5e-7);
  const double dispersion[][3] = {
      {0.534930, -0.000940, 0}, {0.560514, -0.011952, 0}, {0.615757, 0.014613, 0}};
  const char *const names[3] = {"n-bk7", "n-kzfs11", "n-sf6"};
  double sums[3] = {0};
  for (int i = 0; i < 3; i++) {
    abbe_material_numbers n;
    abbe_material_numbers_make(find_material(&table, names[i]), &n);
    assert_near(n.p_gF, dispersion[i][0], 5e-7);
    assert_near(n.dp_gF, dispersion[i][1], 5e-7);
    sums[0] += p.power[i];
    sums[1] += p.power[i] * (n.n_F - n.n_C) / (n.n_d - 1);
    sums[2] += p.power[i] * (n.n_g - n.n_F) / (n.n_d - 1);
  }
  assert_near(sums[0], 1, 1e-12);
  assert_near(sums[1], 0, 1e-12);
  assert_near(sums[2], 0, 1e-12);
}

TEST(partners_are_ranked_and_a_glass_of_two_names_stands_once) {
  abbe_glass_partners p;
  OK(abbe_glass_partners_find(&table, find_material(&table, "n-bk7"), NULL, 12, &p, &error));
  assert_int_equal(p.skipped, 2); /* the last two; bk7 would need endless powers */
  assert_int_equal(p.count, 5);
  for (size_t i = 0; i < p.count; i++) {
    assert_int_equal(p.partner[i].doubles,
                     strcmp(p.partner[i].material->name, "f2") == 0 ||
                         strcmp(p.partner[i].material->name, "f2-again") == 0);
    assert_true(p.partner[i].power_sum <= 12);
    if (i > 0) assert_true(fabs(p.partner[i - 1].secondary) <= fabs(p.partner[i].secondary));
  }
  abbe_glass_partners_free(&p);
  REFUSED(ABBE_OUT_OF_RANGE, "plain has no single index with a V_d and a P_gF",
          abbe_glass_partners_find(&table, find_material(&table, "plain"), NULL, 12, &p, &error));
}

/* A glass with itself leaves no condition to fulfil. */
TEST(a_triplet_takes_three_glasses) {
  abbe_glass_partners p;
  const abbe_material *glass = find_material(&table, "n-bk7");
  REFUSED(ABBE_INVALID_ARGUMENT, "n-bk7 and n-bk7 are one glass",
          abbe_glass_partners_find(&table, glass, glass, 12, &p, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "n-bk7 and bk7 are one glass",
          abbe_glass_partners_find(&table, glass, find_material(&table, "bk7"), 12, &p, &error));
}

/* Of two names of one glass that which is for sale is shown, whichever comes first. */
TEST(a_double_that_is_for_sale_stands_for_both) {
  char standard[] = "standard", obsolete[] = "Obsolete";
  for (int sold = 0; sold < 2; sold++) {
    abbe_material f2[2] = {*find_material(&table, "f2"), *find_material(&table, "f2-again")};
    for (int i = 0; i < 2; i++) f2[i].catalogue.status = i == sold ? standard : obsolete;
    const abbe_material_table two = {.material = f2, .count = 2};
    MADE(abbe_glass_partners, p,
         abbe_glass_partners_find(&two, find_material(&table, "n-bk7"), NULL, 12, &p, &error));
    assert_int_equal(p.count, 1);
    assert_int_equal(p.partner[0].doubles, 1);
    assert_string_equal(p.partner[0].material->name, f2[sold].name);
  }
}
