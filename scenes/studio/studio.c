#define _XOPEN_SOURCE 700 /* realpath */
#include "scenes/studio/studio.h"

#include "base/file.h"
#include "base/number.h"
#include "base/yaml/yaml_edit.h"
#include "base/yaml/yaml_edit_text.h"
#include "scenes/studio/setting.h"
#include "spectral/formats/material_import.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOOK(name)                                                                                 \
  extern const unsigned char abbe_embedded_look_##name[];                                          \
  extern const size_t abbe_embedded_look_##name##_size;
ABBE_STUDIO_LOOKS(LOOK)
#undef LOOK

#define SETTING_NAME(code, name) #name,
static const char *const settings[] = {ABBE_SETTING_KINDS(SETTING_NAME)};
#undef SETTING_NAME

const char *abbe_studio_setting_name(int setting) {
  return settings[setting - 1];
}

/* Between the outlines of stones in a row, of the larger of them. */
#define GAP 0.35
/* Where stones together are wider than this, m, the looks are made larger. */
#define ROOM_M 0.025
/* The band of a ring, m: the radius of its circle, and of its wire. */
#define BAND_M 0.0093
#define WIRE_M 0.0009

typedef struct building {
  const abbe_studio *studio;
  const char *folder;
  abbe_studio_stone *stone;
  size_t count, columns, rows;
  double pitch[2]; /* m, from stone to stone along x and y */
  double high;     /* m, how far above the table they stand */
  abbe_yaml_edit edit;
} building;

/* ---- the text ---- */

static size_t pair_of(const building *b, abbe_yaml_node mapping, const char *key) {
  for (size_t i = 0; i < abbe_yaml_count(b->edit.yaml, mapping); i++)
    if (strcmp(abbe_yaml_text(b->edit.yaml, abbe_yaml_key(b->edit.yaml, mapping, i)), key) == 0)
      return i;
  return SIZE_MAX;
}

static abbe_yaml_node value_of(const building *b, const char *key) {
  return abbe_yaml_get(b->edit.yaml, abbe_yaml_root(b->edit.yaml), key);
}

/* The value of a key that the mapping has or gets. */
static abbe_result put(building *b, abbe_yaml_node mapping, const char *key, const char *value,
                       abbe_error *error) {
  const size_t at = pair_of(b, mapping, key);
  return at == SIZE_MAX
             ? abbe_yaml_edit_insert_pair(&b->edit, mapping, ABBE_YAML_EDIT_END, key, value, error)
             : abbe_yaml_edit_replace(&b->edit, mapping, at, value, error);
}

static abbe_result append(building *b, const char *item, abbe_error *error) {
  const abbe_yaml_node root = abbe_yaml_root(b->edit.yaml);
  return abbe_yaml_edit_append(&b->edit, root, pair_of(b, root, "objects"), item, error);
}

static abbe_yaml_node object_called(const building *b, const char *name, size_t *index) {
  const abbe_yaml_node list = value_of(b, "objects");
  for (*index = 0; *index < abbe_yaml_count(b->edit.yaml, list); ++*index) {
    const abbe_yaml_node item = abbe_yaml_item(b->edit.yaml, list, *index);
    const char *own = abbe_yaml_text(b->edit.yaml, abbe_yaml_get(b->edit.yaml, item, "name"));
    if (own != NULL && strcmp(own, name) == 0) return item;
  }
  return (abbe_yaml_node){0};
}

static abbe_result take_out(building *b, const char *name, abbe_error *error) {
  size_t index;
  if (object_called(b, name, &index).id == 0) return ABBE_OK;
  return abbe_yaml_edit_remove(&b->edit, value_of(b, "objects"), index, error);
}

/* ---- the stones ---- */

/* The file as the scene's folder has it, quoted; malloc'd. */
static abbe_result name_file(const building *b, const char *path, char **out, abbe_error *error) {
  char whole[PATH_MAX], folder[PATH_MAX];
  const char *name = abbe_file_name(path);
  const bool found = realpath(path, whole) != NULL;
  const bool beside = realpath(b->folder[0] != '\0' ? b->folder : ".", folder) != NULL && found &&
                      strncmp(whole, folder, strlen(folder)) == 0 &&
                      strcmp(whole + strlen(folder) + (strcmp(folder, "/") != 0), name) == 0;
  return abbe_yaml_quote_make(beside || !found ? name : whole, out, error);
}

