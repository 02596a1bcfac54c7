/* frame_times.h: how long a renderer's frames take: the median of several, after one that warms up.
 */
#ifndef ABBE_GL_ACCURACY_FRAME_TIMES_H
#define ABBE_GL_ACCURACY_FRAME_TIMES_H

#include "gl/renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_FRAME_TIMES_MAX 1000

typedef struct abbe_frame_times_desc {
  size_t frames; /* behind the median, at most ABBE_FRAME_TIMES_MAX; 0: 5 */
  double
      enough_ms; /* slow frames vary less: three suffice where they took more; 0: all are drawn */
  abbe_render_progress progress; /* asked before every frame; may be NULL */
  void *user;
} abbe_frame_times_desc;

typedef struct abbe_frame_times {
  abbe_statistics median; /* of the frame in the middle */
  double fastest_ms;
} abbe_frame_times;

/* ABBE_CANCELLED where progress says stop; errors of abbe_renderer_frame. */
abbe_result abbe_frame_times_measure(abbe_renderer *renderer, const abbe_frame_times_desc *desc,
                                     abbe_frame_times *out, abbe_error *error);

/* The median of `count` (1 to 16) times of drawing the surfaces alone, which the default profile
 * knows. */
abbe_result abbe_frame_times_baseline(abbe_renderer *renderer, size_t count, double *ms,
                                      abbe_error *error);

/* The median of `count` (1 to 16) times of a frame after the camera has moved a little, the change
 * with it, ms: `scene` and `desc` are the renderer's. It ends with the camera where it was. Errors of
 * abbe_renderer_change and abbe_renderer_frame. */
abbe_result abbe_frame_times_camera(abbe_renderer *renderer, const abbe_scene *scene,
                                    const abbe_render_desc *desc, size_t count, double *ms,
                                    abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
