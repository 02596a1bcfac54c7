/* state.h: OpenGL's state around Abbe's passes: what they rely on, whatever a caller left, and what
 * a caller finds afterwards (gl/renderer.h says it). It touches no texture binding, no indexed
 * buffer, no viewport. Internal to gl/.
 */
#ifndef ABBE_GL_DEVICE_STATE_H
#define ABBE_GL_DEVICE_STATE_H

#include "gl/device/api.h"

/* Units from 0 on whose sampler objects are taken away: a sampler would override what a texture
 * says of its own filter. No pass uses further units (bindings.h). */
#define ABBE_GL_STATE_UNITS 18

/* Sets, in the current context, every enable and every setting of rasterising, testing, blending
 * and pixel transfer as GL begins with it, but rows of pixels without padding and cube maps read
 * across their edges; no sampler objects and no pixel buffers. Errors that are pending are
 * dropped. */
void abbe_gl_state_begin(const abbe_gl *gl);

/* GL's own settings once more, rows of pixels padded to 4 bytes; framebuffer 0, no program, no
 * vertex array, texture unit 0 active. */
void abbe_gl_state_end(const abbe_gl *gl);

#endif
