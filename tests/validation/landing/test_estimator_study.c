/* The study of estimators: rates beside their law, errors that fall with iterations, to a texel. */
#include "tests/check.h"
#include "tests/scenes/scene_text.h"

#include "validation/landing/estimator_study.h"

static const abbe_estimator_point *find(const abbe_estimator_study *s, abbe_estimator kind,
                                        bool printed, size_t iterations) {
  for (size_t i = 0; i < s->count; i++)
    if (s->point[i].kind == kind && s->point[i].printed == printed &&
        s->point[i].iterations == iterations)
      return &s->point[i];
  fail();
  return NULL;
}

static void study(const char *text, abbe_estimator_study *out) {
  OWNED(abbe_scene, scene) = {0};
  load_text(text, &scene);
  OK(abbe_estimator_study_make(&scene, 256, 64, out, &error));
}

TEST(a_ball_over_a_floor) {
  static abbe_estimator_study s;
  study(CAMERA POINT_LIGHT FLOOR BALL("crown"), &s);
  /* a disk in a square, less what total reflection and the padding take of it */
  const double share = (double)find(&s, ABBE_ESTIMATOR_SHAH, false, 1)->rays / (64 * 64);
  assert_true(share > 0.7 && share < 0.786);
  /* measured rates are the law's */
  for (int kind = ABBE_ESTIMATOR_SHAH; kind <= ABBE_ESTIMATOR_AXIS; kind++) {
    const abbe_estimator_point *p = find(&s, (abbe_estimator)kind, false, 1);
    if (isfinite(p->rate)) assert_near(p->rate, p->law, 0.02 + 0.1 * p->law);
  }
  assert_true(isfinite(find(&s, ABBE_ESTIMATOR_SHAH, false, 1)->rate));
  for (int kind = ABBE_ESTIMATOR_SHAH; kind < ABBE_ESTIMATOR_EXACT; kind++) {
    const abbe_estimator_point *p = find(&s, (abbe_estimator)kind, false, 8);
    assert_true(p->rays > 10 && p->lookups >= 2);
    assert_true(p->median <= p->p95 && p->p95 <= p->worst);
    if (kind != ABBE_ESTIMATOR_MARCH && kind != ABBE_ESTIMATOR_BISECTION)
      assert_true(p->median < 1); /* what a texel's middle leaves */
    assert_true(p->lost < 0.05);
  }
  /* the signed ratio is there after one iteration, on a floor */
  assert_true(find(&s, ABBE_ESTIMATOR_RATIO, false, 1)->median < 1);
  assert_true(find(&s, ABBE_ESTIMATOR_BISECTION, false, 1)->median >
              find(&s, ABBE_ESTIMATOR_BISECTION, false, 8)->median);
}

TEST(both_kinds_of_light) {
  static abbe_estimator_study s;
  size_t kinds[2] = {0, 0};
  study(
      CAMERA SUN FLOOR BALL(
          "crown") "- {name: ball of silver, shape: sphere, radius: 0.05, levels: 3, mirror: 0.9, "
                   "transform: [{translate: [0.3, 0, 0.2]}]}\n",
      &s);
  for (size_t i = 0; i < s.count; i++) kinds[s.point[i].reflected]++;
  assert_true(kinds[0] > 40 && kinds[1] > 40);
}

TEST(what_cannot_be_saved) {
  static abbe_estimator_study s;
  study(CAMERA POINT_LIGHT FLOOR BALL("flat"), &s);
  REFUSED(ABBE_IO, "", abbe_estimator_study_save(&s, "/nowhere/at/all.csv", &error));
}
