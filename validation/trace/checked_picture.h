/* checked_picture.h: a picture that was made otherwise, compared with traced passes.
 *
 * Presets promise what other scenes had. Whether the picture of this one keeps a bound is measured
 * by passes of the tracer, twice as many each time, until they show that it does, or keep the bound
 * themselves: then theirs can be taken instead, and the other is not known to keep it. To tell
 * takes fewer passes than to make as good a picture, for their noise is known and taken off
 * (pass_error.h). Where the time has an end, passes are begun only where they end before it.
 */
#ifndef ABBE_VALIDATION_TRACE_CHECKED_PICTURE_H
#define ABBE_VALIDATION_TRACE_CHECKED_PICTURE_H

#include "validation/trace/pass_error.h"
#include "validation/trace/tracer/tracer.h"

#include <stdbool.h>

/* How much of a budget is left, and whether a piece of work still fits.
 *
 * It has no clock of its own: the caller brings one. */

/* Work takes up to so many times as long as was expected of it, and fits if there is so much
 * time. */
#define ABBE_TIME_LEFT_ROOM 1.3

/* Zeroed: the time has no end. */
typedef struct abbe_time_left {
  double (*seconds)(void *user); /* until it ends, below 0 after that; or NULL */
  void *user;
} abbe_time_left;

/* s; infinite without an end. */
double abbe_time_left_seconds(const abbe_time_left *left);

/* Whether work that is expected to take so many seconds ends in time, with ABBE_TIME_LEFT_ROOM.
 * NaN is work of which nothing is known: it fits where there is no end. */
bool abbe_time_left_holds(const abbe_time_left *left, double seconds);

enum { ABBE_CHECKED_PICTURE_MOST_PASSES = 1024 };

typedef struct abbe_checked_picture_desc {
  abbe_trace_desc trace; /* with the picture's size, wavelengths and space; with a seed of its own
                            where the picture is traced too */
  double max_error;      /* mean CIEDE2000 in the caustic, above 0 */
  bool only_check;       /* ends too once the picture is known not to keep it */
  bool (*progress)(void *user, double done); /* progress of the passes; false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops a pass midway; or NULL */
  abbe_time_left left;      /* for all of this */
  double first_s;           /* what the tracer and two passes are expected to take, where the time
                               has an end */
} abbe_checked_picture_desc;

typedef struct abbe_checked_picture {
  size_t passes;          /* passes that show it; 0: none */
  abbe_pass_error given;  /* error of the picture, by the passes; NaN: they do not show it */
  abbe_pass_error traced; /* error of the passes' own picture */
  bool timed_out;         /* more passes would show more, and there was no time for them */
} abbe_checked_picture;

/* `traced` receives what the passes made, unless timed_out. Ends with both bounds above max_error
 * after ABBE_CHECKED_PICTURE_MOST_PASSES or out of time, and with NaN after two passes where the
 * picture has no caustic. What passes showed stands, also where the next ones ran out of time.
 * ABBE_INVALID_ARGUMENT for a max_error of 0 and pictures of different sizes; ABBE_CANCELLED;
 * errors of abbe_tracer_make, abbe_tracer_pass and abbe_pass_error_of_picture. */
abbe_result abbe_checked_picture_make(const abbe_scene *scene,
                                      const abbe_checked_picture_desc *desc,
                                      const abbe_image *picture, abbe_image *traced,
                                      abbe_checked_picture *out, abbe_error *error);

/* A traced picture whose passes go on until its own error keeps a bound.
 *
 * Presets promise what other scenes had; a scene with light of another kind is found out here, by
 * its own passes (pass_error.h), and traced for longer. It compares with no reference. */

/* A bound may take up to so many times the passes that were requested. */
#define ABBE_BOUNDED_TRACE_MOST_TIMES 64

typedef struct abbe_bounded_trace_desc {
  abbe_trace_desc trace; /* its guides are set where the picture is to be filtered */
  size_t passes;         /* at least 1, of a filtered picture 2 */
  bool filtered;
  double max_error; /* mean CIEDE2000 in the caustic, by pass_error's bound; 0: none is requested */
  bool (*progress)(void *user, double done); /* progress of the passes; false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops a pass midway; or NULL */
} abbe_bounded_trace_desc;

typedef struct abbe_bounded_trace {
  size_t passes;       /* that were traced */
  abbe_pass_error own; /* NaN: of one pass, of a filtered picture without max_error, and where
                          nothing is lit through refractors */
} abbe_bounded_trace;

/* Traces the passes; with max_error two at least, four of a filtered picture, and then more until
 * own.bound keeps it. Ends with own.bound above max_error where that would take more than
 * ABBE_BOUNDED_TRACE_MOST_TIMES times the passes, as soon as that shows. ABBE_INVALID_ARGUMENT for
 * too few passes; ABBE_CANCELLED; errors of abbe_tracer_make, abbe_tracer_pass and
 * abbe_denoise_picture. */
abbe_result abbe_bounded_trace_make(const abbe_scene *scene, const abbe_bounded_trace_desc *desc,
                                    abbe_image *picture, abbe_bounded_trace *out,
                                    abbe_error *error);

#endif
