/* plan_facts.h: what a plan holds: facts of the scene, models, entries and notes.
 *
 * gl/plan/examine finds the facts out, gl/plan/plan.h makes the plan of them, the renderer reads
 * it. Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_FACTS_PLAN_FACTS_H
#define ABBE_GL_PLAN_FACTS_PLAN_FACTS_H

#include "gl/plan/facts/render_desc.h"
#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The passes of a frame, and what its plan settles beside them: ids, texts, conditions.
 *
 * The one table of them. The plan lists its entries by it, the timer and the statistics count by
 * it; nothing identifies a pass by its text. It runs nothing. */

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
  X(EYE_GLOW, EYE, "eye: glow", p->glowing)                                                        \
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

typedef enum abbe_refractor_model {
  ABBE_REFRACTOR_SPHERE, /* exact quadric */
  ABBE_REFRACTOR_CONVEX, /* plane tests */
  ABBE_REFRACTOR_LAYERS, /* front and back as a view sees them */
  ABBE_REFRACTOR_BVH,    /* triangles, traversed */
  ABBE_REFRACTOR_MODEL_COUNT
} abbe_refractor_model;

typedef enum abbe_receiver_model {
  ABBE_RECEIVER_EXACT, /* parallelograms, hit exactly */
  ABBE_RECEIVER_BVH,   /* triangles, traversed */
  ABBE_RECEIVER_DEPTH  /* iterated image-space intersection */
} abbe_receiver_model;

typedef struct abbe_plan_entry {
  abbe_plan_item item;
  unsigned index; /* the scene's object or light, of the items that are about one; else 0 */
  char name[60];
  char reason[224];
  bool runs;
} abbe_plan_entry;

#define ABBE_PLAN_MAX_ENTRIES 96

/* A light, or a face of the cube around one whose refractors do not fit one view. */
typedef struct abbe_light_view {
  size_t light; /* the scene's */
  int face;     /* that it looks through (gl/plan/examine/examine.h); -1: it is no part of a cube */
  unsigned faces; /* whose light it carries, a bit each: its own; the first of a cube also has all
                     those through which no light reaches a refractor; without a cube, all */
} abbe_light_view;

/* Bands of equal width, in which a medium counts as grey. */
enum { ABBE_PLAN_HAZE_BANDS = 12 };

/* A medium that scatters: means over wavelengths, 1/m, and the mean cosine; by band what is
 * scattered, and what is scattered and absorbed. */
typedef struct abbe_plan_haze {
  double scattering, absorption, g;
  double scatters[ABBE_PLAN_HAZE_BANDS], takes[ABBE_PLAN_HAZE_BANDS];
} abbe_plan_haze;

/* What keeps light inside the plan's one convex solid (gl/plan/examine/examine.h): exits, the
 * share at which paths end, and what is inside still then. */
typedef struct abbe_plan_inside {
  uint64_t of; /* a digest of what it was found from; 0: it was not looked for */
  size_t exits;
  double energy_share, left;
} abbe_plan_inside;

/* Whether the one refractor's mesh is convex, which is much to be looked at. */
typedef struct abbe_plan_shape {
  uint64_t of; /* a digest of the mesh; 0: it was not looked for */
  bool convex;
} abbe_plan_shape;

/* A medium that bent and mirrored rays of the camera may run through. */
typedef struct abbe_plan_shaft {
  int refractor;        /* that it fills; -1: the air */
  double scattering, g; /* in the band that scatters most, 1/m; the mean cosine */
} abbe_plan_shaft;

#define ABBE_PLAN_MOST_SHAFTS 8
/* Refractors of a scene in which some may glow. */
#define ABBE_PLAN_MOST_GLOWING 32
/* Cells of their glow, along each axis. */
#define ABBE_PLAN_GLOW_CELLS 12

/* Where band k begins, nm. */
double abbe_plan_haze_edge(const abbe_render_desc *desc, int k);

