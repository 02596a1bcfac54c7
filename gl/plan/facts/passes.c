#include "gl/plan/facts/passes.h"

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
