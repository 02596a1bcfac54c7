/* renderer.h: pictures of a scene by adaptive spectral mapping, pass by pass as the plan says.
 *
 * A renderer belongs to one context, which outlives it. It may be changed: to another camera, other
 * lights, objects, materials or settings, or to another scene; what does not depend on what differs
 * is kept, and a frame draws what it draws of a renderer made anew, bit for bit. Pictures are
 * scene-linear radiance, W/(m2 sr) with each light's power shared out by its illuminant, in the
 * plan's colour space. A process may have many renderers, on one context or on several; those of
 * one context are used by one thread at a time.
 *
 * Every function that takes a renderer and gives a result, abbe_renderer_make and
 * abbe_renderer_free make its context current and leave it so; ABBE_GL where it cannot be. They
 * take OpenGL's state in the context as they find it, except that no query, conditional rendering
 * or transform feedback may be active; errors that are pending are dropped. They leave framebuffer
 * 0, no program, no vertex array, texture unit 0 active, no pixel buffers, no samplers at units 0
 * to 15, glPixelStore's values and all enables of drawing as GL begins with them (not its debug
 * output and seamless cube maps), and so also blend function and equation, clip control, colour and
 * depth mask, cull face, depth function and range, front face, polygon mode, provoking vertex and
 * the hint for derivatives. Viewport, scissor box and the bindings of textures, images and indexed
 * buffers are left as they fall.
 */
#ifndef ABBE_GL_RENDERER_H
#define ABBE_GL_RENDERER_H

#include "base/error.h"
#include "colorimetry/image/image.h"
#include "gl/device/context.h"
#include "gl/device/statistics.h"
#include "gl/plan/plan.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_renderer abbe_renderer;

/* Plans, uploads the scene, compiles what the plan needs and fits the light's views. desc may be
 * NULL. Errors as abbe_plan_make, and ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_renderer_make(abbe_context *context, const abbe_scene *scene,
                               const abbe_render_desc *desc, abbe_renderer **out,
                               abbe_error *error);
/* Before its context is freed. Where that cannot be made current, what it holds in it stays there.
 */
void abbe_renderer_free(abbe_renderer *renderer);

/* Takes over the scene as it is now, the same one or another, and the request. It finds out itself
 * what differs: a camera that has moved needs the camera's passes alone; a light that is dimmed,
 * for those and a table; another material, for tables, photons and the camera's passes; an object
 * that has moved, for its bounds and all that follows. The scene must stay as it is until it is
 * handed over again, or the renderer is freed. Errors as of abbe_renderer_make. Where the scene
 * cannot be planned the renderer stays as it was; a caller that has edited the scene in place puts
 * it back, or changes on, before it draws. After another failure it draws nothing until a change
 * succeeds, and has what that change did not ask to be made anew. ABBE_CANCELLED by the request's
 * progress and by the thread's watch (base/thread/watch.h). */
abbe_result abbe_renderer_change(abbe_renderer *renderer, const abbe_scene *scene,
                                 const abbe_render_desc *desc, abbe_error *error);

/* Gives memory back that only the next frame that follows photons needs, which then takes it
 * again: where frames end for a while. */
void abbe_renderer_rest(abbe_renderer *renderer);

/* The next frame runs every pass, whatever could be kept: to measure it. */
void abbe_renderer_redraw(abbe_renderer *renderer);

const abbe_plan *abbe_renderer_plan(const abbe_renderer *renderer);
/* Whether the light of the scene that was last taken over is drawn: the next frame is the camera's
 * alone, unless a change needs more. */
bool abbe_renderer_is_lit(const abbe_renderer *renderer);

/* One frame: the passes whose result is not there yet, none where nothing has changed since the
 * last one. With statistics every pass is finished and timed by itself; without, none is waited for
 * but the last. progress and statistics may be NULL. progress may make another context current and
 * use another renderer there, and leaves this context as it is. ABBE_CANCELLED by progress: the
 * frame may be drawn again; ABBE_GL. */
abbe_result abbe_renderer_frame(abbe_renderer *renderer, abbe_render_progress progress, void *user,
                                abbe_statistics *statistics, abbe_error *error);

