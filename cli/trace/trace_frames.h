/* trace_frames.h: frames of `abbe trace --frames A:B`, and the PNG that moves. */
#ifndef ABBE_CLI_TRACE_TRACE_FRAMES_H
#define ABBE_CLI_TRACE_TRACE_FRAMES_H

#include "cli/trace/trace_request.h"

#include <argp.h>

/* --frames and what goes with it. Its input is the request's abbe_frame_series. */
extern const struct argp abbe_trace_frames_argp;

/* Ends the program where options of the request do not go together with frames, or without. */
void abbe_trace_frames_check(const abbe_trace_request *q, struct argp_state *state);

typedef abbe_result (*abbe_trace_frame)(abbe_trace_request *q, const abbe_scene *scene,
                                        abbe_error *error);

/* Each frame of the request's series as a request of its own, whose files are numbered, by
 * trace_one on the scene at its time; then FILE.png of all. What is there is left as it is where
 * the request resumes. */
abbe_result abbe_trace_frames(const abbe_trace_request *q, const abbe_scene *scene,
                              abbe_trace_frame trace_one, abbe_error *error);

#endif
