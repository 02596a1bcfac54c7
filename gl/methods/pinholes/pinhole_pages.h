/* pinhole_pages.h: maps on receivers of what mirrors and refractors make there of the surroundings'
 * soft light: of what is left of them beside directional lights (environment_lights.h), whose light
 * photons carry. They hold the difference to what nothing hides, so that both sum to all light.
 * Internal to gl/.
 */
#ifndef ABBE_GL_PINHOLES_PINHOLE_PAGES_H
#define ABBE_GL_PINHOLES_PINHOLE_PAGES_H

#include "gl/methods/pinholes/pinhole_samples.h"
#include "gl/scene/gpu_scene.h"
#include "gl/scene/shader_variant.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Charts of receivers that are meshes, for the tiles of what pinholes show: where each texel of a
 * chart lies on its mesh, and how shaders find a place's chart and texel again. */

typedef struct abbe_page_charts {
  GLuint places; /* two rows a texel, of the charts of meshes: place (w: 1; 0: none), normal */
  GLuint rows, rows_texture;  /* rows of all charts: from a place to its u, and v */
  GLuint faces, face_texture; /* side of a chart that each receiver's face is of */
  bool *closed;               /* [all charts] it is of what encloses a space: its back is inside */
} abbe_page_charts;

typedef struct abbe_pinhole_pages {
  const abbe_gpu_scene *scene; /* NULL: there are none */
  abbe_pinhole_samples samples;
  abbe_pinhole_sky sky;
  abbe_page_charts charts; /* where the plan has them */
  size_t side, count;      /* texels of a tile; tiles: two a chart (gl/scene/gpu_scene.h) */
  GLuint texels[2];        /* lists: of a tile's, those that are filled, and that need more */
  uint32_t *order;         /* [side * side] space to sort one of them */
  GLuint select, fill;     /* programs */
  bool filled;             /* they hold the light as it is now */
  GLuint texture;          /* irradiance, W/m2, working space; an array */
} abbe_pinhole_pages;

/* Where the plan's transport is by pinholes, and *out is zero: else they stay. Errors of its parts;
 * ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_pinhole_pages_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                    abbe_pinhole_pages *out, abbe_error *error);
void abbe_pinhole_pages_free(abbe_pinhole_pages *pages);
/* All that may be lit, unless they are filled. ABBE_GL, ABBE_CANCELLED. */
abbe_result abbe_pinhole_pages_run(abbe_pinhole_pages *pages, abbe_error *error);
/* Into the program that is in use (pinhole_lookup.glsl). */
void abbe_pinhole_pages_set(const abbe_pinhole_pages *pages, GLuint program);

#endif
