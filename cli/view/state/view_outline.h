/* view_outline.h: what of a scene can be taken hold of: lights and objects, where they stand, and
 * the keys under which their values are set.
 *
 * It is made of the scene and of the text that it was read from: of the one come places and names,
 * of the other keys, and how an object was put where it is. It changes nothing of these.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_OUTLINE_H
#define ABBE_CLI_VIEW_STATE_VIEW_OUTLINE_H

#include "cli/view/state/view_document.h"
#include "scenes/scene.h"

#define ABBE_VIEW_MOST_OBJECTS 64 /* that can be taken hold of; more are left alone */
#define ABBE_VIEW_MOST_VALUES 6   /* values of a shape */
#define ABBE_VIEW_MOST_STONES 512 /* and as many metals */
enum { ABBE_VIEW_NAME = 80, ABBE_VIEW_KEY = 128 };

/* A number of the scene that a slider sets. */
typedef struct abbe_view_value {
  char key[ABBE_VIEW_KEY]; /* "objects.gem.crown" */
  const char *label, *unit;
  double value, min, max; /* as the file has it */
  double scale;           /* from the file's unit to the one shown */
} abbe_view_value;

typedef struct abbe_view_light {
  char name[ABBE_VIEW_NAME], key[ABBE_VIEW_KEY]; /* "lights.lamp" */
  abbe_light_kind kind;
  bool placed;        /* it has a position or a direction, which may be set */
  double position[3]; /* for a directional light a place from which it shines at `aim` */
  double aim[3];      /* the middle of what the camera sees */
  bool owned;         /* where it stands by the file alone is known: */
  double own[3];
  abbe_view_value power;
} abbe_view_light;

typedef struct abbe_view_object {
  char name[ABBE_VIEW_NAME], key[ABBE_VIEW_KEY]; /* "objects.gem" */
  bool bends;                                    /* light: it is a refractor or a mirror */
  bool thick;                                    /* it is no flat receiver, such as a table */
  bool mirror;
  char material[ABBE_VIEW_NAME]; /* or metal; "": of none */
  size_t scene_index;            /* index of the scene's object, the first of what it is made of */
  double middle[3], radius;      /* bounds, m, without the metal around it */
  double above; /* m, from the flat receiver below it to its underside; NaN: not known */
  /* How it was put there, as one line of YAML without brackets, but for a last `translate`; and
   * that. Where the file fits or centres it, which would undo other steps, these are steps too, and
   * whoever sets the transform takes the keys out. */
  char *before;
  double translate[3];
  bool fitted, centred, stands, sized;
  char *own_before; /* so by the file alone; NULL: not known */
  double own_translate[3], own_middle[3];
  char *design; /* file of a design that it is cut by; NULL: it is none */
  size_t value_count;
  abbe_view_value value[ABBE_VIEW_MOST_VALUES];
} abbe_view_object;

typedef struct abbe_view_outline {
  abbe_camera camera; /* the scene's own */
  size_t light_count, object_count, stone_count, metal_count;
  abbe_view_light light[ABBE_SCENE_MAX_LIGHTS];
  abbe_view_object object[ABBE_VIEW_MOST_OBJECTS];
  /* names of the scene's table of materials: those that are clear, stones before glasses and
   * liquids, and metals; and their colours, 0xRRGGBB of sRGB: of white light after 5 mm of the one,
   * reflected by the other */
  size_t glasses_from; /* the first of stone[] that is none */
  char *stone[ABBE_VIEW_MOST_STONES], *metal[ABBE_VIEW_MOST_STONES];
  unsigned stone_colour[ABBE_VIEW_MOST_STONES], metal_colour[ABBE_VIEW_MOST_STONES];
  char table[1024]; /* table of these */
  bool surrounded;  /* an environment is there, with this value: */
  abbe_view_value rotate;
  abbe_view_value ambient;
} abbe_view_outline;

/* text[size] is what the scene was read from. Errors of abbe_yaml_parse, ABBE_NO_MEMORY; *out is
 * then zeroed. */
abbe_result abbe_view_outline_make(const abbe_scene *scene, const char *text, size_t size,
                                   abbe_view_outline *out, abbe_error *error);
void abbe_view_outline_free(abbe_view_outline *outline);
/* The table's materials into an outline; false without memory. */
bool abbe_view_outline_list_materials(const abbe_material_table *table, abbe_view_outline *out);

/* What a slider is at: as the document sets it, with a unit of length or without; else, or where
 * that is no number, as the scene that was read has it. In the file's unit. */
double abbe_view_outline_value(const abbe_view_value *value, const abbe_view_document *document);
/* The whole transform of an object as a value to be set: as it was, but tilted about the origin of
 * its shape by `tilt_rad` about `axis` (0: not), and moved to `translate`. False where it does not
 * fit. */
bool abbe_view_outline_transform(const abbe_view_object *object, double tilt_rad,
                                 const double axis[3], const double translate[3], char *out,
                                 size_t size);
/* Where things stand by the file alone: the outline is of the document (NULL: of another one),
 * which may not have moved them; else as the outline before had it, whose it was. */
void abbe_view_outline_own(abbe_view_outline *outline, const abbe_view_document *document,
                           abbe_view_outline *before);
/* Lights and objects stand as another document of the same file says, as far as that is known: by
 * values of abbe_view_outline_transform, lights' positions, or the file. Until it is learnt anew.
 */
void abbe_view_outline_stand(abbe_view_outline *outline, const abbe_view_document *document);

#endif
