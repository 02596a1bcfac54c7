/* preset.h: settings that were measured to be worth their time, and which of them to take.
 *
 * For every class of scenes a front: settings of rising cost and falling error, read off sweeps
 * (abbe sweep --write-presets) and kept in gl/accuracy/presets.yaml with the run that made them.
 * Three of them have names. Others are chosen by an error or by a time; for a time, one quick frame
 * on this machine measures its speed. An error is a promise and no measurement: the worst of the
 * front's own scenes, times the margin by which leaving one of them out would have been wrong.
 */
#ifndef ABBE_GL_ACCURACY_PRESET_H
#define ABBE_GL_ACCURACY_PRESET_H

#include "gl/device/context.h"
#include "gl/plan/plan.h"

#define ABBE_PRESETS(X) X(DRAFT, "draft") X(BALANCED, "balanced") X(ACCURATE, "accurate")
typedef enum abbe_preset_name {
#define ABBE_PRESET_ENUM(code, name) ABBE_PRESET_##code,
  ABBE_PRESETS(ABBE_PRESET_ENUM)
#undef ABBE_PRESET_ENUM
      ABBE_PRESET_COUNT
} abbe_preset_name;

const char *abbe_preset_name_text(abbe_preset_name name);

/* X(code, name): of a scene, its hardest refractor as the plan models it. Bows are of spheres that
 * no receiver stands behind, so that only what they reflect lands: little light, from many photons.
 */
#define ABBE_PRESET_CLASSES(X)                                                                     \
  X(NONE, "none") X(SPHERES, "spheres") X(BOWS, "bows") X(CONVEX, "convex") X(MESHES, "meshes")
typedef enum abbe_preset_class {
#define ABBE_PRESET_ENUM(code, name) ABBE_PRESET_CLASS_##code,
  ABBE_PRESET_CLASSES(ABBE_PRESET_ENUM)
#undef ABBE_PRESET_ENUM
      ABBE_PRESET_CLASS_COUNT
} abbe_preset_class;

const char *abbe_preset_class_name(abbe_preset_class which);
abbe_preset_class abbe_preset_class_of(const abbe_plan *plan);

#define ABBE_PRESET_MAX_POINTS 128

typedef struct abbe_preset_point {
  abbe_render_desc desc;   /* wavelengths, photons, map, samples, upsampling, fill, share, exits,
                              model; the rest 0 */
  double light_ms, eye_ms; /* on the run's machine, as promised: the worst of its scenes in ratio to
                              the first point, times the time's margin */
  double error;            /* that is promised: the worst times the front's margin */
  double worst, least;     /* as measured, of the run's scenes */
} abbe_preset_point;

typedef struct abbe_preset_front {
  abbe_preset_class of;
  char scenes[256];
  /* The most by which one of the run's scenes was worse than the others had promised. */
  double margin, time_margin;
  size_t margin_scenes; /* behind them; 0: too few of this class, so another class's are taken */
  size_t named[ABBE_PRESET_COUNT]; /* indices of points; count where no point has the name */
  size_t count;                    /* at least 1 */
  abbe_preset_point *point;        /* [count] of rising cost and falling error */
} abbe_preset_front;

typedef struct abbe_presets {
  char error[32];      /* the name of the error: a column of abbe sweep */
  char error_text[64]; /* what it is, for people */
  char run[640];       /* date, machine, device, size, frames: what made them */
  size_t count;
  abbe_preset_front front[ABBE_PRESET_CLASS_COUNT];
} abbe_presets;

/* From a file, or with NULL the shipped ones. ABBE_SCHEMA, ABBE_PARSE and ABBE_IO name file, line
 * and key. */
abbe_result abbe_presets_load(const char *path, abbe_presets *out, abbe_error *error);
void abbe_presets_free(abbe_presets *presets);
/* The text of the shipped file. */
const char *abbe_presets_shipped(size_t *size);

/* The front for the plan's scene. ABBE_UNSUPPORTED where no run had such a scene. */
abbe_result abbe_presets_find(const abbe_presets *presets, const abbe_plan *plan,
                              const abbe_preset_front **out, abbe_error *error);

