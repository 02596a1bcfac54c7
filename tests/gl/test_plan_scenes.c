/* The plan of each shipped scene, whole, and what one fact more or less in a scene changes of its
 * plan. Rows tell the entries in their order: '+' runs, '-' does not, then the name, '|' and a part
 * of the reason; '!' a part of a note; '=' wavelengths, exits and landings of a photon. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/plan.h"

#include <stdio.h>

enum { MAX_LINES = ABBE_PLAN_MAX_ENTRIES + 16 };

typedef struct lines {
  size_t count;
  char line[MAX_LINES][300];
} lines;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
put(lines *l, const char *format, ...) {
  assert_true(l->count < MAX_LINES);
  va_list args;
  va_start(args, format);
  vsnprintf(l->line[l->count++], sizeof l->line[0], format, args);
  va_end(args);
}

static void tell(const abbe_plan *plan, lines *out) {
  out->count = 0;
  put(out, "=%zu wavelengths, %zu exits, %zu landings", plan->desc.wavelengths, plan->desc.orders,
      plan->slots);
  for (size_t i = 0; i < plan->entry_count; i++)
    put(out, "%c%s|%s", plan->entry[i].runs ? '+' : '-', plan->entry[i].name,
        plan->entry[i].reason);
  for (size_t i = 0; i < plan->note_count; i++) put(out, "!%s", plan->note[i]);
}

static void plan_of(const abbe_scene *scene, const abbe_render_desc *desc, lines *out) {
  abbe_plan plan;
  abbe_error error = {0};
  if (abbe_plan_make(scene, desc, &plan, &error) != ABBE_OK) fail_msg("%s", error.text);
  tell(&plan, out);
  abbe_plan_free(&plan);
}

/* "+name|part" holds for "+name|reason" where the part is in the reason. */
static bool holds(const char *row, const char *line) {
  const char *bar = strchr(row, '|');
  if (*row == '!') return *line == '!' && strstr(line + 1, row + 1) != NULL;
  if (bar == NULL) return strcmp(row, line) == 0;
  size_t name = (size_t)(bar - row) + 1;
  return strncmp(row, line, name) == 0 && strstr(line + name, bar + 1) != NULL;
}

static void check(const char *scene, const char *const *row, const lines *l) {
  size_t rows = 0;
  while (row[rows] != NULL) rows++;
  for (size_t i = 0; i < rows || i < l->count; i++) {
    if (i < rows && i < l->count && holds(row[i], l->line[i])) continue;
    for (size_t k = 0; k < l->count; k++) print_message("  %s\n", l->line[k]);
    fail_msg("%s: row %zu: '%s', not '%s'", scene, i + 1, i < l->count ? l->line[i] : "no more",
             i < rows ? row[i] : "no more");
  }
}

static bool has(const lines *l, const char *line) {
  for (size_t i = 0; i < l->count; i++)
    if (strcmp(l->line[i], line) == 0) return true;
  return false;
}

/* Up to the reason. */
static bool names(const lines *l, const char *line) {
  const char *bar = strchr(line, '|');
  size_t name = bar != NULL ? (size_t)(bar - line) : strlen(line);
  for (size_t i = 0; i < l->count; i++)
    if (strlen(l->line[i]) > name && strncmp(l->line[i] + 1, line + 1, name - 1) == 0 &&
        l->line[i][name] == '|')
      return true;
  return false;
}

/* What the other plan has otherwise, in its order; then the names that it has no more. */
static void differ(const lines *from, const lines *to, lines *out) {
  out->count = 0;
  for (size_t i = 0; i < to->count; i++)
    if (!has(from, to->line[i])) put(out, "%s", to->line[i]);
  for (size_t i = 0; i < from->count; i++) {
    if (has(to, from->line[i])) continue;
    if (from->line[i][0] != '=' && !names(to, from->line[i]))
      put(out, "no %.*s", (int)strcspn(from->line[i] + 1, "|"), from->line[i] + 1);
  }
}

