#include "cli/gem/gem_stone_input.h"

#include <stdio.h>

void abbe_gem_stone_input_free(abbe_gem_stone_input *input) {
  abbe_gem_stone_free(&input->stone);
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

abbe_result abbe_gem_stone_input_load(abbe_gem_stone_input *q, abbe_error *error) {
  const abbe_illuminant d65 = {0};
  const double from = q->from_nm > 0 ? q->from_nm : ABBE_WAVELENGTH_MIN_NM;
  const double to = q->to_nm > 0 ? q->to_nm : ABBE_WAVELENGTH_MAX_NM;
  q->width_m = q->in.width_m > 0 ? q->in.width_m : ABBE_GEM_WIDTH_M;
  abbe_result result = abbe_gem_input_load(&q->in, error);
  if (result == ABBE_OK && q->in.material == NULL)
    result = abbe_error_set(error, ABBE_NOT_FOUND, "of which stone? Give --material NAME");
  if (result == ABBE_OK) result = abbe_wavelengths_make(q->count, from, to, &q->wavelengths, error);
  if (result == ABBE_OK)
    result = abbe_weights_make(&q->wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &q->weights, error);
  if (result == ABBE_OK)
    result = abbe_gem_stone_make(&q->in.cut, &q->in.stone, q->in.material, &q->wavelengths,
                                 q->width_m, &q->stone, error);
  if (result == ABBE_OK && !q->in.quiet) note_range(q, from, to);
  return result;
}
