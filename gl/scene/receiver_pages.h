/* receiver_pages.h: maps on receivers, for light that the light's own map cannot hold: what lands
 * behind a point light, far off the map view's axis, or where a receiver hides the place.
 *
 * A chart is a parallelogram, or a part of a mesh within the parallelogram that bounds it
 * (scenes/mesh/mesh_charts.h). A page is a window of one side of a chart and a rectangle of texels for
 * it, in one layer beside the light's map. This chooses pages from where light landed and lays them
 * out; it knows no GL.
 */
#ifndef ABBE_GL_SCENE_RECEIVER_PAGES_H
#define ABBE_GL_SCENE_RECEIVER_PAGES_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_RECEIVER_PAGES 64 /* of one light at the most */
#define ABBE_PAGE_BINS 4096
#define ABBE_PAGE_FLOATS 16 /* of the shaders' Page */

/* What landed on one side of a chart, corner + u U + v V, and where: flux by u and by v, 0 to 1. */
typedef struct abbe_page_light {
  double flux;
  double bin[2][ABBE_PAGE_BINS];
} abbe_page_light;

typedef struct abbe_receiver_page {
  size_t chart_side; /* 2 * chart: the side that U x V points to; + 1: the other */
  double window[4];  /* least and greatest u, then v */
  size_t rect[4];    /* texels: left, right, bottom, top; the ends excluded */
} abbe_receiver_page;

typedef struct abbe_receiver_pages {
  size_t count;
  abbe_receiver_page page[ABBE_RECEIVER_PAGES];
  size_t rows; /* of the layer that are used */
} abbe_receiver_pages;

/* u and v are clamped to 0 to 1; a flux that is not above zero is left out. */
void abbe_page_light_add(abbe_page_light *light, double u, double v, double flux);

/* Pages in a layer of side x side texels for those of `count` charts' sides that take most light,
 * brightest first, until what has none is less than a thousandth of `total`, the flux of all that
 * lands. light: [count], NULL where there is none; parallelogram: of each chart, corner, U, V. A
 * rectangle's sides are multiples of `align`, which divides `side`; its texels are nearly squares
 * across the chart. All but 2e-4 of its light on each side lies in a page's window. */
void abbe_receiver_pages_lay_out(abbe_page_light *const *light, const double (*parallelogram)[9],
                                 size_t count, double total, size_t side, size_t align,
                                 abbe_receiver_pages *out);

/* Area of one of its texels on the parallelogram, m2. */
double abbe_receiver_page_texel(const abbe_receiver_page *page, const double parallelogram[9]);
/* The place on the parallelogram of (x, y) in the layer's texels. */
void abbe_receiver_page_place(const abbe_receiver_page *page, const double parallelogram[9],
                              double x, double y, double out[3]);
/* The shaders' Page (receiver_pages.glsl). */
void abbe_receiver_page_pack(const abbe_receiver_page *page, const double parallelogram[9],
                             float out[ABBE_PAGE_FLOATS]);

#ifdef __cplusplus
}
#endif
#endif