#define EYE_ASIDE "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [-0.6, 0, 0.05]}\n"
#define SPOT(target)                                                                               \
  "lights:\n- {name: lamp, kind: spot, position: [0.05, 0.03, 0.6], target: " target               \
  ", cone: 10, intensity: 1}\n"
#define LIGHT_ASIDE_OF(illuminant)                                                                 \
  "- {name: second, kind: point, position: [-0.1, 0.03, 0.6], intensity: 1, "                      \
  "illuminant: " illuminant "}\n"
#define LIGHT_ASIDE LIGHT_ASIDE_OF("D65")
#define CARD                                                                                       \
  "- {name: card, shape: rectangle, width: 0.1, height: 0.1, transform: [{translate: [-0.4, 0, "   \
  "0.3]}], reflectance: 0.5}\n"
#define CEILING                                                                                    \
  "- {name: ceiling, shape: rectangle, width: 2, height: 2, transform: [{rotate: {axis: [1, 0, "   \
  "0], angle: 180}}, {translate: [0, 0, 0.7]}], reflectance: 0.5}\n"
#define PEBBLE "- {name: pebble, shape: sphere, radius: 0.05, reflectance: 0.5}\n"
#define DOME                                                                                       \
  "- {name: dome, shape: sphere, radius: 0.05, transform: [{translate: [0.5, 0, 0.8]}], "          \
  "reflectance: 0.5}\n"
#define WOOD                                                                                       \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5, "            \
  "texture: " ABBE_SOURCE_DIR "/scenes/wood.png}\n"
#define CUBE(material)                                                                             \
  "- {name: ball, shape: box, size: [0.1, 0.1, 0.1], transform: [{translate: [0, 0, 0.2]}], "      \
  "material: " material "}\n"
#define STONE(material)                                                                            \
  "- {name: ball, shape: gem, sides: 6, girdle: 0.08, table: 0.05, crown: 0.024, pavilion: 0.04, " \
  "transform: [{rotate: {axis: [1, 0, 0], angle: 5}}, {translate: [0, 0, 0.2]}], "                 \
  "material: " material "}\n"
#define EGG(material)                                                                              \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{scale: [1, 1, 1.2]}, "      \
  "{translate: [0, 0, 0.2]}], material: " material "}\n"
#define TORUS(material)                                                                            \
  "- {name: ball, shape: ring, major: 0.08, minor: 0.02, transform: [{translate: [0, 0, 0.2]}], "  \
  "material: " material "}\n"
#define YOLK(material)                                                                             \
  "- {name: yolk, shape: sphere, radius: 0.04, levels: 3, transform: [{translate: [0, 0, 0.2]}], " \
  "material: " material "}\n"
#define SUNK(material)                                                                             \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0, 0, 0.05]}]," \
  " material: " material "}\n"

/* What each has in common, and differs from in one fact. */
static const char ball[] = CAMERA POINT_LIGHT FLOOR BALL("crown");

static const char flat[] = CAMERA POINT_LIGHT FLOOR BALL("flat");
static const char cube[] = CAMERA POINT_LIGHT FLOOR CUBE("crown");
static const char stone[] = CAMERA POINT_LIGHT FLOOR STONE("dense");
static const char egg[] = CAMERA POINT_LIGHT FLOOR EGG("crown");

#define BALL_BESIDE                                                                                \
  "- {name: other, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0.5, 0, "      \
  "0.2]}], material: crown}\n"
#define LAMP_BETWEEN                                                                               \
  "lights:\n- {name: lamp, kind: point, position: [0.25, 0, 0.2], intensity: 1}\n"
static const char two_balls[] = CAMERA POINT_LIGHT FLOOR BALL("crown") BALL_BESIDE;

typedef struct pair {
  const char *fact, *from, *to;
  abbe_render_desc desc; /* of the second */
  const char *row[40];
} pair;

