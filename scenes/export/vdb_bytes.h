/* vdb_bytes.h: grids of vectors as the bytes of an OpenVDB file: a bridge to the library, where the
 * build was asked for it (ABBE_OPENVDB).
 */
#ifndef ABBE_SCENES_EXPORT_VDB_BYTES_H
#define ABBE_SCENES_EXPORT_VDB_BYTES_H

#include "base/error.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_vdb_desc {
  size_t side;               /* cells along each axis */
  double cell;               /* m */
  size_t grids;              /* grids of the same cells, about the origin */
  const char *const *name;   /* [grids] */
  const float *const *value; /* [grids] of [side][side][side][3]: z, y, x */
  const char *note;          /* kept with each */
} abbe_vdb_desc;

/* ABBE_UNSUPPORTED, with what to install, where the build has no OpenVDB. */
abbe_result abbe_vdb_bytes_check(abbe_error *error);

/* *bytes is malloc'd. Cells of three zeros are left out. Errors of
 * abbe_vdb_bytes_check, ABBE_NO_MEMORY. */
abbe_result abbe_vdb_bytes_make(const abbe_vdb_desc *desc, char **bytes, size_t *size,
                                abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
