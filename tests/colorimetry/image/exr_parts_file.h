/* exr_parts_file.h: a file of four parts of different kinds and sizes, for tests of EXR readers. */
#ifndef ABBE_TESTS_COLORIMETRY_IMAGE_EXR_PARTS_FILE_H
#define ABBE_TESTS_COLORIMETRY_IMAGE_EXR_PARTS_FILE_H

#include "tests/check.h"

#include "tests/colorimetry/image/exr_library.h"

#include <openexr.h>

enum { PARTS = 4 };
static const exr_library_file parts[PARTS] = {
    {.part = "depth", .channels = 1, .name = {"Z"}, .type = {2}, .codec = EXR_COMPRESSION_ZIPS},
    {.part = "grey", .channels = 1, .name = {"Y"}, .type = {2}, .codec = EXR_COMPRESSION_PIZ},
    {.part = "rgb left", .channels = 3, .name = {"B", "G", "R"}, .type = {1, 1, 1}, .tile = {8, 8}},
    {.part = "rgb right", .channels = 3, .name = {"B", "G", "R"}, .type = {1, 1, 1}}};

static inline void write_parts(const char *path, int count) {
  exr_library_file f[PARTS];
  char why[300];
  for (int i = 0; i < count; i++) {
    f[i] = parts[i];
    f[i].data_window[2] = 20 + i;
    f[i].data_window[3] = 30 - i;
    f[i].display_window[2] = f[i].display_window[3] = 29;
  }
  if (!exr_library_write_parts(path, f, count, why, sizeof why)) fail_msg("%s", why);
}

#endif
