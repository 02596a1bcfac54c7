/* view_document.h: what is looked at: a scene file, the changes to it, the settings; and the way
 * back through what it was before.
 *
 * Changes are as `--set` takes them (scenes/import/scene_file.h), one for each key, so that the
 * same list loads the scene, writes it and makes the command line that repeats the picture. It
 * reads no files. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_DOCUMENT_H
#define ABBE_CLI_VIEW_STATE_VIEW_DOCUMENT_H

#include "base/error.h"
#include "scenes/studio/studio.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_VIEW_MOST_CHANGES 64
#define ABBE_VIEW_MOST_STEPS 256 /* back */

typedef struct abbe_view_document {
  char *path;                /* path of the scene file, or of a stone's: */
  const abbe_studio *studio; /* how that is shown; borrowed, and NULL of a scene */
  size_t set_count;
  char *set[ABBE_VIEW_MOST_CHANGES];     /* "KEY=VALUE" */
  size_t wavelengths, photons, map_size; /* 0: as the stage has them */
} abbe_view_document;

/* *out is zeroed on failure: ABBE_NO_MEMORY. */
abbe_result abbe_view_document_copy(const abbe_view_document *document, abbe_view_document *out,
                                    abbe_error *error);
void abbe_view_document_free(abbe_view_document *document);

/* Becomes that file as it is, with settings as stages have them. ABBE_NO_MEMORY; the document is
 * then as it was. */
abbe_result abbe_view_document_open(abbe_view_document *document, const char *path,
                                    abbe_error *error);

/* The value of a key becomes this one; the last change stands last. ABBE_INVALID_ARGUMENT for one
 * change too many; the document is then as it was. */
abbe_result abbe_view_document_set(abbe_view_document *document, const char *key, const char *value,
                                   abbe_error *error);
/* What a key was set to, or NULL. */
const char *abbe_view_document_value(const abbe_view_document *document, const char *key);

/* "[x, y, z]" with six digits, which read back as *numbers are then. */
void abbe_view_document_point(double point[3], char *out, size_t size);
/* Reads such a text, which may be NULL; false where it is none: out stays. */
bool abbe_view_document_read(const char *text, double out[3]);

/* What differs between two: this and nothing that stands below it. */
typedef enum abbe_view_difference {
  ABBE_VIEW_SAME,
  ABBE_VIEW_CAMERA,   /* values under "camera." */
  ABBE_VIEW_SETTINGS, /* wavelengths, photons, texels */
  ABBE_VIEW_LIGHTS,   /* values under "lights.", ambient light, background */
  ABBE_VIEW_CHANGED   /* any value, or the file */
} abbe_view_difference;
abbe_view_difference abbe_view_document_compare(const abbe_view_document *a,
                                                const abbe_view_document *b);

/* What was before and, after steps back, what came then. */
typedef struct abbe_view_history {
  size_t count, at; /* entry[at] is now */
  abbe_view_document entry[ABBE_VIEW_MOST_STEPS];
} abbe_view_history;

/* Starts anew with a copy of the document. */
abbe_result abbe_view_history_begin(abbe_view_history *history, const abbe_view_document *document,
                                    abbe_error *error);
void abbe_view_history_free(abbe_view_history *history);
const abbe_view_document *abbe_view_history_now(const abbe_view_history *history);
/* The document to be changed: a new step, or with `continued` the present one. */
abbe_result abbe_view_history_edit(abbe_view_history *history, bool continued,
                                   abbe_view_document **out, abbe_error *error);
/* False where there is none. */
bool abbe_view_history_undo(abbe_view_history *history);
bool abbe_view_history_redo(abbe_view_history *history);

#endif
