#include "gl/plan/plan.h"

#include <string.h>

#define ABBE_NAME_OF(code, name) name,
const char *abbe_profile_name(abbe_profile profile) {
  static const char *const names[] = {ABBE_PROFILES(ABBE_NAME_OF)};
  return (int)profile >= 0 && profile < ABBE_PROFILE_COUNT ? names[profile] : "unknown";
}

bool abbe_profile_is_thesis(abbe_profile profile) {
  return profile == ABBE_PROFILE_THESIS || profile == ABBE_PROFILE_THESIS_CIE;
}

const char *abbe_fill_name(abbe_fill fill) {
  static const char *const names[] = {ABBE_FILLS(ABBE_NAME_OF)};
  return (int)fill >= 0 && fill < ABBE_FILL_COUNT ? names[fill] : "unknown";
}

const char *abbe_model_name(abbe_model model) {
  static const char *const names[] = {ABBE_MODELS(ABBE_NAME_OF)};
  return (int)model >= 0 && model < ABBE_MODEL_COUNT ? names[model] : "unknown";
}
#undef ABBE_NAME_OF

const char *abbe_refractor_model_name(abbe_refractor_model model) {
  return model == ABBE_REFRACTOR_SPHERE   ? "exact sphere"
         : model == ABBE_REFRACTOR_CONVEX ? "convex planes"
         : model == ABBE_REFRACTOR_LAYERS ? "front and back layers"
                                          : "triangle hierarchy";
}

const char *abbe_receiver_model_name(abbe_receiver_model model) {
  return model == ABBE_RECEIVER_EXACT       ? "exact parallelograms"
         : model == ABBE_RECEIVER_HIERARCHY ? "triangle hierarchy"
                                            : "iterated image space";
}

const abbe_plan_entry *abbe_plan_find(const abbe_plan *plan, const char *name) {
  for (size_t i = 0; i < plan->entry_count; i++)
    if (strcmp(plan->entry[i].name, name) == 0) return &plan->entry[i];
  return NULL;
}
