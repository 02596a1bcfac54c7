/* passes.h: the passes of a frame, and what its plan settles beside them: ids, texts, conditions.
 *
 * The one table of them. The plan lists its entries by it, the timer and the statistics count by
 * it; nothing identifies a pass by its text. It runs nothing. Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_FACTS_PASSES_H
#define ABBE_GL_PLAN_FACTS_PASSES_H

#include <stdbool.h>

/* X(id, stage, text, condition), in the plan's order: a pass runs where the condition holds of the
 * plan p (gl/plan/facts/plan_facts.h). The published methods draw front and back in one pass, of
 * which their plans list both halves. */
#define ABBE_PASSES(X)                                                                             \
  X(RECEIVER_DEPTH, LIGHT, "light: receiver depth", has_lamp(p))                                   \
  X(LIGHT_FRONT, LIGHT, "light: refractor front", p->caustics)                                     \
  X(LIGHT_BACK, LIGHT, "light: refractor back", p->caustics && p->draw_back)                       \
  X(LIGHT_FRONT_AND_BACK, LIGHT, "light: refractor layers", has_lamp(p) && p->caustics)            \
  X(PHOTON_PLACEMENT, LIGHT, "light: photon placement", p->caustics && !is_gridded(p))             \
  X(PHOTONS, LIGHT, "light: photons", p->caustics)                                                 \
  X(SPECTRAL_MAP, LIGHT, "light: spectral map", p->caustics)                                       \
  X(GAP_FILL, LIGHT, "light: gap fill", p->fills)                                                  \
  X(PINHOLES, LIGHT, "light: pinholes", has_pinholes(p))                                           \
  X(SHAFTS, LIGHT, "light: shafts", p->shaft_count > 0)                                            \
  X(EYE_RECEIVERS, EYE, "eye: receivers", true)                                                    \
  X(EYE_FRONT, EYE, "eye: refractor front", p->camera_sees_refractor)                              \
  X(EYE_BACK, EYE, "eye: refractor back", p->camera_sees_refractor && p->draw_back)                \
  X(EYE_FRONT_AND_BACK, EYE, "eye: refractor layers", has_lamp(p) && p->camera_sees_refractor)     \
  X(EYE_ADAPTIVE, EYE, "eye: adaptive samples", p->desc.adaptive > 1)                              \
  X(EYE_REFRACTION, EYE, "eye: refraction", p->camera_sees_refractor)                              \
  X(EYE_PICTURE, EYE, "eye: picture",                                                              \
    p->desc.supersample > 1 || (p->desc.upsample > 1 && p->desc.coarse == ABBE_COARSE_NONE))       \
  X(EYE_HAZE, EYE, "eye: haze", p->hazy)

/* X(id, text, condition): models and facts that passes rest on; i is the index of the scene's
 * object or light that an entry is about. A text that ends in a blank goes on with its name. */
#define ABBE_PLAN_CHOICES(X)                                                                       \
  X(REFRACTOR_MODEL, "model: ", refracts(p, i))                                                    \
  X(MIRROR, "mirror: ", mirrors(p, i))                                                             \
  X(MORE_REFRACTORS, "models", true)                                                               \
  X(MULTI_REFRACTOR_PATHS, "refractors in turn", p->multi_refractor_paths)                         \
  X(RECEIVER_MODEL, "model: receivers", true)                                                      \
  X(RECEIVER_SHADOWS, "shadows of receivers", p->receiver_shadows)                                 \
  X(WAVELENGTHS, "wavelengths", true)                                                              \
  X(INNER_REFLECTIONS, "inner reflections",                                                        \
    (p->caustics || p->camera_sees_refractor) && p->desc.exits > 1)                                \
  X(LIGHT_MAP, "map: ", p->reaches[i])                                                             \
  X(RECEIVER_MAPS, "maps on receivers", p->tiles)                                                  \
  X(ABSORPTION, "absorption", p->absorbing)                                                        \
  X(TEXTURES, "textures", p->textured)                                                             \
  X(RECEIVER_COLOURS, "colours of receivers", p->receiver_colours)                                 \
  X(LIGHT_SIZE, "lights with a size", p->sized_lights)                                             \
  X(ENVIRONMENT, "environment", p->surrounded)

/* Passes first, so that arrays can be indexed by them. */
typedef enum abbe_plan_item {
#define ABBE_PASS_ENUM(id, stage, text, condition) ABBE_PASS_##id,
#define ABBE_CHOICE_ENUM(id, text, condition) ABBE_CHOICE_##id,
  ABBE_PASSES(ABBE_PASS_ENUM) ABBE_PASS_COUNT,
  ABBE_BEFORE_CHOICES = ABBE_PASS_COUNT - 1,
  ABBE_PLAN_CHOICES(ABBE_CHOICE_ENUM)
#undef ABBE_PASS_ENUM
#undef ABBE_CHOICE_ENUM
      ABBE_PLAN_ITEM_COUNT
} abbe_plan_item;

/* An item below ABBE_PASS_COUNT. */
typedef abbe_plan_item abbe_pass;

typedef enum abbe_pass_stage { ABBE_STAGE_LIGHT, ABBE_STAGE_EYE } abbe_pass_stage;

const char *abbe_plan_item_text(abbe_plan_item item);
abbe_pass_stage abbe_pass_stage_of(abbe_pass pass);

#endif