typedef struct abbe_plan {
  abbe_render_desc desc; /* the request, with a value for each that it left to the plan */
  size_t lines;          /* of the lights in the range, which have no other light; the wavelengths
                            are theirs. 0: they are evenly spaced */

  /* Objects, by their index in the scene, each with its model. Mirrors are among the refractors:
   * photons start at them, and paths that go from one to the next meet them, too. */
  size_t refractor_count;
  size_t *refractor_object;
  abbe_refractor_model *model; /* [refractor_count] */
  bool *mirror;                /* [refractor_count] it is one */
  size_t mirror_count;
  bool rough; /* some mirror is */
  size_t receiver_count;
  size_t *receiver_object;
  abbe_receiver_model *receiver_model; /* [receiver_count] */
  /* Models of refractors in use; the most general model of receivers; parallelograms that are hit
   * exactly. */
  bool spheres, convex, layers, bvh;
  bool facets; /* some of them is a solid of planes, whatever its model */
  abbe_receiver_model receivers;
  size_t parallelogram_count;

  /* What the light and the camera's rays may meet. */
  bool reaches[ABBE_SCENE_MAX_LIGHTS]; /* the light may meet a refractor: it has a map */
  bool caustics;                       /* some light may meet one */
  bool volume;                         /* one may, and its caustics are looked up: no photons */
  size_t volume_pages; /* in maps on receivers: two a parallelogram; 0: in cells around it */
  const abbe_object *around_eye; /* the scene's first refractor that the camera is inside of; NULL:
                                    none; while the plan is made */
  unsigned eye_inside;           /* bit r: the camera is inside refractor r */
  bool camera_sees_refractor;    /* the camera may */
  /* Light is followed from interface to interface of all refractors: what leaves one may meet one
   * again, or a receiver inside; or one is a mirror; or the BVH was asked for. Without this no
   * model is the BVH. */
  bool multi_refractor_paths;
  bool forward_transmission; /* some receiver may lie where light goes on nearly straight through a
                                refractor */
  bool outside_map_view;     /* some receiver lies beyond a light's map view */
  bool receiver_shadows;     /* some receiver may hide another from a light */
  bool surrounded;           /* an environment is around the scene */
  bool sized_lights;         /* points stand for a light with a size */
  bool hazy;                 /* a medium scatters, or absorbs in the air; then: */
  bool eye_in_air;
  abbe_plan_haze air_haze, eye_haze; /* of the air, and of what the camera is in */
  bool haze_beyond;   /* the camera may see the air's haze by a bent or mirrored ray */
  size_t shaft_count; /* media with light of photons that such rays may run through */
  abbe_plan_shaft shaft[ABBE_PLAN_MOST_SHAFTS];
  size_t unseen_media; /* more of them, beyond the plan's capacity */

  /* The scene's lights, and after them the views that cubes have more than one of. */
  size_t light_view_count;
  abbe_light_view light_view[ABBE_SCENE_MAX_LIGHTS];
  bool cubes;                             /* some light has one */
  size_t off_view[ABBE_SCENE_MAX_LIGHTS]; /* for a light with a cube: an object that needs it */

  /* Over the range of wavelengths, of some refractor. */
  bool dispersive; /* its index varies */
  bool absorbing;  /* its attenuation is above zero somewhere */
  bool tinting;    /* its attenuation varies */
  bool colouring;  /* some mirror's reflectance varies */
  bool filmed;     /* some refractor has films on faces that are drawn */
  bool crystals;   /* it has several indices: the camera follows both waves */
  bool biaxial;    /* of such some have three */
  bool pleochroic; /* it attenuates by the direction of the light's field */
  bool glowing;    /* it is fluorescent, and its glow is drawn */
  bool tinted_air; /* the air's absorption or scattering varies */

  abbe_plan_inside inside;
  abbe_plan_shape shape;
  size_t eye_exits; /* exits of the camera's rays, followed at the most */
  double eye_share; /* below this share of their light they end */
  size_t hit_slots; /* hits of a photon at a wavelength, at the most: its exits, and the mirror on
                       the outside; on multi-refractor paths a number of its own */

  /* What follows from the facts above. */
  bool tiles;       /* light may land where its light's map cannot hold it: receivers have tiles */
  bool page_charts; /* pinholes light receivers that are meshes: by their charts */
  bool fills;       /* light is laid between wavelengths */
  bool edges;       /* some refractor has facets: light ends at edges, and splats are cut finer */
  size_t tints;     /* hits keep how much of so many stuffs their path passed (examine.h) */
  bool band_parts;  /* attenuation or reflectance varies: bands have parts that are attenuated alike
                     */
  bool draw_back;   /* views show the back of refractors, too */
  abbe_coarse fewer_triangles; /* for whose sake some mesh is drawn by fewer */
  bool textured;               /* some receiver has a texture */
  bool receiver_colours; /* dispersed light may fall on receivers in colours: tables say what they
                            reflect of its bands */

  size_t entry_count; /* models and passes, in the order in which they run */
  abbe_plan_entry entry[ABBE_PLAN_MAX_ENTRIES];
  size_t note_count; /* what is not modelled, or extrapolated: all of it */
  char (*note)[256];
  bool note_lost; /* for want of memory, which making the plan ends with */
} abbe_plan;

void abbe_plan_free(abbe_plan *plan);

/* Refractors and mirrors; where some are pleochroic, after them all for fields along x, then y,
 * then z. */
size_t abbe_plan_surfaces(const abbe_plan *plan);

/* How many wavelengths every photon is traced at. Where its hits need more it takes more, up to all
 * the plan's. */
size_t abbe_plan_least_wavelengths(const abbe_plan *plan);
/* Why nothing refracts, as a sentence's part, or NULL. */
const char *abbe_plan_no_refraction(const abbe_plan *plan);
const char *abbe_refractor_model_name(abbe_refractor_model model);
const char *abbe_receiver_model_name(abbe_receiver_model model);

/* Whether the plan, as it stands, runs the item, by the table's condition. */
bool abbe_plan_runs(const abbe_plan *plan, abbe_plan_item item, size_t index);

/* Adds an entry that runs or does not by its condition, with its reason; one about an object or a
 * light by its index and name; or a note. More than the capacity are left out. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void
abbe_plan_add(abbe_plan *plan, abbe_plan_item item, const char *reason, ...);
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
void
abbe_plan_add_about(abbe_plan *plan, abbe_plan_item item, size_t index, const char *name,
                    const char *reason, ...);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void
abbe_plan_note(abbe_plan *plan, const char *format, ...);

/* The entry of that item, and of that object or light (0 where it is about none); or NULL. */
const abbe_plan_entry *abbe_plan_find(const abbe_plan *plan, abbe_plan_item item, size_t index);

#endif
