/* gem_stones.h: stones for the tests of what stones are judged by. */
#ifndef ABBE_TESTS_VALIDATION_MEASURE_GEM_GEM_STONES_H
#define ABBE_TESTS_VALIDATION_MEASURE_GEM_GEM_STONES_H

#include "tests/scenes/cuts/designs.h"

#include "spectral/formats/material_import.h"
#include "validation/measure/gem/gem_optimum.h"
#include "validation/measure/gem/gem_view.h"

#define GIRDLE_OF_FOUR "a -90 1.0 96 24 48 72\n"
/* A square plate twice as wide as thick. */
static const char slab[] = "GemCad 5.0\ng 96 0.0\n" GIRDLE_OF_FOUR "a 0 0.5 96\na -0 0.5 96\n";

/* A roof of that slope under a table: its ridge runs along x. */
static inline void roof_text(double slope_deg, char text[256]) {
  snprintf(text, 256, "GemCad 5.0\ng 96 0.0\na -90 1.0 24 72\na -%.9f 0.7 96 48\na 0 0.1 96\n",
           slope_deg);
}

typedef struct judged {
  abbe_cut cut;
  abbe_cut_polyhedron polyhedron;
  abbe_wavelengths wavelengths;
  abbe_weights weights;
  abbe_gem_stone stone;
} judged;

static inline judged judged_make(const char *text, const abbe_material *material, size_t count) {
  judged j;
  abbe_illuminant d65 = {0};
  j.cut = design_parse(text);
  OK(abbe_cut_polyhedron_make(&j.cut, 0, &j.polyhedron, &error));
  OK(abbe_wavelengths_make(count, 400, 700, &j.wavelengths, &error));
  OK(abbe_weights_make(&j.wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &j.weights, &error));
  OK(abbe_gem_stone_make(&j.cut, &j.polyhedron, material, &j.wavelengths, 0.01, &j.stone, &error));
  return j;
}

/* Of one index, at one wavelength. */
static inline judged judged_plain(const char *text, double n) {
  static char name[] = "plain";
  const abbe_material m =
      FIELDS(.name = name, .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {n}},
             .min_nm = 300, .max_nm = 800);
  return judged_make(text, &m, 1);
}

static inline void judged_free(judged *j) {
  abbe_gem_stone_free(&j->stone);
  abbe_weights_free(&j->weights);
  abbe_wavelengths_free(&j->wavelengths);
  abbe_cut_polyhedron_free(&j->polyhedron);
  abbe_cut_free(&j->cut);
}

static inline abbe_gem_view judged_view(const judged *j, const abbe_gem_view_desc *desc) {
  abbe_gem_view view;
  OK(abbe_gem_view_make(&j->stone, &j->weights, desc, &view, &error));
  return view;
}

#define DEG (3.14159265358979323846 / 180)

/* A search of 3 x 4 pairs of angles, by few rays. */
static inline abbe_gem_optimum_desc small_search(void) {
  return (abbe_gem_optimum_desc){.crown_from_rad = 30 * DEG,
                                 .crown_to_rad = 40 * DEG,
                                 .pavilion_from_rad = 35 * DEG,
                                 .pavilion_to_rad = 46 * DEG,
                                 .crowns = 3,
                                 .pavilions = 4,
                                 .measure = ABBE_GEM_ISO,
                                 .width_m = 0.0065,
                                 .view = {.side = 16, .repeats = 4, .threads = 1}};
}

/* Of one index, without absorption. */
static inline abbe_material glass(double n) {
  static char name[] = "plain";
  return (abbe_material){.name = name,
                         .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {n}},
                         .min_nm = 300,
                         .max_nm = 800};
}

/* A clear crystal of those three indices; of two where the first two are alike. */
static inline abbe_material crystal(double alpha, double beta, double gamma) {
  abbe_material m = glass(beta);
  abbe_dispersion *outer[] = {alpha == beta ? NULL : &m.outer[0],
                              alpha == beta ? &m.extraordinary : &m.outer[1]};
  const double n[] = {alpha, gamma};
  for (int i = 0; i < 2; i++)
    if (outer[i] != NULL)
      *outer[i] = (abbe_dispersion){.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {n[i]}};
  return m;
}

#endif
