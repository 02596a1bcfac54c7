#define _XOPEN_SOURCE 700 /* realpath */
#include "cli/options/scene_input.h"

#include "base/file.h"
#include "base/maths.h"
#include "base/number.h"
#include "base/text.h"
#include "cli/base/command.h"
#include "scenes/import/scene_file.h"
#include "scenes/object_motion.h"
#include "scenes/studio/setting.h"
#include "scenes/view/view.h"

#include <cjson/cJSON.h>
#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static void take_tilt(abbe_scene_input_changes *changes, const char *text, const char *program) {
  char tilt[64];
  const size_t length = strcspn(text, ",");
  snprintf(tilt, sizeof tilt, "%.*s", (int)length, text);
  changes->tilt_deg = abbe_command_number(program, "--tilt", tilt, -180, 180);
  changes->axis_deg = text[length] == ','
                          ? abbe_command_number(program, "--tilt", text + length + 1, -360, 360)
                          : 0;
}

/* Keys of scenes whose values name files. */
static bool names_file(const char *key, size_t length) {
  static const char *const keys[] = {"file", "mesh", "texture", "spectrum"};
  while (length > 0 && memchr(key, '.', length) != NULL) length--, key++;
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    if (length == strlen(keys[i]) && strncmp(key, keys[i], length) == 0) return true;
  return false;
}

/* A file that is there from where the user stands is meant, and by its whole path, for in a scene
 * names count from the scene's folder. */
static const char *find_from_here(const char *set) {
  static char *kept[ABBE_SCENE_INPUT_MOST];
  static size_t count;
  const char *equals = strchr(set, '=');
  char whole[PATH_MAX];
  if (equals == NULL || !names_file(set, (size_t)(equals - set)) || equals[1] == '/' ||
      count == ABBE_SCENE_INPUT_MOST || realpath(equals + 1, whole) == NULL)
    return set;
  const size_t size = (size_t)(equals - set) + strlen(whole) + 4;
  char *text = malloc(size);
  if (text == NULL) return set;
  snprintf(text, size, "%.*s='%s'", (int)(equals - set), set, whole);
  return kept[count++] = text;
}

enum { LOOK = 1, WITH, SETTING, METAL, WIDTH, TILT = 1, AT, SET };

static const abbe_option studio_options[] = {
    {"look", LOOK, "NAME", 0,
     "of a stone's file: white, for a catalogue; black, for pale stones; velvet, for a window; "
     "daylight, for its colour; darkfield, for what is inside; lightbox, for its pattern; "
     "dispersion and fire, for its sparks; backdrop, for a poster (white)",
     1, ABBE_TAKE_BY_KEY},
    {"with", WITH, "WHAT", 0, "what a stone's file is shown with: table, ring, none (table)", 1,
     ABBE_TAKE_BY_KEY},
    {"setting", SETTING, "KIND", 0,
     "metal around each stone of a file: prongs, bezel, channel, band, pave (none)", 1,
     ABBE_TAKE_BY_KEY},
    {"metal", METAL, "NAME", 0,
     "of a ring or a setting: gold, silver, platinum, rhodium, palladium, gold-18k, "
     "rose-gold-18k … (gold)",
     1, ABBE_TAKE_BY_KEY},
    {"width", WIDTH, "LENGTH", 0,
     "of a stone's file, its smaller extent, such as 6.5mm or 0.2in; a bare number is of mm "
     "(as its file has it, else 6.5mm)",
     1, ABBE_TAKE_BY_KEY},
    {"save-scene", 0, "FILE.yaml", ABBE_ARGUMENT_WRITES,
     "write the scene that is made of a stone's file, to be edited", 1,
     ABBE_TAKE_TARGET(abbe_scene_input_changes, save, ".yaml")},
    {0}};

static error_t take_studio(int key, char *text, struct argp_state *state) {
#define LOOK_NAME(name) #name,
#define WITH_NAME(code, name) #name,
  static const char *const looks[] = {ABBE_STUDIO_LOOKS(LOOK_NAME)};
  static const char *const withs[] = {ABBE_STUDIO_WITHS(WITH_NAME)};
  static const char *const settings[] = {ABBE_SETTING_KINDS(WITH_NAME)};
#undef LOOK_NAME
#undef WITH_NAME
  static const char *const names[] = {"", "--look", "--with", "--setting", "--metal", "--width"};
  abbe_scene_input_changes *changes = state->input;
  abbe_studio *studio = &changes->studio;
  if (key < LOOK || key > WIDTH) return ARGP_ERR_UNKNOWN;
  changes->look = names[key];
  if (key == LOOK)
    studio->look = (abbe_studio_look)abbe_command_choice(state->name, "--look", text, looks,
                                                         ABBE_STUDIO_LOOK_COUNT);
  else if (key == WITH)
    studio->with = (abbe_studio_with)abbe_command_choice(state->name, "--with", text, withs,
                                                         ABBE_STUDIO_WITH_COUNT);
  else if (key == SETTING)
    studio->setting =
        1 + abbe_command_choice(state->name, "--setting", text, settings, ABBE_SETTING_COUNT);
  else if (key == METAL)
    studio->metal = text;
  else
    studio->width_m = abbe_command_length(state->name, "--width", text, 1e-6, 1e3);
  return 0;
}

