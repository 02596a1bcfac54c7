/* float4.h: rows of four floats, as shaders read tables. Internal to gl/.
 */
#ifndef ABBE_GL_DEVICE_FLOAT4_H
#define ABBE_GL_DEVICE_FLOAT4_H

static inline void abbe_float4_store(const double v[3], double w, float out[4]) {
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
  out[3] = (float)w;
}

#endif
