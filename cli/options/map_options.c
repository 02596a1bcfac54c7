#include "cli/options/map_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include <stdio.h>
#include <string.h>

enum { OPTION_SAVE_MAP = 0x300, OPTION_MAP_LIGHT, OPTION_MAP_LIKE };

static const struct argp_option options[] = {
    {"save-map", OPTION_SAVE_MAP, "FILE.exr", ABBE_ARGUMENT_WRITES,
     "where one light's flux lands, texel by texel", 3},
    {"map-light", OPTION_MAP_LIGHT, "NAME|NUMBER", 0, "whose map that is (the first light's)", 3},
    {"map-like", OPTION_MAP_LIKE, "FILE.exr", ABBE_ARGUMENT_READS,
     "texels that lie exactly as in that map, and as many", 3},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TARGET(abbe_map_options, OPTION_SAVE_MAP, save, ".exr"),
    ABBE_TAKE_TEXT(abbe_map_options, OPTION_MAP_LIGHT, light),
    ABBE_TAKE_TEXT(abbe_map_options, OPTION_MAP_LIKE, like),
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state) {
  if (abbe_take_option(takes, key, text, state)) return 0;
  return ARGP_ERR_UNKNOWN;
}

const struct argp abbe_map_options_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};

/* The one light of that name: unlike what people type, what a file names is never a number. */
static abbe_result find_named(const abbe_map_options *o, const abbe_scene *scene, const char *name,
                              size_t *index, abbe_error *error) {
  size_t found = 0;
  for (size_t i = 0; i < scene->light_count; i++)
    if (strcmp(scene->light[i].name, name) == 0 && ++found == 1) *index = i;
  if (found == 1) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s is the map of the light '%.60s'; %s has %s of that name; say with "
                        "--map-light which one is meant",
                        o->like, name, scene->path, found == 0 ? "none" : "several");
}

static abbe_result read_like(abbe_map_options *o, const abbe_scene *scene, bool sized,
                             abbe_error *error) {
  abbe_image map = {0};
  abbe_result result = abbe_command_read_picture(o->like, &map, error);
  if (result == ABBE_OK) result = abbe_map_layout_read(&map, o->like, &o->layout, error);
  if (result == ABBE_OK && sized && map.width != map.height)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s has %zu x %zu texels; maps are square here, so give a side with "
                            "--map",
                            o->like, map.width, map.height);
  const char *name = abbe_image_attribute_text(&map, "abbe:map_light");
  if (result == ABBE_OK && o->light == NULL && name != NULL)
    result = find_named(o, scene, name, &o->light_index, error);
  o->side = map.width;
  abbe_image_free(&map);
  return result;
}

abbe_result abbe_map_options_resolve(abbe_map_options *o, const abbe_scene *scene, bool sized,
                                     abbe_error *error) {
  abbe_result result = ABBE_OK;
  o->light_index = 0;
  if (o->light != NULL) result = abbe_scene_find_light(scene, o->light, &o->light_index, error);
  if (result == ABBE_OK && o->like != NULL) result = read_like(o, scene, sized, error);
  return result;
}
