/* frame_record.h: what made a frame, in lines of text that its files carry: so that a series that
 * is resumed or merged has no frames of another size, seed, scene or program among it.
 */
#ifndef ABBE_CLI_OPTIONS_FRAME_RECORD_H
#define ABBE_CLI_OPTIONS_FRAME_RECORD_H

#include "base/error.h"
#include "scenes/scene.h"

/* What all frames of this run have in common: the program's version, its options but for those that
 * change no pixel and the one named `without` (NULL: none), and digests of all files that it reads.
 * *out is malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_frame_record_make(const abbe_scene *scene, const char *without, char **out,
                                   abbe_error *error);
/* The record of frame `number`; malloc'd, or NULL without memory. */
char *abbe_frame_record_of(const char *common, size_t number);

/* What the PNG or EXR file at path carries; malloc'd. NULL: none, or it cannot be read. */
char *abbe_frame_record_read(const char *path);

/* Whether both are of one run, whatever their frames; else in text[size] how they differ: "'size
 * 64x64', and not 'size 96x64'". theirs may be NULL. */
bool abbe_frame_record_is_like(const char *theirs, const char *ours, char *text, size_t size);

#endif