const abbe_parser abbe_studio_options = {.options = studio_options, .parse = take_studio};

/* Files that people try, and what to do with them. */
static void refuse_foreign(const char *path, struct argp_state *state) {
  static const char *const endings[] = {".step", ".stp", ".3dm", ".blend", ".fbx",  ".dxf", ".iges",
                                        ".dae",  ".jpg", ".png", ".jpeg",  ".webp", ".mtl", ".zip"};
  const char *dot = strrchr(abbe_file_name(path), '.');
  for (size_t i = 0; dot != NULL && i < sizeof endings / sizeof *endings; i++)
    if (strcasecmp(dot, endings[i]) == 0)
      argp_error(state,
                 "'%s' is neither a scene (.yaml) nor a stone's file (.asc, .gem, .gcs, .stl, "
                 ".obj, .ply, .gltf, .glb)%s",
                 path, i < 8 ? "; let the program that made it export one of these" : "");
}

void abbe_scene_input_take_file(abbe_scene_input_changes *changes, const char **scene,
                                const char *text, struct argp_state *state) {
  abbe_studio *studio = &changes->studio;
  if (*scene == NULL) {
    refuse_foreign(text, state);
    *scene = text;
    return;
  }
  if (!abbe_studio_is_stone(*scene) || !abbe_studio_is_stone(text))
    argp_error(state,
               "one scene at a time: '%s' and '%s' (several stones' files, such as .asc or "
               ".stl, stand side by side)",
               *scene, text);
  if (studio->more_count + 1 >= ABBE_STUDIO_MOST_STONES)
    argp_error(state, "at most %d stones stand on one table", ABBE_STUDIO_MOST_STONES);
  changes->more[studio->more_count++] = text;
}

const char *abbe_scene_input_picture(const char *program, const char *scene) {
  static char path[NAME_MAX + 8];
  if (!abbe_studio_is_stone(scene)) return NULL;
  const char *name = abbe_file_name(scene);
  snprintf(path, sizeof path, "%.*s.png", (int)(strrchr(name, '.') - name), name);
  abbe_arguments_add(program, ABBE_ARGUMENT_WRITES, "the picture", path);
  return path;
}

void abbe_scene_input_set(abbe_scene_input_changes *changes, const char *text,
                          const char *program) {
  if (changes->set_count < ABBE_SCENE_INPUT_MOST) {
    changes->set[changes->set_count++] = find_from_here(text);
    return;
  }
  fprintf(stderr, "%s: no more than %d --set; write the values into the scene\n", program,
          ABBE_SCENE_INPUT_MOST);
  exit(ABBE_EXIT_USAGE);
}

static const abbe_option scene_options[] = {
    {"material", 0, "[NAME=]STONE", 0,
     "make the refractors of STONE; where they are of several materials, those of the material or "
     "object NAME",
     1, ABBE_TAKE_TEXT(abbe_scene_input_changes, stone)},
    {"set", SET, "KEY=VALUE", 0,
     "another value in the scene, such as camera.fov=30 or lights.lamp.intensity=2; may be "
     "repeated",
     1, ABBE_TAKE_BY_KEY},
    {"tilt", TILT, "DEG[,AXIS]", 0,
     "tilt the refractors about their middle, about the horizontal axis of azimuth AXIS (0: +x)", 1,
     ABBE_TAKE_BY_KEY},
    {"at", AT, "SECONDS", 0,
     "the scene at that time, of its waves and keyframes (its own 'time', else 0)", 1,
     ABBE_TAKE_BY_KEY},
    {0}};

