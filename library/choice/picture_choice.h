/* picture_choice.h: which tool makes one picture, and with what settings: by a name, by an error,
 * or by the time from the start of the process to its end.
 *
 * The renderer, the tracer and the filtered tracer compete on the fronts that sweeps of whole
 * processes gave (library/python/abbe/sweep/presets.py), in the files of gl/accuracy/preset.h. It
 * makes no picture. What it says of errors and times are promises: the worst of the run's scenes,
 * times the tool's margin. How they carry over to this scene and machine is measured by the
 * yardstick, a short frame of the tracer: how long it takes, and what it says of its own error.
 */
#ifndef ABBE_LIBRARY_CHOICE_PICTURE_CHOICE_H
#define ABBE_LIBRARY_CHOICE_PICTURE_CHOICE_H

#include "gl/accuracy/preset.h"
#include "scenes/scene.h"
#include "validation/trace/pass_error.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_PICTURE_TOOLS(X) X(RENDER, "render") X(TRACE, "trace") X(TRACE_FILTER, "trace-filter")
typedef enum abbe_picture_tool {
#define ABBE_PICTURE_ENUM(code, name) ABBE_PICTURE_##code,
  ABBE_PICTURE_TOOLS(ABBE_PICTURE_ENUM)
#undef ABBE_PICTURE_ENUM
      ABBE_PICTURE_TOOL_COUNT
} abbe_picture_tool;
const char *abbe_picture_tool_name(abbe_picture_tool tool);

/* A frame of the tracer that tells this scene and machine from the run's. */
#define ABBE_PICTURE_YARDSTICK_PASSES 2
#define ABBE_PICTURE_YARDSTICK_PHOTONS 128

/* One tool's point. */
typedef struct abbe_picture_point {
  abbe_picture_tool tool;
  size_t photons; /* a side */
  size_t passes;  /* of the tracer; what follows is the renderer's */
  size_t wavelengths, map_size, supersample, upsample, exits;
  double energy_share;
  abbe_fill fill;
  abbe_model model;
  double ms;           /* of a whole process, in the run, with the time's margin */
  double error;        /* the worst of the run's scenes, with the error's margin */
  double worst, least; /* of the run's scenes, without */
} abbe_picture_point;

#define ABBE_PICTURE_MAX_POINTS (ABBE_PICTURE_TOOL_COUNT * 48)

typedef struct abbe_picture_front {
  abbe_preset_class of;
  char scenes[256];
  double base_ms, base_error; /* the yardstick's in the run, geometric means over its scenes */
  double margin[ABBE_PICTURE_TOOL_COUNT], time_margin[ABBE_PICTURE_TOOL_COUNT];
  size_t margin_scenes;                              /* behind them; 0: too few to know */
  size_t count;                                      /* at least 1 */
  abbe_picture_point point[ABBE_PICTURE_MAX_POINTS]; /* [count] tool by tool */
} abbe_picture_front;

/* The fronts of a class of scenes, from a file of presets (NULL: the shipped ones).
 * ABBE_UNSUPPORTED where the file has none; ABBE_SCHEMA, ABBE_PARSE and ABBE_IO name file, line and
 * key. */
abbe_result abbe_picture_front_load(const char *path, abbe_preset_class of, abbe_picture_front *out,
                                    abbe_error *error);

/* One of name, max_error and budget_ms. */
typedef struct abbe_picture_request {
  const char *name;                   /* name of a preset, or NULL */
  const char *file;                   /* file of presets, or NULL: the shipped ones */
  double max_error;                   /* 0: none */
  double budget_ms;                   /* time of the whole process; 0: none */
  bool timed;                         /* promise a time too, where budget_ms does not request one */
  bool tool[ABBE_PICTURE_TOOL_COUNT]; /* those that may be taken; none: all */
  size_t width, height;               /* pixels; 0: the scene's */
} abbe_picture_request;

