/* field.h: a picture or a receiver map as it is compared: colour, bands, their standard errors.
 *
 * Made from an OpenEXR file of the renderer's, the tracer's or another program's. Colour is three
 * channels, R, G, B or X, Y, Z, kept as the file has them beside the matrix to XYZ; bands are
 * the layers S0.550,000000nm of spectral OpenEXR [Fichet2021]. Standard errors are the channels of
 * the same names behind "stderr."; where none of them is finite they are not known. Two fields are
 * brought to one size and one space here; how far they are apart is compare.h's business.
 * Internal to validation/measure/.
 */
#ifndef ABBE_VALIDATION_MEASURE_FIELD_H
#define ABBE_VALIDATION_MEASURE_FIELD_H

#include "colorimetry/image/image.h"
#include "colorimetry/observer.h"

#include <stdbool.h>

/* X(code, name): the attribute abbe:kind of a file, or what its other attributes mean. */
#define ABBE_FIELD_KINDS(X)                                                                        \
  X(PICTURE, "picture")           /* radiance a pixel */                                           \
  X(RECEIVER_MAP, "receiver map") /* flux a texel, in a light's layout */

typedef enum abbe_field_kind {
#define ABBE_FIELD_ENUM(code, name) ABBE_FIELD_##code,
  ABBE_FIELD_KINDS(ABBE_FIELD_ENUM)
#undef ABBE_FIELD_ENUM
      ABBE_FIELD_KIND_COUNT
} abbe_field_kind;

const char *abbe_field_kind_name(abbe_field_kind kind);

/* Interleaved samples of every pixel, row 0 at the top. */
typedef struct abbe_field_samples {
  size_t channels; /* 0: there are none */
  float *value;    /* [height][width][channels], in the file's unit; bands in W, m and sr */
  float *error;    /* the same, standard error of the mean; NULL where the file has none */
} abbe_field_samples;

/* A zeroed field is empty. */
typedef struct abbe_field {
  abbe_field_kind kind;
  size_t width, height;
  abbe_field_samples colour; /* 0 or 3 channels */
  bool is_xyz;               /* the channels are X, Y, Z; else R, G, B */
  abbe_observer observer;    /* whose XYZ it is */
  double to_xyz[9];          /* matrix of the colour, row-major; XYZ is relative to D65 */
  char space[40];            /* "acescg", …, "R, G, B of the file's chromaticities" */
  bool space_assumed;        /* the file does not say its space; Rec.709 was taken */
  abbe_field_samples bands;
  double *lambda_nm;          /* [bands.channels] ascending */
  size_t unread;              /* channels of a spectrum that are none of these bands */
  abbe_field_samples caustic; /* 0 or 3 channels, in the colour's space, without errors */
  size_t passes;              /* independent estimates behind the errors; 0: not known */
  abbe_image header;          /* the file's attributes and its display window; no pixels */
} abbe_field;

/* What image holds. ABBE_INVALID_ARGUMENT where it has neither colour nor bands, where only some
 * of the channels of a set are there, and for chromaticities that span no space. `name` is what
 * errors call it. */
abbe_result abbe_field_make(const abbe_image *image, const char *name, abbe_field *out,
                            abbe_error *error);
/* The same from an OpenEXR file; errors of abbe_exr_read as well. */
abbe_result abbe_field_load(const char *path, abbe_field *out, abbe_error *error);
void abbe_field_free(abbe_field *field);

/* XYZ of a pixel. `error` (may be NULL) is the standard error where there is one, else zeros; from
 * R, G, B it is the bound that holds whatever the correlation of their errors is. */
void abbe_field_xyz(const abbe_field *field, size_t pixel, double xyz[3], double error[3]);
/* Turns the colour into X, Y, Z, and its errors into those of abbe_field_xyz. */
void abbe_field_become_xyz(abbe_field *field);

/* Adds texels up to a map of width x height, which divide the map's own; errors add as those of
 * independent texels. For maps of flux alone. ABBE_INVALID_ARGUMENT, ABBE_NO_MEMORY. */
abbe_result abbe_field_sum_down(abbe_field *field, size_t width, size_t height, abbe_error *error);

/* Brings two fields together: of one kind, with colour or bands in common, one size and, for maps,
 * one layout (scenes/view/map_layout.h; none for both is the same) and one abbe:map_light. The
 * finer of two maps is summed down to the coarser; if the spaces of colour differ, both become XYZ;
 * bands stay only where both have the same. ABBE_INVALID_ARGUMENT with what differs (the places
 * where they lie, too), by the names that are given. */
abbe_result abbe_field_align(abbe_field *a, const char *name_a, abbe_field *b, const char *name_b,
                             abbe_error *error);

#endif
