#include "tests/house/sources.h"

#include "tests/house/lists.h"

#include <dirent.h>
#include <sys/stat.h>

static const char *const rooms[] = {"base",       "spectral", "colorimetry", "scenes", "gl",
                                    "validation", "library",  "cli",         "tests"};

/* ---- paths ---- */

const char *sources_room(const char *path) {
  for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) {
    size_t length = strlen(rooms[i]);
    if (strncmp(path, rooms[i], length) == 0 && path[length] == '/') return rooms[i];
  }
  return "";
}

const char *sources_folder(const char *path, char *out) {
  const char *slash = strrchr(path, '/');
  snprintf(out, SOURCES_MAX_PATH, "%.*s", slash == NULL ? 0 : (int)(slash - path), path);
  return out;
}

const char *sources_ending(const char *path) {
  const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
  return dot != NULL && (slash == NULL || dot > slash) ? dot + 1 : "";
}

bool sources_has_word(const char *words, const char *word) {
  size_t length = strlen(word);
  if (length == 0) return false;
  for (const char *at = words; (at = strstr(at, word)) != NULL; at += length)
    if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
  return false;
}

bool sources_included_name(const char *line, char *out, size_t size) {
  char mark, name[SOURCES_MAX_PATH];
  if (sscanf(line, " # include %c%1023[^\">]", &mark, name) != 2) return false;
  if (mark != '"' && !(mark == '<' && sources_room(name)[0] != '\0')) return false;
  snprintf(out, size, "%s", name);
  return true;
}

/* ---- files ---- */

static void read_file(source_file *f, const char *full) {
  char line[4096], name[SOURCES_MAX_PATH];
  FILE *file = fopen(full, "r");
  assert_non_null(file);
  while (fgets(line, sizeof line, file) != NULL) {
    f->lines++;
    if (!sources_included_name(line, name, sizeof name)) continue;
    f->include = grown(f->include, f->include_count, sizeof *f->include);
    f->include[f->include_count++] = (source_include){copy_of(name), (int)f->lines};
  }
  fclose(file);
}

static void visit(sources *all, const char *folder) {
  char full[2 * SOURCES_MAX_PATH], path[SOURCES_MAX_PATH];
  struct stat status;
  snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", folder);
  DIR *dir = opendir(full);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
    bool made = *folder == '\0' &&
                (strcmp(entry->d_name, "build") == 0 || strcmp(entry->d_name, "out") == 0);
    if (entry->d_name[0] == '.' || made) continue;
    int n = snprintf(path, sizeof path, "%s%s%s", folder, *folder ? "/" : "", entry->d_name);
    assert_true(n > 0 && (size_t)n < sizeof path);
    snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", path);
    if (stat(full, &status) != 0) continue;
    if (S_ISDIR(status.st_mode)) {
      visit(all, path);
      continue;
    }
    all->file = grown(all->file, all->count, sizeof *all->file);
    source_file *f = &all->file[all->count++];
    *f = (source_file){.path = copy_of(path)};
    f->is_source =
        sources_has_word("c h cpp cc cxx hpp hh C glsl comp vert geom frag", sources_ending(path));
    if (f->is_source) read_file(f, full);
  }
  closedir(dir);
}

static int by_path(const void *a, const void *b) {
  return strcmp(((const source_file *)a)->path, ((const source_file *)b)->path);
}

void sources_read(sources *out) {
  *out = (sources){0};
  visit(out, "");
  qsort(out->file, out->count, sizeof *out->file, by_path);
}

void sources_free(sources *all) {
  for (size_t i = 0; i < all->count; i++) {
    for (size_t k = 0; k < all->file[i].include_count; k++) free(all->file[i].include[k].name);
    free(all->file[i].include);
    free(all->file[i].path);
  }
  free(all->file);
  *all = (sources){0};
}
