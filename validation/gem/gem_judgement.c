#include "validation/gem/gem_judgement.h"

#include <string.h>

void abbe_gem_judgement_free(abbe_gem_judgement *judgement) {
  if (judgement == NULL) return;
  abbe_gem_view_free(&judgement->view);
  abbe_gem_tilts_free(&judgement->tilts);
  memset(judgement, 0, sizeof *judgement);
}

static abbe_gem_number colour(const abbe_gem_view *v, int c) {
  double sum[ABBE_GEM_MOST_REPEATS];
  for (size_t r = 0; r < v->repeats; r++) sum[r] = v->colour[r][c];
  return abbe_gem_number_ratio(sum, v->met, v->repeats);
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
    for (int c = 0; c < 3; c++) out->xyz[c] = colour(&out->view, c);
    out->contrast = abbe_gem_view_contrast(&out->view);
    result = abbe_gem_view_areas(&out->view, &out->areas, error);
  }
  if (result == ABBE_OK && desc->tilts) {
    abbe_gem_tilts_desc rocked = desc->rocked;
    rocked.head_rad = desc->view.head_rad;
    rocked.threads = desc->view.threads;
    if (rocked.side == 0) rocked.side = tilts_side(out->view.side);
    result = abbe_gem_tilts_make(stone, weights, &rocked, &out->tilts, error);
    out->has_tilts = result == ABBE_OK;
  }
  if (result != ABBE_OK) abbe_gem_judgement_free(out);
  return result;
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