/* The time of drawing all surfaces once into the camera's picture, normals and distances alone, ms:
 * the baseline of any frame. The picture stays. ABBE_UNSUPPORTED but of the default profile;
 * ABBE_GL. */
abbe_result abbe_renderer_baseline(abbe_renderer *renderer, double *ms, abbe_error *error);

/* The picture: R, G, B (X, Y, Z in that space); with AOVs (which the request must have
 * requested) also direct.*, caustic.* (radiance of
 * the receivers that the camera sees straight) and Z (distance from the camera, m; 0: nothing). A
 * coarse picture has a pixel for each of its samples, the last of which may stand for pixels beyond
 * it. ABBE_INVALID_ARGUMENT before a whole frame was drawn; so of maps. */
abbe_result abbe_renderer_read(abbe_renderer *renderer, bool aovs, abbe_image *out,
                               abbe_error *error);

/* The same of a camera with an aperture as through that: colours are the mean of so many frames as
 * the request's `lens` says, from places evenly spread over the pupil; AOVs are those of its
 * middle. scene and desc: those that the renderer has; then no frame is drawn, and the light stays.
 * Errors of abbe_renderer_change and abbe_renderer_frame too. */
abbe_result abbe_renderer_read_blurred(abbe_renderer *renderer, const abbe_scene *scene,
                                       const abbe_render_desc *desc, bool aovs,
                                       abbe_render_progress progress, void *user, abbe_image *out,
                                       abbe_error *error);

/* A light's spectral map: channels X, Y, Z, flux a texel in W, with its layout and the light's name
 * in its attributes (abbe_map_layout_read). Of a light with a cube of maps only where the request
 * gives one layout for all, else ABBE_UNSUPPORTED. filled: after the gap fill, where the fill is a
 * pass of its own (smear). */
abbe_result abbe_renderer_read_map(abbe_renderer *renderer, size_t light, bool filled,
                                   abbe_image *out, abbe_error *error);

/* The same with so many bands of equal width over the range beside X, Y, Z, in W/nm, named as
 * abbe_image_band_name does. It follows the photons anew, once for three bands and once more, so
 * that the renderer is then as it was. Default profile only, 1 to ABBE_RENDER_MAX_BANDS. */
#define ABBE_RENDER_MAX_BANDS 256
abbe_result abbe_renderer_read_map_bands(abbe_renderer *renderer, size_t light, size_t bands,
                                         abbe_image *out, abbe_error *error);

/* The layout of a light's map: fitted to its hits, or the request's; of the first face of a
 * light with a cube. */
void abbe_renderer_map_layout(const abbe_renderer *renderer, size_t light, abbe_map_layout *out);

/* Where a light's photons land at some wavelengths of the plan's. */
typedef struct abbe_renderer_hits {
  size_t count, slots, samples; /* photons; hits of each; wavelengths from the first on */
  /* [count][slots][samples] x 4: world position in m and flux for unit weight in W, all 0 where
   * nothing lands */
  float *at;
  unsigned *path; /* [count][slots][samples]: equal where light met the same faces; 0: no hit */
  unsigned *cell; /* [count]: x | y << 16 of a photon's cell in the grid */
  /* Fitted to the map, so it may be coarser than the request's: the middle of cell (x, y) is at
   * uv = ((x + 0.5) / grid[0], (y + 0.5) / grid[1]) of the view. */
  size_t grid[2];
  abbe_view view;
} abbe_renderer_hits;

/* Traces one batch of wavelengths, number `first` and those after it up to the capacity; the
 * last batch has empty ones behind it. It leaves maps and pictures as they are. progress (may be
 * NULL) as of abbe_renderer_frame. ABBE_INVALID_ARGUMENT where no photons start from that light or
 * there is no such wavelength. */
abbe_result abbe_renderer_read_hits(abbe_renderer *renderer, size_t light, size_t first,
                                    abbe_render_progress progress, void *user,
                                    abbe_renderer_hits *out, abbe_error *error);
void abbe_renderer_hits_free(abbe_renderer_hits *hits);

#endif
