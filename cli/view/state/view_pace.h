/* view_pace.h: how coarse the next moving picture is, by what the last ones took.
 *
 * A table of times: of each step of the light and of the eye that was drawn, what its pictures took
 * last. What was not drawn yet is guessed by its share of the work, so that one picture that is too
 * slow leads to one that is not, and steps that save nothing are left again: where a picture takes
 * as long however few its photons and samples are, it has all of them.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_PACE_H
#define ABBE_CLI_VIEW_STATE_VIEW_PACE_H

#include <stdbool.h>
#include <stddef.h>

/* From one picture to the next. An event waits for the one in the making and for its own, so no
 * longer than 60 ms. */
#define ABBE_VIEW_MOVING_MS 29.0
#define ABBE_VIEW_EYE_STEPS 4   /* 0: a sample a pixel, then one for 2 x 2, 3 x 3, 4 x 4 */
#define ABBE_VIEW_LIGHT_STEPS 4 /* 0: the draft's photons, then half as many each */

/* Zeroed: nothing is known. */
typedef struct abbe_view_pace {
  size_t light_step, eye_step; /* to be tried next */
  size_t lights;  /* steps of the light that can be drawn, the finest first; 0: all can */
  double ms;      /* of the last picture that counts; 0: there is none */
  size_t in_time; /* pictures in turn that kept the time */
  bool strange;   /* the last one does not: nothing follows from one alone */
  /* of pictures whose light was drawn, and of those whose light was kept; 0: not known */
  double lit_ms[ABBE_VIEW_LIGHT_STEPS][ABBE_VIEW_EYE_STEPS], kept_ms[ABBE_VIEW_EYE_STEPS];
} abbe_view_pace;

/* The first picture of all took so long to be drawn, as far as that is known: coarser ones, of the
 * same programs, have their share. */
void abbe_view_pace_guess(abbe_view_pace *pace, double drawn_ms);

/* A picture of these steps took so long; lit: its light was drawn for it. One that took many times
 * as long as the one before has compiled programs, which does not last. */
void abbe_view_pace_take(abbe_view_pace *pace, size_t light_step, size_t eye_step, bool lit,
                         double ms);

#endif
