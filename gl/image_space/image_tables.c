#include "gl/image_space/image_tables.h"

#include "scenes/view/estimator.h"

#include <stdio.h>
#include <stdlib.h>

size_t abbe_image_tables_define(const abbe_render_desc *d, char *out, size_t size) {
  size_t used = (size_t)snprintf(out, size, "#define WAVELENGTHS %zu\n#define INTERFACES %zu\n%s",
                                 d->wavelengths, d->interfaces,
                                 abbe_profile_is_printed(d->profile) ? "#define AS_PRINTED\n" : "");
#define ABBE_DEFINE(code, name)                                                                    \
  used += (size_t)snprintf(out + used, size - used, "#define ESTIMATOR_" #code " %d\n",            \
                           (int)ABBE_ESTIMATOR_##code);
  ABBE_ESTIMATORS(ABBE_DEFINE)
#undef ABBE_DEFINE
  return used;
}

abbe_result abbe_image_tables_colours(const abbe_gpu_scene *scene, bool by_white, float (**out)[3],
                                      abbe_error *error) {
  const size_t n = scene->plan->desc.wavelengths;
  const bool printed = abbe_profile_is_printed(scene->plan->desc.profile);
  float(*colour)[3] = calloc(n, sizeof *colour);
  *out = colour;
  if (colour == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for colours");
  for (size_t i = 0; i < n; i++)
    for (size_t c = 0; c < 3; c++) {
      colour[i][c] = !printed ? (float)scene->tables.camera.weight[i][c]
                     : n == 1 ? 1.0f
                              : (float)(i + c == 2); /* blue, green, red */
      if (by_white && !printed) colour[i][c] /= (float)scene->tables.camera.sum[c];
    }
  return ABBE_OK;
}
