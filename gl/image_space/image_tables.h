/* image_tables.h: what programs of the published methods are told of the request: definitions, and
 * the colours of wavelengths. Internal to gl/.
 */
#ifndef ABBE_GL_IMAGE_SPACE_IMAGE_TABLES_H
#define ABBE_GL_IMAGE_SPACE_IMAGE_TABLES_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>
#include <stddef.h>

/* WAVELENGTHS, INTERFACES, AS_PRINTED and the estimators' numbers; the characters that are used. */
size_t abbe_image_tables_define(const abbe_render_desc *desc, char *out, size_t size);

/* Of unit light at each wavelength: XYZ, or RGB as printed; by_white: of the sum of all. malloc'd.
 * ABBE_NO_MEMORY. */
abbe_result abbe_image_tables_colours(const abbe_gpu_scene *scene, bool by_white, float (**out)[3],
                                      abbe_error *error);

#endif
