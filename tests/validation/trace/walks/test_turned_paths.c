/* Rough faces and haze in refractors: every watt is in the ledger. */
#include "tests/validation/trace/walks/light_walks.h"

#define SCENE "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR

static const char *const bodies[] = {
    "n-bk7, roughness: 0.3",
    "calcite, axis: [1, 0.3, 0.5], roughness: [{alpha: 1, faces: pavilion}]",
    "n-bk7, coating: {layers: [[1.38, 99.6]]}, roughness: 0.5",
    "n-bk7, medium: {scattering: 12, g: 0.5}",
    "calcite, axis: [1, 0.3, 0.5], medium: {scattering: [[400, 20], [700, 10]], g: -0.4}",
    "n-bk7, roughness: 0.2, medium: {scattering: 5}, clouds: [{centre: [0, 0, 0], radius: 0.03, "
    "medium: {scattering: 40, g: 0.9}}, {centre: [0.08, 0.05, 0], size: [0.05, 0.1, 0.04]}]",
};
enum { BODIES = sizeof bodies / sizeof *bodies };

static void count_known(void *user, const abbe_light_stretch *stretch) {
  size_t *count = user;
  count[stretch->known]++;
}

TEST(every_watt_is_in_the_ledger) {
  for (int i = 0; i < BODIES; i++) {
    FREED fixture *f = malloc(sizeof *f);
    make(printed(SCENE SLAB("%s"), bodies[i]), NULL, f);
    size_t count[2] = {0};
    abbe_light_walk_watch(f->walk, count_known, count);
    flood(f, 8);
    const abbe_light_ledger *l = &f->ledger;
    assert_near(l->deposited + l->absorbed + l->missed + l->lost, l->reached, 1e-5 * l->reached);
    assert_true(l->lost <= 1e-3 * l->reached);
    assert_true(l->scattered == 0);
    if (i == 1) /* all but what the table mirrors */
      assert_true(l->frosted > 0.9 * l->reached && l->frosted < 0.97 * l->reached);
    else if (i < 3)
      assert_near(l->frosted, l->reached, 1e-6 * l->reached);
    assert_true(i < 3 ? l->turned == 0 : l->turned > 0.2 * l->reached);
    /* all that comes in by a rough face is known from there on, else what haze has turned */
    assert_true((count[0] > 0) == (i == 1 || i == 3 || i == 4));
    assert_true((count[1] > 0) == (i != 1));
    assert_true(l->turned <= l->reached && l->frosted <= l->reached);
    fixture_free(f);
  }
}
