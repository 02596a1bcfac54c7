#include "cli/options/spectral_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"

enum { OPTION_OBSERVER = 0x900, OPTION_LIT_BY, OPTION_ILLUMINANT };

static const struct argp_option options[] = {
    {"observer", OPTION_OBSERVER, "NAME", 0,
     "of the spectrum's colour: 1931, 1964, 2015-2 or 2015-10; without it, 1931", 0},
    {"lit-by", OPTION_LIT_BY, "NAME|FILE", ABBE_ARGUMENT_READS,
     "the illuminant that all lights of the scene have", 0},
    {"illuminant", OPTION_ILLUMINANT, "NAME|FILE", ABBE_ARGUMENT_READS,
     "another to see the spectrum under (a reflectance: D65 without it)", 0},
    {0}};

abbe_observer abbe_spectral_options_observer(const char *program, const char *text) {
  const char *names[ABBE_OBSERVER_COUNT];
  for (int i = 0; i < ABBE_OBSERVER_COUNT; i++) names[i] = abbe_observer_name((abbe_observer)i);
  const abbe_observer known = abbe_observer_find(text);
  if (known != ABBE_OBSERVER_COUNT) return known;
  return (abbe_observer)abbe_command_choice(program, "--observer", text, names,
                                            ABBE_OBSERVER_COUNT);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_spectral_options *o = state->input;
  switch (key) {
  case OPTION_OBSERVER:
    o->view.observer = abbe_spectral_options_observer(o->program, text);
    break;
  case OPTION_LIT_BY:
    o->lit_by = text;
    break;
  case OPTION_ILLUMINANT:
    o->illuminant = text;
    break;
  default:
    return ARGP_ERR_UNKNOWN;
  }
  o->given = true;
  return 0;
}

const struct argp abbe_spectral_options_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};

static abbe_result make_light(const char *name, abbe_illuminant *light,
                              const abbe_illuminant **used, abbe_error *error) {
  if (name == NULL) return ABBE_OK;
  *used = light;
  return abbe_illuminant_make(name, light, error);
}

abbe_result abbe_spectral_options_load(abbe_spectral_options *o, abbe_error *error) {
  abbe_result result = make_light(o->lit_by, &o->from, &o->view.from, error);
  if (result == ABBE_OK) result = make_light(o->illuminant, &o->to, &o->view.to, error);
  return result;
}

void abbe_spectral_options_free(abbe_spectral_options *o) {
  abbe_illuminant_free(&o->from);
  abbe_illuminant_free(&o->to);
}

void abbe_spectral_options_note_unread(const abbe_image *image, const char *layer,
                                       const char *name) {
  static const char *const what[ABBE_SPECTRAL_UNREAD_COUNT] = {
      "of polarised light", "of re-radiation, which is not applied",
      "named as bands are not: S0.550nm is right"};
  abbe_spectral_unread unread;
  abbe_spectral_channels_find_unread(image, layer, &unread);
  for (int k = 0; k < ABBE_SPECTRAL_UNREAD_COUNT; k++)
    if (unread.count[k] > 0)
      fprintf(stderr, "note: %s: left out are %zu channels %s, such as %s\n", name, unread.count[k],
              what[k], unread.first[k]);
}
