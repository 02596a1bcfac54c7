#include "gl/accuracy/frame_times.h"

#include "base/order.h"

#include <stdlib.h>

enum { DEFAULT_FRAMES = 5, ENOUGH_FRAMES = 3, MAX_BASELINES = 16 };

static int by_time(const void *a, const void *b) {
  double x = ((const abbe_statistics *)a)->frame_ms, y = ((const abbe_statistics *)b)->frame_ms;
  return (x > y) - (x < y);
}

abbe_result abbe_frame_times_measure(abbe_renderer *renderer, const abbe_frame_times_desc *desc,
                                     abbe_frame_times *out, abbe_error *error) {
  ABBE_REQUIRE(renderer && desc && out, error);
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

abbe_result abbe_frame_times_baseline(abbe_renderer *renderer, size_t count, double *ms,
                                      abbe_error *error) {
  ABBE_REQUIRE(renderer && ms, error);
  double all[MAX_BASELINES];
  if (count < 1 || count > MAX_BASELINES) count = count < 1 ? 1 : MAX_BASELINES;
  for (size_t i = 0; i < count; i++) {
    abbe_result result = abbe_renderer_baseline(renderer, &all[i], error);
    if (result != ABBE_OK) return result;
  }
  qsort(all, count, sizeof *all, abbe_order_ascending);
  *ms = all[count / 2];
  return ABBE_OK;
}
