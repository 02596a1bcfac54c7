/* Stones in company, by every transport, at every stage of the viewer: the hue and the light of
 * each picture are those of a trace. A covering array holds every pair of these. */
#include "tests/gl/gl_context.h"

#include "tests/pairs/pair_judge.h"

static const struct {
  cover_row row;
  const char *words;
  bool is;
} noted[] = {
    {{{0, 0, 1, 1}}, "layers show few of them", false},
    {{{1, 0, 1, 1}}, "ruby: double refraction by 0.0081", true},
};

static void name_of(const cover_row *row, char *out, size_t size) {
  snprintf(out, size, "%s, %s, %s, %s", pair_level_name(PAIR_STONE, row->level[PAIR_STONE]),
           pair_level_name(PAIR_COMPANY, row->level[PAIR_COMPANY]),
           pair_level_name(PAIR_TRANSPORT, row->level[PAIR_TRANSPORT]),
           pair_level_name(PAIR_STAGE, row->level[PAIR_STAGE]));
}

GROUP(make_context, free_context);

TEST(few_cases_hold_all_pairs) {
  cover_row row[COVER_MOST];
  size_t pairs, missing;
  const size_t count = cover_make(pair_levels, pair_can, row);
  cover_count(pair_levels, pair_can, row, count, &pairs, &missing);
  /* Of 3, 6, 4 and 3 levels there are 93 pairs. */
  assert_int_equal(pairs, 93 - pair_refusal_count);
  assert_int_equal(missing, 0);
  assert_int_in_range(count, 18, COVER_MOST);
  for (size_t i = 0; i < count; i++) assert_true(pair_can(&row[i]));
  /* Each row holds what none before it does. */
  cover_count(pair_levels, pair_can, row, count - 1, &pairs, &missing);
  assert_true(missing > 0);
}

/* What no row holds is refused in words; nothing else is. */
TEST(what_cannot_be_is_refused_by_name) {
  for (size_t company = 0; company < PAIR_COMPANIES; company++)
    for (size_t transport = 0; transport < PAIR_TRANSPORTS; transport++) {
      const cover_row row = {{0, company, transport, 1}};
      const char *words = NULL;
      char name[128];
      abbe_error error = {0};
      name_of(&row, name, sizeof name);
      for (size_t i = 0; i < pair_refusal_count; i++)
        if (pair_refusals[i].company == company && pair_refusals[i].transport == transport)
          words = pair_refusals[i].words;
      OWNED(abbe_plan, plan) = {0};
      const abbe_result result = pair_plan(&row, &plan, &error);
      if ((words == NULL) != (result == ABBE_OK))
        print_error("%s: %s\n", name, result == ABBE_OK ? "is not refused" : error.text);
      assert_int_equal(result, words == NULL ? ABBE_OK : ABBE_UNSUPPORTED);
      if (words != NULL) assert_contains(error.text, words);
    }
}

/* What differs from traces for a reason is said where it is asked for. */
TEST(what_is_known_is_noted) {
  for (size_t i = 0; i < sizeof noted / sizeof *noted; i++) {
    OWNED(abbe_plan, plan) = {0};
    bool found = false;
    OK(pair_plan(&noted[i].row, &plan, &error));
    for (size_t k = 0; k < plan.note_count; k++)
      found = found || strstr(plan.note[k], noted[i].words) != NULL;
    assert_int_equal(found, noted[i].is);
  }
}

static bool expect(const cover_row *row, size_t region, const char *what, bool right,
                   const pair_verdict *v) {
  char name[128];
  name_of(row, name, sizeof name);
  if (!right)
    print_message(
        "%s: %s of the %s is wrong: hue off by %.2f %s (bound %.2f), light %.4f (bound %.3f)\n",
        name, what, pair_region_name[region], v->hue, v->saturated ? "nm" : "CIEDE2000",
        v->hue_bound, v->light, v->light_bound);
  return right;
}

static bool is_as_traced(const cover_row *row) {
  pair_light traced, drawn;
  abbe_error error = {0};
  bool right = true;
  if (pair_judge_read(row->level[PAIR_STONE], row->level[PAIR_COMPANY], &traced, &error) !=
          ABBE_OK ||
      pair_draw(context, row, &drawn, &error) != ABBE_OK) {
    print_error("%s\n", error.text);
    return false;
  }
  for (size_t region = 0; region < PAIR_REGIONS; region++) {
    pair_verdict v;
    pair_judge(row, region, &traced, &drawn, &v);
    right = expect(row, region, "hue", pair_verdict_hue(&v), &v) && right;
    right = expect(row, region, "light", pair_verdict_light(&v), &v) && right;
  }
  return right;
}

/* Eight hold half of the pairs: each of the first holds six that no earlier one does. */
TEST(pictures_are_as_traced) {
  cover_row row[COVER_MOST];
  size_t wrong = 0;
  const size_t count = cover_make(pair_levels, pair_can, row);
  for (size_t i = 0; i < (all_cases() ? count : 8); i++) wrong += !is_as_traced(&row[i]);
  assert_int_equal(wrong, 0);
}
