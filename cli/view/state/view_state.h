/* view_state.h: the viewer without its window: pointer, keys and edits in, changes of the document
 * and jobs out.
 *
 * Pointers are in pixels of the picture, from its upper left corner; times in s, ever growing. It
 * draws nothing and reads no files. The left button turns the camera around its target, on a handle
 * it moves the light or the object; a click requests a pixel's spectrum. The middle button, or
 * the left one with shift, pans, the right one looks about, and while it is down w, a, s, d, q and
 * e fly. Shift makes a handle move upright, control tilts an object, g drops the one that was held
 * last. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_STATE_H
#define ABBE_CLI_VIEW_STATE_VIEW_STATE_H

#include "cli/view/state/view_document.h"
#include "cli/view/state/view_outline.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What is drawn next, and by which of two workers: the cheapest picture while things
 * move, ever better ones when they rest.
 *
 * A state machine: changes, times and finished jobs in, jobs out. It draws nothing, knows no scene
 * and no settings, only their order. One worker shows: it draws what moves, with the best light
 * that it has, and at rest no more than what its light and programs are there for. The other one
 * makes the next better stage, which may have to wait for the driver's compiler. When that one is
 * the better to show, because its light is better and it has drawn moving pictures with it once,
 * the two change their parts. So motion waits neither for the compiler nor for a stage.
 *
 * Moving, a job takes the steps that cli/view/state/view_state.h finds; after ABBE_VIEW_REST_S
 * without a change the stages follow each other up to the last. A change makes any stage but a
 * moving one obsolete at once: a moving one is nearly done, and what it shows is newer than what
 * stands. */

/* How coarse the next moving picture is, by what the last ones took.
 *
 * A table of times: of each step of the light and of the camera that was drawn, what its pictures
 * took last. What was not drawn yet is guessed by its share of the work, so that one picture that
 * is too slow leads to one that is not, and steps that save nothing are left again: where a
 * picture takes as long however few its photons and samples are, it has all of them. */

/* From one picture to the next. An event waits for the one in the making and for its own, so no
 * longer than 60 ms. */
#define ABBE_VIEW_MOVING_MS 29.0
#define ABBE_VIEW_EYE_STEPS 4   /* 0: a sample a pixel, then one for 2 x 2, 3 x 3, 4 x 4 */
#define ABBE_VIEW_LIGHT_STEPS 4 /* 0: the draft's photons, then half as many each */

/* Zeroed: nothing is known. */
typedef struct abbe_view_pace {
  size_t light_step, eye_step; /* to be tried next */
  size_t lights;  /* steps of the light that can be drawn, the finest first; 0: all can */
  double ms;      /* time of the last picture that counts; 0: there is none */
  size_t in_time; /* pictures in turn that kept the time */
  bool strange;   /* the last one does not: nothing follows from one alone */
  /* times of pictures whose light was drawn, and of those whose light was kept; 0: not known */
  double lit_ms[ABBE_VIEW_LIGHT_STEPS][ABBE_VIEW_EYE_STEPS], kept_ms[ABBE_VIEW_EYE_STEPS];
} abbe_view_pace;

/* A picture of these steps took so long; lit: its light was drawn for it. One that took many times
 * as long as the one before has compiled programs, which does not last. */
void abbe_view_pace_take(abbe_view_pace *pace, size_t light_step, size_t eye_step, bool lit,
                         double ms);

/* X(code, name, what the window calls it) */
#define ABBE_VIEW_STAGES(X)                                                                        \
  X(NONE, "none", "loading")                                                                       \
  X(MOVING, "moving", "preview")                                                                   \
  X(BALANCED, "balanced", "good")                                                                  \
  X(ACCURATE, "accurate", "better")                                                                \
  X(MEAN, "mean", "best")                                                                          \
  X(TRACED, "traced", "checked by tracing")
typedef enum abbe_view_stage {
#define ABBE_VIEW_ENUM(code, name, word) ABBE_VIEW_##code,
  ABBE_VIEW_STAGES(ABBE_VIEW_ENUM)
#undef ABBE_VIEW_ENUM
      ABBE_VIEW_STAGE_COUNT
} abbe_view_stage;
const char *abbe_view_stage_name(abbe_view_stage stage);
const char *abbe_view_stage_word(abbe_view_stage stage);

#define ABBE_VIEW_REST_S 0.15
#define ABBE_VIEW_TRACED_PASSES 64

/* What a change leaves as it was. */
typedef enum abbe_view_change {
  ABBE_VIEW_MOVED_CAMERA,  /* the light's passes hold */
  ABBE_VIEW_CHANGED_LIGHT, /* programs that draw do */
  ABBE_VIEW_CHANGED_SCENE  /* nothing does */
} abbe_view_change;

