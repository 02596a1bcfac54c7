#include "scenes/coating/coating.h"

#include "spectral/materials/absorption.h"

#include <stdlib.h>

void abbe_coatings_free(abbe_coatings *c) {
  if (c == NULL) return;
  for (size_t i = 0; i < c->count; i++) {
    abbe_coating *coating = &c->coating[i];
    for (size_t k = 0; k < coating->count; k++) {
      abbe_spectrum_free(coating->layer[k].n);
      abbe_spectrum_free(coating->layer[k].k);
    }
    free(coating->path);
    free(coating->faces);
  }
  free(c->face);
  free(c);
}

const abbe_coating *abbe_coatings_on(const abbe_coatings *c, size_t face) {
  if (c == NULL) return NULL;
  const size_t number = c->face == NULL ? 1 : c->face[face];
  return number == 0 ? NULL : &c->coating[number - 1];
}

static abbe_result layer_at(const abbe_coating_layer *l, double lambda_nm, abbe_film_layer *out,
                            abbe_error *error) {
  *out = (abbe_film_layer){l->index[0], l->index[1], l->nm};
  if (l->n != NULL) {
    out->n = abbe_spectrum_at(l->n, lambda_nm);
    out->k = abbe_spectrum_at(l->k, lambda_nm);
  }
  if (l->material == NULL) return ABBE_OK;
  if (abbe_material_is_conductor(l->material))
    return abbe_material_nk(l->material, lambda_nm, &out->n, &out->k, error);
  out->k = abbe_absorption_k(abbe_material_attenuation(l->material, lambda_nm), lambda_nm);
  return abbe_material_n(l->material, lambda_nm, &out->n, error);
}

abbe_result abbe_coating_at(const abbe_coating *coating, double lambda_nm,
                            abbe_film_layer layer[ABBE_FILM_MOST_LAYERS], abbe_error *error) {
  for (size_t i = 0; i < coating->count; i++) {
    ABBE_TRY(layer_at(&coating->layer[i], lambda_nm, &layer[i], error));
  }
  return ABBE_OK;
}

abbe_result abbe_coating_straight(const abbe_coating *coating, double n, bool inside,
                                  double lambda_nm, double *reflected, double *transmitted,
                                  abbe_error *error) {
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_film_light light;
  ABBE_TRY(abbe_coating_at(coating, lambda_nm, layer, error));
  const double to[2] = {inside ? 1 : n, 0};
  abbe_film_light_at(layer, coating->count, inside, inside ? n : 1, to, 1, lambda_nm, &light);
  abbe_film_unpolarised(&light, reflected, transmitted);
  return ABBE_OK;
}

abbe_result abbe_coating_add(abbe_coating *coating, const abbe_coating_layer *layer,
                             abbe_error *error) {
  const abbe_material *m = layer->material;
  if (coating->count == ABBE_FILM_MOST_LAYERS)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "a coating has at most %d layers",
                          ABBE_FILM_MOST_LAYERS);
  if (m != NULL && abbe_material_is_crystal(m))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the material '%s' is a crystal, and layers have one index in all "
                          "directions: give the layer's index as a number",
                          m->name);
  if (!(layer->nm >= 0 && layer->nm <= ABBE_FILM_MOST_NM))
    return abbe_error_set(error, ABBE_SCHEMA,
                          "a layer is %g nm thick; it is to be from 0 to %d nm: light that crosses "
                          "more does not interfere",
                          layer->nm, ABBE_FILM_MOST_NM);
  coating->layer[coating->count++] = *layer;
  return ABBE_OK;
}
