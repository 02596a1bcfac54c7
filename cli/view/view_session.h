/* view_session.h: what a running viewer holds: its state, its pictures, what is known of them.
 *
 * cli/view/view_app.h leads it; panel and scripts look into it. Internal to cli/view/.
 */
#ifndef ABBE_CLI_VIEW_VIEW_SESSION_H
#define ABBE_CLI_VIEW_VIEW_SESSION_H

#include "cli/view/inspect/inspect.h"
#include "cli/view/picture/view_show.h"
#include "cli/view/widgets/view_ui.h"
#include "cli/view/work/view_scene.h"
#include "cli/view/work/view_worker.h"

#include <pthread.h>
#include <sys/types.h>

#define ABBE_VIEW_PANEL_WIDTH 340
#define ABBE_VIEW_MOST_SCENES 64
#define ABBE_VIEW_TIMED 256

/* A worker, and what it was given. */
typedef struct abbe_view_desk {
  abbe_view_worker *worker;
  uint64_t serial; /* number of what it does, */
  bool other;      /* which is no job of cli/view/state/view_state.h: a look, a turntable's frame */
  bool asked;      /* about this pixel: */
  size_t pixel[2];
  abbe_camera camera; /* as it was led to then */
  double stopped_s;   /* when it was cancelled; below 0: it was not */
  double ended_s;     /* when it had drawn its last moving picture, */
  double waited_ms;   /* and how long it had waited for the next one to be wanted */
} abbe_view_desk;

typedef struct abbe_view_listener abbe_view_listener;

/* Pictures that are looked at, and by which hand. */
typedef struct abbe_view_inspection {
  abbe_inspect *pictures;       /* NULL: a scene is shown instead */
  abbe_view_listener *listener; /* of other pictures; or NULL */
  size_t received;              /* packets of them */
  bool more;                    /* some may wait */
  bool reading;                 /* large pictures are not whole yet */
  abbe_inspect_look look;       /* as it is wished, of picture `at`; */
  size_t at;
  bool stale, whole; /* it is not shown yet; no tile is missing */
  const abbe_illuminant
      *given[2];           /* on the command line: light of the scene, and another; or NULL */
  abbe_illuminant made[2]; /* those that were chosen instead */
  int held;                /* 1: the pointer marks a region, 2: it moves the picture; 0: neither */
  double pressed[2];       /* where that began */
  bool picked;
  size_t window[4];            /* the region, x0, y0, x1, y1 */
  abbe_inspect_probe probe[2]; /* of the picture and of the other one */
  unsigned char *pixels;       /* of the window, */
  size_t size[2];              /* so many */
} abbe_view_inspection;
enum { ABBE_VIEW_MOST_JUDGED = 4, ABBE_VIEW_JUDGED_LONGEST = 4096 };
enum { ABBE_VIEW_SLOPES = 3, ABBE_VIEW_FACE = 24 };
enum { ABBE_VIEW_RETURN, ABBE_VIEW_ISO, ABBE_VIEW_WINDOW, ABBE_VIEW_JUDGED_NUMBERS };

/* A design as light judges it. */
typedef struct abbe_view_judged {
  char key[ABBE_VIEW_KEY];                /* of its object */
  char request[ABBE_VIEW_JUDGED_LONGEST]; /* what was judged */
  size_t side;                            /* pixels a side; 0: nothing was */
  double value[ABBE_VIEW_JUDGED_NUMBERS]; /* shares of 1, and standard errors; NaN: cannot be */
  double error[ABBE_VIEW_JUDGED_NUMBERS];
  /* By a degree of the crown's and of the pavilion's slider: light return, ISO, fire; NaN: not
   * known. And what a degree more adds to the light return from place to place. */
  double slope[2][ABBE_VIEW_SLOPES], slope_error[2][ABBE_VIEW_SLOPES];
  float change[2][ABBE_VIEW_FACE * ABBE_VIEW_FACE];
} abbe_view_judged;

typedef struct abbe_view_judge {
  pthread_t thread; /* while begun: makes */
  bool begun;
  volatile int done;
  size_t place; /* index of judged[] that it is for */
  abbe_view_judged made;
  void (*wake)(void);
} abbe_view_judge;

