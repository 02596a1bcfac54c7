#include "scenes/cuts/cut_file.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const struct {
  const char *ending;
  abbe_result (*parse)(const char *data, size_t size, const char *name, abbe_cut *out,
                       abbe_report *report, abbe_error *error);
} kinds[] = {
    {".asc", abbe_cut_asc_parse}, {".gem", abbe_cut_gem_parse}, {".gcs", abbe_cut_gcs_parse}};

abbe_result abbe_cut_file_read(const char *path, abbe_cut *out, abbe_report *report,
                               abbe_error *error) {
  memset(out, 0, sizeof *out);
  const char *ending = strrchr(abbe_file_name(path), '.');
  for (size_t i = 0; ending && i < sizeof kinds / sizeof *kinds; i++) {
    char *data = NULL;
    size_t size;
    if (strcasecmp(ending, kinds[i].ending) != 0) continue;
    abbe_result result = abbe_file_read(path, ABBE_CUT_MAX_FILE, &data, &size, error);
    if (result == ABBE_OK && strcasecmp(ending, ".gem") == 0 && strncmp(data, "GemCad ", 7) == 0)
      result = abbe_error_set(
          error, ABBE_PARSE, "%s: it is GemCad's text, whose name ends with .asc; rename it", path);
    if (result == ABBE_OK) result = kinds[i].parse(data, size, path, out, report, error);
    free(data);
    return result;
  }
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "'%s' is no design that is known by its name: they end with .asc, .gem "
                        "(GemCad) or .gcs (Gem Cut Studio)",
                        path);
}

abbe_result abbe_cut_file_read_stone(const char *path, double weld, abbe_cut *cut,
                                     abbe_cut_polyhedron *stone, abbe_report *report,
                                     abbe_error *error) {
  abbe_error why;
  memset(stone, 0, sizeof *stone);
  ABBE_TRY(abbe_cut_file_read(path, cut, report, error));
  abbe_result result = abbe_cut_polyhedron_make(cut, weld, stone, &why);
  return result == ABBE_OK ? result : abbe_error_set(error, result, "%s: %s", path, why.text);
}
