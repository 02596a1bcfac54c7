/* view_feed.h: where the light of a place has come in: the photons that light it, the cells of
 * refractors or mirrors that they met first, and the facets that these belong to.
 *
 * It takes photons' hits as the renderer has them (gl/renderer.h). A photon lights what lies
 * between its hit and its neighbours', and between its hits at two wavelengths, as the map has it.
 * Each one's ray is followed from its light to the first of them. What happened inside is not in
 * a hit, so the facets are those of the entry alone. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_FEED_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_FEED_H

#include "base/error.h"
#include "gl/renderer.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

/* What a ray meets, and where a look into refractors ends: one ray at one wavelength, at each
 * interface the way that takes more light. Meshes as they are: it knows no normals but their
 * triangles' and exact spheres', no absorption and no surroundings. */

enum { ABBE_VIEW_SIGHT_PLACES = 24 };

typedef struct abbe_view_met {
  const abbe_object *object; /* NULL: nothing */
  size_t index, face;        /* index in the scene; face in its mesh */
  double distance;           /* infinite where nothing is met */
} abbe_view_met;

typedef struct abbe_view_sight {
  double nm;
  size_t count; /* interfaces that were met, then where it ends */
  double place[ABBE_VIEW_SIGHT_PLACES][3];
  double length; /* length of the whole path, m */
  bool lands;    /* on a receiver: the last place */
} abbe_view_sight;

/* From the camera along a unit direction. Where the path does not end within so many interfaces, or
 * leaves the scene, it hits nothing. */
void abbe_view_sight_follow(const abbe_scene *scene, const double eye[3], const double direction[3],
                            double nm, abbe_view_sight *out);

enum { ABBE_VIEW_FEED_RAYS = 192, ABBE_VIEW_FEED_FACETS = 6, ABBE_VIEW_FEED_EDGES = 240 };

typedef struct abbe_view_ray_in {
  double entry[3], light[3]; /* on the refractor or mirror; where the ray began */
  double share;              /* share of the flux of all photons that were found */
  size_t facet;              /* index of those below; their count: of a lesser one */
} abbe_view_ray_in;

typedef struct abbe_view_facet {
  size_t object;            /* index in the scene */
  double normal[3], offset; /* n . x = offset, m */
  double share;             /* share of the rays followed */
} abbe_view_facet;

typedef struct abbe_view_feed {
  double point[3], radius; /* whose light is requested, m */
  bool on_refractor;       /* the place that was requested lies on one, where no photon hits: */
  abbe_view_sight sight;   /* through it to the point */
  size_t photons;          /* that light it, at any wavelength */
  size_t ray_count;        /* number of these, the strongest that meet one */
  abbe_view_ray_in ray[ABBE_VIEW_FEED_RAYS];
  size_t facet_count; /* the strongest */
  abbe_view_facet facet[ABBE_VIEW_FEED_FACETS];
  size_t edge_count; /* around them */
  double edge[ABBE_VIEW_FEED_EDGES][2][3];
  struct abbe_view_landed *landed; /* in the making */
  double flux;
} abbe_view_feed;

/* A light's hits at some wavelengths side by side. */
typedef struct abbe_view_hits {
  const float *at; /* [count][slots][samples] x 4: world place, flux */
  const unsigned
      *path; /* [count][slots][samples]: equal where light met the same faces; 0: no hit */
  const unsigned *cell; /* [count], x | y << 16 of the grid */
  size_t count, slots, samples, grid[2];
  bool last;                /* the last sample has no other behind it, in this batch or the next */
  abbe_view view;           /* that the grid is of */
  const volatile int *stop; /* other than 0: the rest is left out; or NULL */
} abbe_view_hits;

void abbe_view_feed_begin(const double point[3], double radius, abbe_view_feed *out);
/* Where the camera sees a refractor at the place, it becomes that which is seen through it at this
 * wavelength. False: none is, and nothing is to be added. */
bool abbe_view_feed_look(abbe_view_feed *feed, const abbe_scene *scene, double nm);
/* Once for each light and batch of its wavelengths; a batch begins with the last wavelength of the
 * one before it. ABBE_NO_MEMORY. */
abbe_result abbe_view_feed_add(abbe_view_feed *feed, const abbe_view_hits *hits, abbe_error *error);
/* Follows what was added; nothing is to be freed then. *stop other than 0 leaves the rest out,
 * after a ray or a facet at most; stop may be NULL. */
void abbe_view_feed_end(abbe_view_feed *feed, const abbe_scene *scene, const volatile int *stop);

/* A pixel's spectrum by the reference tracer, long before a whole picture has one.
 *
 * A camera looks at nothing but the pixel, with many samples; the photons of each pass are as many
 * as a picture has, and are gathered as widely. */

#define ABBE_VIEW_SPOT_BANDS 40

typedef struct abbe_view_spot {
  size_t passes;
  size_t bands;                          /* 0: there is none */
  double nm[ABBE_VIEW_SPOT_BANDS];       /* their middles */
  double radiance[ABBE_VIEW_SPOT_BANDS]; /* W/(m2 sr nm), mean over the pixel */
  double stderr_of[ABBE_VIEW_SPOT_BANDS];
} abbe_view_spot;

/* Traces a pixel of the scene's picture of width x height pixels; at least four passes, and more
 * until so many seconds are over, up to 16. ABBE_CANCELLED where *stop (may be NULL) becomes other
 * than 0; errors of abbe_tracer_make. */
abbe_result abbe_view_spot_trace(const abbe_scene *scene, size_t width, size_t height,
                                 const size_t pixel[2], double seconds, const volatile int *stop,
                                 abbe_view_spot *out, abbe_error *error);

/* What is in a renderer beside its picture: the photons that feed a place, and the spectral map. */

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