typedef struct abbe_view_session {
  abbe_view_inspection inspection;
  abbe_view_state state;
  abbe_view_desk desk[ABBE_VIEW_WORKERS];
  const abbe_gl *gl;
  const char *keep, *ocio, *materials, *volume_path;
  char elsewhere[512]; /* folder of what is kept, with its slash; "": the current one */
  const abbe_caustic_volume *volume;
  abbe_display *display;
  abbe_view_table *table; /* its table, from the first picture on; or NULL */
  char *views;            /* lines "display / view" */
  size_t view;            /* index of these */
  char *scene[ABBE_VIEW_MOST_SCENES];
  size_t scene_count;
  size_t edition; /* edition of the files: how often they have changed */
  abbe_view_pictures pictures;
  abbe_view_result taken;     /* while it is looked at */
  abbe_view_result last;      /* result of the last rendered picture: plan, statistics, settings */
  abbe_view_stage stage;      /* stage of the picture that stands */
  abbe_view_job moved;        /* job of the last picture of the stage `moving`, */
  abbe_render_desc moving;    /* and its settings */
  double promised, estimated; /* mean CIEDE2000 in the caustic; 0: not known */
  double against; /* root mean square of rendered less traced, over the mean; 0: not known */
  double noise;   /* noise of the traced picture alone, the same */
  size_t passes;  /* behind the traced picture */
  abbe_view_painter *painter; /* painter of what rests */
  abbe_view_screen screen;
  bool stale;            /* the screen */
  abbe_view_shown drawn; /* what it shows */
  double drawn_exposure;
  abbe_view_probe probe;
  abbe_view_feed *feed; /* the light that reaches the pixel; NULL: not known */
  uint64_t fed_serial;  /* number of what was requested last, and its pixel */
  size_t fed_pixel[2];
  abbe_view_spot spot;  /* the pixel's spectrum, until the traced picture has it; */
  uint64_t spot_serial; /* number of what was requested last, and its pixel */
  size_t spot_pixel[2];
  uint64_t mapped_serial; /* number of the map that was requested last, */
  abbe_view_stage mapped; /* and at which stage */
  abbe_ui_input input;    /* input of the frame before */
  double area[2];         /* size of the picture in the window */
  double first_s;         /* from the program's start to its first picture; 0: there is none */
  double seen_s, frames_ms[32]; /* times between pictures while something moves */
  size_t frame_count;
  double own_ms; /* the most that a worker's own thread has worked for one of these */
  double event_s[ABBE_VIEW_TIMED]; /* times of changes by pointer, by their number; 0: another
                                      change */
  uint64_t pictured;               /* the last change that a picture has shown, */
  double latency_ms;               /* and from the first one that it showed to it */
  uint64_t obsolete;               /* the last change that ended a rest; 0: it is shown */
  double obsolete_s, cancel_ms;    /* when it came; and how long until a picture showed it, */
  double stop_ms; /* what was made for the one before took to stop; the last times */
  abbe_view_judge judge;
  abbe_view_judged judged[ABBE_VIEW_MOST_JUDGED];
  const abbe_view_judged *hinted; /* while the pointer is over a slider of its: */
  int hinted_side;                /* the crown's, 0, or the pavilion's */
  bool reports;                   /* a report is made */
  pid_t reporter;                 /* by it */
  size_t turn_frame;              /* frame of the turntable, from 1; 0: it stands */
  uint64_t turn_serial;           /* what it turns */
  bool keys;                      /* the list of keys is open */
  bool exposed;                   /* the scene's own exposure was taken over */
  bool turned;                    /* the last one is whole */
  char note[1200];                /* what was saved, or why not */
  abbe_view_files files;          /* files of the scene */
  double looked_s;
} abbe_view_session;

/* Lists the scenes beside the one of that path, sorted: at most ABBE_VIEW_MOST_SCENES. */
void abbe_view_session_list_scenes(abbe_view_session *session, const char *path);
/* A line of the list of displays and views, as a display without a source; the texts are names'. */
typedef struct abbe_view_names {
  char display[128], view[128];
} abbe_view_names;
abbe_display_desc abbe_view_session_display(const abbe_view_session *session, size_t view,
                                            abbe_view_names *names);
/* Another line of the list of displays and views; ABBE_COLOUR where it is broken. */
abbe_result abbe_view_session_choose_view(abbe_view_session *session, size_t view,
                                          abbe_error *error);
/* The first one: of what is encoded for a screen, Plain. */
abbe_result abbe_view_session_begin_view(abbe_view_session *session, bool encoded,
                                         abbe_error *error);
/* Pictures a second while something moves, of the last ones; 0: nothing has moved. */
double abbe_view_session_rate(const abbe_view_session *session);
/* A value by its name, for scripts (docs/view.md lists them), or what a key was set to. False:
 * there is none. */
bool abbe_view_session_value(const abbe_view_session *session, const char *name, char *out,
                             size_t size);
/* The same of pictures that are looked at. */
bool abbe_view_inspect_value(const abbe_view_session *session, const char *name, char *out,
                             size_t size);
/* What feeds the pixel that is picked, where that is known; else NULL. */
const abbe_view_feed *abbe_view_session_feed(const abbe_view_session *session);
/* How far the rendered picture is from the traced one, and how sure that is, over the mean. The
 * errors of the three channels are taken as one. */
void abbe_view_session_compare(abbe_view_session *session);

#endif
