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
#include "cli/view/state/view_refine.h"

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
