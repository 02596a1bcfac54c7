#include "gl/accuracy/frame_times.h"

#include "base/clock.h"
#include "base/maths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { DEFAULT_FRAMES = 5, ENOUGH_FRAMES = 3, MAX_TIMES = 16 };

static int by_time(const void *a, const void *b) {
  double x = ((const abbe_statistics *)a)->frame_ms, y = ((const abbe_statistics *)b)->frame_ms;
  return (x > y) - (x < y);
}

abbe_result abbe_frame_times_measure(abbe_renderer *renderer, const abbe_frame_times_desc *desc,
                                     abbe_frame_times *out, abbe_error *error) {
  size_t count = desc->frames > 0 ? desc->frames : DEFAULT_FRAMES;
  if (count > ABBE_FRAME_TIMES_MAX) count = ABBE_FRAME_TIMES_MAX;
  double spent_ms = 0;
  abbe_statistics *all = calloc(count, sizeof *all);
  if (all == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the times");
  abbe_result result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    if (desc->progress != NULL && !desc->progress(desc->user, (double)i / (double)count))
      result = abbe_error_set(error, ABBE_CANCELLED, "stopped; nothing was written");
    abbe_renderer_redraw(renderer);
    if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, &all[i], error);
    spent_ms += all[i].frame_ms;
    if (desc->enough_ms > 0 && i + 1 >= ENOUGH_FRAMES && spent_ms > desc->enough_ms) count = i + 1;
  }
  if (result == ABBE_OK) {
    qsort(all, count, sizeof *all, by_time);
    *out = (abbe_frame_times){.median = all[count / 2], .fastest_ms = all[0].frame_ms};
  }
  free(all);
  return result;
}

double abbe_frame_times_unrest(double median_ms, double fastest_ms) {
  return median_ms > 0 && fastest_ms > 0 ? median_ms / fastest_ms - 1 : NAN;
}

void abbe_frame_times_say_unrest(double unrest, const char *before, char *out, size_t size) {
  *out = '\0';
  if (unrest > ABBE_FRAME_TIMES_QUIET)
    snprintf(out, size, "%sthe machine is busy: repeats took %ld %% longer than the fastest",
             before, lround(100 * unrest));
}

abbe_result abbe_frame_times_baseline(abbe_renderer *renderer, size_t count, double *ms,
                                      abbe_error *error) {
  double all[MAX_TIMES];
  if (count < 1 || count > MAX_TIMES) count = count < 1 ? 1 : MAX_TIMES;
  for (size_t i = 0; i < count; i++) {
    ABBE_TRY(abbe_renderer_baseline(renderer, &all[i], error));
  }
  qsort(all, count, sizeof *all, abbe_order_ascending);
  *ms = all[count / 2];
  return ABBE_OK;
}

static abbe_result time_change(abbe_renderer *renderer, const abbe_scene *scene,
                               const abbe_render_desc *desc, double *ms, abbe_error *error) {
  const double start = abbe_clock_seconds();
  ABBE_TRY(abbe_renderer_change(renderer, scene, desc, error));
  ABBE_TRY(abbe_renderer_frame(renderer, NULL, NULL, NULL, error));
  *ms = 1e3 * (abbe_clock_seconds() - start);
  return ABBE_OK;
}

/* To the left by 1/64 of the distance to the target. */
static abbe_scene move_camera(const abbe_scene *scene) {
  abbe_scene moved = *scene;
  double ahead[3], left[3];
  abbe_vector_subtract(scene->camera.target, scene->camera.eye, ahead);
  abbe_vector_cross(scene->camera.up, ahead, left);
  const double step = abbe_vector_length(ahead) / (64 * abbe_vector_length(left));
  for (int i = 0; i < 3; i++) moved.camera.eye[i] += step * left[i];
  return moved;
}

abbe_result abbe_frame_times_camera(abbe_renderer *renderer, const abbe_scene *scene,
                                    const abbe_render_desc *desc, size_t count, double *ms,
                                    abbe_error *error) {
  const abbe_scene moved = move_camera(scene);
  double all[MAX_TIMES], unused;
  if (count < 1 || count > MAX_TIMES) count = count < 1 ? 1 : MAX_TIMES;
  abbe_result result = time_change(renderer, &moved, desc, &unused, error); /* warms up */
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = time_change(renderer, i % 2 == 0 ? scene : &moved, desc, &all[i], error);
  /* `moved` does not outlive this, whatever went wrong */
  if (result != ABBE_OK) abbe_renderer_change(renderer, scene, desc, NULL);
  if (result == ABBE_OK) result = abbe_renderer_change(renderer, scene, desc, error);
  if (result != ABBE_OK) return result;
  qsort(all, count, sizeof *all, abbe_order_ascending);
  *ms = all[count / 2];
  return abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
}
