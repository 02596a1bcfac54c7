/* page_charts.h: charts of receivers that are meshes, for the pages of what pinholes show: where
 * each texel of a chart lies on its mesh, and how shaders find a place's chart and texel again.
 * Internal to gl/.
 */
#ifndef ABBE_GL_PINHOLES_PAGE_CHARTS_H
#define ABBE_GL_PINHOLES_PAGE_CHARTS_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_page_charts {
  GLuint places; /* two rows a texel, of the charts of meshes: place (w: 1; 0: none), normal */
  GLuint rows, rows_texture;  /* of all charts: from a place to its u, and v */
  GLuint faces, face_texture; /* side of a chart that each receiver's face is of */
  bool *closed;               /* [all charts] it is of what encloses a space: its back is inside */
} abbe_page_charts;

/* Of side x side texels a page, laid out as pinhole_map.glsl says; a texel beside its chart has the
 * nearest place of it. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_page_charts_make(const abbe_gpu_scene *scene, size_t side, abbe_page_charts *out,
                                  abbe_error *error);
void abbe_page_charts_free(abbe_gpu *gpu, abbe_page_charts *charts);
/* The charts and their faces, where shaders expect them. */
void abbe_page_charts_bind(abbe_gpu *gpu, const abbe_page_charts *charts);

#endif
