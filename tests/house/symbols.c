#include "tests/house/symbols.h"

#include "tests/check.h"
#include "tests/house/sources.h"

#include <unistd.h>

bool symbols_source(const char *object, char *out, size_t size) {
  static const char build[] = "/CMakeFiles/", target[] = ".dir/";
  const char *middle = strstr(object, build), *inside = middle ? strstr(middle, target) : NULL;
  size_t length = strlen(object);
  if (inside == NULL || length < 2 || strcmp(object + length - 2, ".o") != 0) return false;
  const char *room = middle; /* back to the slash before the room's name */
  while (room > object && room[-1] != '/') room--;
  inside += strlen(target);
  if (strncmp(inside, "./", 2) == 0) inside += 2;
  int n = snprintf(out, size, "%.*s/%.*s", (int)(middle - room), room,
                   (int)(object + length - 2 - inside), inside);
  return n > 0 && (size_t)n < size && sources_room(out)[0] != '\0';
}

/* Upper case is for others to see; v and w are weak, and C++'s names its own. */
bool symbols_line(const char *line, symbol *out) {
  char object[SOURCES_MAX_PATH], name[512], kind;
  if (sscanf(line, "%1023[^:]: %511s %c", object, name, &kind) != 3) return false;
  bool defined = strchr("TDBRC", kind) != NULL;
  char source[SOURCES_MAX_PATH];
  if (!(defined || kind == 'U') || strncmp(name, "_Z", 2) == 0 ||
      !symbols_source(object, source, sizeof source))
    return false;
  *out = (symbol){strdup(source), strdup(name), defined};
  assert_true(out->source != NULL && out->name != NULL);
  return true;
}

/* What the build itself writes (embedded files) is no room of the house. */
static bool is_written_by_people(const symbol *s) {
  char full[2 * SOURCES_MAX_PATH];
  snprintf(full, sizeof full, ABBE_SOURCE_DIR "/%s", s->source);
  return access(full, R_OK) == 0;
}

void symbols_read(const char *nm, const char *list, symbols *out) {
  char command[3 * SOURCES_MAX_PATH], line[2048];
  *out = (symbols){0};
  snprintf(command, sizeof command, "xargs '%s' -A -P < '%s'", nm, list);
  FILE *pipe = popen(command, "r");
  assert_non_null(pipe);
  size_t capacity = 0;
  while (fgets(line, sizeof line, pipe) != NULL) {
    if (out->count == capacity) {
      capacity = capacity == 0 ? 4096 : 2 * capacity;
      symbol *larger = realloc(out->symbol, capacity * sizeof *larger);
      assert_non_null(larger);
      out->symbol = larger;
    }
    symbol *next = &out->symbol[out->count];
    if (!symbols_line(line, next)) continue;
    if (is_written_by_people(next))
      out->count++;
    else
      free(next->source), free(next->name);
  }
  assert_int_equal(pclose(pipe), 0);
}

void symbols_free(symbols *all) {
  for (size_t i = 0; i < all->count; i++) {
    free(all->symbol[i].source);
    free(all->symbol[i].name);
  }
  free(all->symbol);
  *all = (symbols){0};
}

static int by_name(const void *a, const void *b) {
  return strcmp((*(const symbol *const *)a)->name, (*(const symbol *const *)b)->name);
}

void symbols_edges(const symbols *all,
                   void (*edge)(void *user, const char *from, const char *to, const char *name),
                   void *user) {
  const symbol **sorted = malloc((all->count + 1) * sizeof *sorted);
  assert_non_null(sorted);
  for (size_t i = 0; i < all->count; i++) sorted[i] = &all->symbol[i];
  qsort(sorted, all->count, sizeof *sorted, by_name);
  for (size_t i = 0, end; i < all->count; i = end) {
    for (end = i; end < all->count && by_name(&sorted[i], &sorted[end]) == 0;) end++;
    for (size_t d = i; d < end; d++)
      for (size_t u = i; u < end && sorted[d]->defined; u++)
        if (!sorted[u]->defined) edge(user, sorted[u]->source, sorted[d]->source, sorted[d]->name);
  }
  free(sorted);
}
