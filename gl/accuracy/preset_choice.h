/* preset_choice.h: which settings a picture takes: by a preset's name, by an error or by a time;
 * and what they promise.
 */
#ifndef ABBE_GL_ACCURACY_PRESET_CHOICE_H
#define ABBE_GL_ACCURACY_PRESET_CHOICE_H

#include "gl/accuracy/preset.h"

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
