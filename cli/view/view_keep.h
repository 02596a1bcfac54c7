/* view_keep.h: what is seen, kept: EXR, PNG, the scene with its changes, and the command line that
 * repeats the picture. Internal to cli/view/. */
#ifndef ABBE_CLI_VIEW_VIEW_KEEP_H
#define ABBE_CLI_VIEW_VIEW_KEEP_H

#include "cli/view/view_session.h"

#include <stdio.h>

#define ABBE_VIEW_KEEP_LONGEST 1000 /* bytes of a name, without an ending */

/* Where the folder that the program was started in cannot be written to, unnamed files go to the
 * user's own, or to that of temporary files. */
void abbe_view_keep_find_place(abbe_view_session *session);
/* What kept files are called, with that ending: as given, or the scene's name and -view. */
void abbe_view_keep_name(const abbe_view_session *session, const char *ending, char *out,
                         size_t size);
/* Whether the picture that stands is that of the last change, at rest; else ABBE_INVALID_ARGUMENT.
 */
abbe_result abbe_view_keep_rests(const abbe_view_session *session, abbe_error *error);
/* Writes the rendered picture as NAME.exr, what is looked at as NAME.png, and NAME.yaml, says so in
 * the session's note, and the command on standard output. In another folder than its own the scene
 * names its files by their whole paths. Errors of abbe_view_keep_rests;
 * ABBE_INVALID_ARGUMENT where one of the three is a file that the scene is read from; errors of
 * files. */
abbe_result abbe_view_keep(abbe_view_session *session, abbe_error *error);
/* The image as it is shown, through the display and view that are chosen. Errors of
 * abbe_view_keep_check and of files. */
abbe_result abbe_view_keep_png(const abbe_view_session *session, const abbe_image *image,
                               const char *path, abbe_error *error);
/* ABBE_INVALID_ARGUMENT where the target is a file that the scene is read from. */
abbe_result abbe_view_keep_check(const abbe_view_session *session, const char *target,
                                 abbe_error *error);
/* As a shell reads it back. */
void abbe_view_keep_quote(FILE *out, const char *text);
/* Whether two names are of one file that is there, by links too, or are the same name. */
bool abbe_view_keep_same_file(const char *a, const char *b);

/* `abbe render …` that draws the picture that stands into NAME-again.exr and .png; malloc'd, NULL
 * where it is not at rest, and without memory. */
char *abbe_view_keep_command(const abbe_view_session *session);

#endif