static void name_stone(const building *b, size_t i, char out[32]) {
  snprintf(out, 32, b->count > 1 ? "stone %zu" : "stone", i + 1);
}

static const char *metal_of(const building *b) {
  return b->studio->metal != NULL ? b->studio->metal : "gold";
}

/* The metal around each stone; with a ring the band of a finger below it. */
static void setting_of(const building *b, char *out, size_t size) {
  const char *metal = metal_of(b);
  out[0] = '\0';
  if (b->studio->setting == 0) return;
  const size_t used = (size_t)snprintf(out, size, "setting:\n- {kind: %s, metal: %.100s}\n",
                                       settings[b->studio->setting - 1], metal);
  if (b->studio->with == ABBE_STUDIO_WITH_RING && b->studio->setting != 1 + ABBE_SETTING_BAND)
    snprintf(out + used, size - used, "- {kind: band, metal: %.100s}\n", metal);
}

static abbe_result add_stone(building *b, size_t i, abbe_error *error) {
  const abbe_studio_stone *s = &b->stone[i];
  char *file = NULL, *material = NULL, name[32], setting[320];
  const double x = ((double)(i % b->columns) - 0.5 * (double)(b->columns - 1)) * b->pitch[0];
  const double y = (0.5 * (double)(b->rows - 1) - (double)(i / b->columns)) * b->pitch[1];
  abbe_result result = name_file(b, s->path, &file, error);
  if (result == ABBE_OK) result = abbe_yaml_quote_make(s->material, &material, error);
  if (result == ABBE_OK) {
    const size_t size = strlen(file) + strlen(material) + sizeof setting + 256;
    char *item = malloc(size);
    name_stone(b, i, name);
    setting_of(b, setting, sizeof setting);
    if (item == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a scene");
    if (item != NULL)
      abbe_number_format(
          item, size, "name: %s\n%s%s\nwidth: %.6gmm\nstand: [%.6g, %.6g, %.6g]\nmaterial: %s\n%s",
          name, s->design ? "shape: cut\nfile: " : "mesh: ", file, 1e3 * s->width, x, y, b->high,
          material, setting);
    if (item != NULL) result = append(b, item, error);
    free(item);
  }
  free(file);
  free(material);
  return result;
}

/* ---- the ring ---- */

/* A plain band that stands upright, and a cup that holds the stone by its girdle. */
static abbe_result add_ring(building *b, abbe_error *error) {
  const abbe_studio_stone *s = &b->stone[0];
  const double w = 0.5 * hypot(s->size[0], s->size[1]), r = fmax(BAND_M, s->width);
  const double wire = WIRE_M * r / BAND_M, top = 2 * (r + wire);
  const double girdle = s->girdle * s->size[2];
  const char *metal = metal_of(b);
  char item[640];
  b->high = top + 0.1 * s->size[2];
  abbe_number_format(item, sizeof item,
                     "name: band\nshape: ring\nmajor: %.6gmm\nminor: %.6gmm\nmirror: %s\n"
                     "transform:\n- rotate: {axis: [1, 0, 0], angle: 90}\nstand: [0, 0, 0]\n",
                     1e3 * r, 1e3 * wire, metal);
  ABBE_TRY(append(b, item, error));
  const double x = s->size[0] / hypot(s->size[0], s->size[1]) * sqrt(2);
  const double y = s->size[1] / hypot(s->size[0], s->size[1]) * sqrt(2);
  const double rim = w / sqrt(2);
  abbe_number_format(
      item, sizeof item,
      "name: cup\nshape: lathe\naround: 128\nmirror: %s\nprofile:\n"
      "- [%.6gmm, %.6gmm]\n- [%.6gmm, %.6gmm]\n- [%.6gmm, %.6gmm]\n- [%.6gmm, %.6gmm]\n"
      "- [%.6gmm, %.6gmm]\ntransform:\n- scale: [%.6g, %.6g, 1]\n- translate: [0, 0, %.6g]\n",
      metal, 300 * rim, -50 * s->size[2], 1e3 * 1.12 * rim, 1e3 * (girdle - 0.1 * s->size[2]),
      1e3 * 1.12 * rim, 1e3 * (girdle + 0.03 * s->size[2]), 1e3 * 1.04 * rim,
      1e3 * (girdle + 0.03 * s->size[2]), 1e3 * 1.04 * rim, 1e3 * (girdle - 0.1 * s->size[2]), x, y,
      b->high);
  return append(b, item, error);
}

/* ---- all of it ---- */

/* Two or three side by side, more in rows. */
static void arrange(building *b) {
  b->columns = b->count <= 3 ? b->count : (size_t)ceil(sqrt((double)b->count));
  b->rows = (b->count + b->columns - 1) / b->columns;
  const abbe_setting setting = {.kind = (abbe_setting_kind)(b->studio->setting - 1)};
  const bool row =
      b->studio->setting == 1 + ABBE_SETTING_PAVE || b->studio->setting == 1 + ABBE_SETTING_CHANNEL;
  if (row) b->columns = b->count, b->rows = 1;
  for (int k = 0; k < 2; k++)
    for (size_t i = 0; i < b->count; i++) {
      const abbe_studio_stone *s = &b->stone[i];
      const double apart = row && k == 0 ? abbe_setting_pitch(&setting, s->size[0], s->width)
                                         : (1 + GAP) * s->size[k];
      b->pitch[k] = fmax(b->pitch[k], apart);
    }
}

static abbe_result set_camera(building *b, abbe_error *error) {
  const size_t room = b->count * 16 + 32;
  char *names = malloc(room), size[64];
  if (names == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a scene");
  size_t used = (size_t)snprintf(names, room, "[");
  for (size_t i = 0; i < b->count; i++) {
    char name[32];
    name_stone(b, i, name);
    used += (size_t)snprintf(names + used, room - used, "%s%s", i > 0 ? ", " : "", name);
  }
  snprintf(names + used, room - used, "]");
  abbe_result result = put(b, value_of(b, "camera"), "frame", names, error);
  free(names);
  if (b->studio->with == ABBE_STUDIO_WITH_RING && result == ABBE_OK)
    result = put(b, value_of(b, "camera"), "fill", "0.45", error); /* with some of the band */
  const bool sized = b->studio->columns > 0 && b->studio->rows > 0;
  if (b->count == 1 && !sized) return result;
  /* as many pixels a stone as in a picture of its own, up to three of these across */
  const double across = (double)b->columns * b->pitch[0], down = (double)b->rows * b->pitch[1];
  const double side = 512 * fmin((double)b->columns, 3);
  abbe_number_format(size, sizeof size, "[%.0f, %.0f]", side,
                     fmax(256, fmin(side, side * down / across)));
  if (sized) snprintf(size, sizeof size, "[%zu, %zu]", b->studio->columns, b->studio->rows);
  if (result == ABBE_OK && b->count > 1)
    result = put(b, value_of(b, "camera"), "fill", "0.85", error);
  return result == ABBE_OK ? put(b, value_of(b, "camera"), "size", size, error) : result;
}

/* What the mapping has under a key, a number or a list, times the factor. */
static abbe_result scale(building *b, abbe_yaml_node (*of)(const building *b, size_t i), size_t i,
                         const char *key, size_t count, double factor, abbe_error *error) {
  double v[3];
  ABBE_FREED char *text = NULL;
  if (pair_of(b, of(b, i), key) == SIZE_MAX) return ABBE_OK;
  ABBE_TRY(count == 1 ? abbe_yaml_get_length(b->edit.yaml, of(b, i), key, 0, HUGE_VAL, v, error)
                      : abbe_yaml_get_lengths(b->edit.yaml, of(b, i), key, count, -HUGE_VAL,
                                              HUGE_VAL, v, error));
  for (size_t k = 0; k < count; k++) v[k] *= factor;
  ABBE_TRY(abbe_yaml_edit_list(v, count, &text, error));
  if (count == 1) text[strlen(text) - 1] = '\0'; /* no brackets */
  return put(b, of(b, i), key, text + (count == 1), error);
}

static abbe_yaml_node light_of(const building *b, size_t i) {
  return abbe_yaml_item(b->edit.yaml, value_of(b, "lights"), i);
}

static abbe_yaml_node table_of(const building *b, size_t i) {
  (void)i;
  size_t index;
  return object_called(b, "table", &index);
}

/* Table and light sources are as large beside large stones as beside small ones. */
static abbe_result set_size(building *b, abbe_error *error) {
  const double across = fmax((double)b->columns * b->pitch[0], (double)b->rows * b->pitch[1]);
  const bool finger =
      b->studio->with == ABBE_STUDIO_WITH_RING || b->studio->setting == 1 + ABBE_SETTING_BAND;
  const double high = finger ? 2 * (BAND_M + WIRE_M) : 0;
  const double factor = fmax(across, fmax(b->high, high)) / ROOM_M;
  if (factor <= 1) return ABBE_OK;
  for (size_t i = 0; i < abbe_yaml_count(b->edit.yaml, value_of(b, "lights")); i++) {
    ABBE_TRY(scale(b, light_of, i, "position", 3, factor, error));
    ABBE_TRY(scale(b, light_of, i, "radius", 1, factor, error));
    ABBE_TRY(scale(b, light_of, i, "intensity", 1, factor * factor, error));
  }
  if (b->studio->with == ABBE_STUDIO_WITH_NONE) return ABBE_OK;
  ABBE_TRY(scale(b, table_of, 0, "width", 1, factor, error));
  return scale(b, table_of, 0, "height", 1, factor, error);
}

/* Cards of light behind, where flat metal mirrors the camera: brighter upwards, as many times the
 * room's own light. Without them it shows the dark between the looks' lights. */
static abbe_result add_cards(building *b, abbe_error *error) {
  static const double card[][2] = {{-9, 4}, {1, 6}, {11, 10}}; /* degrees above the camera, times */
  const size_t boxes = pair_of(b, value_of(b, "environment"), "softboxes");
  double elevation = 0, uniform = 0;
  if (boxes == SIZE_MAX || (b->studio->with != ABBE_STUDIO_WITH_RING && b->studio->setting == 0))
    return ABBE_OK;
  ABBE_TRY(abbe_yaml_get_number(b->edit.yaml, value_of(b, "camera"), "elevation", -90, 90,
                                &elevation, error));
  ABBE_TRY(abbe_yaml_get_number(b->edit.yaml, value_of(b, "environment"), "uniform", 0, HUGE_VAL,
                                &uniform, error));
  for (size_t i = 0; i < sizeof card / sizeof *card; i++) {
    char item[128];
    abbe_number_format(item, sizeof item,
                       "{elevation: %.6g, azimuth: 90, width: 90, height: 10, radiance: %.6g}",
                       elevation + card[i][0], uniform * card[i][1]);
    ABBE_TRY(abbe_yaml_edit_append(&b->edit, value_of(b, "environment"), boxes, item, error));
  }
  return ABBE_OK;
}

static abbe_result describe(building *b, abbe_error *error) {
  static const char *const looks[] = {
#define NAME(name) #name,
      ABBE_STUDIO_LOOKS(NAME)
#undef NAME
  };
  const abbe_studio_stone *s = &b->stone[0];
  char text[1024], *quoted = NULL;
  const size_t used =
      (size_t)abbe_number_format(text, sizeof text, "%.200s as %.120s, %.3g mm wide",
                                 abbe_file_name(s->path), s->material, 1e3 * s->width);
  snprintf(text + used, sizeof text - used, "%s%.250s%s; look: %s", s->note[0] ? " (" : "", s->note,
           s->note[0] ? ")" : "", looks[b->studio->look]);
  abbe_result result = abbe_yaml_quote_make(text, &quoted, error);
  if (result == ABBE_OK)
    result = put(b, abbe_yaml_root(b->edit.yaml), "description", quoted, error);
  free(quoted);
  return result;
}

static abbe_result compose(building *b, abbe_error *error) {
  const abbe_studio_with with = b->studio->with;
  arrange(b);
  ABBE_TRY(with == ABBE_STUDIO_WITH_RING && b->studio->setting == 0 ? add_ring(b, error) : ABBE_OK);
  for (size_t i = 0; i < b->count; i++) ABBE_TRY(add_stone(b, i, error));
  /* the look's own goes last, for a list keeps its last item; `stone` is the first of that name */
  ABBE_TRY(take_out(b, "stone", error));
  if (with == ABBE_STUDIO_WITH_NONE) ABBE_TRY(take_out(b, "table", error));
  ABBE_TRY(set_size(b, error));
  ABBE_TRY(set_camera(b, error));
  ABBE_TRY(add_cards(b, error));
  return describe(b, error);
}

/* What is asked for by name is looked up before it stands in a scene, whose lines nobody knows. */
static abbe_result check_name(const building *b, const char *name, bool metal, abbe_error *error) {
  ABBE_OWNED(abbe_material_table, table) = {0};
  const abbe_material *found;
  if (name == NULL) return ABBE_OK;
  ABBE_TRY(abbe_material_table_load_named(b->studio->table, &name, 1, &table, error));
  ABBE_TRY(abbe_material_table_find(&table, name, &found, error));
  if (abbe_material_is_conductor(found) != metal)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          metal ? "'%s' is no metal; a ring is of one, such as gold or platinum"
                                : "'%s' is a metal; a stone is of something that light passes, "
                                  "such as ruby ('abbe materials list')",
                          name);
  return ABBE_OK;
}

static abbe_result check_names(const building *b, abbe_error *error) {
  if (b->studio->metal != NULL && b->studio->with != ABBE_STUDIO_WITH_RING &&
      b->studio->setting == 0)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "a metal is for a ring or a setting: add --with ring or --setting prongs");
  ABBE_TRY(check_name(b, b->studio->material, false, error));
  return check_name(b, b->studio->metal, true, error);
}

