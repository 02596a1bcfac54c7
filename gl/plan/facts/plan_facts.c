#include "gl/plan/facts/plan_facts.h"

#include "base/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *abbe_refractor_model_name(abbe_refractor_model model) {
  return model == ABBE_REFRACTOR_SPHERE   ? "exact sphere"
         : model == ABBE_REFRACTOR_CONVEX ? "convex planes"
         : model == ABBE_REFRACTOR_LAYERS ? "front and back layers"
                                          : "triangle hierarchy";
}

const char *abbe_receiver_model_name(abbe_receiver_model model) {
  return model == ABBE_RECEIVER_EXACT ? "exact parallelograms"
         : model == ABBE_RECEIVER_BVH ? "triangle hierarchy"
                                      : "iterated image space";
}

const char *abbe_plan_no_refraction(const abbe_plan *plan) {
  return plan->caustics || plan->camera_sees_refractor ? NULL
         : plan->refractor_count == 0                  ? "nothing refracts"
                                      : "neither a light nor the eye meets a refractor";
}

double abbe_plan_haze_edge(const abbe_render_desc *desc, int k) {
  return desc->min_nm + (desc->max_nm - desc->min_nm) * k / ABBE_PLAN_HAZE_BANDS;
}

size_t abbe_plan_surfaces(const abbe_plan *plan) {
  return plan->refractor_count * (plan->pleochroic ? 4 : 1);
}

size_t abbe_plan_least_wavelengths(const abbe_plan *plan) {
  /* What lies between these is followed from the interface where light leaves
   * (outgoing_segment.glsl). */
  static const size_t coarse = 4;
  const size_t n = plan->desc.wavelengths;
  /* Hits do not know what the air or films change between two wavelengths. */
  const bool apart = plan->fills && !abbe_method_of(plan->desc.profile)->own_passes;
  return apart && !plan->tinted_air && !plan->filmed && plan->lines == 0 && n > coarse ? coarse : n;
}

static bool has_lamp(const abbe_plan *p) {
  return abbe_method_of(p->desc.profile)->lamp;
}

static bool has_pinholes(const abbe_plan *p) {
  return p->desc.transport == ABBE_TRANSPORT_PINHOLE;
}

/* Its photons are the pixels of what the light sees. */
static bool is_gridded(const abbe_plan *p) {
  return abbe_method_of(p->desc.profile)->estimates;
}

static bool refracts(const abbe_plan *p, size_t object) {
  for (size_t k = 0; k < p->refractor_count; k++)
    if (p->refractor_object[k] == object) return true;
  return false;
}

static bool mirrors(const abbe_plan *p, size_t object) {
  for (size_t k = 0; k < p->refractor_count; k++)
    if (p->refractor_object[k] == object) return p->mirror[k];
  return false;
}

bool abbe_plan_runs(const abbe_plan *p, abbe_plan_item item, size_t i) {
  switch (item) {
#define PASS_CASE(id, stage, text, condition)                                                      \
  case ABBE_PASS_##id:                                                                             \
    return condition;
#define CHOICE_CASE(id, text, condition)                                                           \
  case ABBE_CHOICE_##id:                                                                           \
    return condition;
    ABBE_PASSES(PASS_CASE)
    ABBE_PLAN_CHOICES(CHOICE_CASE)
  default:
    return false;
  }
}

static void add_entry(abbe_plan *plan, abbe_plan_item item, size_t index, const char *name,
                      const char *reason, va_list args) {
  if (plan->entry_count == ABBE_PLAN_MAX_ENTRIES) return;
  abbe_plan_entry *entry = &plan->entry[plan->entry_count++];
  *entry = (abbe_plan_entry){
      .item = item, .index = (unsigned)index, .runs = abbe_plan_runs(plan, item, index)};
  snprintf(entry->name, sizeof entry->name, "%s%.50s", abbe_plan_item_text(item), name);
  abbe_number_format_list(entry->reason, sizeof entry->reason, reason, args);
}

void abbe_plan_add(abbe_plan *plan, abbe_plan_item item, const char *reason, ...) {
  va_list args;
  va_start(args, reason);
  add_entry(plan, item, 0, "", reason, args);
  va_end(args);
}

void abbe_plan_add_about(abbe_plan *plan, abbe_plan_item item, size_t index, const char *name,
                         const char *reason, ...) {
  va_list args;
  va_start(args, reason);
  add_entry(plan, item, index, name, reason, args);
  va_end(args);
}

void abbe_plan_note(abbe_plan *plan, const char *format, ...) {
  char(*more)[256] = realloc(plan->note, (plan->note_count + 1) * sizeof *more);
  if (more == NULL) {
    plan->note_lost = true;
    return;
  }
  plan->note = more;
  va_list args;
  va_start(args, format);
  abbe_number_format_list(more[plan->note_count++], sizeof *more, format, args);
  va_end(args);
}

const abbe_plan_entry *abbe_plan_find(const abbe_plan *plan, abbe_plan_item item, size_t index) {
  for (size_t i = 0; i < plan->entry_count; i++)
    if (plan->entry[i].item == item && plan->entry[i].index == index) return &plan->entry[i];
  return NULL;
}

void abbe_plan_free(abbe_plan *plan) {
  if (plan == NULL) return;
  free(plan->refractor_object);
  free(plan->receiver_object);
  free(plan->receiver_model);
  free(plan->model);
  free(plan->mirror);
  free(plan->note);
  memset(plan, 0, sizeof *plan);
}

const char *abbe_plan_item_text(abbe_plan_item item) {
#define PASS_TEXT(id, stage, text, condition) text,
#define CHOICE_TEXT(id, text, condition) text,
  static const char *const texts[] = {ABBE_PASSES(PASS_TEXT) ABBE_PLAN_CHOICES(CHOICE_TEXT)};
  return (int)item >= 0 && item < ABBE_PLAN_ITEM_COUNT ? texts[item] : "unknown";
}

abbe_pass_stage abbe_pass_stage_of(abbe_pass pass) {
#define PASS_STAGE(id, stage, text, condition) ABBE_STAGE_##stage,
  static const abbe_pass_stage stages[] = {ABBE_PASSES(PASS_STAGE)};
  return (int)pass >= 0 && pass < ABBE_PASS_COUNT ? stages[pass] : ABBE_STAGE_LIGHT;
}
