#include "tests/extremes/laws.h"

#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <string.h>

/* What rounding to whole units may take from the ledger (docs/rendering.md), or from one of X, Y
 * and Z against the others. */
static const double closed = 1e-4;
/* What bridging may correct of the light that is reached, by the quadrature over wavelengths alone:
 * 9e-4 is seen in stones of a thousand facets, 5e-3 where there are two wavelengths, or where the
 * index is larger by a tenth or more in the blue than in the red. */
static const double corrected = 1e-3, corrected_coarsely = 1e-2;
/* A picture's X, Y and Z come from ACEScg by a matrix whose terms nearly cancel where a colour is
 * at the edge of the visible ones: some roundings of the brightest. */
static const double rounding = 1e-6;

static abbe_result read_frame(abbe_renderer *renderer, extreme_frame *out, abbe_error *error) {
  abbe_result result = abbe_renderer_frame(renderer, NULL, NULL, &out->statistics, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, &out->picture, error);
  if (result != ABBE_OK || !abbe_renderer_plan(renderer)->caustics) return result;
  abbe_renderer_map_layout(renderer, 0, &out->layout);
  return abbe_renderer_read_map(renderer, 0, true, &out->map, error);
}

/* Faces of a cube have no layout in common but a given one: the floor as the light sees it. */
static void look_down(const abbe_scene *scene, abbe_map_layout *out) {
  static const double down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  abbe_view view;
  abbe_view_look(scene->light[0].position, down, up, false, &view);
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].material == NULL)
      abbe_view_fit(&view, (const double(*)[3])scene->object[i].mesh.position,
                    scene->object[i].mesh.vertex_count);
  abbe_view_pad(&view, 0.01);
  abbe_map_layout_make(&view, out);
}

abbe_result extreme_frame_make(abbe_context *context, const extreme *e, extreme_frame *out,
                               abbe_error *error) {
  abbe_render_desc desc = extreme_desc(e);
  abbe_renderer *renderer = NULL;
  memset(out, 0, sizeof *out);
  abbe_result result = extreme_load(&e->scene, &out->scene, error);
  if (result == ABBE_OK) result = abbe_renderer_make(context, &out->scene, &desc, &renderer, error);
  abbe_map_layout layout;
  if (result == ABBE_OK && abbe_renderer_plan(renderer)->cubes && desc.map_layout == NULL) {
    look_down(&out->scene, &layout);
    desc.map_layout = &layout;
    abbe_renderer_free(renderer);
    renderer = NULL;
    result = abbe_renderer_make(context, &out->scene, &desc, &renderer, error);
  }
  if (result == ABBE_OK) result = read_frame(renderer, out, error);
  abbe_renderer_free(renderer);
  if (result != ABBE_OK) extreme_frame_free(out);
  return result;
}

void extreme_frame_free(extreme_frame *frame) {
  abbe_image_free(&frame->picture);
  abbe_image_free(&frame->map);
  abbe_scene_free(&frame->scene);
}

double extreme_sum(const abbe_image *image, size_t channel) {
  double sum = 0;
  for (size_t i = 0; i < image->width * image->height; i++)
    sum += (double)image->data[i * image->channels + channel];
  return sum;
}

double extreme_max(const abbe_image *image, size_t channel) {
  double most = 0;
  for (size_t i = 0; i < image->width * image->height; i++)
    most = fmax(most, (double)image->data[i * image->channels + channel]);
  return most;
}

static void check_numbers(const char *what, const abbe_image *image, double slack,
                          extreme_row *row) {
  size_t count = image->width * image->height * image->channels;
  double most = 0, least = 0;
  for (size_t i = 0; i < count; i++) {
    double x = (double)image->data[i];
    if (!isfinite(x)) {
      extreme_row_break(row, "%s: value %zu of %zu is %g", what, i, count, x);
      return;
    }
    most = fmax(most, x);
    least = fmin(least, x);
  }
  if (least < -slack * most) extreme_row_break(row, "%s: %g of %g is negative", what, least, most);
}

