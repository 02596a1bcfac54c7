/* exr_parts.h: what reading and writing OpenEXR files share. Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_IMAGE_EXR_PARTS_H
#define ABBE_COLORIMETRY_IMAGE_EXR_PARTS_H

/* The texts that are the file's own: whether it is in scan lines or tiles, and what a stored 1
 * stands for. */
#define ABBE_EXR_STORAGE_NAME "type"
#define ABBE_EXR_UNIT_NAME "abbe:stored_unit"

#endif
