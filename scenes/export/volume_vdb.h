/* volume_vdb.h: a caustic volume in one light as an OpenVDB file, for programs that draw fields.
 */
#ifndef ABBE_SCENES_EXPORT_VOLUME_VDB_H
#define ABBE_SCENES_EXPORT_VOLUME_VDB_H

#include "scenes/volume/caustic_volume.h"

/* Writes the volume for light from unit direction to_light, in the object's coordinates: three
 * grids of vectors, X, Y and Z, the vector irradiance of unit light at the middles of the cells;
 * places from the object's centre, m. The file is written beside its target and renamed.
 * ABBE_INVALID_ARGUMENT for another than a grid of vectors; errors of abbe_vdb_bytes_make and
 * abbe_file_write. */
abbe_result abbe_volume_vdb_write(const char *path, const abbe_caustic_volume *volume,
                                  const double to_light[3], abbe_error *error);

#endif
