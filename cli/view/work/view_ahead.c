#include "cli/view/work/view_ahead.h"

enum { PHOTONS = 32, TEXELS = 128 };

/* Programs are the same for pictures and grids of any size; but llvmpipe compiles one once more for
 * what is a power of two or is not any more. */
static size_t small(size_t side) {
  const bool power = (side & (side - 1)) == 0;
  return side <= 32 ? side : power ? 32 : 48;
}

abbe_result abbe_view_ahead_give(abbe_view_ahead *ahead, const char *materials,
                                 const abbe_caustic_volume *volume, void (*wake)(void),
                                 abbe_view_request *request, abbe_error *error) {
  abbe_result result = ABBE_OK;
  if (ahead->worker == NULL)
    result = abbe_view_worker_make(materials, volume, wake, &ahead->worker, error);
  if (result != ABBE_OK) {
    abbe_view_document_free(&request->document);
    return result;
  }
  request->width = small(request->width);
  request->height = small(request->height);
  request->document.photons = PHOTONS;
  request->document.map_size = TEXELS;
  request->job.compiles = true;
  abbe_view_worker_give(ahead->worker, request);
  return ABBE_OK;
}

bool abbe_view_ahead_idle(const abbe_view_ahead *ahead) {
  return ahead->worker == NULL || abbe_view_worker_idle(ahead->worker);
}

bool abbe_view_ahead_take(abbe_view_ahead *ahead) {
  if (ahead->worker == NULL || !abbe_view_worker_take(ahead->worker, &ahead->taken)) return false;
  abbe_view_result_free(&ahead->taken);
  return true;
}

void abbe_view_ahead_free(abbe_view_ahead *ahead) {
  abbe_view_worker_free(ahead->worker);
  ahead->worker = NULL;
}
