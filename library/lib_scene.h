/* lib_scene.h: a scene that a program outside works on: opened, changed, rendered, traced.
 *
 * It holds the scene, and from the first picture on the renderer with its off-screen context; what
 * a change does not touch is kept. Lengths in metres, angles in radians. It neither compares
 * pictures nor shows them: lib_comparison.h, lib_picture.h.
 */
#ifndef ABBE_LIBRARY_LIB_SCENE_H
#define ABBE_LIBRARY_LIB_SCENE_H

#include "base/error.h"
#include "library/lib_picture.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_lib_scene abbe_lib_scene;

/* Opens a scene file (docs/scene-files.md); one that is not there is looked for among the scenes
 * that came with the library. materials: "default", "thesis" or a file instead of the scene's own
 * table; stone: what its refractors are made of instead, STONE or NAME=STONE; either may be NULL.
 * set[count]: values of the file as "camera.fov=30" or "lights.lamp.intensity=2"; NULL where count
 * is 0. ABBE_IO, ABBE_PARSE, ABBE_SCHEMA, ABBE_NOT_FOUND and others, with file, line and key. */
abbe_result abbe_lib_scene_open(const char *path, const char *materials, const char *stone,
                                const char *const *set, size_t count, abbe_lib_scene **out,
                                abbe_error *error);
void abbe_lib_scene_free(abbe_lib_scene *scene);

/* Values besides those that were set before; a value that is set twice is the later one. On failure
 * the scene stays as it was. */
abbe_result abbe_lib_scene_change(abbe_lib_scene *scene, const char *const *set, size_t count,
                                  abbe_error *error);

/* Where the camera stands, what it looks at, which way is up, and its full vertical angle; each may
 * be NULL, or 0: as it is. A camera with an aperture keeps its pupil, and is sharp at its target as
 * before where it was; else its focus stays as far. It holds until camera.* is set.
 * ABBE_INVALID_ARGUMENT for numbers that are not finite, an angle outside (0, pi), and a view that
 * is none; ABBE_GEOMETRY and others where that cannot be rendered. On failure the camera stays as
 * it was. */
abbe_result abbe_lib_scene_look(abbe_lib_scene *scene, const double eye[3], const double target[3],
                                const double up[3], double fov_y_rad, abbe_error *error);
abbe_result abbe_lib_scene_camera(const abbe_lib_scene *scene, double eye[3], double target[3],
                                  double up[3], double *fov_y_rad, abbe_error *error);

/* Called now and then with the share that is done, 0 to 1, while a picture is rendered or traced;
 * false stops that with ABBE_CANCELLED. NULL: nobody is. */
typedef bool (*abbe_lib_progress)(void *user, double done);
void abbe_lib_scene_set_progress(abbe_lib_scene *scene, abbe_lib_progress progress, void *user);

/* The picture by OpenGL. Settings, each of which may be left out: width, height (pixels),
 * wavelengths, min_nm, max_nm, photons (a side), map_size (a side), supersample, upsample,
 * adaptive, receiver_samples, environment_lights, light_points, exits, energy_share, profile
 * (default, thesis, thesis-cie, shah2007, shah2007-cie, wyman2006, wyman2006-cie, wand2003), fill
 * (auto, none, bridge, smear), model (auto, sphere, convex, layers, hierarchy), transport (auto,
 * photons, pinhole), of pinholes also pinholes and clusters (numbers), footprint (auto, off, on),
 * space (acescg, rec709, xyz), observer (1931, 1964, 2015-2, 2015-10), aovs (1: direct.*, caustic.*
 * and Z too), backend (auto, cpu, gpu: of the first picture), redraw (1: every pass anew, of a
 * picture that holds several frames), and those of published methods that 'abbe methods --help'
 * lists, with _ for -. docs/rendering.md and docs/methods.md say what they do.
 * ABBE_INVALID_ARGUMENT, ABBE_UNSUPPORTED, ABBE_GL, ABBE_CANCELLED, ABBE_NO_MEMORY. */
abbe_result abbe_lib_scene_render(abbe_lib_scene *scene, const char *const *settings, size_t count,
                                  abbe_lib_picture **out, abbe_error *error);
/* Where a light's flux fell in the last rendered picture, X, Y, Z in W a texel, and so many bands
 * in W/nm (0: none). light: a name or a number from 1; NULL: the first. ABBE_INVALID_ARGUMENT
 * before a picture was rendered. */
abbe_result abbe_lib_scene_map(abbe_lib_scene *scene, const char *light, size_t bands,
                               abbe_lib_picture **out, abbe_error *error);

/* The reference: every path with its own wavelength, and standard errors from two passes on
 * (channels stderr.*, caustic.*). Settings: passes (64, unless seconds or error is given), seconds,
 * error (relative standard error), width, height, photons (a pass), bands, seed, threads, min_nm,
 * max_nm, space, observer, physics (full, or matched: what the renderer models and no more),
 * polarisation (auto: where there are polarisers; on; off), filter (1: less noise, by non-local
 * means), map_size (a side), light (whose map), checkpoint (a file that a stopped trace is kept in
 * and goes on from). like: a map, for a map of the same texels, or of map_size of them in the same
 * place; or NULL. picture and map may be NULL: then that is left out. ABBE_INVALID_ARGUMENT,
 * ABBE_OUT_OF_RANGE, ABBE_UNSUPPORTED, ABBE_CANCELLED, ABBE_NO_MEMORY.
 */
abbe_result abbe_lib_scene_trace(abbe_lib_scene *scene, const char *const *settings, size_t count,
                                 const abbe_lib_picture *like, abbe_lib_picture **picture,
                                 abbe_lib_picture **map, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
