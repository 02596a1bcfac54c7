#include "cli/view/work/view_scene.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void abbe_view_files_free(abbe_view_files *files) {
  for (size_t i = 0; i < files->count; i++) free(files->path[i]);
  free(files->path);
  free(files->changed);
  *files = (abbe_view_files){0};
}

static long long changed_at(const char *path) {
  struct stat status;
  if (stat(path, &status) != 0) return -1;
  return (long long)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec;
}

void abbe_view_files_take(abbe_view_files *files, abbe_view_scene_news *news) {
  long long *changed = news->file != NULL ? calloc(news->file_count + 1, sizeof *changed) : NULL;
  if (changed == NULL) return;
  for (size_t i = 0; i < news->file_count; i++) {
    changed[i] = changed_at(news->file[i]);
    for (size_t k = 0; k < files->count; k++)
      if (strcmp(files->path[k], news->file[i]) == 0) changed[i] = files->changed[k];
  }
  abbe_view_files_free(files);
  *files = (abbe_view_files){news->file_count, news->file, changed};
  news->file = NULL;
  news->file_count = 0;
}

bool abbe_view_files_changed(abbe_view_files *files) {
  bool others = false;
  for (size_t i = 0; i < files->count; i++) {
    const long long at = changed_at(files->path[i]);
    if (at == files->changed[i] || at < 0) continue;
    files->changed[i] = at;
    others = true;
  }
  return others;
}
