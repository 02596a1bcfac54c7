/* command.h: the program's subcommands, a file each: arguments in, library calls, text out.
 *
 * Arguments are parsed by argp, which answers --help and ends with 2 for wrong use. Results go to
 * stdout, messages to stderr. Exit codes: 0 done, 1 failed at run time, 2 used wrongly, 3 a
 * comparison was out of tolerance. Internal to cli/.
 */
#ifndef ABBE_CLI_BASE_COMMAND_H
#define ABBE_CLI_BASE_COMMAND_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

struct abbe_exr_reader;
struct abbe_image;
struct abbe_image_odd;
struct cJSON;

enum { ABBE_EXIT_DONE = 0, ABBE_EXIT_FAILED = 1, ABBE_EXIT_USAGE = 2, ABBE_EXIT_TOLERANCE = 3 };

/* X(name, summary): every subcommand NAME is `int abbe_command_NAME(int argc, char **argv)`;
 * argv[0] is "abbe NAME". Three groups, as `abbe help` shows them. */
#define ABBE_SCENE_COMMANDS(X)                                                                     \
  X(render, "render a stone or a scene to OpenEXR and to a picture for a display")                 \
  X(view, "show it in a window: turn it, change it, see the light follow")                         \
  X(trace, "trace the reference: what light really does, with standard errors")                    \
  X(derive, "say how a picture or a caustic changes with numbers of its scene")                    \
  X(gem, "say what a gem's design holds, draw it, report on it, convert it, change its angles")    \
  X(plan, "say which passes and models a scene asks for, and why")                                 \
  X(export, "write a scene for pbrt, glTF, Blender or POV-Ray")                                    \
  X(volume, "compute an object's caustics beforehand, for light from all sides")                   \
  X(methods, "the published methods that render can take in place of its own, and their options")
#define ABBE_PICTURE_COMMANDS(X)                                                                   \
  X(info, "say what an EXR holds: size, channels, space, settings, statistics")                    \
  X(display, "turn a linear EXR into a picture for a display, through OpenColorIO")                \
  X(pixel, "say what a picture has at a pixel: spectrum, XYZ, wavelength, colour temperature")     \
  X(relight, "show a spectral picture to another observer, or under another illuminant")           \
  X(compare, "say how far a picture or a receiver map is from a reference")
#define ABBE_DATA_COMMANDS(X)                                                                      \
  X(materials, "look into, edit, convert and check tables of materials")                           \
  X(weights, "what each wavelength sample adds to a colour, in XYZ or RGB")                        \
  X(validate, "hold the reference tracer against optics that is known")
/* In Python, and not among those whose options the program knows. */
#define ABBE_PYTHON_COMMANDS(X)                                                                    \
  X(design, "makes a pane whose caustic is a picture, a prism or a pair without colour")           \
  X(sweep, "measures settings: time against error, and which are worth it")
#define ABBE_COMMANDS(X) ABBE_SCENE_COMMANDS(X) ABBE_PICTURE_COMMANDS(X) ABBE_DATA_COMMANDS(X)

#define ABBE_COMMAND_DECLARE(name, summary) int abbe_command_##name(int argc, char **argv);
ABBE_COMMANDS(ABBE_COMMAND_DECLARE)
#undef ABBE_COMMAND_DECLARE

/* What the program's own help and manual page begin with. */
#define ABBE_FIRST_STEPS                                                                           \
  "  abbe render round.asc --material ruby   a picture of a stone: round.png\n"                    \
  "  abbe view round.asc                     the stone in a window, to be turned and changed\n"    \
  "  abbe gem report round.asc -o round.pdf  how well it is cut\n"                                 \
  "\n"                                                                                             \
  "  round.asc is a design (.asc, .gem, .gcs) or, but for the report, a mesh (.stl, .obj, .ply,\n" \
  "  .glb); a scene of your own is a .yaml: abbe render scenes/gem.yaml --png gem.png\n"

/* Parses the whole text as a finite number in [min, max]. On failure prints a sentence that names
 * the option, and ends the program with ABBE_EXIT_USAGE. */
double abbe_command_number(const char *program, const char *option, const char *text, double min,
                           double max);
/* The same for a length with its unit or, a bare number, in millimetres; in metres. */
double abbe_command_length(const char *program, const char *option, const char *text, double min_m,
                           double max_m);
/* The same for whole numbers. */
unsigned long abbe_command_count(const char *program, const char *option, const char *text,
                                 unsigned long min, unsigned long max);
/* "380:780" as a range, 0 < from < to. */
void abbe_command_range(const char *program, const char *option, const char *text, double *from,
                        double *to);