static error_t take_change(int key, char *text, struct argp_state *state) {
  abbe_scene_input_changes *changes = state->input;
  if (key == TILT)
    take_tilt(changes, text, state->name);
  else if (key == SET)
    abbe_scene_input_set(changes, text, state->name);
  else if (key == AT) {
    changes->timed = true;
    changes->time = abbe_command_number(state->name, "--at", text, -1e6, 1e6);
  } else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

const abbe_parser abbe_scene_input_options = {.options = scene_options, .parse = take_change};

/* Options of a studio are for stones' files. */
static void check_studio(const char *program, const char *path,
                         const abbe_scene_input_changes *changes) {
  const char *option = changes->save != NULL ? "--save-scene" : changes->look;
  if (option == NULL || abbe_studio_is_stone(path)) return;
  fprintf(stderr,
          "%s: %s is for a stone's file (.asc, .gem, .gcs, .stl, .obj, .ply, .gltf, .glb); '%s' is "
          "a scene, whose own values --set changes\n",
          program, option, path);
  exit(ABBE_EXIT_USAGE);
}

/* The scene as it would stand in that file's folder. */
static abbe_result save(const char *path, abbe_studio *studio, abbe_scene_options options,
                        const char *to, abbe_error *error) {
  char folder[PATH_MAX], *text = NULL;
  size_t size = 0;
  const char *slash = strrchr(to, '/');
  snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - to) + 1 : 0, to);
  studio->folder = folder;
  options.studio = studio;
  abbe_result result = abbe_scene_text(path, &options, &text, &size, error);
  studio->folder = NULL;
  if (result == ABBE_OK) result = abbe_file_write(to, text, size, error);
  free(text);
  return result;
}

/* With the changes in it. */
static abbe_result load(const char *path, const char *materials,
                        const abbe_scene_input_changes *changes, abbe_scene *out,
                        abbe_error *error) {
  abbe_studio studio = changes->studio;
  studio.more = changes->more;
  const char *set[ABBE_SCENE_INPUT_MOST + 1];
  char time[64];
  memcpy(set, changes->set, sizeof changes->set);
  set[changes->set_count] = time;
  abbe_number_format(time, sizeof time, "time=%.17g", changes->time);
  const abbe_scene_options options = {.materials = materials,
                                      .stone = changes->stone,
                                      .set = set,
                                      .set_count = changes->set_count + changes->timed,
                                      .studio = &studio};
  ABBE_TRY(abbe_scene_load(path, &options, out, error));
  if (changes->save != NULL) ABBE_TRY(save(path, &studio, options, changes->save, error));
  out->transparent = changes->alpha;
  if (changes->tilt_deg == 0) return ABBE_OK;
  return abbe_refractors_tilt(out, changes->tilt_deg * ABBE_DEGREE, changes->axis_deg * ABBE_DEGREE,
                              error);
}

/* To the sentence on a file that is not there, the name beside it that is nearest. */
static void add_nearest(const char *path, abbe_error *error) {
  enum { MOST = 1000 };
  char folder[PATH_MAX], *names[MOST];
  const char *name = abbe_file_name(path);
  size_t count = 0;
  snprintf(folder, sizeof folder, "%.*s", name > path ? (int)(name - path) : 1,
           name > path ? path : ".");
  DIR *dir = access(path, F_OK) != 0 ? opendir(folder) : NULL;
  for (struct dirent *e; dir != NULL && count < MOST && (e = readdir(dir)) != NULL;)
    if ((names[count] = strdup(e->d_name)) != NULL) count++;
  if (dir != NULL) closedir(dir);
  const char *near = abbe_nearest_word(name, (const char *const *)names, count);
  const size_t used = strlen(error->text);
  if (near != NULL)
    snprintf(error->text + used, sizeof error->text - used, "; did you mean '%.*s%s'?",
             (int)(name - path), path, near);
  for (size_t i = 0; i < count; i++) free(names[i]);
}

abbe_result abbe_scene_input_load_with(const char *program, const char *path, const char *materials,
                                       const abbe_scene_input_changes *changes, abbe_scene *out,
                                       abbe_error *error) {
  char shipped[2 * PATH_MAX];
  const char *found = abbe_shipped_find(path, shipped, sizeof shipped);
  if (found != path) fprintf(stderr, "note: %s is not here; %s is taken\n", path, found);
  check_studio(program, found, changes);
  const abbe_result result = load(found, materials, changes, out, error);
  if (result == ABBE_IO) add_nearest(found, error);
  for (size_t i = 0; result == ABBE_OK && i < abbe_scene_file_count(out); i++)
    abbe_arguments_add(program, ABBE_ARGUMENT_READS, "the scene's file", abbe_scene_file(out, i));
  return result;
}

abbe_result abbe_scene_input_at(const abbe_scene *scene, const char *materials,
                                const abbe_scene_input_changes *changes, double time,
                                abbe_scene *out, abbe_error *error) {
  abbe_scene_input_changes timed = *changes;
  timed.timed = true;
  timed.time = time;
  return load(scene->path, materials, &timed, out, error);
}

abbe_result abbe_scene_input_number(const abbe_scene *scene, const char *materials,
                                    const abbe_scene_input_changes *changes, const char *key,
                                    double *value, abbe_error *error) {
  abbe_studio studio = changes->studio;
  studio.more = changes->more;
  const abbe_scene_options options = {.materials = materials,
                                      .stone = changes->stone,
                                      .set = changes->set,
                                      .set_count = changes->set_count,
                                      .studio = &studio};
  return abbe_scene_number(scene->path, &options, key, value, error);
}

