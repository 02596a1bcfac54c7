#include "cli/gem/gem.h"

#include "base/file.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_solid.h"

#include <string.h>
#include <strings.h>

static bool ends_with(const char *path, const char *ending) {
  const size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

abbe_result abbe_gem_output_write(const char *path, const abbe_cut *cut,
                                  const abbe_cut_polyhedron *stone, double scale,
                                  const abbe_material *material, abbe_report *report,
                                  abbe_error *error) {
  const abbe_cut_solid_format solid = abbe_cut_solid_format_of(path);
  const bool asc = ends_with(path, ".asc"), gem = ends_with(path, ".gem");
  const bool gcs = ends_with(path, ".gcs");
  abbe_file_writer writer;
  if (!asc && !gem && !gcs && solid == ABBE_CUT_SOLID_COUNT)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "'%s': a design is written as .asc, .gem or .gcs, its solid as .stl, .obj or "
        ".glb",
        path);
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  result = asc   ? abbe_cut_asc_write(cut, writer.stream, report, error)
           : gem ? abbe_cut_gem_write(cut, stone, writer.stream, report, error)
           : gcs ? abbe_cut_gcs_write(cut, stone, writer.stream, report, error)
                 : abbe_cut_solid_write(cut, stone, scale, material, solid, writer.stream, error);
  return abbe_file_writer_end(&writer, result, error);
}