/* The plan of one ball on a floor. */
#define BALL_ROWS(pages)                                                                           \
  "=7 wavelengths, 8 exits, 9 landings", "+model: ball|exact sphere: the object is a sphere",      \
      "-refractors in turn|light that leaves the refractor cannot meet it again",                  \
      "+model: receivers|exact parallelograms: every receiver is a rectangle or a box",            \
      "-shadows of receivers|the receivers bound a convex room around the lights",                 \
      "+wavelengths|7 from 380 to 780 nm: the index varies with wavelength",                       \
      "+inner reflections|followed until less than 0.01 of the light is left, 8 exits at most",    \
      "+map: lamp|the light may meet a refractor", pages,                                          \
      "-light: receiver depth|receivers are hit exactly",                                          \
      "+light: refractor front|photons start where the light sees a refractor",                    \
      "-light: refractor back|every refractor has an exact surface",                               \
      "+light: photon placement|at most 256 a side, where light meets a refractor",                \
      "+light: photons|4 to 7 wavelengths, as each photon's landings ask",                         \
      "+light: spectral map|1024 x 1024 texels",                                                   \
      "+light: gap fill|bridge: wavelengths land apart", "-absorption|every material is clear",    \
      "+eye: receivers|light, shadow and spectral map",                                            \
      "+eye: refractor front|the pixels that show a refractor",                                    \
      "-eye: refractor back|every refractor has an exact surface",                                 \
      "+eye: refraction|until less than 0.001 of its light is left, 256 exits at most",            \
      "+eye: picture|2 x 2 samples a pixel", "-textures|none",

static const char *const ball_rows[] = {
    BALL_ROWS("-maps on receivers|the lights' maps hold all receivers") NULL};

