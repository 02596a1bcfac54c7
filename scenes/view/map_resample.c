#include "scenes/view/map_layout.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>

/* Views of one light: from one place, or along one direction. */
static bool same_light(const abbe_view *a, const abbe_view *b) {
  if (a->orthographic != b->orthographic) return false;
  double apart[3];
  abbe_vector_subtract(a->orthographic ? a->forward : a->origin,
                       a->orthographic ? b->forward : b->origin, apart);
  return abbe_vector_length(apart) <= 1e-6 * (a->orthographic ? 1 : a->near);
}

/* A place on the ray through uv that both views have in front of them. */
static void place_of(const abbe_map_layout *layout, const double uv[2], double p[3]) {
  double direction[3];
  abbe_map_layout_ray(layout, uv, p, direction);
  for (int k = 0; k < 3; k++) p[k] += layout->view.near * direction[k];
}

static bool has_light(const float *texel, size_t channels) {
  for (size_t c = 0; c < channels; c++)
    if (texel[c] != 0) return true;
  return false;
}

typedef struct work {
  const abbe_image *from;
  abbe_map_layout layout; /* layout of from */
  const abbe_map_layout *to;
  size_t width, height, parts;
  double *sum; /* [height][width][channels] */
} work;

static void spread(const work *w, size_t x, size_t y) {
  size_t channels = w->from->channels;
  const float *texel = w->from->data + (y * w->from->width + x) * channels;
  if (!has_light(texel, channels)) return;
  double share = 1 / ((double)w->parts * (double)w->parts);
  for (size_t k = 0; k < w->parts * w->parts; k++) {
    double dx = ((double)(k % w->parts) + 0.5) / (double)w->parts;
    double dy = ((double)(k / w->parts) + 0.5) / (double)w->parts;
    double uv[2] = {((double)x + dx) / (double)w->from->width,
                    1 - ((double)y + dy) / (double)w->from->height};
    double p[3];
    size_t column, row;
    place_of(&w->layout, uv, p);
    if (!abbe_map_layout_texel(w->to, w->width, w->height, p, &column, &row)) continue;
    double *sum = w->sum + (row * w->width + column) * channels;
    for (size_t c = 0; c < channels; c++) sum[c] += share * (double)texel[c];
  }
}

static abbe_result fill(work *w, abbe_image *out, abbe_error *error) {
  size_t count = w->width * w->height * w->from->channels;
  w->sum = calloc(count, sizeof *w->sum);
  if (w->sum == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a map of %zu x %zu texels",
                          w->width, w->height);
  for (size_t y = 0; y < w->from->height; y++)
    for (size_t x = 0; x < w->from->width; x++) spread(w, x, y);
  for (size_t i = 0; i < count; i++) out->data[i] = (float)w->sum[i];
  free(w->sum);
  for (int i = 0; i < 8; i++) out->xy[i] = w->from->xy[i];
  const char *light = abbe_image_attribute_text(w->from, "abbe:map_light");
  return abbe_map_layout_write(w->to, light, out, error);
}

abbe_result abbe_map_resample(const abbe_image *from, const char *name, const abbe_map_layout *to,
                              size_t width, size_t height, size_t parts, abbe_image *out,
                              abbe_error *error) {
  work w = {.from = from, .to = to, .width = width, .height = height, .parts = parts};
  *out = (abbe_image){0};
  if (parts < 1 || parts > ABBE_MAP_RESAMPLE_MAX_PARTS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a texel cannot be cut into %zu parts a side; it may be 1 to %d", parts,
                          ABBE_MAP_RESAMPLE_MAX_PARTS);
  abbe_result result = abbe_map_layout_read(from, name, &w.layout, error);
  if (result != ABBE_OK) return result;
  if (!same_light(&w.layout.view, &to->view))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s is the map of a light in another place than the layout's", name);
  result = abbe_image_make(width, height, from->channels, (const char *const *)from->channel, out,
                           error);
  if (result == ABBE_OK) result = fill(&w, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
