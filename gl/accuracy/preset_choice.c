#include "gl/accuracy/preset.h"

#include "base/number.h"
#include "gl/accuracy/frame_times.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_asked(const abbe_preset_request *q) {
  return q->name != NULL || q->max_error > 0 || q->budget_ms > 0;
}

static abbe_result find_named(const abbe_preset_request *q, const abbe_preset_front *front,
                              size_t *point, abbe_error *error) {
  size_t i = 0;
  while (i < ABBE_PRESET_COUNT && strcmp(q->name, abbe_preset_name_text((abbe_preset_name)i)) != 0)
    i++;
  *point = i < ABBE_PRESET_COUNT ? front->named[i] : front->count;
  if (*point < front->count) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_NOT_FOUND, "there is no '%s' for scenes of the class %s in %s%s", q->name,
      abbe_preset_class_name(front->of), q->file != NULL ? q->file : "the shipped presets",
      i == ABBE_PRESET_ACCURATE ? ": no sweep of one measured settings finer than the defaults"
                                : "");
}

/* The presets of the file, and the front of them for the scene. */
static abbe_result find_front(const abbe_scene *scene, const abbe_render_desc *desc,
                              abbe_preset_choice *c, abbe_error *error) {
  abbe_plan plan;
  abbe_result result = abbe_presets_load(c->request.file, &c->presets, error);
  if (result == ABBE_OK) result = abbe_plan_make(scene, desc, &plan, error);
  if (result != ABBE_OK) return result;
  result = abbe_presets_find(&c->presets, &plan, &c->front, error);
  abbe_plan_free(&plan);
  return result;
}

abbe_result abbe_preset_choose(const abbe_preset_request *request, abbe_context *context,
                               const abbe_scene *scene, abbe_render_desc *desc,
                               abbe_preset_choice *out, abbe_error *error) {
  const abbe_preset_request *q = request;
  abbe_preset_choice c = {.request = *q, .kept = true, .timed = q->timed || q->budget_ms > 0};
  abbe_preset_speed speed = {0};
  size_t point = 0;
  *out = (abbe_preset_choice){.request = *q};
  if (!is_asked(q)) return ABBE_OK;
  if (!abbe_method_of(desc->profile)->presets)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "presets are of the default profile; a published method has none");
  abbe_result result = find_front(scene, desc, &c, error);
  if (result == ABBE_OK && q->name != NULL) result = find_named(q, c.front, &point, error);
  if (result == ABBE_OK && c.timed)
    result = abbe_preset_calibrate(context, scene, c.front, desc, &speed, error);
  if (result != ABBE_OK) {
    abbe_preset_choice_free(&c);
    return result;
  }
  if (q->budget_ms > 0)
    point = abbe_preset_for_time(c.front, &speed, q->budget_ms, &c.kept);
  else if (q->max_error > 0)
    point = abbe_preset_for_error(c.front, q->max_error, &c.kept);
  c.point = &c.front->point[point];
  c.promised_ms = abbe_preset_ms(c.point, &speed);
  c.unrest = c.timed ? speed.unrest : NAN;
  c.overridden = !abbe_preset_apply(c.point, scene, desc);
  *out = c;
  out->front = &out->presets.front[c.front - c.presets.front];
  return ABBE_OK;
}

void abbe_preset_choice_free(abbe_preset_choice *choice) {
  if (choice == NULL) return;
  abbe_presets_free(&choice->presets);
  *choice = (abbe_preset_choice){0};
}

abbe_result abbe_preset_choice_check(const abbe_preset_choice *choice, double frame_ms,
                                     abbe_error *error) {
  const abbe_preset_request *q = &choice->request;
  if (choice->point == NULL) return ABBE_OK;
  if (q->budget_ms > 0 && frame_ms > q->budget_ms) {
    char busy[120];
    abbe_frame_times_say_unrest(choice->unrest, ", and ", busy, sizeof busy);
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "the frame took %.0f ms and %.0f were promised%s: the budget of %g ms is "
                          "not kept%s; what was asked for is written all the same",
                          frame_ms, choice->promised_ms, busy, q->budget_ms,
                          choice->kept ? "" : ", for no faster settings are known");
  }
  if (q->max_error > 0 && !choice->kept)
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "no settings are known to keep an error of %g; the most accurate ones "
                          "were taken, and what was asked for is written all the same",
                          q->max_error);
  return ABBE_OK;
}

void abbe_preset_describe(const abbe_render_desc *d, char *out, size_t size) {
  const bool plain = abbe_method_of(d->profile)->presets;
  char share[ABBE_NUMBER_TEXT_SIZE], upsample[32] = "";
  if (d->upsample > 1) snprintf(upsample, sizeof upsample, ", upsample %zu", d->upsample);
  snprintf(out, size,
           "%s%s%zu wavelengths, %zu photons, map %zu, %zu samples, fill %s, %zu exits, share %s, "
           "model %s%s",
           plain ? "" : abbe_profile_name(d->profile), plain ? "" : ": ", d->wavelengths,
           d->photons, d->map_size, d->supersample, abbe_fill_name(d->fill), d->exits,
           abbe_number_text(d->energy_share, share), abbe_model_name(d->model), upsample);
}
