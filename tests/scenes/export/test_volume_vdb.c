/* A caustic volume as an OpenVDB file, where the build has the library; a sentence where it has
 * not; what is no grid is refused by both. */
#include "tests/scenes/volume/volumes.h"

#include "base/file.h"
#include "scenes/export/volume_vdb.h"

#include <unistd.h>

static const char path[] = "volume-vdb-test.vdb";
static const double above[3] = {0, 0, 1};

TEST(grids) {
  const abbe_region_desc grid = {.kind = ABBE_REGION_GRID, .side = 6, .outer = 0.3};
  OWNED(abbe_caustic_volume, v);
  abbe_error why = {0};
  make_volume(ABBE_VOLUME_VECTOR, grid, 12, false, &v);
  const abbe_result result = abbe_volume_vdb_write(path, &v, above, &why);
  if (result == ABBE_UNSUPPORTED) {
    assert_contains(why.text, "libopenvdb-dev");
    assert_int_not_equal(access(path, F_OK), 0);
  } else { /* " BDV", the format's magic number */
    char *bytes;
    size_t size;
    assert_int_equal(result, ABBE_OK);
    OK(abbe_file_read(path, 1 << 20, &bytes, &size, &error));
    assert_true(size > 6 * 6 * 6 * 36);
    assert_memory_equal(bytes, " BDV", 4);
    free(bytes);
    unlink(path);
  }
}

TEST(others_are_refused) {
  const abbe_region_desc shells = {
      .kind = ABBE_REGION_GEODESIC, .levels = 1, .shells = 5, .inner = 0.1, .outer = 0.7};
  OWNED(abbe_caustic_volume, v);
  make_volume(ABBE_VOLUME_VECTOR, shells, 1, false, &v);
  REFUSED(ABBE_INVALID_ARGUMENT, "--grid N", abbe_volume_vdb_write(path, &v, above, &error));
}
