#include "validation/compare/compare_notes.h"

#include "base/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
note(abbe_compare_notes *out, const char *format, ...) {
  if (out->count == ABBE_COMPARE_MAX_NOTES) return;
  va_list arguments;
  va_start(arguments, format);
  abbe_number_format_list(out->note[out->count++], sizeof out->note[0], format, arguments);
  va_end(arguments);
}

static void note_files(abbe_compare_notes *out, const abbe_file_comparison *r) {
  static const char *const keys[] = {"abbe:scene", "abbe:unit"};
  for (int side = 0; side < 2; side++)
    if (r->field[side].space_assumed)
      note(out,
           "%.150s does not say its colour space; Rec.709 primaries are assumed, as OpenEXR does",
           r->path[side]);
  for (int side = 0; side < 2; side++)
    if (r->field[side].unread > 0)
      note(
          out,
          "left out are %zu channels of a spectrum in %.150s: of polarised light, re-radiation, or "
          "not named as bands are",
          r->field[side].unread, r->path[side]);
  for (int k = 0; k < 2; k++) {
    const char *a = abbe_file_comparison_attribute(r, 0, keys[k]),
               *b = abbe_file_comparison_attribute(r, 1, keys[k]);
    if (a != NULL && b != NULL && strcmp(a, b) != 0)
      note(out, "the files differ in %s: '%.100s' and '%.100s'", keys[k], a, b);
  }
  for (int side = 0; side < 2; side++) {
    const abbe_field *f = &r->field[side];
    if (r->size[side][0] != f->width || r->size[side][1] != f->height)
      note(out, "%.150s was summed down from %zu x %zu texels", r->path[side], r->size[side][0],
           r->size[side][1]);
  }
}

static void note_observers(abbe_compare_notes *out, const abbe_file_comparison *r) {
  const abbe_observer a = r->field[0].observer, b = r->field[1].observer;
  if (r->field[0].colour.channels == 0) return;
  if (a != b)
    note(out,
         "the files are for two observers, %s and %s: they differ even where they show the same "
         "light",
         abbe_observer_text(a), abbe_observer_text(b));
  else if (a != ABBE_OBSERVER_CIE_1931)
    note(out,
         "both are for the observer %s; u', v', ICtCp and FLIP are defined for the one of 1931",
         abbe_observer_text(a));
}

static void note_units(abbe_compare_notes *out, const abbe_file_comparison *r) {
  const abbe_comparison *c = &r->comparison;
  bool colour = r->field[0].colour.channels > 0;
  if (c->scale != 1)
    note(out,
         "the test was multiplied by %.6g, the factor of least squares; its own energy ratio is "
         "the table's divided by it",
         c->scale);
  note(out, "0.01 in (a-b)^2/(b+0.01)^2 is a hundredth of the reference's mean %s, %.4g",
       colour ? "Y" : "over bands", c->unit);
  if (colour && c->white_found)
    note(out,
         "the white of CIEDE2000 is D65 at Y = %.4g, which the brightest 1 %% of the "
         "reference's lit pixels reach",
         c->white[1]);
  else if (colour)
    note(out, "the white of CIEDE2000 is XYZ = %.4g, %.4g, %.4g, as given", c->white[0],
         c->white[1], c->white[2]);
}

static void note_errors(abbe_compare_notes *out, const abbe_file_comparison *r) {
  const abbe_comparison *c = &r->comparison;
  const abbe_ztest *z = &c->whole.z;
  if (!abbe_file_comparison_has_errors(r, 0))
    note(out, "the reference has no standard errors, so nothing tells its noise from a difference");
  else if (!r->field[0].is_xyz && r->field[0].colour.error != NULL)
    note(out, "noise of X, Y, Z is told from R, G, B at the most, for errors that go together");
  if (c->freedom > 0)
    note(out, "the Z-test takes the standard errors to rest on %.0f estimates (Student's t)",
         c->freedom + 1);
  if (z->untested > 0 && z->count > 0)
    note(out,
         "%zu of %zu samples have no standard error, so they are not in the Z-test; %zu of them "
         "differ",
         z->untested, z->untested + z->count, z->untested_differ);
  const char *seed[2] = {abbe_file_comparison_attribute(r, 0, "abbe:seed"),
                         abbe_file_comparison_attribute(r, 1, "abbe:seed")};
  if (seed[0] != NULL && seed[1] != NULL && strcmp(seed[0], seed[1]) == 0 &&
      abbe_file_comparison_has_errors(r, 0) && abbe_file_comparison_has_errors(r, 1))
    note(out,
         "both were traced with the seed %.20s: noise that they share does not show in their "
         "difference, and less of it is there than is told",
         seed[0]);
  if (c->whole.invalid_reference > 0 || c->whole.invalid_test > 0)
    note(out, "left out: %zu pixels that are not finite in the reference, %zu in the test",
         c->whole.invalid_reference, c->whole.invalid_test);
}

/* Which metrics of light and colour noise explains, in one sentence a region. */
static void note_noise(abbe_compare_notes *out, const abbe_file_comparison *r, bool mask) {
  static const char *const of[] = {"the reference's own noise", "the noise of both"};
  for (int who = 0; who < 2; who++) {
    char list[300] = "";
    size_t used = 0;
    for (int m = 0; m < ABBE_COMPARE_Z_OVER_2; m++) {
      const abbe_compare_value *v = &abbe_file_comparison_region(r, mask)->metric[m];
      abbe_compare_verdict verdict = abbe_compare_judge((abbe_compare_metric)m, v);
      if (verdict != (who == 0 ? ABBE_COMPARE_BELOW_REFERENCE : ABBE_COMPARE_BELOW_BOTH)) continue;
      int n = snprintf(list + used, sizeof list - used, "%s%s", used > 0 ? ", " : "",
                       abbe_compare_metric_text((abbe_compare_metric)m));
      used += n > 0 && used + (size_t)n < sizeof list ? (size_t)n : 0;
    }
    if (used > 0)
      note(out, "%s: the difference is below %s in %s", mask ? r->mask_name : "whole field",
           of[who], list);
  }
}

static void note_z(abbe_compare_notes *out, const abbe_file_comparison *r, bool mask) {
  const abbe_compare_region *region = abbe_file_comparison_region(r, mask);
  if (region->z.count == 0) return;
  bool within = region->z.max <= region->z_critical;
  note(out,
       "%s: the greatest |z| of %zu is %.3g; up to %.3g noise explains it (%g %% chance of one "
       "above): the two %s",
       mask ? r->mask_name : "whole field", region->z.count, region->z.max, region->z_critical,
       100 * ABBE_ZTEST_LEVEL, within ? "agree within their errors" : "differ by more than noise");
}

void abbe_compare_notes_make(const abbe_file_comparison *comparison, abbe_compare_notes *out) {
  *out = (abbe_compare_notes){.count = 0};
  note_files(out, comparison);
  note_observers(out, comparison);
  note_units(out, comparison);
  note_errors(out, comparison);
  for (int mask = 0; mask <= (comparison->comparison.masked ? 1 : 0); mask++) {
    note_noise(out, comparison, mask);
    note_z(out, comparison, mask);
  }
}