abbe_result abbe_scene_input_check_alpha(const abbe_scene *scene, abbe_error *error) {
  if (!scene->transparent || !(scene->camera.aperture > 0)) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "--alpha of a traced picture is of a camera that is sharp: take the "
                        "'aperture' out (--set camera.aperture= --set camera.focus=)");
}

abbe_result abbe_scene_input_add_alpha(const abbe_scene *scene, size_t samples, abbe_image *picture,
                                       abbe_error *error) {
  ABBE_OWNED(abbe_image, alpha) = {0};
  ABBE_TRY(abbe_coverage_make(scene, picture->width, picture->height, samples, &alpha, error));
  return abbe_image_append(picture, &alpha, error);
}

void abbe_scene_input_note(const abbe_scene *scene) {
  const abbe_environment *around = scene->environment;
  if (abbe_studio_is_stone(scene->path)) fprintf(stderr, "%s\n", scene->description);
  if (around != NULL && around->map.space_assumed) abbe_command_note_space(around->path);
  if (around != NULL && around->path != NULL)
    abbe_command_note_part(around->path, around->map.part);
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].fixes != NULL)
      fprintf(stderr, "note: object '%s': %s\n", scene->object[i].name, scene->object[i].fixes);
  abbe_scene_doubts doubts;
  abbe_scene_doubt(scene, &doubts);
  for (size_t i = 0; i < doubts.count; i++) fprintf(stderr, "warning: %s\n", doubts.text[i]);
}

static const char *roughened(const abbe_brushing *b, char *text, size_t size) {
  const size_t used = strlen(text);
  const abbe_microfacets *m = &b->facets;
  if (m->x < m->y || m->y < m->x)
    snprintf(text + used, size - used, ", brushed, %g along and %g across", m->x, m->y);
  else
    snprintf(text + used, size - used, ", rough, %g", m->x);
  return text;
}

static const char *made_of(const abbe_object *o, char *text, size_t size) {
  switch (abbe_object_kind_of(o)) {
  case ABBE_OBJECT_REFRACTOR:
    return o->material->name;
  case ABBE_OBJECT_MIRROR:
    if (o->conductor != NULL)
      snprintf(text, size, "mirror of %s", o->conductor->name);
    else
      snprintf(text, size, "mirror, %g", o->mirror_reflectance);
    return abbe_brushing_is_rough(&o->brushing) ? roughened(&o->brushing, text, size) : text;
  default:
    return "receiver";
  }
}

void abbe_scene_input_list(const abbe_scene *scene) {
  enum { MOST = 48 };
  printf("What is there, with its size and the middle of its bounds, m:\n");
  for (size_t i = 0; i < scene->object_count && i < MOST; i++) {
    const abbe_object *o = &scene->object[i];
    char size[64], middle[64], made[ABBE_MATERIAL_MAX_NAME + 80];
    snprintf(size, sizeof size, "%.3g x %.3g x %.3g", o->max[0] - o->min[0], o->max[1] - o->min[1],
             o->max[2] - o->min[2]);
    snprintf(middle, sizeof middle, "(%.3g, %.3g, %.3g)", 0.5 * (o->min[0] + o->max[0]),
             0.5 * (o->min[1] + o->max[1]), 0.5 * (o->min[2] + o->max[2]));
    printf("  %-26.60s %-26s %-26s %s, %zu faces\n", o->name, size, middle,
           made_of(o, made, sizeof made), o->mesh.face_count);
  }
  if (scene->object_count > MOST) printf("  and %zu objects more\n", scene->object_count - MOST);
  printf("\n");
}

void abbe_scene_input_list_json(const abbe_scene *scene, cJSON *root) {
  cJSON *list = cJSON_AddArrayToObject(root, "objects");
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    cJSON *item = cJSON_CreateObject();
    cJSON_AddStringToObject(item, "name", o->name);
    if (o->material != NULL) cJSON_AddStringToObject(item, "material", o->material->name);
    if (o->conductor != NULL)
      cJSON_AddStringToObject(item, "mirror", o->conductor->name);
    else if (o->mirror)
      cJSON_AddNumberToObject(item, "mirror", o->mirror_reflectance);
    if (abbe_brushing_is_rough(&o->brushing)) {
      const double both[] = {o->brushing.facets.x, o->brushing.facets.y};
      cJSON_AddItemToObject(item, "roughness", cJSON_CreateDoubleArray(both, 2));
    }
    cJSON_AddItemToObject(item, "min", cJSON_CreateDoubleArray(o->min, 3));
    cJSON_AddItemToObject(item, "max", cJSON_CreateDoubleArray(o->max, 3));
    cJSON_AddNumberToObject(item, "faces", (double)o->mesh.face_count);
    if (o->fixes != NULL) cJSON_AddStringToObject(item, "note", o->fixes);
    cJSON_AddItemToArray(list, item);
  }
}
