/* photon_hit.h: where a photon meets a receiver, as shaders keep it (outgoing_segment.glsl): place
 * and flux in four floats, then the interface that the light left. Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_PHOTON_HIT_H
#define ABBE_GL_LIGHT_PHOTON_HIT_H

enum { ABBE_HIT_BYTES = 32 };

#endif
