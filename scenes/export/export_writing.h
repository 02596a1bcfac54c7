/* export_writing.h: what the writers of single formats share. Internal to scenes/. */
#ifndef ABBE_SCENES_EXPORT_EXPORT_WRITING_H
#define ABBE_SCENES_EXPORT_EXPORT_WRITING_H

#include "base/error.h"
#include "base/maths.h"
#include "colorimetry/image/image.h"
#include "scenes/export/scene_export.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The pictures that stand beside an exported file.
 *
 * They are gathered in memory and written at the end, each beside its target and renamed, before
 * the file that names them. Where one cannot be written, those that were not there before are
 * removed again. */

typedef struct abbe_export_file {
  char *path;
  abbe_image picture;
  bool written, fresh;
} abbe_export_file;

typedef struct abbe_export_files {
  char *stem;       /* the exported file's path without its ending */
  const char *name; /* what of it comes after the last slash */
  size_t count;
  abbe_export_file *file;
} abbe_export_files;

/* Zeroed before. ABBE_UNSUPPORTED for a name that the formats cannot spell, ABBE_NO_MEMORY. */
abbe_result abbe_export_files_begin(abbe_export_files *files, const char *path, abbe_error *error);
void abbe_export_files_free(abbe_export_files *files);

abbe_result abbe_export_files_write(abbe_export_files *files, abbe_error *error);
/* Removes what was written and had not been there. */
void abbe_export_files_undo(abbe_export_files *files);

#define ABBE_EXPORT_DEGREES (180 / ABBE_PI)
#define ABBE_EXPORT_NAME_SIZE 96
#define ABBE_EXPORT_DISK_SIDES 64

typedef struct abbe_export_writing {
  FILE *file;
  const abbe_scene *scene;
  abbe_scene_export_target target;
  const abbe_scene_export_report *report;
  abbe_export_files *files;
} abbe_export_writing;

/* One for each format. */
abbe_result abbe_export_pbrt(const abbe_export_writing *w, abbe_error *error);
abbe_result abbe_export_gltf(const abbe_export_writing *w, abbe_error *error);
abbe_result abbe_export_blender(const abbe_export_writing *w, abbe_error *error);

/* prefix, number and the letters and digits of name: an identifier in every format, of its own. */
const char *abbe_export_name(char out[ABBE_EXPORT_NAME_SIZE], const char *prefix, size_t number,
                             const char *name);
/* Index of the material among the report's. */
size_t abbe_export_glass_of(const abbe_export_writing *w, const abbe_material *material);

/* The head of a file: where it comes from, and the report, a line each between before and after.
 * No line holds what ends a comment. */
void abbe_export_comment(const abbe_export_writing *w, const char *before, const char *after);

/* "a b c" with a separator; the numbers of many. */
void abbe_export_vector(FILE *file, const double v[3], const char *separator);

/* The camera's own axes: unit, right-handed with -forward. */
void abbe_export_camera(const abbe_camera *camera, double right[3], double up[3],
                        double forward[3]);
/* Two unit axes with a x b = direction. */
void abbe_export_basis(const double direction[3], double a[3], double b[3]);

/* Linear Rec.709 of the illuminant's light over 380 to 780 nm, Y = 1. */
void abbe_export_light_rgb(const abbe_illuminant *illuminant, double rgb[3]);
/* Calls put for wavelengths from 380 to 780 nm, as densely as the illuminant needs. */
void abbe_export_light_spectrum(const abbe_illuminant *illuminant, double factor,
                                void (*put)(void *user, double lambda_nm, double value),
                                void *user);
/* Calls put with a receiver's reflectance, as Abbe has it: from 360 to 830 nm, at the points
 * between which it is linear. */
void abbe_export_reflectance(const abbe_object *receiver,
                             void (*put)(void *user, double lambda_nm, double value), void *user);
/* Whether that is one number at all wavelengths, reflectance[0]. */
bool abbe_export_is_grey(const abbe_object *receiver);
/* A rectangle's or disk's front as a mesh whose normal is the light's direction. A disk has
 * ABBE_EXPORT_DISK_SIDES sides and its own area. */
abbe_result abbe_export_light_mesh(const abbe_light *light, abbe_mesh *out, abbe_error *error);

/* Attenuation for red, green and blue, 1/m, at the dominant wavelengths of the primaries. */
void abbe_export_attenuation_rgb(const abbe_material *material, double per_m[3]);
/* n and k of a conductor at the wavelength, held at the ends of the data. */
double abbe_export_conductor_n(const abbe_material *conductor, double lambda_nm);
double abbe_export_conductor_k(const abbe_material *conductor, double lambda_nm);
/* What a mirror reflects of white light at normal incidence, linear Rec.709 within 0 to 1. */
void abbe_export_mirror_rgb(const abbe_object *mirror, double rgb[3]);
/* GGX's alpha of a mirror, alike along its grooves and across: the root of both's product; 0: it is
 * smooth. */
double abbe_export_roughness(const abbe_object *mirror);

/* Adds the surroundings as STEM-environment.exr, linear Rec.709. direction says from where, in
 * world axes, light comes at (u, v), both in [0, 1], v downwards. */
abbe_result abbe_export_environment(const abbe_export_writing *w, size_t width, size_t height,
                                    void (*direction)(double u, double v, double out[3]),
                                    abbe_error *error);
/* Adds the receiver's texture times its reflectance as STEM-NAME.exr. */
abbe_result abbe_export_texture(const abbe_export_writing *w, const abbe_object *object,
                                const char *name, abbe_error *error);
/* Whether all triangles have their own normals at their corners. */
bool abbe_export_is_faceted(const abbe_mesh *mesh);

#endif
