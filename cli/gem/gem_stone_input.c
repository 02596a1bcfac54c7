#include "cli/gem/gem_stone_input.h"

#include "base/number.h"
#include "spectral/spectrum.h"

#include <stdio.h>
#include <string.h>

void abbe_gem_stone_input_free(abbe_gem_stone_input *input) {
  abbe_gem_stone_free(&input->stone);
  abbe_material_free(&input->own);
  abbe_weights_free(&input->weights);
  abbe_wavelengths_free(&input->wavelengths);
  abbe_gem_input_free(&input->in);
}

static void note_range(const abbe_gem_stone_input *q, double from, double to) {
  const abbe_material *m = q->in.material;
  if (!abbe_material_extrapolates(m, from) && !abbe_material_extrapolates(m, to)) return;
  fprintf(stderr, "note: the index of %s is known from %g to %g nm, and continued beyond\n",
          m->name, m->min_nm, m->max_nm);
}

/* The design's index, which does not say how it varies over wavelength. */
static abbe_result take_index(abbe_gem_stone_input *q, abbe_error *error) {
  abbe_material *own = &q->own;
  char name[64];
  if (!(q->in.n > 1))
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "of which stone? %s says no index; give --material NAME ('abbe materials "
                          "list' has them)",
                          q->in.path);
  abbe_number_format(name, sizeof name, "index %g", q->in.n);
  *own = (abbe_material){.name = strdup(name),
                         .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1},
                         .min_nm = ABBE_SPECTRUM_LOW_NM,
                         .max_nm = ABBE_SPECTRUM_HIGH_NM};
  own->dispersion.c[0] = q->in.n;
  if (own->name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  q->in.material = own;
  if (!q->in.quiet)
    fprintf(stderr,
            "note: no --material, so the design's index of %s, alike at all wavelengths: no fire\n",
            name + strlen("index "));
  return ABBE_OK;
}

abbe_result abbe_gem_stone_input_load(abbe_gem_stone_input *q, abbe_error *error) {
  const abbe_illuminant d65 = {0};
  const double from = q->from_nm > 0 ? q->from_nm : ABBE_WAVELENGTH_MIN_NM;
  const double to = q->to_nm > 0 ? q->to_nm : ABBE_WAVELENGTH_MAX_NM;
  q->width_m = q->in.width_m > 0 ? q->in.width_m : ABBE_GEM_WIDTH_M;
  abbe_result result = abbe_gem_input_load(&q->in, error);
  if (result == ABBE_OK && q->in.material == NULL) result = take_index(q, error);
  if (result == ABBE_OK) result = abbe_wavelengths_make(q->count, from, to, &q->wavelengths, error);
  if (result == ABBE_OK)
    result = abbe_weights_make(&q->wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &q->weights, error);
  if (result == ABBE_OK)
    result = abbe_gem_stone_make(&q->in.cut, &q->in.stone, q->in.material, &q->wavelengths,
                                 q->width_m, &q->stone, error);
  if (result == ABBE_OK && !q->in.quiet) note_range(q, from, to);
  return result;
}
