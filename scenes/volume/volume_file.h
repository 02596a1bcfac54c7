/* volume_file.h: caustic volumes as OpenEXR files: one part, half precision, ZIP, written beside
 * their target and renamed; what they are stands in named attributes.
 *
 * Pixels follow each other along rows, node after node and cell after cell; those that are left in
 * the last row are 0. Channels are X.x, X.y, X.z, Y.x ... of a vector volume, R, G, B of a printed
 * one. Of exits there are points, then exits node after node, then the cells' free space; channels
 * are P.x to Dn.z, T and S.
 */
#ifndef ABBE_SCENES_VOLUME_VOLUME_FILE_H
#define ABBE_SCENES_VOLUME_VOLUME_FILE_H

#include "scenes/volume/caustic_volume.h"

/* ABBE_IO, ABBE_NO_MEMORY; ABBE_UNSUPPORTED for more values than a picture has pixels. */
abbe_result abbe_volume_file_write(const char *path, const abbe_caustic_volume *volume,
                                   abbe_error *error);

/* Everything is checked before it is used: ABBE_NOT_FOUND for a picture that is no volume,
 * ABBE_PARSE for an attribute that is broken or does not go with the pixels, errors of
 * abbe_exr_read and abbe_volume_region_make. */
abbe_result abbe_volume_file_read(const char *path, abbe_caustic_volume *out, abbe_error *error);

#endif
