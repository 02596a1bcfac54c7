#include "library/choice/sweep_setting.h"

#include "gl/accuracy/preset_choice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const abbe_sweep_polygons[] = {"plain",
                                           "even",
                                           "corners",
                                           "even+corners",
                                           "culled",
                                           "even+culled",
                                           "corners+culled",
                                           "even+corners+culled",
                                           "in-light",
                                           "even+in-light",
                                           "corners+in-light",
                                           "even+corners+in-light",
                                           "culled+in-light",
                                           "even+culled+in-light",
                                           "corners+culled+in-light",
                                           "even+corners+culled+in-light"};

#define NAME(code, name) name,
const char *const abbe_sweep_directions[] = {ABBE_DIRECTIONS(NAME)};
#undef NAME

/* The kinds that a setting's words name; ABBE_POLYGONS_ALL + 1: there is no such kind. */
static unsigned polygons_of(const char *words) {
  unsigned bits = 0;
  while (bits <= ABBE_POLYGONS_ALL && *words != '\0' &&
         strcmp(abbe_sweep_polygons[bits], words) != 0)
    bits++;
  return bits;
}

void abbe_sweep_setting_of_trace(size_t photons, size_t passes, bool filtered,
                                 abbe_sweep_setting *out) {
  *out = (abbe_sweep_setting){.photons = photons,
                              .passes = passes,
                              .samples = 1,
                              .upsample = 1,
                              .history = 1,
                              .share = 0.01, /* without effect, as the words below */
                              .fill = "none",
                              .model = "auto"};
  snprintf(out->profile, sizeof out->profile, "%s",
           filtered ? ABBE_SWEEP_TRACE_FILTER : ABBE_SWEEP_TRACE);
}

void abbe_sweep_setting_of(const abbe_render_desc *d, abbe_sweep_setting *out) {
  bool thesis = abbe_method_of(d->profile)->own_passes;
  *out = (abbe_sweep_setting){.wavelengths = d->wavelengths,
                              .photons = d->photons,
                              .map = d->map_size,
                              /* without effect there: one setting whatever was asked */
                              .samples = thesis ? 1 : d->supersample,
                              .upsample = d->upsample,
                              .share = thesis ? 0.01 : d->energy_share,
                              .exits = d->exits,
                              .history = d->history > 1 ? d->history : 1};
  if (!abbe_method_of(d->profile)->own_passes && d->transport == ABBE_TRANSPORT_PINHOLE)
    snprintf(out->profile, sizeof out->profile, "%s%zu", ABBE_SWEEP_PINHOLE, d->pinholes);
  else
    snprintf(out->profile, sizeof out->profile, "%s", abbe_profile_name(d->profile));
  if (d->polygons > 0 && d->polygons <= ABBE_POLYGONS_ALL)
    snprintf(out->polygons, sizeof out->polygons, "%s", abbe_sweep_polygons[d->polygons]);
  if (d->direction != abbe_method_of(d->profile)->direction && d->direction != ABBE_DIRECTION_AUTO)
    snprintf(out->direction, sizeof out->direction, "%s", abbe_sweep_directions[d->direction]);
  snprintf(out->fill, sizeof out->fill, "%s", abbe_fill_name(d->fill));
  snprintf(out->model, sizeof out->model, "%s", abbe_model_name(d->model));
}

/* 0: it is another contestant. */
static size_t pinholes_of(const char *profile) {
  const size_t length = strlen(ABBE_SWEEP_PINHOLE);
  if (strncmp(profile, ABBE_SWEEP_PINHOLE, length) != 0) return 0;
  char *end = NULL;
  const unsigned long count = strtoul(profile + length, &end, 10);
  return *end == '\0' && count <= ABBE_SURFACE_MAX_SAMPLES ? count : 0;
}

abbe_result abbe_sweep_setting_desc(const abbe_sweep_setting *setting, abbe_render_desc *out,
                                    abbe_error *error) {
  int profile = 0, fill = 0, model = 0, direction = 0;
  const size_t pinholes = pinholes_of(setting->profile);
  const unsigned polygons = polygons_of(setting->polygons);
  while (pinholes == 0 && profile < ABBE_PROFILE_COUNT &&
         strcmp(abbe_profile_name((abbe_profile)profile), setting->profile) != 0)
    profile++;
  while (fill < ABBE_FILL_COUNT && strcmp(abbe_fill_name((abbe_fill)fill), setting->fill) != 0)
    fill++;
  while (model < ABBE_MODEL_COUNT &&
         strcmp(abbe_model_name((abbe_model)model), setting->model) != 0)
    model++;
  while (direction < ABBE_DIRECTION_COUNT && setting->direction[0] != '\0' &&
         strcmp(abbe_sweep_directions[direction], setting->direction) != 0)
    direction++;
  *out = (abbe_render_desc){0};
  if (direction == ABBE_DIRECTION_COUNT)
    return abbe_error_set(error, ABBE_NOT_FOUND, "the renderer has no direction '%s'",
                          setting->direction);
  if (polygons > ABBE_POLYGONS_ALL)
    return abbe_error_set(error, ABBE_NOT_FOUND, "the renderer has no polygons '%s'",
                          setting->polygons);
  if (profile == ABBE_PROFILE_COUNT || fill == ABBE_FILL_COUNT || model == ABBE_MODEL_COUNT)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the renderer has no profile '%s' with a fill '%s' and a model '%s'",
                          setting->profile, setting->fill, setting->model);
  *out =
      (abbe_render_desc){.profile = (abbe_profile)profile,
                         .transport = pinholes > 0 ? ABBE_TRANSPORT_PINHOLE : ABBE_TRANSPORT_AUTO,
                         .pinholes = pinholes,
                         .wavelengths = setting->wavelengths,
                         .photons = setting->photons,
                         .map_size = setting->map,
                         .supersample = setting->samples,
                         .upsample = setting->upsample,
                         .fill = (abbe_fill)fill,
                         .model = (abbe_model)model,
                         .energy_share = setting->share,
                         .exits = setting->exits,
                         .polygons = polygons,
                         .direction = (abbe_direction)direction,
                         .history = setting->history > 1 ? setting->history : 0};
  return ABBE_OK;
}

void abbe_sweep_setting_describe(const abbe_sweep_setting *setting, char *out, size_t size) {
  abbe_render_desc desc;
  if (pinholes_of(setting->profile) == 0 &&
      abbe_sweep_setting_desc(setting, &desc, NULL) == ABBE_OK) {
    abbe_preset_describe(&desc, out, size);
    size_t used = strlen(out);
    if (desc.polygons > 0) snprintf(out + used, size - used, ", polygons %s", setting->polygons);
    used = strlen(out);
    if (desc.direction != ABBE_DIRECTION_AUTO)
      snprintf(out + used, size - used, ", direction %s", setting->direction);
    used = strlen(out);
    if (abbe_sweep_setting_has_history(setting))
      snprintf(out + used, size - used, ", of %zu frames", setting->history);
  } else {
    abbe_sweep_setting_label(setting, out, size);
  }
}

bool abbe_sweep_setting_is_fine(const abbe_sweep_setting *setting) {
  abbe_render_desc desc;
  return pinholes_of(setting->profile) == 0 &&
         abbe_sweep_setting_desc(setting, &desc, NULL) == ABBE_OK && abbe_preset_is_fine(&desc);
}
