#include "validation/sweep/sweep_reference.h"

#include "colorimetry/image/exr.h"
#include "library/choice/matched_physics.h"
#include "scenes/view/map_layout.h"
#include "validation/sweep/sweep_hash.h"
#include "validation/sweep/sweep_measure.h"
#include "validation/tracer/reference.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { DEFAULT_TEXELS = 256, STAMP = 256 };

/* Says for which scene and request a reference was traced, so that no other takes it. */
static const char *const stamp_name = "abbe:sweep";

abbe_result abbe_sweep_reference_name(const char *table, bool matched, abbe_sweep_reference *out,
                                      abbe_error *error) {
  const char *dot = strrchr(table, '.'), *slash = strrchr(table, '/');
  const char *kind = matched ? "matched" : "reference";
  int stem =
      dot != NULL && (slash == NULL || dot > slash) ? (int)(dot - table) : (int)strlen(table);
  if (stem > ABBE_SWEEP_PATH - 64)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the path '%.80s…' is too long", table);
  snprintf(out->picture_path, ABBE_SWEEP_PATH, "%.*s-%s.exr", stem, table, kind);
  snprintf(out->map_path, ABBE_SWEEP_PATH, "%.*s-%s-map.exr", stem, table, kind);
  snprintf(out->checkpoint_path, ABBE_SWEEP_PATH, "%.*s-%s.checkpoint", stem, table, kind);
  return ABBE_OK;
}

void abbe_sweep_reference_free(abbe_sweep_reference *reference) {
  if (reference == NULL) return;
  abbe_image_free(&reference->picture);
  abbe_image_free(&reference->map);
}

static size_t texels_of(const abbe_sweep_reference_desc *d) {
  return d->texels > 0 ? d->texels : DEFAULT_TEXELS;
}

static size_t passes_of(const abbe_sweep_reference_desc *d) {
  return d->passes > 0 ? d->passes : ABBE_REFERENCE_PASSES;
}

static void make_stamp(const abbe_scene *scene, const abbe_sweep_reference_desc *d,
                       char stamp[STAMP]) {
  snprintf(
      stamp, STAMP,
      "scene %016llx, %zu x %zu pixels, %zu texels a side, %d bands, %zu passes of %zu photons, %s",
      abbe_sweep_hash_scene(scene), d->width > 0 ? d->width : scene->camera.width,
      d->height > 0 ? d->height : scene->camera.height, texels_of(d), ABBE_SWEEP_BANDS,
      passes_of(d), d->photons, d->matched ? "matched" : "full");
}

static bool is_stamped(const char *path, const char *stamp, abbe_image *image) {
  if (access(path, F_OK) != 0 || abbe_exr_read(path, image, NULL) != ABBE_OK) return false;
  const char *text = abbe_image_attribute_text(image, stamp_name);
  if (text != NULL && strcmp(text, stamp) == 0) return true;
  abbe_image_free(image);
  return false;
}

/* Written and read again, so that every run has the same image to the bit. */
static abbe_result keep(abbe_image *image, const char *stamp, const char *path, abbe_error *error) {
  abbe_result result = abbe_image_set_attribute(image, stamp_name, stamp, error);
  if (result == ABBE_OK) result = abbe_exr_write(path, image, error);
  if (result != ABBE_OK) return result;
  abbe_image_free(image);
  return abbe_exr_read(path, image, error);
}

static abbe_result trace(abbe_context *context, const abbe_scene *scene,
                         const abbe_sweep_reference_desc *d, const char *stamp,
                         abbe_sweep_reference *to, abbe_error *error) {
  abbe_map_layout layout;
  abbe_reference_desc desc = {.trace = {.width = d->width,
                                        .height = d->height,
                                        .layout = &layout,
                                        .photons = d->photons,
                                        .bands = ABBE_SWEEP_BANDS,
                                        .seed = d->seed,
                                        .map_width = texels_of(d),
                                        .map_height = texels_of(d)},
                              .passes = passes_of(d),
                              .checkpoint = to->checkpoint_path,
                              .progress = d->progress,
                              .user = d->user,
                              .stop = d->stop};
  abbe_result result = abbe_sweep_fit_layout(context, scene, 0, &layout, error);
  if (result == ABBE_OK && d->matched)
    result = abbe_matched_physics(scene, 0, 0, &desc.trace.physics, error);
  if (result == ABBE_OK) result = abbe_reference_trace(scene, &desc, &to->picture, &to->map, error);
  if (result == ABBE_OK) result = keep(&to->picture, stamp, to->picture_path, error);
  if (result == ABBE_OK) result = keep(&to->map, stamp, to->map_path, error);
  if (result == ABBE_OK) unlink(to->checkpoint_path);
  return result;
}

abbe_result abbe_sweep_reference_find(abbe_context *context, const abbe_scene *scene,
                                      const abbe_sweep_reference_desc *desc,
                                      abbe_sweep_reference *reference, abbe_error *error) {
  char stamp[STAMP];
  make_stamp(scene, desc, stamp);
  if (is_stamped(reference->picture_path, stamp, &reference->picture)) {
    if (is_stamped(reference->map_path, stamp, &reference->map)) {
      unlink(reference->checkpoint_path); /* a kill may have left it: another request refuses it */
      return ABBE_OK;
    }
    abbe_image_free(&reference->picture);
  }
  return trace(context, scene, desc, stamp, reference, error);
}

abbe_result abbe_sweep_reference_load(const abbe_scene *scene, const char *picture, const char *map,
                                      abbe_sweep_reference *out, size_t *light, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_map_layout layout;
  *out = (abbe_sweep_reference){0};
  *light = 0;
  snprintf(out->picture_path, ABBE_SWEEP_PATH, "%s", picture != NULL ? picture : "");
  snprintf(out->map_path, ABBE_SWEEP_PATH, "%s", map != NULL ? map : "");
  if (picture != NULL) result = abbe_exr_read(picture, &out->picture, error);
  if (result != ABBE_OK || map == NULL) return result;
  result = abbe_exr_read(map, &out->map, error);
  if (result == ABBE_OK) result = abbe_map_layout_read(&out->map, map, &layout, error);
  const char *name = abbe_image_attribute_text(&out->map, "abbe:map_light");
  return result == ABBE_OK && name != NULL ? abbe_scene_find_light(scene, name, light, error)
                                           : result;
}
