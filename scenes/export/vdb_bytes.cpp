#include "scenes/export/vdb_bytes.h"

#ifdef ABBE_HAVE_OPENVDB
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cstdlib>
#include <cstring>
#include <sstream>

namespace {

openvdb::GridBase::Ptr make_grid(const abbe_vdb_desc *d, size_t i) {
  auto grid = openvdb::Vec3SGrid::create();
  auto at = grid->getAccessor();
  const float *v = d->value[i];
  const int side = static_cast<int>(d->side);
  for (int z = 0; z < side; z++)
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++, v += 3)
        if (v[0] != 0 || v[1] != 0 || v[2] != 0)
          at.setValue(openvdb::Coord(x, y, z), openvdb::Vec3s(v[0], v[1], v[2]));
  const double first = 0.5 * d->cell * (1 - static_cast<double>(side)); /* middle of cell 0 */
  auto place = openvdb::math::Transform::createLinearTransform(d->cell);
  place->postTranslate(openvdb::Vec3d(first));
  grid->setTransform(place);
  grid->setName(d->name[i]);
  grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  grid->insertMeta("abbe:volume", openvdb::StringMetadata(d->note));
  return grid;
}

} // namespace

abbe_result abbe_vdb_bytes_check(abbe_error *error) {
  (void)error;
  return ABBE_OK;
}

abbe_result abbe_vdb_bytes_make(const abbe_vdb_desc *desc, char **bytes, size_t *size,
                                abbe_error *error) {
  *bytes = nullptr;
  try {
    openvdb::initialize();
    openvdb::GridCPtrVec grids;
    for (size_t i = 0; i < desc->grids; i++) grids.push_back(make_grid(desc, i));
    std::ostringstream out(std::ios_base::binary);
    openvdb::io::Stream(out).write(grids);
    const std::string text = out.str();
    *bytes = static_cast<char *>(std::malloc(text.size() + 1));
    *size = text.size();
    if (*bytes != nullptr) std::memcpy(*bytes, text.data(), text.size());
  } catch (const std::bad_alloc &) {
    *bytes = nullptr;
  } catch (const std::exception &e) {
    return abbe_error_set(error, ABBE_IO, "OpenVDB: %.500s", e.what());
  }
  if (*bytes != nullptr) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an OpenVDB file");
}
#else
abbe_result abbe_vdb_bytes_check(abbe_error *error) {
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "this build writes no OpenVDB files; install libopenvdb-dev and build with "
                        "-DABBE_OPENVDB=ON");
}

abbe_result abbe_vdb_bytes_make(const abbe_vdb_desc *, char **bytes, size_t *, abbe_error *error) {
  *bytes = nullptr;
  return abbe_vdb_bytes_check(error);
}
#endif