typedef struct abbe_picture_choice {
  abbe_picture_request request;
  abbe_picture_front front;
  const abbe_picture_point *point; /* point of the front */
  bool kept;                       /* the bound can be kept, by the front */
  bool timed;                      /* promised_ms is known */
  double promised_error;           /* for this scene */
  double promised_ms;              /* on this machine, of the whole process, with the yardstick */
  double spent_ms;                 /* on the yardstick; 0: it was not needed */
  double once_ms;                  /* one run of it, the tracer's making included; or 0 */
  double unrest;       /* unrest of its repeats (gl/accuracy/frame_times.h); NaN: it has none */
  double prepared_ms;  /* on what stands before the first frame; 0: nothing was rendered */
  bool compiled;       /* shaders were, which happens once on a machine */
  size_t passes;       /* that the picture is traced of, or checked by; 0: none */
  bool others;         /* they are not the picture's own: it is held against them */
  bool timed_out;      /* to estimate its error, or to do it better, there was no time left */
  abbe_pass_error met; /* their estimate of its error: NaN, or 0 passes: none */
  bool traced_instead; /* the rendered picture did not keep max_error, and the passes do */
} abbe_picture_choice;

/* Chooses among the tools that may be taken. The yardstick is traced first, unless the renderer
 * alone may be taken and no time is requested; three times for a budget of which all that takes a
 * tenth at the most. Then every point has a promised error and time for this scene: for max_error
 * the fastest that keeps it is taken, for budget_ms the most accurate, by name one of the Pareto
 * front that is left: the cheapest for draft, the cheapest whose error is at most 2 % above the
 * least for accurate, for balanced where the front between them bends most. Where no point keeps
 * the bound, the nearest is taken. The request's texts and `out` outlive the choice's point.
 * ABBE_INVALID_ARGUMENT where nothing is requested, ABBE_NOT_FOUND where no point is left; errors
 * of abbe_picture_front_load and abbe_trace_times_measure. */
abbe_result abbe_picture_choose(const abbe_picture_request *request, const abbe_scene *scene,
                                abbe_picture_choice *out, abbe_error *error);

/* ABBE_TOLERANCE where a process of that time does not keep the bound that was requested. Where
 * passes estimate the picture's error these decide, whatever was promised. */
abbe_result abbe_picture_choice_check(const abbe_picture_choice *choice, double ms,
                                      abbe_error *error);

/* Whether passes have estimated the picture's error. */
bool abbe_picture_choice_tells(const abbe_picture_choice *choice);
/* "about 1.6 (at most 1.9), told by ...; expected were 2", or "2, expected (not checked: ...)".
 */
void abbe_picture_choice_say_error(const abbe_picture_choice *choice, char *out, size_t size);
/* What the tracer and two passes of so many photons take at the most, s, by the yardstick; NaN
 * without one. */
double abbe_picture_choice_pass_s(const abbe_picture_choice *choice, size_t photons);

/* The request of a point of the renderer; size and space are left 0. */
abbe_render_desc abbe_picture_point_desc(const abbe_picture_point *point);

/* "the renderer: 7 wavelengths, ..." or "the tracer: 4 passes of 262144 photons, filtered". */
void abbe_picture_describe(const abbe_picture_point *point, char *out, size_t size);

/* Among costs and errors, those that no other beats in both; and what to pick of them.
 *
 * The Pareto front of settings that cost time and make errors. It knows no settings: arrays in,
 * flags and indices out. A cost or an error that is not finite, and a cost that is not positive,
 * is not on the front. */

/* Finds the points that no other beats, as indices in the order of cost (and so of falling
 * error): none has at most their cost and at most their error, and less of one. Of equal points it
 * is the first. Returns how many; order[count] has room. */
size_t abbe_pareto_front_order(const double *cost, const double *error, size_t count,
                               size_t *order);

/* Where a front in that order, given by its costs and errors, bends most: the point furthest below
 * the straight line between its ends in logarithms (an error of 0 counts as 1e-12). Without a bend,
 * or with fewer than three points, the middle one: count
 * 2. */
size_t abbe_pareto_front_knee(const double *cost, const double *error, size_t count);

/* The cheapest point of such a front whose error is at most 1 + slack times the least there is. */
size_t abbe_pareto_front_accurate(const double *error, size_t count, double slack);

#endif
