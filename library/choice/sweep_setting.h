/* sweep_setting.h: a table's settings as the renderer's requests, and reversed. */
#ifndef ABBE_LIBRARY_CHOICE_SWEEP_SETTING_H
#define ABBE_LIBRARY_CHOICE_SWEEP_SETTING_H

#include "gl/plan/plan.h"
#include "validation/tradeoff/sweep_table.h"

/* Kinds of polygons by their bits (ABBE_POLYGONS): "plain", "even", "corners", "even+corners", ...
 */
extern const char *const abbe_sweep_polygons[ABBE_POLYGONS_ALL + 1];
extern const char *const abbe_sweep_directions[ABBE_DIRECTION_COUNT]; /* abbe_direction's names */

/* The setting of a resolved request, and the request of a setting (size and space left 0).
 * ABBE_NOT_FOUND for a profile, fill or model of an unknown name. */
void abbe_sweep_setting_of(const abbe_render_desc *desc, abbe_sweep_setting *out);
abbe_result abbe_sweep_setting_desc(const abbe_sweep_setting *setting, abbe_render_desc *out,
                                    abbe_error *error);

/* The tracer's setting: so many passes, each of photons x photons photons. */
void abbe_sweep_setting_of_trace(size_t photons, size_t passes, bool filtered,
                                 abbe_sweep_setting *out);

/* In words, as abbe_preset_describe has them; its label where the renderer does not know it, as of
 * what is traced. */
void abbe_sweep_setting_describe(const abbe_sweep_setting *setting, char *out, size_t size);

/* abbe_preset_is_fine. */
bool abbe_sweep_setting_is_fine(const abbe_sweep_setting *setting);

#endif
