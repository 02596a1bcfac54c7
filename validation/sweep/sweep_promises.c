#include "validation/sweep/sweep_promises.h"

#include "library/choice/sweep_setting.h"

#include <math.h>
#include <string.h>

static const double least_ms = 0.01; /* a part too short to measure a speed by */

static const abbe_preset_front *find_front(const abbe_presets *presets, const char *of) {
  for (size_t i = 0; i < presets->count; i++)
    if (strcmp(abbe_preset_class_name(presets->front[i].of), of) == 0) return &presets->front[i];
  return NULL;
}

static const abbe_sweep_row *find_point(const abbe_sweep_table *table, const abbe_preset_point *p) {
  abbe_sweep_setting setting;
  abbe_sweep_setting_of(&p->desc, &setting);
  return abbe_sweep_table_find(table, &setting);
}

static const char *preset_of(const abbe_preset_front *front, size_t point) {
  for (int i = 0; i < ABBE_PRESET_COUNT; i++)
    if (front->named[i] == point) return abbe_preset_name_text((abbe_preset_name)i);
  return "";
}

abbe_result abbe_sweep_promises_make(const abbe_sweep_table *table, const char *presets,
                                     abbe_sweep_promises *out, abbe_error *error) {
  out->front = NULL;
  out->count = 0;
  abbe_result result = abbe_presets_load(presets, &out->presets, error);
  if (result != ABBE_OK) return result;
  const abbe_preset_front *front = find_front(&out->presets, table->fact[ABBE_SWEEP_FACT_CLASS]);
  const abbe_sweep_row *first = front != NULL ? find_point(table, &front->point[0]) : NULL;
  const abbe_sweep_number number = abbe_sweep_number_find(out->presets.error);
  if (first == NULL || number == ABBE_SWEEP_NUMBER_COUNT) return ABBE_OK;
  const abbe_preset_point *cheapest = &front->point[0];
  const abbe_preset_speed speed = {
      .light = first->number[ABBE_SWEEP_LIGHT_MS] / fmax(cheapest->light_ms, least_ms),
      .eye = first->number[ABBE_SWEEP_EYE_MS] / fmax(cheapest->eye_ms, least_ms)};
  out->front = front;
  for (size_t i = 0; i < front->count; i++) {
    const abbe_sweep_row *row = find_point(table, &front->point[i]);
    if (row == NULL) continue;
    out->promise[out->count++] =
        (abbe_sweep_promise){.preset = preset_of(front, i),
                             .row = row,
                             .error = front->point[i].error,
                             .ms = abbe_preset_ms(&front->point[i], &speed),
                             .error_met = row->number[number],
                             .ms_met = row->number[ABBE_SWEEP_FRAME_MS]};
  }
  return ABBE_OK;
}

void abbe_sweep_promises_free(abbe_sweep_promises *promises) {
  if (promises == NULL) return;
  abbe_presets_free(&promises->presets);
  promises->front = NULL;
  promises->count = 0;
}