typedef struct abbe_view_job {
  abbe_view_stage stage;
  uint64_t serial;       /* number of the change that it shows */
  abbe_view_stage light; /* the stage whose photons, map and wavelengths it takes */
  size_t light_step;     /* for a moving light */
  size_t eye_step;       /* for a moving picture */
  size_t pass;           /* traced: how many passes there are before it */
  bool warms;            /* a moving picture for its programs' sake, which is not shown */
} abbe_view_job;

typedef enum abbe_view_outcome {
  ABBE_VIEW_DONE,
  ABBE_VIEW_CANCELLED,
  ABBE_VIEW_LOST,   /* so, and what it had drawn before is lost */
  ABBE_VIEW_REFUSED /* the scene cannot be drawn so; nothing is tried until the next change */
} abbe_view_outcome;

enum { ABBE_VIEW_WORKERS = 2 };

typedef struct abbe_view_hand {
  bool busy;
  abbe_view_job job;     /* while it is busy */
  abbe_view_stage light; /* that it holds for this scene; NONE: none */
  size_t light_step;     /* light step of that */
  /* for its programs: */
  unsigned ready;        /* it has drawn moving pictures with such lights, a bit each, */
  abbe_view_stage moved; /* with this one last; */
  abbe_view_stage rests; /* and this stage with the light that it holds, whatever the camera */
} abbe_view_hand;

typedef struct abbe_view_refine {
  abbe_view_stage last; /* wanted; NONE: TRACED */
  bool spectrum;        /* wanted: the mean is left out, for traced passes give it */
  bool single;          /* no picture could be another: there is no mean */
  bool held;            /* a button is down: it moves */
  uint64_t serial,
      shown;      /* numbers of the last change, and of the one that the last picture shows */
  uint64_t scene; /* number of the last change that left no light */
  double changed_s;
  abbe_view_stage stage; /* stage of the picture that shows serial; NONE: an older one stands */
  size_t passes;         /* traced */
  abbe_view_pace pace;   /* pace of moving pictures */
  bool refused;
  size_t shows; /* the worker that draws what moves */
  size_t made;  /* the one that has drawn the last stage up to ACCURATE */
  abbe_view_hand hand[ABBE_VIEW_WORKERS];
} abbe_view_refine;

void abbe_view_refine_begin(abbe_view_refine *refine);
void abbe_view_refine_change(abbe_view_refine *refine, abbe_view_change change, double now_s);
void abbe_view_refine_hold(abbe_view_refine *refine, bool held, double now_s);

/* What a worker that is not busy does next; false: nothing yet. */
bool abbe_view_refine_next(const abbe_view_refine *refine, size_t worker, double now_s,
                           abbe_view_job *out);
/* It has begun that. */
void abbe_view_refine_take(abbe_view_refine *refine, size_t worker, const abbe_view_job *job);
/* When next may have another answer for any worker, s from now on; below 0: after the next event.
 */
double abbe_view_refine_wait(const abbe_view_refine *refine, double now_s);
/* Whether what a worker does is to stop. */
bool abbe_view_refine_cancels(const abbe_view_refine *refine, size_t worker);
/* What came of its job, and how long it took since the picture before, where that moved too; and of
 * that the worker's own thread, which reads, plans and compiles. Whether its picture is to be
 * shown.
 */
bool abbe_view_refine_end(abbe_view_refine *refine, size_t worker, abbe_view_outcome outcome,
                          double ms, double own_ms);
/* A worker has drawn what was no job of these: what it holds is not known any more. */
void abbe_view_refine_forget(abbe_view_refine *refine, size_t worker);

#define ABBE_VIEW_HANDLE_PIXELS 14.0

typedef enum abbe_view_button {
  ABBE_VIEW_LEFT,
  ABBE_VIEW_RIGHT,
  ABBE_VIEW_MIDDLE,
  ABBE_VIEW_BUTTON_COUNT
} abbe_view_button;
enum { ABBE_VIEW_SHIFT = 1, ABBE_VIEW_CONTROL = 2 }; /* keys that are down beside a button */

typedef enum abbe_view_handle_kind {
  ABBE_VIEW_NO_HANDLE,
  ABBE_VIEW_LIGHT_HANDLE,
  ABBE_VIEW_OBJECT_HANDLE
} abbe_view_handle_kind;

/* Where something can be taken hold of. */
typedef struct abbe_view_handle {
  abbe_view_handle_kind kind;
  size_t index; /* index of the outline's light or object */
  double xy[2];
} abbe_view_handle;

