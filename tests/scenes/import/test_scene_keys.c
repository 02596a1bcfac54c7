/* Every key of a scene: what is no value of it, or no key, is refused where it stands. The scenes
 * together have all keys. */
#include "tests/check.h"

#include "base/file.h"
#include "base/yaml/yaml.h"
#include "scenes/import/scene_file.h"

#include <dirent.h>

#define FUZZ ABBE_SOURCE_DIR "/tests/fuzz/"
#define NAME FUZZ "parts/scene.yaml" /* beside what the scenes name */

typedef struct walk {
  const char *text, *name;
  size_t size;
  abbe_yaml *yaml;
  size_t values, keys; /* refused so far */
} walk;

static abbe_result parse(const walk *w, const char *change, abbe_error *error) {
  const char *const set[] = {change};
  const abbe_scene_options options = {.set = set, .set_count = change != NULL};
  OWNED(abbe_scene, scene) = {0};
  return abbe_scene_parse(w->text, w->size, NAME, &options, &scene, error);
}

/* The change is refused in a sentence that has these words, and where they say so the place. */
static void refuses(const walk *w, const char *change, const char *words) {
  abbe_error error = {0};
  const abbe_result result = parse(w, change, &error);
  if (result == ABBE_OK || strstr(error.text, "scene.yaml:") == NULL ||
      strstr(error.text, words) == NULL)
    fail_msg("%s with %s: not refused by %s: %s", w->name, change, words, error.text);
}

static void visit(walk *w, abbe_yaml_node at, const char *path) {
  const bool mapping = abbe_yaml_is_mapping(w->yaml, at);
  if (mapping) {
    refuses(w, printed("%swrong=1", path), "has no key 'wrong'");
    w->keys++;
  }
  for (size_t i = 0; i < abbe_yaml_count(w->yaml, at); i++) {
    const abbe_yaml_node child =
        mapping ? abbe_yaml_value(w->yaml, at, i) : abbe_yaml_item(w->yaml, at, i);
    char inner[256];
    if (mapping)
      snprintf(inner, sizeof inner, "%s%s", path,
               abbe_yaml_text(w->yaml, abbe_yaml_key(w->yaml, at, i)));
    else
      snprintf(inner, sizeof inner, "%s%zu", path, i);
    /* what is put in the place of lines below a key stands behind the key */
    const abbe_yaml_node first = mapping ? abbe_yaml_key(w->yaml, at, i) : child;
    if (!SANITIZED || w->values % 4 == 0)
      refuses(w, printed("%s={wrong: kind}", inner),
              printed("scene.yaml:%zu:", abbe_yaml_line(w->yaml, first)));
    w->values++;
    strcat(inner, ".");
    visit(w, child, inner);
  }
}

static void visit_file(const char *folder, const char *name) {
  FREED char *text = NULL;
  walk w = {.name = name};
  OK(abbe_file_read(printed(FUZZ "%s/%s", folder, name), 1 << 16, &text, &w.size, &error));
  w.text = text;
  OK(parse(&w, NULL, &error));
  OK(abbe_yaml_parse(text, w.size, name, &w.yaml, &error));
  visit(&w, abbe_yaml_root(w.yaml), "");
  assert_true(w.values > 10 && w.keys > 3);
  abbe_yaml_free(w.yaml);
}

TEST(values_and_keys_that_are_none) {
  static const char *const folders[] = {"corpus/scene", "parts/scenes"};
  size_t files = 0;
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
    DIR *folder = opendir(printed(FUZZ "%s", folders[i]));
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;)
      if (strstr(entry->d_name, ".yaml") != NULL) {
        visit_file(folders[i], entry->d_name);
        files++;
      }
    closedir(folder);
  }
  assert_true(files > 10);
}
