/* frame_times.h: how long a renderer's frames take: the median of several, after one that warms up.
 */
#ifndef ABBE_GL_ACCURACY_FRAME_TIMES_H
#define ABBE_GL_ACCURACY_FRAME_TIMES_H

#include "gl/renderer.h"

#define ABBE_FRAME_TIMES_MAX 1000
/* On a quiet machine the median of repeats takes at most that much longer than the fastest, as a
 * share of it. */
#define ABBE_FRAME_TIMES_QUIET 0.15

typedef struct abbe_frame_times_desc {
  size_t frames; /* behind the median, at most ABBE_FRAME_TIMES_MAX; 0: 5 */
  double
      enough_ms; /* slow frames vary less: three suffice where they took more; 0: all are drawn */
  abbe_render_progress progress; /* asked before every frame; may be NULL */
  void *user;
} abbe_frame_times_desc;

typedef struct abbe_frame_times {
  abbe_statistics median; /* statistics of the frame in the middle */
  double fastest_ms;
} abbe_frame_times;

/* How much longer a median takes than the fastest, as a share of that: a sign of a busy machine.
 * NaN where either is not known. */
double abbe_frame_times_unrest(double median_ms, double fastest_ms);
/* "the machine is busy: ..." for more than ABBE_FRAME_TIMES_QUIET, after `before`; else "". */
void abbe_frame_times_say_unrest(double unrest, const char *before, char *out, size_t size);

/* ABBE_CANCELLED where progress says stop; errors of abbe_renderer_frame. */
abbe_result abbe_frame_times_measure(abbe_renderer *renderer, const abbe_frame_times_desc *desc,
                                     abbe_frame_times *out, abbe_error *error);

/* The median of `count` (1 to 16) times of drawing the surfaces alone, which the default profile
 * knows. */
abbe_result abbe_frame_times_baseline(abbe_renderer *renderer, size_t count, double *ms,
                                      abbe_error *error);

/* The median of `count` (1 to 16) times of a frame after the camera has moved a little, the change
 * with it, ms: `scene` and `desc` are the renderer's. It ends with the camera where it was. Errors
 * of abbe_renderer_change and abbe_renderer_frame. */
abbe_result abbe_frame_times_camera(abbe_renderer *renderer, const abbe_scene *scene,
                                    const abbe_render_desc *desc, size_t count, double *ms,
                                    abbe_error *error);

#endif