/* One word of names[count]; its index. An unknown word names the nearest and the list. */
int abbe_command_choice(const char *program, const char *option, const char *text,
                        const char *const *names, int count);

/* The name of a file that the option writes. One that ends like a file of another kind, such as
 * 'gem.png' or 'gem.jpg' for .exr, is refused; any other ending is the user's own. */
const char *abbe_command_target(const char *program, const char *option, const char *text,
                                const char *ending);

/* The name of a picture: *exr where its ending is of no kind for a display (screen_file.h), else
 * *png. exr NULL: all is for a display. A second one for a display, and a kind whose library the
 * build lacks, are refused. */
void abbe_command_output(const char *program, const char *option, const char *text,
                         const char **exr, const char **png);

/* "512x512" as width and height, each 1 to `most`. */
void abbe_command_size(const char *program, const char *option, const char *text, size_t most,
                       size_t *width, size_t *height);

/* A part of work that several processes share: "2/8" is the third of eight parts. */
typedef struct abbe_command_part {
  size_t part, parts; /* parts 0: all of the work is one process's */
} abbe_command_part;
#define ABBE_COMMAND_MOST_PARTS 1000000
void abbe_command_read_part(const char *program, const char *text, abbe_command_part *out);
/* Whether the part has the piece of that number: each part has every parts-th. */
bool abbe_command_part_has(const abbe_command_part *part, size_t piece);

/* Opens and discards each of the files (NULL: none), so that a target that cannot be written is
 * found out before the work, not after it. */
abbe_result abbe_command_check_targets(const char *const *paths, size_t count, abbe_error *error);

/* Notes on stderr about a picture of that name: that it does not say its space, and Rec.709 is
 * taken; and how many of its pixels are infinite, and what is done with them, or not numbers, where
 * any are. */
void abbe_command_note_space(const char *name);
void abbe_command_note_odd(const char *name, const struct abbe_image_odd *odd, const char *how);

/* The same about which of a file's several parts the picture is: an abbe_image's `part`. */
void abbe_command_note_part(const char *name, const char *part);
/* Reads a scene-linear picture with that note. Errors of abbe_picture_file_read. */
abbe_result abbe_command_read_picture(const char *path, struct abbe_image *out, abbe_error *error);
/* The same, but of an OpenEXR file the header alone: its pixels are read from *file, to be closed
 * by abbe_exr_close, which is NULL for other kinds. */
abbe_result abbe_command_open_picture(const char *path, struct abbe_exr_reader **file,
                                      struct abbe_image *out, abbe_error *error);

/* Prints json and a line's end to stdout and deletes it. Where it is NULL or not all of it was
 * made, for want of memory, nothing is printed and ABBE_NO_MEMORY comes back. */
abbe_result abbe_command_print_json(struct cJSON *json, bool made, abbe_error *error);
/* The same where `print`, and into the file `path` unless that is NULL. */
abbe_result abbe_command_write_json(struct cJSON *json, bool made, bool print, const char *path,
                                    abbe_error *error);
/* At the end of the program: true, and a sentence on stderr, where something did not reach stdout
 * and no command has reported it. */
bool abbe_command_output_failed(void);
/* Ends a command: 0 where all results reached stdout; else the failure, reported on stderr. */
int abbe_command_end(const char *program, abbe_result result, abbe_error *error);

/* A command that has verbs, such as `abbe materials show`: help on all of them, and the one that
 * is requested. */

typedef struct abbe_verb {
  const char *name, *summary;
  int (*run)(int argc, char **argv); /* argv[0] is "abbe COMMAND VERB" */
} abbe_verb;

typedef struct abbe_verbs {
  const abbe_verb *verb;
  size_t count;
  const char *const *example; /* arguments behind the command's name */
  size_t examples;
  const char *page; /* page of the documentation, as a sentence's end */
} abbe_verbs;

/* Runs the verb that argv[1] names, or prints help; the program's exit code. argv[0] is "abbe
 * COMMAND". A word that is no verb is refused with the nearest one. */
int abbe_verbs_run(const abbe_verbs *verbs, int argc, char **argv);

/* Files that came with the program, found wherever it was installed. */

/* path, where something is there; else that path in the share folder beside the program's own, or
 * where the build installs it, in text[size]; else path. */
const char *abbe_shipped_find(const char *path, char *text, size_t size);

/* A command that is a part of the Python module abbe: abbe.NAME, run by python3. */

/* Becomes Python with argc words of argv, and returns an exit code where it cannot. The module is
 * looked for beside the program; $ABBE_PYTHON is taken before Debian's own python3. */
int abbe_python_command_run(const char *name, int argc, char **argv);

#endif
