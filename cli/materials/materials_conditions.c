#include "cli/materials/materials.h"

#include "spectral/materials/material_numbers.h"

#include <math.h>
#include <stdio.h>

/* The conditions of the index that is shown: where it was measured, or what was requested. */
static abbe_conditions conditions_of(const abbe_material *m) {
  const abbe_index_shift *s = &m->dispersion.shift;
  return s->on ? (abbe_conditions){s->to_c, s->pressure_atm}
               : (abbe_conditions){m->temperature_c, 1};
}

void abbe_materials_print_conditions(const abbe_material *material) {
  const abbe_material *m = material;
  const abbe_conditions at = conditions_of(m);
  double gain[2], n_d = NAN;
  char text[32];
  if (!isnan(m->temperature_c)) printf("  temperature   %g C\n", m->temperature_c);
  if (abbe_material_is_conductor(m)) return;
  if (m->n_absolute) printf("  index         relative to vacuum\n");
  if (m->dispersion.shift.on) {
    abbe_material_n_absolute(m, ABBE_LINE_D_NM, &n_d, NULL);
    printf("  shown         at %g C in air of %g atm; n_d %s relative to vacuum\n",
           at.temperature_c, at.pressure_atm,
           abbe_materials_number(text, sizeof text, "%.6f", n_d));
  }
  abbe_material_dn_dt(m, ABBE_LINE_E_NM, at.temperature_c, gain);
  if (isnan(gain[0]))
    printf("  dn/dT         not given\n");
  else
    printf("  dn/dT         %.1f relative to air, %.1f to vacuum, 1e-6/K at e and %g C\n",
           1e6 * gain[0], 1e6 * gain[1], at.temperature_c);
}

void abbe_materials_add_conditions(cJSON *to, const abbe_material *material) {
  const abbe_conditions at = conditions_of(material);
  double gain[2];
  cJSON_AddBoolToObject(to, "n_absolute", material->n_absolute);
  cJSON *item = cJSON_AddObjectToObject(to, "shown_at");
  cJSON_AddNumberToObject(item, "temperature_c", at.temperature_c);
  cJSON_AddNumberToObject(item, "pressure_atm", at.pressure_atm);
  abbe_material_dn_dt(material, ABBE_LINE_E_NM, at.temperature_c, gain);
  cJSON_AddNumberToObject(to, "dn_dt_e_relative_per_k", gain[0]);
  cJSON_AddNumberToObject(to, "dn_dt_e_absolute_per_k", gain[1]);
}