static void check_ledger(const extreme *e, const extreme_frame *f, extreme_row *row) {
  const abbe_ledger *l = &f->statistics.energy;
  const double entry[] = {l->reached, l->reflected, l->absorbed,
                          l->trapped, l->missed,    l->deposited};
  for (size_t i = 0; i < sizeof entry / sizeof *entry; i++)
    if (!(entry[i] >= 0) || !isfinite(entry[i]))
      extreme_row_break(row, "the ledger's entry %zu is %g", i, entry[i]);
  double imbalance = abbe_ledger_imbalance(l);
  extreme_row_add(row, "ledger %.1e", imbalance);
  if (!(imbalance < closed)) extreme_row_break(row, "the ledger is open by %g", imbalance);
  bool coarse = e->desc.wavelengths == 2 || e->scene.b >= 0.1;
  if (!(fabs(l->interpolated) <= (coarse ? corrected_coarsely : corrected) * l->reached))
    extreme_row_break(row, "%g W of the %g W that are reached are interpolated", l->interpolated,
                      l->reached);
  if (e->dark != (l->deposited == 0))
    extreme_row_break(row, "%g W are in the map, of %g W that reached a refractor", l->deposited,
                      l->reached);
}

/* The white of the first light over the range. */
static bool white_of(const extreme *e, const extreme_frame *f, double white[3]) {
  abbe_render_desc d = extreme_desc(e);
  abbe_wavelengths w = {0};
  abbe_weights weights = {0};
  bool known = abbe_wavelengths_make(1, d.min_nm != 0 ? d.min_nm : ABBE_WAVELENGTH_MIN_NM,
                                     d.max_nm != 0 ? d.max_nm : ABBE_WAVELENGTH_MAX_NM, &w,
                                     NULL) == ABBE_OK &&
               abbe_weights_make(&w, &f->scene.light[0].illuminant, ABBE_RGB_SPACE_XYZ, &weights,
                                 NULL) == ABBE_OK;
  for (int c = 0; c < 3 && known; c++) white[c] = weights.sum[c];
  abbe_weights_free(&weights);
  abbe_wavelengths_free(&w);
  return known;
}

/* The map holds what the ledger says that receivers' pages do not, and X and Z as much as Y: a sum
 * that had wrapped around would lack at least as much as all light together, and one that starved
 * its small parts. */
static void check_map(const extreme *e, const extreme_frame *f, extreme_row *row) {
  const abbe_ledger *energy = &f->statistics.energy;
  double deposited = energy->deposited - energy->on_tiles, white[3], worst = 0;
  if (f->map.data == NULL || f->scene.light_count > 1 || !(deposited > 0)) return;
  if (!white_of(e, f, white)) {
    extreme_row_break(row, "the light has no white");
    return;
  }
  double y = extreme_sum(&f->map, 1);
  if (!(fabs(y / deposited - 1) < 1e-5))
    extreme_row_break(row, "the map holds %g W of %g W", y, deposited);
  for (size_t c = 0; c < 3; c++)
    worst = fmax(worst, fabs(extreme_sum(&f->map, c) / y * white[1] / white[c] - 1));
  extreme_row_add(row, ", colour %.1e", worst);
  if (!(worst < (e->scene.b == 0 ? closed : e->scene.b < 0.1 ? 0.1 : 1)))
    extreme_row_break(row, "X or Z is off Y by %g", worst);
}

static void check_refusal(const extreme *e, abbe_result result, const abbe_error *error,
                          extreme_row *row) {
  const char *reason = e->reason != NULL ? e->reason : "";
  if (result != e->refused)
    extreme_row_break(row, "%s instead of %s: %s", abbe_result_text(result),
                      abbe_result_text(e->refused), error->text);
  else if (strstr(error->text, reason) == NULL)
    extreme_row_break(row, "the reason '%s' does not say '%s'", error->text, reason);
  extreme_row_add(row, "refused: %s", error->text);
}

void extreme_check(abbe_context *context, const extreme *e, extreme_row *row) {
  extreme_frame frame;
  abbe_error error = {0};
  abbe_result result = extreme_frame_make(context, e, &frame, &error);
  if (result != ABBE_OK || e->refused != ABBE_OK) {
    check_refusal(e, result, &error, row);
    if (result == ABBE_OK) extreme_frame_free(&frame);
    return;
  }
  check_ledger(e, &frame, row);
  check_map(e, &frame, row);
  check_numbers("picture", &frame.picture, rounding, row);
  if (frame.map.data != NULL) check_numbers("map", &frame.map, 0, row);
  extreme_frame_free(&frame);
}
