/* view_look.h: what is in a renderer beside its picture: the photons that feed a place, and the
 * spectral map. Internal to cli/. */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_LOOK_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_LOOK_H

#include "cli/view/picture/view_feed.h"
#include "gl/renderer.h"

/* The renderer has drawn that scene. nm: the wavelength by which what is seen through a refractor
 * is found, and about which photons are looked for first, at all others where there are none.
 * ABBE_CANCELLED where *stop becomes other than 0. Errors of abbe_renderer_read_hits,
 * ABBE_NO_MEMORY. */
abbe_result abbe_view_look_feed(abbe_renderer *renderer, const abbe_scene *scene,
                                const double point[3], double radius, double nm, volatile int *stop,
                                abbe_view_feed *out, abbe_error *error);
/* The same of twice as many photons a side as the renderer follows, and twice as many again until
 * some are found or there are more than ABBE_VIEW_LOOK_PHOTONS: between a few that land far apart
 * nothing is known. *out is what abbe_view_look_feed has found, and stays so where there are no
 * more to follow. A renderer of its own follows them; the other stays as it is. Errors of
 * abbe_renderer_make, too. */
enum { ABBE_VIEW_LOOK_PHOTONS = 1024 };
abbe_result abbe_view_look_closer(abbe_context *context, const abbe_renderer *renderer,
                                  const abbe_scene *scene, const double point[3], double radius,
                                  double nm, volatile int *stop, abbe_view_feed *out,
                                  abbe_error *error);
/* The map of the first light from which photons start; zeroed where there is none. Errors of
 * abbe_renderer_read_map. */
abbe_result abbe_view_look_map(abbe_renderer *renderer, abbe_image *out, abbe_error *error);

#endif
