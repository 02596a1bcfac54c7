/* plan.h: what a scene requires of the renderer: models, passes, wavelengths, and why.
 *
 * The plan is computed from the scene and the request alone; it needs no GL context. A pass runs
 * only because a fact of the scene asks for it, and every entry says which fact. What the renderer
 * does not model is listed in the plan, or refused with ABBE_UNSUPPORTED.
 */
#ifndef ABBE_GL_PLAN_PLAN_H
#define ABBE_GL_PLAN_PLAN_H

#include "base/error.h"
#include "colorimetry/rgb_space.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* thesis: the thesis's method with its constants; thesis-cie: the same passes with the default
 * profile's wavelengths, CIE weights, indices, Fresnel's law and units. */
#define ABBE_PROFILES(X) X(DEFAULT, "default") X(THESIS, "thesis") X(THESIS_CIE, "thesis-cie")
typedef enum abbe_profile {
#define ABBE_PROFILE_ENUM(code, name) ABBE_PROFILE_##code,
  ABBE_PROFILES(ABBE_PROFILE_ENUM)
#undef ABBE_PROFILE_ENUM
      ABBE_PROFILE_COUNT
} abbe_profile;

/* bridge: light is laid between neighbouring wavelengths' landings; none: each wavelength lands
 * on its own; smear: the thesis's 20-step fill. AUTO is bridge, and smear in the thesis profile. */
#define ABBE_FILLS(X) X(AUTO, "auto") X(NONE, "none") X(BRIDGE, "bridge") X(SMEAR, "smear")
typedef enum abbe_fill {
#define ABBE_FILL_ENUM(code, name) ABBE_FILL_##code,
  ABBE_FILLS(ABBE_FILL_ENUM)
#undef ABBE_FILL_ENUM
      ABBE_FILL_COUNT
} abbe_fill;

/* How light is followed through refractors. AUTO: by the scene; the others ask for one model for
 * all refractors. */
#define ABBE_MODELS(X)                                                                             \
  X(AUTO, "auto")                                                                                  \
  X(SPHERE, "sphere") X(CONVEX, "convex") X(LAYERS, "layers") X(HIERARCHY, "hierarchy")
typedef enum abbe_model {
#define ABBE_MODEL_ENUM(code, name) ABBE_MODEL_##code,
  ABBE_MODELS(ABBE_MODEL_ENUM)
#undef ABBE_MODEL_ENUM
      ABBE_MODEL_COUNT
} abbe_model;

#define ABBE_RENDER_MAX_SIDE 8192
#define ABBE_RENDER_MAX_PHOTONS 4096 /* a side */
#define ABBE_RENDER_MAX_MAP 4096     /* a side */
#define ABBE_RENDER_MAX_WAVELENGTHS 1000
#define ABBE_RENDER_MAX_ORDERS 32

/* Called now and then with the share done, 0 to 1; false stops the work with ABBE_CANCELLED. */
typedef bool (*abbe_render_progress)(void *user, double done);

/* What a request of the default profile leaves open, where a scene disperses. */
#define ABBE_PLAN_WAVELENGTHS 7
#define ABBE_PLAN_PHOTONS 256
#define ABBE_PLAN_MAP 1024
#define ABBE_PLAN_SAMPLES 2
/* Exits that are followed at the most, and the share of its light below which a path ends, where
 * the request leaves them open. */
#define ABBE_PLAN_EXITS 8
#define ABBE_PLAN_LAYER_EXITS 4 /* where a refractor is known by its layers */
#define ABBE_PLAN_SHARE 0.01
/* As far as they go where a convex solid keeps light inside (gl/plan/inner_light.h). */
#define ABBE_PLAN_MOST_EXITS 24
#define ABBE_PLAN_LOW_SHARE 0.005
/* Of the eye's rays through exact surfaces, the share of one solid alone; what light is left
 * inside then is too little to show. */
#define ABBE_PLAN_EYE_EXITS 256
#define ABBE_PLAN_EYE_SHARE 0.001

/* A request; zero means the default in every field. */
typedef struct abbe_render_desc {
  abbe_profile profile;
  size_t width, height; /* pixels; 0: the scene's */
  /* samples at the most; 0: 7, or 1 where neither index nor attenuation varies */
  size_t wavelengths;
  double min_nm, max_nm; /* 0: 380, 780 (thesis: its nodes are 380 to 680) */
  size_t photons;        /* side of the photon grid; 0: 256 (thesis: 512) */
  size_t map_size;       /* side of the spectral map; 0: 1024 */
  size_t supersample;    /* 1 to 4 samples a pixel side; 0: 2 (thesis, and with upsample: 1) */
  size_t upsample;       /* or 1 to 4 pixels a sample side, and between samples; 0: 1 */
  abbe_fill fill;
  abbe_model model;
  /* paths below this share of their light end; 0: 0.01, or 0.005 where paths that end leave too much
   * light inside a convex solid */
  double energy_share;
  /* exits followed at the most; 0: as many as carry energy, at most 8, or up to 24 where a convex
   * solid keeps light inside (4 where a mesh is known by its layers) */
  size_t orders;
  abbe_rgb_space space; /* of the picture */
  /* Layout of one light's map, and which light's; it lives as long as the plan. NULL: each map is
   * fitted to where its light lands. */
  const abbe_map_layout *map_layout;
  size_t map_layout_light;
  /* Of the photon grid in cells and of the eye's samples in their distance, x and y, -0.5 to 0.5:
   * other pictures that the same request could have given (gl/accuracy/error_bars.h). */
  double photon_shift[2], sample_shift[2];
  bool everything;               /* all on, to measure what the plan saves (gl/plan/everything.h) */
  bool layers;                   /* keep direct and caustic light of the receivers apart as well */
  abbe_render_progress progress; /* while the renderer is made: photons are traced once to fit */
  void *progress_user;
} abbe_render_desc;

