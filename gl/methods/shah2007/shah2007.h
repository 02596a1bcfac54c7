/* shah2007.h: caustics mapping as it was published, and in units. Internal to gl/methods/.
 */
#ifndef ABBE_GL_METHODS_SHAH2007_SHAH2007_H
#define ABBE_GL_METHODS_SHAH2007_SHAH2007_H

#include "gl/methods/image_space/method.h"

typedef struct abbe_shah2007 {
  abbe_method base;
  GLuint splat, low_pass; /* programs */
  GLuint map, smoothed;   /* arrays of a cube's faces; smoothed: where the map is filtered */
} abbe_shah2007;

#endif
