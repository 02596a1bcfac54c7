/* lib_measure.h: what measurements of settings need besides pictures (lib_scene.h): what a request
 * comes to in a scene, how long its frames take, which texels its maps have, and what presets
 * promise. It compares nothing: lib_comparison.h.
 *
 * Answers are texts of lines KEY=VALUE, which the caller frees by abbe_lib_text_free. A key may be
 * added.
 */
#ifndef ABBE_LIBRARY_LIB_MEASURE_H
#define ABBE_LIBRARY_LIB_MEASURE_H

#include "base/error.h"
#include "library/lib_picture.h"
#include "library/lib_scene.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

void abbe_lib_text_free(char *text);

/* What a request of abbe_lib_scene_render comes to in the scene, without rendering: each of its
 * settings as the plan resolves it. Before them what the scene is: class (of presets), hash (of all
 * that light meets, 16 digits), size (its own, "512x512"), mesh (1: a refractor is a general mesh),
 * mesh_faces (of its refractors), caustics (1: there are some), light_views (lights that may have a
 * map) and device (what renders; once a picture was rendered). Errors of abbe_lib_scene_render, but
 * ABBE_GL. */
abbe_result abbe_lib_scene_plan(const abbe_lib_scene *scene, const char *const *settings,
                                size_t count, char **out, abbe_error *error);

/* Where the default picture's map of the first light would lie, without rendering it: a map of one
 * texel, for `like`. backend: of the first picture, or NULL. ABBE_UNSUPPORTED where no light
 * reaches a refractor, or the light has a cube of maps; errors of abbe_lib_scene_render. */
abbe_result abbe_lib_scene_place_map(abbe_lib_scene *scene, const char *backend,
                                     abbe_lib_picture **out, abbe_error *error);

/* Pictures rendered from now on have their light's map in the texels' layout of that map, a
 * rendered or traced one, and not fitted to what lands; published methods have their own. like
 * NULL: fitted. ABBE_INVALID_ARGUMENT where the picture is no map; errors of finding its light. */
abbe_result abbe_lib_scene_lay_map(abbe_lib_scene *scene, const abbe_lib_picture *like,
                                   abbe_error *error);

/* How long frames of the last rendered picture take, every pass drawn anew. Settings: frames
 * (behind the median, after one that warms up; frame_ms, fastest_ms, light_ms, eye_ms, photons,
 * refractor_share, polygon_layers, device_bytes, and invented and lost, shares of a map's light
 * that the gap fill adds and drops), enough_ms (three frames suffice where they took more),
 * baseline (frames of surfaces alone, 1 to 16: baseline_ms), camera (frames after the camera has
 * moved a little, 1 to 16: camera_ms). What is not asked for is not measured. picture: as the last
 * frame shows it; may be NULL. ABBE_INVALID_ARGUMENT before a picture was rendered; ABBE_CANCELLED,
 * ABBE_UNSUPPORTED, ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_lib_scene_times(abbe_lib_scene *scene, const char *const *settings, size_t count,
                                 abbe_lib_picture **picture, char **out, abbe_error *error);

/* The same of the tracer, without what is prepared once. Settings: passes, photons (a side, of a
 * pass), filter (1), width, height, frames, enough_ms. Numbers: frame_ms, fastest_ms, light_ms,
 * eye_ms and, of an even number of passes without the filter, own_de: the mean CIEDE2000 of the
 * caustic between the first half of the passes and all. ABBE_CANCELLED; errors of
 * abbe_lib_scene_trace. */
abbe_result abbe_lib_scene_trace_times(abbe_lib_scene *scene, const char *const *settings,
                                       size_t count, abbe_lib_picture **picture, char **out,
                                       abbe_error *error);

/* A map's light in the texels of another one of the same light. ABBE_INVALID_ARGUMENT where the two
 * lie in different places, or one is no map. */
abbe_result abbe_lib_picture_resample(const abbe_lib_picture *map, const abbe_lib_picture *like,
                                      abbe_lib_picture **out, abbe_error *error);

/* What a file of presets (NULL: the shipped ones) promises of a class of scenes: error (a column),
 * error_text, scenes, margin, time_margin, and a line "point=NAME KEY=VALUE…" for each point of the
 * front, the cheapest first: the preset's name or nothing, settings as abbe_lib_scene_plan has
 * them, light_ms, eye_ms and error as promised. Nothing where there is no such class. ABBE_SCHEMA,
 * ABBE_PARSE and ABBE_IO name file, line and key. */
abbe_result abbe_lib_presets_read(const char *path, const char *of, char **out, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
