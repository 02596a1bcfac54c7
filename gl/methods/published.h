/* published.h: the profiles of published methods behind one set of verbs: whichever the plan asks
 * for is made, drawn and read. Internal to gl/.
 */
#ifndef ABBE_GL_PUBLISHED_H
#define ABBE_GL_PUBLISHED_H

#include "gl/methods/shah2007/shah2007.h"
#include "gl/methods/thesis/thesis.h"
#include "gl/methods/wand2003/wand2003.h"
#include "gl/methods/wyman2006/wyman2006.h"

typedef struct abbe_published {
  abbe_thesis thesis;
  abbe_shah2007 shah;
  abbe_wyman2006 wyman;
  abbe_wand2003 wand;
} abbe_published;

abbe_result abbe_published_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                abbe_published *out, abbe_error *error);
/* A zeroed one too; it is zeroed. */
void abbe_published_free(abbe_published *published);
/* lit: the light's passes have run and hold, so that the camera's alone run where they keep it. */
abbe_result abbe_published_run(abbe_published *published, bool lit, abbe_error *error);
/* Whether a moved camera leaves what the light's passes make as it is: maps in the light's image,
 * or photons, that hold no frames before. abbe_published_look then follows the camera. */
bool abbe_published_keeps_light(const abbe_render_desc *desc);
void abbe_published_look(abbe_published *published);

/* The frames that a filter over time goes on with, from a renderer that is changed to what it
 * becomes; what is left of them afterwards is the caller's. */
void abbe_published_take_frames(abbe_published *published, abbe_wyman_history *out);
void abbe_published_give_frames(abbe_published *published, abbe_wyman_history *frames);

/* As of abbe_renderer_read and _read_map; filled: after the method's gap fill, where it has one. */
abbe_result abbe_published_read(const abbe_published *published, abbe_image *out,
                                abbe_error *error);
abbe_result abbe_published_read_map(abbe_published *published, bool filled, abbe_image *out,
                                    abbe_error *error);
const abbe_map_layout *abbe_published_layout(const abbe_published *published);
GLuint abbe_published_picture(const abbe_published *published);
/* Photons of the last frame with statistics; of how many cells; and how many polygons lie over a
 * pixel, in the mean, where photons are drawn as polygons. */
size_t abbe_published_photons(const abbe_published *published);
size_t abbe_published_cells(const abbe_published *published);
double abbe_published_layers(const abbe_published *published);

#endif
