/* view_screen.h: the picture in the window: a texture, and how it is brought under the panel.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_SCREEN_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_SCREEN_H

#include "gl/device/api.h"

#include <stddef.h>

/* Zeroed but for gl: no picture. */
typedef struct abbe_view_screen {
  const abbe_gl *gl; /* functions of the window's context, which is current in all of these */
  unsigned texture, framebuffer;
  size_t width, height; /* size of the texture */
  size_t side;          /* pixels of the window that one of it is, each way, */
  size_t seen[2];       /* and how many of these are the picture, across and down */
} abbe_view_screen;
void abbe_view_screen_free(abbe_view_screen *screen);

/* Becomes a picture of that size, 4 bytes a pixel, rows downward. Each is side x side of the
 * window's, which are so many in all; what is more of them is to the right and above. */
void abbe_view_screen_take(abbe_view_screen *screen, const unsigned char *pixels, size_t width,
                           size_t height, size_t side, const size_t seen[2]);
/* Into the left upper corner of a window of that height, no farther across than that width. It is
 * copied there, for to draw it as a widget takes a software rasteriser twice as long. Before there
 * is a picture it is a dark pixel, enlarged, so that the driver has compiled that by then. */
void abbe_view_screen_draw(abbe_view_screen *screen, size_t width, size_t height);

#endif