/* Fills the fields of desc that are 0 with the point's, but for exits and a share that plans have
 * by themselves: those are left to the scene's own, and so is the model 'layers', which follows no
 * light off mirrors and is not seen from inside a refractor, where the scene has a mirror, or a
 * camera that may be inside. False where this is so, or a field that was not 0 differs from the
 * point's: then what the point promises does not hold. scene may be NULL: of neither. */
bool abbe_preset_apply(const abbe_preset_point *point, const abbe_scene *scene,
                       abbe_render_desc *desc);

/* This machine's time for this scene and size over the run's, for the light's and the camera's
 * passes. */
typedef struct abbe_preset_speed {
  double light, eye;
  double unrest; /* unrest of the repeats that gave it (frame_times.h) */
} abbe_preset_speed;

/* Draws the front's cheapest point once to warm up and three times for the clock. size and space
 * are desc's. Errors of abbe_renderer_make. */
abbe_result abbe_preset_calibrate(abbe_context *context, const abbe_scene *scene,
                                  const abbe_preset_front *front, const abbe_render_desc *desc,
                                  abbe_preset_speed *out, abbe_error *error);
double abbe_preset_ms(const abbe_preset_point *point, const abbe_preset_speed *speed);

/* The cheapest point whose error is at most max_error; where there is none the most accurate, and
 * *kept is false. */
size_t abbe_preset_for_error(const abbe_preset_front *front, double max_error, bool *kept);
/* The most accurate point that takes at most ms; where there is none the fastest, likewise. */
size_t abbe_preset_for_time(const abbe_preset_front *front, const abbe_preset_speed *speed,
                            double ms, bool *kept);

/* Which settings a picture takes: by a preset's name, by an error or by a time; and what they
 * promise. */

/* One of name, max_error and budget_ms; of none nothing is chosen. */
typedef struct abbe_preset_request {
  const char *name; /* name of a preset, or NULL */
  const char *file; /* file of presets, or NULL: the shipped ones */
  double max_error; /* 0: none */
  double budget_ms; /* 0: none */
  bool timed;       /* promise a time too, where budget_ms does not request one */
} abbe_preset_request;

typedef struct abbe_preset_choice {
  abbe_preset_request request;
  abbe_presets presets;
  const abbe_preset_front *front; /* NULL: nothing was asked for */
  const abbe_preset_point *point; /* point of the front */
  bool kept;                      /* the bound can be kept, by the front */
  bool overridden;    /* the picture's request or scene stands against it: it promises nothing */
  bool timed;         /* promised_ms is known */
  double promised_ms; /* on this machine */
  double
      unrest; /* unrest of the frames that gave its speed (frame_times.h); NaN: none were drawn */
} abbe_preset_choice;

/* Chooses and fills the fields of desc that are 0. With a time to keep or to promise, this
 * machine's speed is measured by a quick frame first. The request's texts outlive the choice.
 * ABBE_INVALID_ARGUMENT for the thesis profiles, ABBE_NOT_FOUND for a name that the front does not
 * have; errors of abbe_presets_load, abbe_presets_find and abbe_preset_calibrate. */
abbe_result abbe_preset_choose(const abbe_preset_request *request, abbe_context *context,
                               const abbe_scene *scene, abbe_render_desc *desc,
                               abbe_preset_choice *out, abbe_error *error);
void abbe_preset_choice_free(abbe_preset_choice *choice);

/* ABBE_TOLERANCE where a frame of that time, drawn by the choice, does not keep the bound that was
 * asked for. */
abbe_result abbe_preset_choice_check(const abbe_preset_choice *choice, double frame_ms,
                                     abbe_error *error);

/* "7 wavelengths, 256 photons, map 1024, 2 samples, fill bridge, 8 exits, share 0.01, model auto",
 * the profile first where it is not the default one. */
void abbe_preset_describe(const abbe_render_desc *desc, char *out, size_t size);

#endif
