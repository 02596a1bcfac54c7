#include "validation/gem/gem_light.h"

#include <math.h>

static const char *const names[] = {
#define ABBE_GEM_AMOUNT_NAME(code, name, text) name,
    ABBE_GEM_AMOUNTS(ABBE_GEM_AMOUNT_NAME)
#undef ABBE_GEM_AMOUNT_NAME
};
static const char *const texts[] = {
#define ABBE_GEM_AMOUNT_TEXT(code, name, text) text,
    ABBE_GEM_AMOUNTS(ABBE_GEM_AMOUNT_TEXT)
#undef ABBE_GEM_AMOUNT_TEXT
};

const char *abbe_gem_amount_name(abbe_gem_amount amount) {
  return (unsigned)amount < ABBE_GEM_AMOUNT_COUNT ? names[amount] : "unknown";
}

const char *abbe_gem_amount_text(abbe_gem_amount amount) {
  return (unsigned)amount < ABBE_GEM_AMOUNT_COUNT ? texts[amount] : "unknown";
}

abbe_gem_light abbe_gem_light_make(const double eye[3], double head_rad) {
  abbe_gem_light light;
  for (int k = 0; k < 3; k++) light.eye[k] = (float)eye[k];
  /* beyond any cosine where there is no head */
  light.cos_head = head_rad > 0 ? (float)cos(head_rad) : 2;
  return light;
}

void abbe_gem_light_judge(const abbe_gem_light *light, const abbe_gem_path *path,
                          float amount[ABBE_GEM_AMOUNT_COUNT]) {
  for (int k = 0; k < ABBE_GEM_AMOUNT_COUNT; k++) amount[k] = 0;
  for (size_t i = 0; i < path->count; i++) {
    const abbe_gem_exit *e = &path->exit[i];
    const float up = e->d[2];
    const float to_eye =
        e->d[0] * light->eye[0] + e->d[1] * light->eye[1] + e->d[2] * light->eye[2];
    const bool head = to_eye >= light->cos_head;
    if (up > 0) {
      amount[ABBE_GEM_ISO] += e->share;
      amount[ABBE_GEM_COS] += e->share * fminf(up, 1);
      amount[head ? ABBE_GEM_HEAD : ABBE_GEM_RETURN] += e->share;
    } else {
      amount[ABBE_GEM_DOWN] += e->share;
    }
    amount[to_eye <= 0            ? ABBE_GEM_BELOW
           : head                 ? ABBE_GEM_BLUE
           : to_eye > 0.70710678f ? ABBE_GEM_RED
                                  : ABBE_GEM_GREEN] += e->share;
  }
  amount[ABBE_GEM_ABSORBED] = path->absorbed;
  amount[ABBE_GEM_LEFT] = path->left;
}