typedef enum abbe_refractor_model {
  ABBE_REFRACTOR_SPHERE,    /* exact quadric */
  ABBE_REFRACTOR_CONVEX,    /* plane tests */
  ABBE_REFRACTOR_LAYERS,    /* front and back as a view sees them */
  ABBE_REFRACTOR_HIERARCHY, /* triangles, traversed */
  ABBE_REFRACTOR_MODEL_COUNT
} abbe_refractor_model;

typedef enum abbe_receiver_model {
  ABBE_RECEIVER_EXACT,     /* parallelograms, hit exactly */
  ABBE_RECEIVER_HIERARCHY, /* triangles, traversed */
  ABBE_RECEIVER_DEPTH      /* iterated image-space intersection */
} abbe_receiver_model;

typedef struct abbe_plan_entry {
  char name[64];
  char reason[224];
  bool runs;
} abbe_plan_entry;

#define ABBE_PLAN_MAX_ENTRIES 96

/* A light, or a face of the cube around one whose refractors do not fit one view. */
typedef struct abbe_plan_lamp {
  size_t light;   /* the scene's */
  int face;       /* that it looks through (gl/plan/light_cube.h); -1: it is no part of a cube */
  unsigned faces; /* whose light it carries, a bit each: its own; the first of a cube also has all
                     those through which no light reaches a refractor; without a cube, all */
} abbe_plan_lamp;

typedef struct abbe_plan {
  abbe_render_desc desc; /* every field resolved, none zero */
  size_t refractor_count;
  size_t *refractor_object;    /* [refractor_count] index into the scene's objects */
  abbe_refractor_model *model; /* [refractor_count] */
  size_t receiver_count;
  size_t *receiver_object;                 /* [receiver_count] */
  abbe_receiver_model *receiver_model;     /* [receiver_count] */
  size_t parallelogram_count;              /* of the exact receivers */
  abbe_receiver_model receivers;           /* the most general of theirs */
  bool receiver_shadows;                   /* some receiver may hide another from a light */
  bool through; /* some receiver may lie where light goes on nearly straight through a refractor */
  bool aside; /* some receiver lies beyond a light's map view */
  bool pages; /* light may land where its light's map cannot hold it: receivers have pages */
  bool spheres, convex, layers, hierarchy; /* models in use */
  bool walk;       /* light that leaves a refractor may meet one again, and is followed */
  bool dispersive; /* some index varies over the range */
  bool absorbing;  /* some attenuation is above zero in the range */
  bool tinting;    /* some attenuation varies over the range */
  bool lengths;    /* and landings keep the length of their way inside, which tells it anywhere */
  bool textured;
  size_t eye_exits; /* that the eye's rays are followed for, at the most */
  double eye_share; /* and the share of their light at which they end */
  size_t slots; /* landings of a photon at the most: its exits, and the mirror on the outside */
  bool reaches[ABBE_SCENE_MAX_LIGHTS]; /* the light may meet a refractor: it has a map */
  bool caustics;                       /* some light may */
  bool seen;                           /* the eye may */
  bool fills;                          /* light is laid between wavelengths */
  bool back;                           /* the back of refractors is drawn */
  size_t light_count; /* the scene's lights, and after them what cubes have more than one face each */
  abbe_plan_lamp lamp[ABBE_SCENE_MAX_LIGHTS];
  bool cubes; /* some light has one */
  size_t off_view[ABBE_SCENE_MAX_LIGHTS]; /* of a light with a cube: an object that asks for it */
  size_t entry_count; /* passes and models, in the order in which they run */
  abbe_plan_entry entry[ABBE_PLAN_MAX_ENTRIES];
  size_t note_count; /* what is not modelled, or extrapolated */
  char note[16][256];
} abbe_plan;

/* ABBE_INVALID_ARGUMENT for a request outside the limits above, ABBE_OUT_OF_RANGE for an index
 * that is not known over the range, ABBE_UNSUPPORTED for what is not modelled. desc may be NULL. */
abbe_result abbe_plan_make(const abbe_scene *scene, const abbe_render_desc *desc, abbe_plan *out,
                           abbe_error *error);
void abbe_plan_free(abbe_plan *plan);

const char *abbe_profile_name(abbe_profile profile);
/* Whether it draws with the thesis's passes. */
bool abbe_profile_is_thesis(abbe_profile profile);
/* Wavelengths that every photon is traced at; more, up to the plan's, where its landings ask. */
size_t abbe_plan_least_wavelengths(const abbe_plan *plan);
const char *abbe_fill_name(abbe_fill fill);
const char *abbe_model_name(abbe_model model);
const char *abbe_refractor_model_name(abbe_refractor_model model);
const char *abbe_receiver_model_name(abbe_receiver_model model);

/* The entry of that name, or NULL. */
const abbe_plan_entry *abbe_plan_find(const abbe_plan *plan, const char *name);

#ifdef __cplusplus
}
#endif
#endif
