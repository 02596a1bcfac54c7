/* view_refine.h: what is drawn next: the cheapest picture while things move, ever better ones when
 * they rest.
 *
 * A state machine: changes, times and finished jobs in, jobs out. It draws nothing, knows no scene
 * and no settings, only their order. Moving, a job takes the steps that cli/view/state/view_pace.h
 * finds; after
 * ABBE_VIEW_REST_S without a change the stages follow each other up to the last. A change makes any
 * stage but a moving one obsolete at once: a moving one is nearly done, and what it shows is newer
 * than what stands. A stage that would have to wait for the compiler ends, and waits itself until
 * that is done beside it.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_REFINE_H
#define ABBE_CLI_VIEW_STATE_VIEW_REFINE_H

#include "cli/view/state/view_pace.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* X(code, name) */
#define ABBE_VIEW_STAGES(X)                                                                        \
  X(NONE, "none")                                                                                  \
  X(MOVING, "moving")                                                                              \
  X(BALANCED, "balanced")                                                                          \
  X(ACCURATE, "accurate")                                                                          \
  X(MEAN, "mean")                                                                                  \
  X(TRACED, "traced")
typedef enum abbe_view_stage {
#define ABBE_VIEW_ENUM(code, name) ABBE_VIEW_##code,
  ABBE_VIEW_STAGES(ABBE_VIEW_ENUM)
#undef ABBE_VIEW_ENUM
      ABBE_VIEW_STAGE_COUNT
} abbe_view_stage;
const char *abbe_view_stage_name(abbe_view_stage stage);

#define ABBE_VIEW_REST_S 0.15
#define ABBE_VIEW_TRACED_PASSES 64

/* What a change leaves as it was. */
typedef enum abbe_view_change {
  ABBE_VIEW_MOVED_CAMERA, /* the light's passes hold */
  ABBE_VIEW_CHANGED_SCENE /* nothing does */
} abbe_view_change;

typedef struct abbe_view_job {
  abbe_view_stage stage;
  uint64_t serial;       /* of the change that it shows */
  abbe_view_stage light; /* the stage whose photons, map and wavelengths it takes */
  size_t light_step;     /* of a moving light */
  size_t eye_step;       /* of a moving picture */
  size_t pass;           /* traced: how many passes there are before it */
  bool compiles;         /* itself what is not compiled; else it ends with ABBE_VIEW_UNCOMPILED */
} abbe_view_job;

typedef enum abbe_view_outcome {
  ABBE_VIEW_DONE,
  ABBE_VIEW_CANCELLED,
  ABBE_VIEW_UNCOMPILED, /* the driver does not know what it draws with */
  ABBE_VIEW_REFUSED     /* the scene cannot be drawn so; nothing is tried until the next change */
} abbe_view_outcome;

typedef struct abbe_view_refine {
  abbe_view_stage last;   /* wanted; NONE: TRACED */
  bool spectrum;          /* wanted: the mean is left out, for traced passes tell it */
  bool single;            /* no picture could be another: there is no mean */
  bool held;              /* a button is down: it moves */
  uint64_t serial, shown; /* of the last change; of what the last picture shows */
  double changed_s;
  abbe_view_stage stage;   /* of the picture that shows serial; NONE: an older one stands */
  size_t passes;           /* traced */
  abbe_view_stage light;   /* whose light is drawn for this scene; NONE: none */
  size_t drawn_light_step; /* of the light that is drawn */
  abbe_view_pace pace;     /* of moving pictures */
  bool camera_only;        /* all that has changed since the last picture */
  bool ahead;              /* somebody compiles beside what is drawn: */
  bool compiling;          /* they do, and no stage at rest begins; */
  bool compiled;           /* they have, and the next one does itself what is left */
  bool refused;
} abbe_view_refine;

void abbe_view_refine_begin(abbe_view_refine *refine);
void abbe_view_refine_change(abbe_view_refine *refine, abbe_view_change change, double now_s);
void abbe_view_refine_hold(abbe_view_refine *refine, bool held, double now_s);

/* What to do next, where nothing is being done; false: nothing yet. */
bool abbe_view_refine_next(const abbe_view_refine *refine, double now_s, abbe_view_job *out);
/* When next may have another answer, s from now on; below 0: after the next event. */
double abbe_view_refine_wait(const abbe_view_refine *refine, double now_s);
/* Whether a job that is being done is to stop. */
bool abbe_view_refine_cancels(const abbe_view_refine *refine, const abbe_view_job *job);
/* Whoever compiles is done, or there is nobody. */
void abbe_view_refine_compiled(abbe_view_refine *refine, bool ahead);
/* What came of a job, and how long it took. */
void abbe_view_refine_end(abbe_view_refine *refine, const abbe_view_job *job,
                          abbe_view_outcome outcome, double ms, double now_s);

#endif
