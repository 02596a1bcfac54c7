#include "validation/measure/gem/gem_judgement.h"

#include "base/maths.h"
#include "colorimetry/difference.h"

#include <math.h>
#include <string.h>

void abbe_gem_judgement_free(abbe_gem_judgement *judgement) {
  if (judgement == NULL) return;
  abbe_gem_view_free(&judgement->view);
  abbe_gem_tilts_free(&judgement->tilts);
  memset(judgement, 0, sizeof *judgement);
}

/* Under tilts, where each ray takes ten times as long. */
enum { CRYSTAL_REPEATS = 4 };

abbe_gem_axes abbe_gem_orientation_axes(const abbe_gem_stone *stone, double tilt, double azimuth) {
  const double s = sin(tilt), c = cos(tilt), sa = sin(azimuth), ca = cos(azimuth);
  if (!abbe_media_is_biaxial(&stone->media, 0)) return (abbe_gem_axes){.z = {s * ca, s * sa, c}};
  return (abbe_gem_axes){.z = {s, 0, c}, .x = {-c * ca, sa, s * ca}};
}

/* A copy of the stone, with axes of its own. */
abbe_result abbe_gem_orientation_judge(const abbe_gem_stone *stone, const abbe_weights *weights,
                                       const abbe_gem_view_desc *desc, abbe_gem_amount measure,
                                       abbe_gem_orientation *out, abbe_error *error) {
  double axis[1][3], frame[1][3][3], xyz[3];
  abbe_gem_stone turned = *stone;
  abbe_gem_view view = {0};
  turned.media.axis = axis;
  turned.media.frame = frame;
  const abbe_gem_axes axes = abbe_gem_orientation_axes(stone, out->tilt_rad, out->azimuth_rad);
  ABBE_TRY(abbe_gem_stone_turn(&turned, &axes, error));
  ABBE_TRY(abbe_gem_view_make(&turned, weights, desc, &view, error));
  out->value = abbe_gem_view_amount(&view, measure);
  for (int c = 0; c < 3; c++) xyz[c] = abbe_gem_sums_ratio(&view.colour[c]).value;
  abbe_difference_lab(xyz, weights->sum, out->lab);
  abbe_gem_view_free(&view);
  return ABBE_OK;
}

static abbe_result judge_orientations(const abbe_gem_stone *stone, const abbe_weights *weights,
                                      const abbe_gem_view_desc *desc, abbe_gem_judgement *j,
                                      abbe_error *error) {
  static const double tilt[] = {0, ABBE_PI / 2, ABBE_PI / 2}, azimuth[] = {0, 0, ABBE_PI / 2};
  enum { LEAST = 8 };
  abbe_gem_view_desc view = *desc;
  view.side = j->view.side / 2 > LEAST ? j->view.side / 2 : LEAST;
  j->is_crystal = abbe_media_is_crystal(&stone->media, 0);
  j->is_biaxial = abbe_media_is_biaxial(&stone->media, 0);
  for (int i = 0; i < ABBE_GEM_ORIENTATIONS && j->is_crystal; i++) {
    j->orientation[i] = (abbe_gem_orientation){.tilt_rad = tilt[i], .azimuth_rad = azimuth[i]};
    ABBE_TRY(
        abbe_gem_orientation_judge(stone, weights, &view, ABBE_GEM_ISO, &j->orientation[i], error));
  }
  return ABBE_OK;
}

/* There are many tilts: an eighth of the view's side each. */
static size_t tilts_side(size_t side) {
  enum { LEAST = 4 };
  return side / 8 > LEAST ? side / 8 : LEAST;
}

abbe_result abbe_gem_judgement_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                                    const abbe_gem_judgement_desc *desc, abbe_gem_judgement *out,
                                    abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_result result = abbe_gem_view_make(stone, weights, &desc->view, &out->view, error);
  if (result == ABBE_OK) {
    for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++)
      out->amount[a] = abbe_gem_view_amount(&out->view, (abbe_gem_amount)a);
    for (int c = 0; c < 3; c++) out->xyz[c] = abbe_gem_sums_ratio(&out->view.colour[c]);
    out->contrast = abbe_gem_view_contrast(&out->view);
    result = abbe_gem_view_areas(&out->view, &out->areas, error);
  }
  if (result == ABBE_OK) result = judge_orientations(stone, weights, &desc->view, out, error);
  if (result == ABBE_OK && desc->tilts) {
    abbe_gem_tilts_desc rocked = desc->rocked;
    rocked.head_rad = desc->view.head_rad;
    rocked.threads = desc->view.threads;
    if (rocked.side == 0) rocked.side = tilts_side(out->view.side);
    if (rocked.repeats == 0 && out->is_crystal) rocked.repeats = CRYSTAL_REPEATS;
    result = abbe_gem_tilts_make(stone, weights, &rocked, &out->tilts, error);
    out->has_tilts = result == ABBE_OK;
  }
  if (result != ABBE_OK) abbe_gem_judgement_free(out);
  return result;
}

static const char *const lies[2][ABBE_GEM_ORIENTATIONS] = {
    {"brightness, optic axis upright", "brightness, optic axis along x",
     "brightness, optic axis along y"},
    {"brightness, crystal's z up", "brightness, crystal's x up", "brightness, crystal's y up"}};

const char *abbe_gem_orientation_text(const abbe_gem_judgement *j, int i) {
  return lies[j->is_biaxial][i] + strlen("brightness, ");
}

size_t abbe_gem_judgement_rows(const abbe_gem_judgement *j,
                               abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS]) {
  size_t count = 0;
  for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++)
    row[count++] =
        (abbe_gem_judgement_row){abbe_gem_amount_name((abbe_gem_amount)a),
                                 abbe_gem_amount_text((abbe_gem_amount)a), j->amount[a], true};
  row[count++] = (abbe_gem_judgement_row){"area_brilliant", "area that mostly returns light",
                                          j->areas.brilliant, true};
  row[count++] = (abbe_gem_judgement_row){"area_window", "area that mostly leaks: windows",
                                          j->areas.window, true};
  row[count++] = (abbe_gem_judgement_row){"area_extinct", "area that is mostly dark: extinction",
                                          j->areas.extinct, true};
  row[count++] = (abbe_gem_judgement_row){"contrast", "contrast of the light return, RMS over mean",
                                          j->contrast, false};
  static const char *const name[2][ABBE_GEM_ORIENTATIONS] = {
      {"iso_upright", "iso_lying_x", "iso_lying_y"}, {"iso_z_up", "iso_x_up", "iso_y_up"}};
  for (int i = 0; i < ABBE_GEM_ORIENTATIONS && j->is_crystal; i++)
    row[count++] = (abbe_gem_judgement_row){name[j->is_biaxial][i], lies[j->is_biaxial][i],
                                            j->orientation[i].value, true};
  if (!j->has_tilts) return count;
  const abbe_gem_tilts *t = &j->tilts;
  row[count++] = (abbe_gem_judgement_row){"tilt_iso", "brightness, mean over tilts",
                                          t->mean[ABBE_GEM_TILT_ISO], true};
  row[count++] =
      (abbe_gem_judgement_row){"tilt_spread", "its standard deviation over tilts", t->spread, true};
  if (t->has_fire)
    row[count++] = (abbe_gem_judgement_row){"fire", "fire: coloured pixels under small lamps",
                                            t->mean[ABBE_GEM_TILT_FIRE], true};
  row[count++] = (abbe_gem_judgement_row){
      "scintillation", "scintillation: pixels that blink, a step", t->blinks, true};
  return count;
}
