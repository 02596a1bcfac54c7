/* view_painter.h: what rests, made what the screen shows of it by a thread of its own.
 *
 * The display's own transform takes as long as a moving picture or two; whoever watches would wait
 * for it. One picture at a time. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_PAINTER_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_PAINTER_H

#include "cli/view/picture/view_show.h"

typedef struct abbe_view_painter abbe_view_painter;

/* What is to be shown; all of it stays as it is until it is taken or stopped. */
typedef struct abbe_view_painting {
  const abbe_view_pictures *pictures;
  abbe_view_shown shown;
  double exposure;
  const abbe_display *display;
} abbe_view_painting;

/* Starts the thread. wake (may be NULL) is called on it whenever a picture is there.
 * ABBE_NO_MEMORY. */
abbe_result abbe_view_painter_make(void (*wake)(void), abbe_view_painter **out, abbe_error *error);
/* painter may be NULL, here and where it is stopped. */
void abbe_view_painter_free(abbe_view_painter *painter);

/* Only while it has nothing. */
void abbe_view_painter_give(abbe_view_painter *painter, const abbe_view_painting *painting);
/* What it was given last and what is not taken yet; NULL: nothing. */
const abbe_view_painting *abbe_view_painter_has(const abbe_view_painter *painter);
/* It has nothing any more; waits for it, about a millisecond. */
void abbe_view_painter_stop(abbe_view_painter *painter);
/* Once it is done, what came of it, as abbe_view_show has it, and it has nothing any more. False:
 * not yet. */
bool abbe_view_painter_take(abbe_view_painter *painter, unsigned char **pixels, abbe_result *result,
                            abbe_error *error);

#endif
