/* The stones of the default table: n_D, B-G and density as the records name them, and their
 * colours. It finds slips: the figures are the records' own. */
#include "tests/spectral/shipped_table.h"

#include "colorimetry/difference.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"

enum { CLEAR = -1 };

/* n_D and density: [GemTables], or the source of the record's formula. Hue: CIELAB's angle under
 * D65, in degrees, of the word that people have for the stone's colour, from the unique hues (red
 * 25, yellow 90, green 165, blue 240) and what lies between. */
static const struct {
  const char *name;
  double n_d, density, hue_from, hue_to;
} stones[] = {
    {"diamond", 2.417, 3.52, CLEAR, 0},
    {"ruby", 1.768, 4.00, 0, 45},
    {"ruby-fluorescent", 1.768, 4.00, 0, 45},
    {"diamond-fluorescent", 2.417, 3.52, CLEAR, 0},
    {"sapphire", 1.768, 4.00, CLEAR, 0},
    {"sapphire-blue", 1.768, 4.00, 240, 300},
    {"sapphire-pink", 1.768, 4.00, 330, 385},
    {"sapphire-yellow", 1.768, 4.00, 80, 110},
    {"emerald", 1.583, 2.72, 140, 180},
    {"aquamarine", 1.583, 2.72, 200, 260},
    {"tourmaline-green", 1.644, 3.06, 115, 170},
    {"tourmaline-pink", 1.644, 3.06, 335, 380},
    {"tourmaline-blue", 1.644, 3.06, 205, 270},
    {"tourmaline-paraiba", 1.644, 3.06, 180, 230},
    {"topaz", 1.613, 3.56, CLEAR, 0},
    {"topaz-blue", 1.613, 3.56, 220, 270},
    {"topaz-imperial", 1.631, 3.53, 50, 85},
    {"peridot", 1.672, 3.34, 95, 130},
    {"pyrope", 1.746, 3.78, 10, 55},
    {"almandine", 1.790, 4.05, 335, 395},
    {"spessartine", 1.810, 4.15, 45, 75},
    {"demantoid", 1.888, 3.84, 110, 165},
    {"tsavorite", 1.740, 3.61, 125, 175},
    {"spinel", 1.718, 3.60, CLEAR, 0},
    {"spinel-red", 1.718, 3.60, 0, 45},
    {"quartz", 1.544, 2.65, CLEAR, 0},
    {"amethyst", 1.544, 2.65, 295, 335},
    {"citrine", 1.544, 2.65, 75, 105},
    {"tanzanite", 1.693, 3.35, 265, 310},
    {"alexandrite", 1.743, 3.73, 140, 260},
    {"iolite", 1.547, 2.61, 225, 300},
    {"andalusite", 1.633, 3.15, 60, 110},
    {"zircon", 1.925, 4.70, CLEAR, 0},
    {"zircon-blue", 1.925, 4.70, 205, 265},
    {"sphene", 1.907, 3.52, 85, 125},
    {"moissanite", 2.648, 3.22, CLEAR, 0},
    {"cubic-zirconia", 2.158, 5.80, CLEAR, 0},
    {"yag", 1.833, 4.55, CLEAR, 0},
    {"strontium-titanate", 2.409, 5.13, CLEAR, 0},
    {"rutile", 2.616, 4.26, CLEAR, 0},
    {"f2", 1.620, 3.60, CLEAR, 0},
};
enum { COUNT = sizeof stones / sizeof stones[0] };

GROUP(shipped_load, shipped_free);

TEST(indices_and_densities_are_those_named) {
  for (size_t i = 0; i < COUNT; i++) {
    const abbe_material *m = shipped_material(stones[i].name);
    double n = 0;
    OK(abbe_material_n(m, 589.3, &n, &error));
    if (!(fabs(n - stones[i].n_d) <= 0.005))
      fail_msg("%s has n_D %g; published: %g", m->name, n, stones[i].n_d);
    assert_near(m->catalogue.density_g_cm3, stones[i].density, 0.005);
  }
}

/* No stone of the table is without figures above; they stand from ruby to strontium titanate. */
TEST(every_stone_is_held) {
  for (const abbe_material *m = shipped_material("ruby"); m < shipped_material("air"); m++) {
    size_t found = 0;
    for (size_t i = 0; i < COUNT; i++) found += strcmp(stones[i].name, m->name) == 0;
    if (found != 1) fail_msg("%s is held %zu times", m->name, found);
  }
}

/* B-G of those whose index is known by it alone. */
TEST(fire_is_the_one_that_is_named) {
  static const struct {
    const char *name;
    double b_g;
  } rows[] = {{"emerald", 0.014},   {"aquamarine", 0.014},  {"tourmaline-green", 0.017},
              {"topaz", 0.014},     {"peridot", 0.020},     {"pyrope", 0.022},
              {"almandine", 0.027}, {"spessartine", 0.027}, {"demantoid", 0.057},
              {"tsavorite", 0.028}, {"tanzanite", 0.030},   {"zircon", 0.039},
              {"sphene", 0.051},    {"diamond", 0.044},     {"sapphire", 0.018},
              {"quartz", 0.013},    {"spinel", 0.020},      {"yag", 0.028}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    double blue = 0, red = 0;
    const abbe_material *m = shipped_material(rows[i].name);
    OK(abbe_material_n(m, 430.8, &blue, &error));
    OK(abbe_material_n(m, 686.7, &red, &error));
    assert_near(blue - red, rows[i].b_g, 0.001);
  }
}

/* CIELAB of D65 through so much of the stone. */
static void colour_through(const abbe_material *m, double metres, double lab[3]) {
  const abbe_illuminant d65 = {.kind = ABBE_ILLUMINANT_D65};
  double white[3] = {0}, seen[3] = {0};
  for (double nm = 380.5; nm < 780; nm += 1) {
    double xyz[3], power = abbe_illuminant_power(&d65, nm);
    abbe_observer_xyz(nm, xyz);
    for (int k = 0; k < 3; k++) {
      white[k] += power * xyz[k];
      seen[k] += power * xyz[k] * exp(-abbe_material_attenuation(m, nm) * metres);
    }
  }
  abbe_difference_lab(seen, white, lab);
}

TEST(five_to_ten_millimetres_have_the_stones_colour) {
  for (size_t i = 0; i < COUNT; i++) {
    const abbe_material *m = shipped_material(stones[i].name);
    for (int mm = 5; mm <= 10; mm++) {
      double lab[3];
      colour_through(m, 1e-3 * mm, lab);
      const double chroma = hypot(lab[1], lab[2]);
      if (stones[i].hue_from == CLEAR) {
        if (!(chroma < 2)) fail_msg("%d mm of %s have a chroma of %g", mm, m->name, chroma);
        continue;
      }
      double hue = atan2(lab[2], lab[1]) * 180 / acos(-1);
      while (hue < stones[i].hue_from) hue += 360;
      if (!(hue <= stones[i].hue_to) || !(chroma > 5) || !(lab[0] > 15))
        fail_msg("%d mm of %s: L* %.1f, chroma %.1f, hue %.1f; wanted %g to %g", mm, m->name,
                 lab[0], chroma, fmod(hue, 360), stones[i].hue_from, stones[i].hue_to);
    }
  }
}

TEST(a_designed_colour_says_so) {
  for (size_t i = 0; i < COUNT; i++) {
    const abbe_material *m = shipped_material(stones[i].name);
    if (stones[i].hue_from != CLEAR) assert_contains(m->warning, "The absorption is designed");
  }
}
