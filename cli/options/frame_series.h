/* frame_series.h: pictures one after another: which frames, when each of them is, what moves in
 * them, what their files are called, and the picture that moves. It draws nothing. Internal to
 * cli/.
 */
#ifndef ABBE_CLI_OPTIONS_FRAME_SERIES_H
#define ABBE_CLI_OPTIONS_FRAME_SERIES_H

#include "base/error.h"
#include "cli/base/command.h"
#include "cli/options/scene_input.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_FRAME_SERIES_MOST 100000
enum { ABBE_FRAME_SERIES_MOVES = 16, ABBE_FRAME_SERIES_MOVE_TEXT = 256 };

typedef struct abbe_frame_series {
  const char *program;
  size_t first, count; /* numbers first to first + count - 1; count 0: one picture and no series */
  bool around;         /* the camera goes around, and time stands still */
  bool piece;          /* not the camera but the piece turns */
  double per_second;   /* 0: 25 */
  abbe_command_part part;
  bool merge;  /* frames that are there, and draw none */
  bool resume; /* draw those alone that are not there, or that another run has made */
  char *made;  /* what this run's frames have in common */
  bool stated; /* --exposure's stops are all frames' */
  size_t moves;
  char move_first[ABBE_FRAME_SERIES_MOVES][ABBE_FRAME_SERIES_MOVE_TEXT]; /* "KEY=A" */
  const char *move_last[ABBE_FRAME_SERIES_MOVES];                        /* "B" */
} abbe_frame_series;

/* "A:B": frames A to B - 1. Ends the program where it is none. */
void abbe_frame_series_take(abbe_frame_series *series, const char *text);

/* A row of a command's options with frames over time. */
#define ABBE_FRAME_SERIES_MOVE(key, group)                                                         \
  {                                                                                                \
    "move", key, "KEY=A:B", 0,                                                                     \
        "a number or numbers of the scene go from A at the first of --frames A:B to B at the "     \
        "last, "                                                                                   \
        "such as lights.sun.direction=[0,0,-1]:[1,0,-1]; may be repeated",                         \
        group, ABBE_TAKE_BY_KEY                                                                    \
  }
/* "KEY=A:B"; the scene begins with KEY=A. Ends the program where it is none, or one too many. */
void abbe_frame_series_take_move(abbe_frame_series *series, abbe_scene_input_changes *changes,
                                 const char *text);
/* Moves without frames over time, and a file (NULL: none) that cannot move at their rate, end the
 * program. */
void abbe_frame_series_check(const abbe_frame_series *series, const char *png,
                             struct argp_state *state);

/* The scene of frame i, at its time and with what has moved till then. */
abbe_result abbe_frame_series_scene(const abbe_frame_series *series, const abbe_scene *scene,
                                    const char *materials, const abbe_scene_input_changes *changes,
                                    size_t i, abbe_scene *out, abbe_error *error);

/* Sets series->made, which abbe_frame_series_free frees. ABBE_INVALID_ARGUMENT where each frame
 * would choose its own exposure, ABBE_NO_MEMORY. */
abbe_result abbe_frame_series_record(abbe_frame_series *series, const abbe_scene *scene,
                                     abbe_error *error);
void abbe_frame_series_free(abbe_frame_series *series);
/* The picture of frame i carries what has made it. */
abbe_result abbe_frame_series_mark(const abbe_frame_series *series, size_t i, abbe_image *image,
                                   abbe_error *error);

/* Whether frame i of the count is this process's to draw: of its part, and, where that is
 * requested, with a file that is not there yet or was made by another request, which is reported on
 * stderr. exr and png as below, or NULL. */
bool abbe_frame_series_draws(const abbe_frame_series *series, size_t i, const char *exr,
                             const char *png);

/* "stone.png", and any other picture for a display, is "stone-0001.png" for the number 1; malloc'd,
 * NULL without a path. */
abbe_result abbe_frame_series_name(const char *path, size_t number, char **out, abbe_error *error);

/* path, a picture that moves, of the series' numbered files beside it. ABBE_INVALID_ARGUMENT where
 * they carry records of several requests; errors of abbe_screen_file_move. */
abbe_result abbe_frame_series_merge(const abbe_frame_series *series, const char *path,
                                    abbe_error *error);

#endif