/* X(code, name) */
#define ABBE_VIEW_SHOWN(X)                                                                         \
  X(RENDERED_PICTURE, "rendered")                                                                  \
  X(TRACED_PICTURE, "traced")                                                                      \
  X(DIFFERENCE_PICTURE, "rendered less traced")                                                    \
  X(ERROR_PICTURE, "estimated error")                                                              \
  X(CAUSTIC_PICTURE, "caustic alone")                                                              \
  X(DIRECT_PICTURE, "direct light alone")                                                          \
  X(LUMINANCE_PICTURE, "luminance in false colours")                                               \
  X(DISTANCE_PICTURE, "distance from the eye")                                                     \
  X(MAP_PICTURE, "spectral map")
typedef enum abbe_view_shown {
#define ABBE_VIEW_ENUM(code, name) ABBE_VIEW_##code,
  ABBE_VIEW_SHOWN(ABBE_VIEW_ENUM)
#undef ABBE_VIEW_ENUM
      ABBE_VIEW_SHOWN_COUNT
} abbe_view_shown;

typedef struct abbe_view_state {
  abbe_view_history history;
  abbe_view_refine refine;
  abbe_view_outline outline; /* zeroed before the first picture */
  abbe_camera camera;        /* as it is led, */
  abbe_camera pictured;      /* and that of the picture that stands; zeroed: there is none */
  size_t width, height;      /* size of the picture, pixels */
  bool down[ABBE_VIEW_BUTTON_COUNT];
  double from[2], at[2];   /* places of the pointer: where a button went down; now */
  bool dragged, continued; /* the pointer has left that place; the step is begun */
  uint64_t turned;         /* the change that was the wheel's last turn */
  int modifiers;
  abbe_view_handle held, was_held; /* now; last, an object or none yet */
  double held_point[3];            /* where it stood when it was taken, */
  double pulled[3];                /* and stands in the last scene that was learnt since */
  double fly[3];                   /* right, up, forward: -1, 0 or 1 */
  bool picked;                     /* a pixel is: */
  size_t pixel[2];
  abbe_view_shown shown;
  double exposure;    /* stops */
  char refusal[1024]; /* why the last change cannot be drawn; "": it can */
} abbe_view_state;

/* The document is copied. ABBE_NO_MEMORY. */
abbe_result abbe_view_state_begin(abbe_view_state *state, const abbe_view_document *document,
                                  abbe_error *error);
void abbe_view_state_free(abbe_view_state *state);

/* The scene as a job has found it, which may be that of an older change than the newest; the
 * outline is taken over, or freed while something is pulled. */
void abbe_view_state_learn(abbe_view_state *state, abbe_view_outline *outline, bool newest);
/* A picture with that camera stands now. */
void abbe_view_state_picture(abbe_view_state *state, const abbe_camera *camera);

void abbe_view_state_press(abbe_view_state *state, abbe_view_button button, double x, double y,
                           int modifiers, double now_s);
void abbe_view_state_move(abbe_view_state *state, double x, double y, double now_s);
void abbe_view_state_release(abbe_view_state *state, abbe_view_button button, double now_s);
void abbe_view_state_wheel(abbe_view_state *state, double clicks, double now_s);
/* A key by its character, lower case; 'z' and 'y' with control: back and forth. False: it means
 * nothing. */
bool abbe_view_state_key(abbe_view_state *state, int key, bool down, int modifiers, double now_s);
/* Flies on by so many seconds. */
void abbe_view_state_tick(abbe_view_state *state, double seconds, double now_s);

/* A value of the scene, as a slider or a picker sets it; `continued`: as the one before. */
void abbe_view_state_set(abbe_view_state *state, const char *key, const char *value, bool continued,
                         double now_s);
/* Wavelengths, photons and the map's side; 0: by the stage. */
void abbe_view_state_settings(abbe_view_state *state, size_t wavelengths, size_t photons,
                              size_t map_size, bool continued, double now_s);
/* Another scene file, as a step; or the same once more as it is now on disk. */
void abbe_view_state_open(abbe_view_state *state, const char *path, double now_s);
void abbe_view_state_reload(abbe_view_state *state, double now_s);
bool abbe_view_state_undo(abbe_view_state *state, double now_s);
bool abbe_view_state_redo(abbe_view_state *state, double now_s);
void abbe_view_state_resize(abbe_view_state *state, size_t width, size_t height, double now_s);

/* The handle under a place, or one of kind NO_HANDLE. */
abbe_view_handle abbe_view_state_handle_at(const abbe_view_state *state, double x, double y);
/* Handle `i` of those in the picture that stands; false past the last. */
bool abbe_view_state_handle(const abbe_view_state *state, size_t i, abbe_view_handle *out);

#endif