static const pair pairs[] = {
    {"no refractor",
     ball,
     CAMERA POINT_LIGHT FLOOR,
     {0},
     {"=1 wavelengths, 8 exits, 9 landings", "-refractors in turn|nothing refracts",
      "+wavelengths|1 from 380 to 780 nm: nothing refracts", "-inner reflections|nothing refracts",
      "-maps on receivers|no light meets a refractor",
      "-light: refractor front|no light meets a refractor",
      "-light: photon placement|no light meets a refractor",
      "-light: photons|no light meets a refractor",
      "-light: spectral map|no light meets a refractor", "-light: gap fill|nothing lands apart",
      "-absorption|nothing refracts", "-eye: refractor front|nothing refracts",
      "-eye: refraction|nothing refracts", "no model: ball", "no map: lamp", NULL}},
    {"one sample a pixel",
     ball,
     ball,
     {.supersample = 1},
     {"-eye: picture|one sample a pixel: nothing is averaged", NULL}},
    {"a lamp between the refractors",
     two_balls,
     CAMERA LAMP_BETWEEN FLOOR BALL("crown") BALL_BESIDE,
     {0},
     {"+map: lamp|a cube: 2 of 6 faces, as 'other' is more than 76 degrees off the middle of all "
      "refractors",
      NULL}},
    {"a mesh about a lamp between the refractors",
     two_balls,
     CAMERA LAMP_BETWEEN FLOOR DOME BALL("crown") BALL_BESIDE,
     {0},
     {"+model: receivers|triangle hierarchy: 'dome' is a general mesh",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+map: lamp|a cube: 2 of 6 faces, as 'other' is more than 76 degrees off the middle of all "
      "refractors",
      "+maps on receivers|a receiver may hide from a light where its light lands", NULL}},
    {"an index that is constant",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("flat"),
     {0},
     {"=1 wavelengths, 8 exits, 9 landings",
      "+wavelengths|1 from 380 to 780 nm: all indices are constant, one geometry serves all",
      "+light: photons|1 wavelengths through the refractors",
      "-light: gap fill|nothing lands apart", NULL}},
    {"an index that is air's",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("air"),
     {0},
     {"=1 wavelengths, 8 exits, 9 landings",
      "-model: ball|clear, and its index is that of air: light does not notice it",
      "-refractors in turn|nothing refracts", "+wavelengths|1 from 380 to 780 nm: nothing refracts",
      "-inner reflections|nothing refracts", "-maps on receivers|no light meets a refractor",
      "-light: refractor front|no light meets a refractor",
      "-light: photon placement|no light meets a refractor",
      "-light: photons|no light meets a refractor",
      "-light: spectral map|no light meets a refractor", "-light: gap fill|nothing lands apart",
      "-absorption|nothing refracts", "-eye: refractor front|nothing refracts",
      "-eye: refraction|nothing refracts", "no map: lamp", NULL}},
    {"a material that absorbs",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("murk"),
     {0},
     {"+absorption|a material attenuates by wavelength: landings keep the length inside", NULL}},
    {"a material that absorbs outside the range alone",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("murk"),
     {.min_nm = 500},
     {"+wavelengths|7 from 500 to 780 nm: the index varies with wavelength", NULL}},
    {"a constant index, and an attenuation that varies",
     flat,
     CAMERA POINT_LIGHT FLOOR BALL("smoke"),
     {0},
     {"=7 wavelengths, 8 exits, 9 landings",
      "+wavelengths|7 from 380 to 780 nm: the attenuation varies with wavelength",
      "+light: photons|7 wavelengths through the refractors",
      "+absorption|a material attenuates by wavelength: landings keep the length inside", NULL}},
    {"a cube for the ball",
     ball,
     CAMERA POINT_LIGHT FLOOR CUBE("crown"),
     {0},
     {"+model: ball|convex planes: the object is a convex faceted solid",
      "+inner reflections|followed until less than 0.01 of the light is left, 8 exits at most; "
      "0.17 % of it is still inside then",
      NULL}},
    {"an index above 2, of a cube",
     cube,
     CAMERA POINT_LIGHT FLOOR CUBE("dense"),
     {0},
     {"+inner reflections|followed until less than 0.01 of the light is left, 8 exits at most; "
      "0.42 % of it is still inside then",
      NULL}},
    {"facets that slope, of a cube",
     cube,
     CAMERA POINT_LIGHT FLOOR STONE("dense"),
     {0},
     {"=7 wavelengths, 24 exits, 25 landings",
      "+model: ball|convex planes: the object is a convex faceted solid: it has 19 planes",
      "+inner reflections|followed until less than 0.01 of the light is left, 24 exits at most; "
      "6.1 % of it is still inside then",
      NULL}},
    {"an index of 1.5, of a dense stone",
     stone,
     CAMERA POINT_LIGHT FLOOR STONE("crown"),
     {0},
     {"=7 wavelengths, 11 exits, 12 landings",
      "+inner reflections|followed until less than 0.01 of the light is left, 11 exits at most; "
      "0.49 % of it is still inside then",
      NULL}},
    {"ten exits, asked for in a dense stone",
     stone,
     CAMERA POINT_LIGHT FLOOR STONE("dense"),
     {.orders = 10},
     {"=7 wavelengths, 10 exits, 11 landings",
      "+inner reflections|followed until less than 0.01 of the light is left, 10 exits at most; 20 "
      "% of it is still inside then",
      NULL}},
    {"a share, asked for in a dense stone",
     stone,
     CAMERA POINT_LIGHT FLOOR STONE("dense"),
     {.energy_share = 0.05},
     {"+inner reflections|followed until less than 0.05 of the light is left, 24 exits at most; "
      "7.8 % of it is still inside then",
      NULL}},
    {"an index above 2, of a ball",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("dense"),
     {0},
     {

         NULL}},
    {"a convex mesh for the ball",
     ball,
     CAMERA POINT_LIGHT FLOOR EGG("crown"),
     {0},
     {"=7 wavelengths, 4 exits, 5 landings",
      "+model: ball|front and back layers: the object is a convex mesh and stands alone: a view "
      "sees all of it, front and back",
      "+inner reflections|followed until less than 0.01 of the light is left, 4 exits at most",
      "+light: refractor back|a mesh without an exact surface ends at its back layer",
      "+eye: refractor back|a mesh without an exact surface ends at its back layer",
      "+simplified layers|'ball' has 5120 faces: fewer, where no cell or sample tells",
      "+eye: refraction|until less than 0.001 of its light is left, 4 exits at most", NULL}},
    {"a mesh with a hole for the ball",
     ball,
     CAMERA POINT_LIGHT FLOOR TORUS("crown"),
     {0},
     {"=7 wavelengths, 8 exits, 16 landings",
      "+model: ball|triangle hierarchy: the object is a general mesh, and light may meet it more "
      "than twice",
      "+refractors in turn|the refractor is not convex",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most", NULL}},
    {"a second refractor, apart",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("crown"),
     {0},
     {"=7 wavelengths, 8 exits, 16 landings",
      "+model: brick|convex planes: the object is a convex faceted solid",
      "+refractors in turn|there is more than one refractor",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most", NULL}},
    {"a second refractor, within",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown") YOLK("crown"),
     {0},
     {"=7 wavelengths, 8 exits, 16 landings", "+model: yolk|exact sphere: the object is a sphere",
      "+refractors in turn|there is more than one refractor",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most", NULL}},
    {"a refractor that reaches into the floor",
     ball,
     CAMERA POINT_LIGHT FLOOR SUNK("crown"),
     {0},
     {"=7 wavelengths, 8 exits, 16 landings",
      "+refractors in turn|a receiver may reach into the refractor",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most", NULL}},
    {"a directional light",
     ball,
     CAMERA SUN FLOOR BALL("crown"),
     {0},
     {"+map: sun|the light may meet a refractor", "no map: lamp", NULL}},
    {"a spot that shines on the refractor",
     ball,
     CAMERA SPOT("[0, 0, 0]") FLOOR BALL("crown"),
     {0},
     {

         NULL}},
    {"a spot that shines past the refractor",
     ball,
     CAMERA SPOT("[-0.5, 0, 0]") FLOOR BALL("crown"),
     {0},
     {"-map: lamp|its cone misses every refractor", "-maps on receivers|no light meets a refractor",
      "-light: refractor front|no light meets a refractor",
      "-light: photon placement|no light meets a refractor",
      "-light: photons|no light meets a refractor",
      "-light: spectral map|no light meets a refractor", "-light: gap fill|nothing lands apart",
      NULL}},
    {"a spot that shines past a mesh",
     egg,
     CAMERA SPOT("[-0.5, 0, 0]") FLOOR EGG("crown"),
     {0},
     {"-map: lamp|its cone misses every refractor", "-maps on receivers|no light meets a refractor",
      "-light: refractor front|no light meets a refractor",
      "-light: refractor back|no light meets a refractor",
      "-light: photon placement|no light meets a refractor",
      "-light: photons|no light meets a refractor",
      "-light: spectral map|no light meets a refractor", "-light: gap fill|nothing lands apart",
      NULL}},
    {"a second light",
     ball,
     CAMERA POINT_LIGHT LIGHT_ASIDE FLOOR BALL("crown"),
     {0},
     {"+map: second|the light may meet a refractor", NULL}},
    {"a second light of another spectrum",
     ball,
     CAMERA POINT_LIGHT LIGHT_ASIDE_OF("A") FLOOR BALL("crown"),
     {0},
     {"+map: second|the light may meet a refractor",
      "!through refractors, colours are split by the first light's illuminant", NULL}},
    {"a receiver that may hide another",
     ball,
     CAMERA POINT_LIGHT FLOOR CARD BALL("crown"),
     {0},
     {"+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands", NULL}},
    {"a receiver far off the way to the refractor",
     ball,
     CAMERA POINT_LIGHT FLOOR CEILING BALL("crown"),
     {0},
     {"+maps on receivers|a receiver lies more than 76 degrees off the view of a light's map",
      NULL}},
    {"a mesh far off the way to the refractor",
     ball,
     CAMERA POINT_LIGHT FLOOR DOME BALL("crown"),
     {0},
     {"+model: receivers|triangle hierarchy: 'dome' is a general mesh",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands", NULL}},
    {"meshes alone",
     ball,
     CAMERA POINT_LIGHT "objects:\n" PEBBLE DOME BALL("crown"),
     {0},
     {"+model: receivers|triangle hierarchy: 'pebble' is a general mesh",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands", NULL}},
    {"a receiver that is no rectangle",
     ball,
     CAMERA POINT_LIGHT FLOOR HILL BALL("crown"),
     {0},
     {"+model: receivers|triangle hierarchy: 'hill' is a general mesh",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands", NULL}},
    {"a receiver that is no rectangle, and layers as asked",
     egg,
     CAMERA POINT_LIGHT FLOOR HILL EGG("crown"),
     {.model = ABBE_MODEL_LAYERS},
     {"+model: ball|front and back layers: as asked",
      "-refractors in turn|light goes through two layers and no further, as asked",
      "+model: receivers|triangle hierarchy: 'hill' is a general mesh",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands", NULL}},
    {"a texture",
     ball,
     CAMERA POINT_LIGHT WOOD BALL("crown"),
     {0},
     {"+textures|a receiver has one", NULL}},
    {"an eye that looks past the refractor",
     ball,
     EYE_ASIDE POINT_LIGHT FLOOR BALL("crown"),
     {0},
     {"-eye: refractor front|the eye sees no refractor",
      "-eye: refraction|the eye sees no refractor", NULL}},
    {"an eye that looks past a mesh",
     egg,
     EYE_ASIDE POINT_LIGHT FLOOR EGG("crown"),
     {0},
     {"-eye: refractor front|the eye sees no refractor",
      "-eye: refractor back|the eye sees no refractor",
      "-eye: refraction|the eye sees no refractor", NULL}},
    {"neither light nor eye for the refractor",
     ball,
     EYE_ASIDE SPOT("[-0.5, 0, 0]") FLOOR BALL("murk"),
     {0},
     {"=1 wavelengths, 8 exits, 9 landings",
      "+wavelengths|1 from 380 to 780 nm: neither a light nor the eye meets a refractor",
      "-inner reflections|neither a light nor the eye meets a refractor",
      "-map: lamp|its cone misses every refractor", "-maps on receivers|no light meets a refractor",
      "-light: refractor front|no light meets a refractor",
      "-light: photon placement|no light meets a refractor",
      "-light: photons|no light meets a refractor",
      "-light: spectral map|no light meets a refractor", "-light: gap fill|nothing lands apart",
      "-absorption|neither a light nor the eye meets a refractor",
      "-eye: refractor front|the eye sees no refractor",
      "-eye: refraction|the eye sees no refractor", NULL}},
    {"one wavelength, as asked",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown"),
     {.wavelengths = 1},
     {"=1 wavelengths, 8 exits, 9 landings", "+wavelengths|1 from 380 to 780 nm: as asked",
      "+light: photons|1 wavelengths through the refractors",
      "-light: gap fill|nothing lands apart", NULL}},
    {"many wavelengths of a constant index, as asked",
     flat,
     CAMERA POINT_LIGHT FLOOR BALL("flat"),
     {.wavelengths = 21},
     {"=21 wavelengths, 8 exits, 9 landings", "+wavelengths|21 from 380 to 780 nm: as asked",
      "+light: photons|21 wavelengths through the refractors", NULL}},
    {"many wavelengths of a glass that tints",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("murk"),
     {.wavelengths = 21},
     {"=21 wavelengths, 8 exits, 9 landings", "+wavelengths|21 from 380 to 780 nm: as asked",
      "+light: photons|4 to 21 wavelengths, as each photon's landings ask",
      "+absorption|a material attenuates by wavelength: landings keep the length inside", NULL}},
    {"many wavelengths of a glass that tints, from wall to wall of a mesh",
     ball,
     CAMERA POINT_LIGHT FLOOR RING("murk"),
     {.wavelengths = 21},
     {"=21 wavelengths, 8 exits, 16 landings", "+model: ring|triangle hierarchy",
      "+refractors in turn|the refractor is not convex",
      "+wavelengths|21 from 380 to 780 nm: as asked",
      "+light: photons|21 wavelengths through the refractors",
      "+absorption|a material attenuates; path lengths are kept",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most",
      "no model: ball", NULL}},
    {"many wavelengths of a clear glass",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown"),
     {.wavelengths = 21},
     {"=21 wavelengths, 8 exits, 9 landings", "+wavelengths|21 from 380 to 780 nm: as asked",
      "+light: photons|4 to 21 wavelengths, as each photon's landings ask", NULL}},
    {"no fill, as asked",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown"),
     {.fill = ABBE_FILL_NONE},
     {"+light: photons|7 wavelengths through the refractors", "-light: gap fill|none, as asked",
      NULL}},
    {"one exit, as asked",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown"),
     {.orders = 1},
     {"=7 wavelengths, 1 exits, 2 landings", "-inner reflections|two interfaces only, as asked",
      "+eye: refraction|one direction a wavelength", NULL}},
    {"the thesis profile, as asked",
     ball,
     CAMERA POINT_LIGHT FLOOR BALL("crown"),
     {.profile = ABBE_PROFILE_THESIS},
     {"=7 wavelengths, 1 exits, 1 landings",
      "+model: ball|front and back layers: the thesis profile knows no other model",
      "-refractors in turn|the thesis profile follows two interfaces",
      "+model: receivers|iterated image space: the thesis profile knows no other model",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+wavelengths|7 from 380 to 680 nm: the index varies with wavelength",
      "-inner reflections|two interfaces only, as in the thesis",
      "-maps on receivers|the thesis knows none",
      "+light: receiver depth|receivers are found by their depth from the light",
      "+light: refractor back|a mesh without an exact surface ends at its back layer",
      "+light: photon placement|at most 512 a side, where light meets a refractor",
      "+light: photons|7 wavelengths through the refractors",
      "+light: gap fill|smear: wavelengths land apart",
      "+eye: refractor back|a mesh without an exact surface ends at its back layer",
      "+eye: refraction|one direction a wavelength",
      "-eye: picture|one sample a pixel: nothing is averaged", NULL}},
};

static const char *const sphere_rows[] = {BALL_ROWS(
    "+maps on receivers|a receiver lies more than 76 degrees off the view of a light's map") NULL};

/* What each has otherwise than scenes/sphere.yaml. */
static const struct {
  const char *name, *row[24];
} shipped[] = {
    {"rainbow",
     {"+model: drop|exact sphere: the object is a sphere",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+maps on receivers|a receiver may hide from a light where its light lands", "no model: ball",
      NULL}},
    {"gem",
     {"=7 wavelengths, 20 exits, 21 landings",
      "+model: gem|convex planes: the object is a convex faceted solid",
      "+inner reflections|followed until less than 0.005 of the light is left, 20 exits at most; "
      "0.4 % of it is still inside then",
      "+absorption|a material attenuates by wavelength: landings keep the length inside",
      "no model: ball", NULL}},
    {"prism",
     {"+model: prism|convex planes: the object is a convex faceted solid",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+inner reflections|followed until less than 0.01 of the light is left, 8 exits at most; "
      "0.16 % of it is still inside then",
      "+maps on receivers|a receiver may hide from a light where its light lands",
      "+textures|a receiver has one", "no model: ball", NULL}},
    {"diamond",
     {"=7 wavelengths, 24 exits, 25 landings",
      "+model: diamond|convex planes: the object is a convex faceted solid",
      "+shadows of receivers|a receiver may stand between a light and another",
      "+inner reflections|followed until less than 0.01 of the light is left, 24 exits at most; "
      "2.9 % of it is still inside then",
      "-map: lamp of the left card|its cone misses every refractor",
      "-map: lamp of the high card|its cone misses every refractor",
      "+maps on receivers|a receiver may hide from a light where its light lands", "no model: ball",
      NULL}},
    {"ring",
     {"=7 wavelengths, 8 exits, 16 landings",
      "+model: ring|triangle hierarchy: the object is a general mesh, and light may meet it more "
      "than twice",
      "+refractors in turn|the refractor is not convex",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most",
      "no model: ball", NULL}},
    {"bunny",
     {"=7 wavelengths, 8 exits, 16 landings",
      "+model: bunny|triangle hierarchy: the object is a general mesh, and light may meet it more "
      "than twice",
      "+refractors in turn|the refractor is not convex",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most",
      "no model: ball", NULL}},
    {"glass",
     {"=7 wavelengths, 8 exits, 16 landings",
      "+model: glass|triangle hierarchy: the object is a general mesh, and light may meet it more "
      "than twice",
      "+refractors in turn|the refractor is not convex",
      "+eye: refraction|until less than 0.01 of its light is left, 256 exits at most",
      "+textures|a receiver has one", "no model: ball", NULL}},
};

static void load_and_plan(const char *text, const abbe_render_desc *desc, lines *out) {
  abbe_scene scene = {0};
  load_text(text, &scene);
  plan_of(&scene, desc, out);
  abbe_scene_free(&scene);
}

static void load_and_plan_shipped(const char *name, lines *out) {
  abbe_scene scene = {0};
  load_shipped(name, &scene);
  plan_of(&scene, NULL, out);
  abbe_scene_free(&scene);
}

static void test_shipped_scenes(void **state) {
  (void)state;
  static lines sphere, other, difference;
  load_and_plan_shipped("sphere", &sphere);
  check("sphere", sphere_rows, &sphere);
  for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
    load_and_plan_shipped(shipped[i].name, &other);
    differ(&sphere, &other, &difference);
    check(shipped[i].name, shipped[i].row, &difference);
  }
}

static void test_a_fact_changes_what_follows_from_it_alone(void **state) {
  (void)state;
  static lines from, to, difference;
  load_and_plan(ball, NULL, &from);
  check("ball", ball_rows, &from);
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
    load_and_plan(pairs[i].from, NULL, &from);
    load_and_plan(pairs[i].to, &pairs[i].desc, &to);
    differ(&from, &to, &difference);
    check(pairs[i].fact, pairs[i].row, &difference);
  }
}

/* 1 where the entry runs, 0 where it does not, -1 where there is none. */
static int runs(const lines *l, const char *name, size_t length) {
  for (size_t i = 0; i < l->count; i++)
    if (strncmp(l->line[i] + 1, name, length) == 0 && l->line[i][length + 1] == '|')
      return l->line[i][0] == '+';
  return -1;
}

/* What every picture of the default profile needs: some light, some receiver and the eye. */
static bool is_always_there(const char *name, size_t length) {
  static const char *const always[] = {"model: receivers", "wavelengths", "eye: receivers"};
  for (size_t i = 0; i < sizeof always / sizeof *always; i++)
    if (strncmp(name, always[i], length) == 0 && always[i][length] == '\0') return true;
  return false;
}

static void test_every_pass_goes_with_some_fact(void **state) {
  (void)state;
  enum { PAIRS = sizeof pairs / sizeof *pairs };
  static lines all, from[PAIRS], to[PAIRS];
  load_and_plan(ball, NULL, &all);
  for (size_t k = 0; k < PAIRS; k++) {
    load_and_plan(pairs[k].from, NULL, &from[k]);
    load_and_plan(pairs[k].to, &pairs[k].desc, &to[k]);
  }
  for (size_t i = 0; i < all.count; i++) {
    if (all.line[i][0] != '+' && all.line[i][0] != '-') continue;
    const char *name = all.line[i] + 1;
    size_t length = strcspn(name, "|");
    bool flips = false;
    for (size_t k = 0; k < PAIRS && !flips; k++)
      flips = runs(&from[k], name, length) + runs(&to[k], name, length) == 1;
    if (flips == is_always_there(name, length))
      fail_msg("'%.*s' goes with %s", (int)length, name, flips ? "a fact" : "no fact");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shipped_scenes),
      cmocka_unit_test(test_a_fact_changes_what_follows_from_it_alone),
      cmocka_unit_test(test_every_pass_goes_with_some_fact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