static abbe_result read_stones(building *b, const char *path, abbe_error *error) {
  for (size_t i = 0; i < b->count; i++)
    ABBE_TRY(abbe_studio_stone_read(i == 0 ? path : b->studio->more[i - 1], b->studio, &b->stone[i],
                                    error));
  return ABBE_OK;
}

abbe_result abbe_studio_scene(const char *path, const abbe_studio *studio, const char *folder,
                              char **out, size_t *size, abbe_error *error) {
  static const struct {
    const char *text;
    const size_t *size;
  } looks[] = {
#define LOOK(name) {(const char *)abbe_embedded_look_##name, &abbe_embedded_look_##name##_size},
      ABBE_STUDIO_LOOKS(LOOK)
#undef LOOK
  };
  const abbe_studio plain = {0};
  building b = {.studio = studio ? studio : &plain, .folder = folder};
  *out = NULL;
  *size = 0;
  b.count = 1 + b.studio->more_count;
  if (b.count > ABBE_STUDIO_MOST_STONES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu stones; at most %d stand on one table",
                          b.count, ABBE_STUDIO_MOST_STONES);
  if (b.count > 1 && b.studio->with == ABBE_STUDIO_WITH_RING)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a ring holds one stone, not %zu", b.count);
  b.stone = calloc(b.count, sizeof *b.stone);
  abbe_result result = b.stone != NULL
                           ? check_names(&b, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for stones");
  if (result == ABBE_OK) result = read_stones(&b, path, error);
  if (result == ABBE_OK)
    result = abbe_yaml_edit_make(looks[b.studio->look].text, *looks[b.studio->look].size, path,
                                 &b.edit, error);
  if (result == ABBE_OK) result = compose(&b, error);
  if (result == ABBE_OK) {
    *out = b.edit.text;
    *size = b.edit.size;
    b.edit.text = NULL;
  }
  abbe_yaml_edit_free(&b.edit);
  free(b.stone);
  return result;
}
