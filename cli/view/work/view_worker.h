/* view_worker.h: a thread that draws and traces: a job in, a picture out. The viewer has two.
 *
 * It has a context, a renderer and a tracer of its own, and loads the scene by itself, so that
 * whoever watches never waits, nor another worker. One job at a time; what it makes is handed over
 * whole. It decides nothing: which job is next, and whether one is to stop, is
 * cli/view/state/view_state.h's business. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_WORK_VIEW_WORKER_H
#define ABBE_CLI_VIEW_WORK_VIEW_WORKER_H

#include "cli/view/picture/view_feed.h"
#include "cli/view/state/view_document.h"
#include "cli/view/state/view_state.h"
#include "cli/view/work/view_scene.h"
#include "colorimetry/image/image.h"
#include "gl/accuracy/error_bars.h"
#include "gl/accuracy/preset.h"
#include "gl/device/statistics.h"
#include "gl/plan/plan.h"

#define ABBE_VIEW_BANDS 40                         /* bands of a traced pixel's spectrum */
#define ABBE_VIEW_BANDS_PIXELS ((size_t)640 * 640) /* more pixels have fewer bands */

typedef struct abbe_view_request {
  abbe_view_job job;
  abbe_view_document document; /* the request's own */
  size_t edition;              /* another one than of the last request: the files anew */
  size_t width, height;
  bool asks;                   /* no picture, but what feeds this place: */
  double point[3], radius, nm; /* its colour's wavelength */
  bool lit;                    /* the picture shows a caustic there: photons are looked for until
                                  some are found */
  bool maps;                   /* no picture, but the spectral map */
  bool tells;                  /* no picture, but the spectrum of this pixel */
  size_t pixel[2];             /* the picked one, which is requested and reported */
  bool turns;                  /* the picture, seen from elsewhere: */
  double turn_rad;
} abbe_view_request;

typedef struct abbe_view_line {
  char name[64], reason[224];
  bool runs, kept;
  double ms; /* below 0: it did not run in this picture */
} abbe_view_line;

/* What came of a request; zeroed parts were not made. */
typedef struct abbe_view_result {
  abbe_view_job job;
  abbe_view_outcome outcome;
  char sentence[1024];
  size_t width, height;
  double ms, ended_s; /* how long it took; when it ended, by base/clock.h */
  double own_ms;      /* processor time of the worker's own thread, where drivers compile */
  abbe_image picture; /* rendered: R, G, B, and at rest direct.* and caustic.* */
  abbe_image traced;  /* R, G, B, stderr.*, bands */
  abbe_view_scene_news news;
  abbe_render_desc asked; /* request of a rendered picture; the rest was left to the plan: */
  abbe_render_desc desc;  /* as the plan has it; photons and map_size 0: none are followed */
  size_t line_count;
  abbe_view_line *line; /* lines of the plan */
  bool counted;         /* the statistics are there */
  abbe_statistics statistics;
  double promised;      /* mean CIEDE2000 in the caustic, by the presets; 0: nothing promised */
  abbe_error_bars bars; /* error bars of the stage `mean`; its pictures too */
  size_t passes;        /* traced */
  bool turned;          /* it is a frame of the turntable */
  bool looked;          /* for one of these alone */
  bool asks, tells;     /* what feeds this pixel, its spectrum */
  size_t pixel[2];
  abbe_image map;       /* zeroed: there is none */
  abbe_view_spot spot;  /* the spectrum of the requested pixel */
  abbe_view_feed *feed; /* NULL: the last picture drawn is not of this scene any more */
} abbe_view_result;
void abbe_view_result_free(abbe_view_result *result);

typedef struct abbe_view_worker abbe_view_worker;

/* Starts the thread, which makes its context when it has a first picture to draw; where it cannot,
 * that is refused. volume (may be NULL): caustics are looked up in it, which stays where it is.
 * wake (may be NULL) is called on it whenever a result is there. ABBE_NO_MEMORY. */
abbe_result abbe_view_worker_make(const char *materials, const abbe_caustic_volume *volume,
                                  void (*wake)(void), abbe_view_worker **out, abbe_error *error);
/* Cancels what is being done and ends the thread. */
void abbe_view_worker_free(abbe_view_worker *worker);

/* Whether a request may be given. */
bool abbe_view_worker_idle(abbe_view_worker *worker);
/* The share of the picture that is done, 0 to 1. */
double abbe_view_worker_done(const abbe_view_worker *worker);
/* Takes the request over; only while idle. */
void abbe_view_worker_give(abbe_view_worker *worker, abbe_view_request *request);
/* What is being done ends soon, with ABBE_VIEW_CANCELLED. */
void abbe_view_worker_cancel(abbe_view_worker *worker);
/* Waits until what was given is done, at most so long. */
void abbe_view_worker_wait(abbe_view_worker *worker, double seconds);
/* The result, once; the caller frees it. False: none yet. */
bool abbe_view_worker_take(abbe_view_worker *worker, abbe_view_result *out);

/* What a stage of the viewer requests of the renderer.
 *
 * Its settings are a preset's, coarser or finer as the job requires. It draws nothing and knows no
 * worker; a picture's size is its caller's. */

/* The preset that a stage takes; NULL where the front has none. */
const abbe_preset_point *abbe_view_settings_point(const abbe_preset_front *front,
                                                  abbe_view_stage stage);

/* The request of a job. Without a preset, the plan's own settings and what is coarser and finer
 * than these. document: its wavelengths, photons and texels hold but where light moves. volume (may
 * be NULL): caustics are looked up in it, which lives as long as the request. */
abbe_render_desc abbe_view_settings_of(const abbe_preset_front *front, const abbe_scene *scene,
                                       const abbe_view_job *job, const abbe_view_document *document,
                                       const abbe_caustic_volume *volume);

#endif
