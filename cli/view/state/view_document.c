#include "cli/view/state/view_document.h"

#include "base/number.h"

#include <stdlib.h>
#include <string.h>

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a change of the scene");
}

void abbe_view_document_free(abbe_view_document *document) {
  for (size_t i = 0; i < document->set_count; i++) free(document->set[i]);
  free(document->path);
  *document = (abbe_view_document){0};
}

abbe_result abbe_view_document_copy(const abbe_view_document *document, abbe_view_document *out,
                                    abbe_error *error) {
  abbe_view_document copy = *document;
  copy.set_count = 0;
  copy.path = document->path != NULL ? strdup(document->path) : NULL;
  bool whole = copy.path != NULL || document->path == NULL;
  for (size_t i = 0; i < document->set_count && whole; i++) {
    copy.set[i] = strdup(document->set[i]);
    whole = copy.set[i] != NULL;
    if (whole) copy.set_count++;
  }
  *out = (abbe_view_document){0};
  if (whole)
    *out = copy;
  else
    abbe_view_document_free(&copy);
  return whole ? ABBE_OK : no_memory(error);
}

abbe_result abbe_view_document_open(abbe_view_document *document, const char *path,
                                    abbe_error *error) {
  char *own = strdup(path);
  if (own == NULL) return no_memory(error);
  abbe_view_document_free(document);
  document->path = own;
  return ABBE_OK;
}

/* Whether the change is of that key. */
static bool is_of(const char *set, const char *key) {
  const size_t length = strlen(key);
  return strncmp(set, key, length) == 0 && set[length] == '=';
}

abbe_result abbe_view_document_set(abbe_view_document *document, const char *key, const char *value,
                                   abbe_error *error) {
  size_t at = 0;
  while (at < document->set_count && !is_of(document->set[at], key)) at++;
  if (at == ABBE_VIEW_MOST_CHANGES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a scene takes %d changes; save it and go on from the new file",
                          ABBE_VIEW_MOST_CHANGES);
  const size_t size = strlen(key) + strlen(value) + 2;
  char *text = malloc(size);
  if (text == NULL) return no_memory(error);
  snprintf(text, size, "%s=%s", key, value);
  if (at < document->set_count) {
    free(document->set[at]);
    document->set_count--;
    memmove(&document->set[at], &document->set[at + 1],
            (document->set_count - at) * sizeof *document->set);
  }
  document->set[document->set_count++] = text;
  return ABBE_OK;
}

const char *abbe_view_document_value(const abbe_view_document *document, const char *key) {
  for (size_t i = 0; i < document->set_count; i++)
    if (is_of(document->set[i], key)) return document->set[i] + strlen(key) + 1;
  return NULL;
}

void abbe_view_document_point(double point[3], char *out, size_t size) {
  abbe_number_format(out, size, "[%.6g, %.6g, %.6g]", point[0], point[1], point[2]);
  for (int k = 0; k < 3; k++) {
    char text[ABBE_NUMBER_TEXT_SIZE];
    const char *end;
    abbe_number_format(text, sizeof text, "%.6g", point[k]);
    abbe_number_read(text, &end, &point[k]);
  }
}

bool abbe_view_document_read(const char *text, double out[3]) {
  double v[3];
  for (int k = 0; k < 3; k++) {
    if (text == NULL || (*text != '[' && *text != ',')) return false;
    if (!abbe_number_read(text + 1, &text, &v[k])) return false;
  }
  memcpy(out, v, sizeof v);
  return true;
}

static bool is_camera(const char *set) {
  return strncmp(set, "camera.", 7) == 0;
}

static bool is_light_or_camera(const char *set) {
  return is_camera(set) || strncmp(set, "lights.", 7) == 0 || is_of(set, "ambient") ||
         is_of(set, "background");
}

/* Whether all changes of one, but for those of a kind, stand in the other in the same order. */
static bool same_but(bool (*is_of_kind)(const char *set), const abbe_view_document *a,
                     const abbe_view_document *b) {
  size_t i = 0, k = 0;
  for (;;) {
    while (i < a->set_count && is_of_kind(a->set[i])) i++;
    while (k < b->set_count && is_of_kind(b->set[k])) k++;
    if (i == a->set_count || k == b->set_count) return i == a->set_count && k == b->set_count;
    if (strcmp(a->set[i++], b->set[k++]) != 0) return false;
  }
}

abbe_view_difference abbe_view_document_compare(const abbe_view_document *a,
                                                const abbe_view_document *b) {
  const bool paths = a->path != NULL && b->path != NULL && strcmp(a->path, b->path) == 0;
  if (!paths || !same_but(is_light_or_camera, a, b)) return ABBE_VIEW_CHANGED;
  if (!same_but(is_camera, a, b)) return ABBE_VIEW_LIGHTS;
  if (a->wavelengths != b->wavelengths || a->photons != b->photons || a->map_size != b->map_size)
    return ABBE_VIEW_SETTINGS;
  if (a->set_count != b->set_count) return ABBE_VIEW_CAMERA;
  for (size_t i = 0; i < a->set_count; i++) {
    bool there = false;
    for (size_t k = 0; k < b->set_count && !there; k++) there = strcmp(a->set[i], b->set[k]) == 0;
    if (!there) return ABBE_VIEW_CAMERA;
  }
  return ABBE_VIEW_SAME;
}

/* ---- history ---- */

static void drop(abbe_view_history *history, size_t first, size_t count) {
  for (size_t i = first; i < first + count; i++) abbe_view_document_free(&history->entry[i]);
  memmove(&history->entry[first], &history->entry[first + count],
          (history->count - first - count) * sizeof *history->entry);
  history->count -= count;
}

void abbe_view_history_free(abbe_view_history *history) {
  drop(history, 0, history->count);
  history->at = 0;
}

abbe_result abbe_view_history_begin(abbe_view_history *history, const abbe_view_document *document,
                                    abbe_error *error) {
  abbe_view_document first;
  ABBE_TRY(abbe_view_document_copy(document, &first, error));
  abbe_view_history_free(history);
  history->entry[0] = first;
  history->count = 1;
  return ABBE_OK;
}

const abbe_view_document *abbe_view_history_now(const abbe_view_history *history) {
  return &history->entry[history->at];
}

abbe_result abbe_view_history_edit(abbe_view_history *history, bool continued,
                                   abbe_view_document **out, abbe_error *error) {
  abbe_view_document next;
  *out = &history->entry[history->at];
  if (continued && history->at + 1 == history->count && history->at > 0) return ABBE_OK;
  ABBE_TRY(abbe_view_document_copy(&history->entry[history->at], &next, error));
  drop(history, history->at + 1, history->count - history->at - 1);
  if (history->count == ABBE_VIEW_MOST_STEPS) drop(history, 0, 1);
  history->entry[history->count] = next;
  history->at = history->count++;
  *out = &history->entry[history->at];
  return ABBE_OK;
}

bool abbe_view_history_undo(abbe_view_history *history) {
  if (history->at == 0) return false;
  history->at--;
  return true;
}

bool abbe_view_history_redo(abbe_view_history *history) {
  if (history->at + 1 >= history->count) return false;
  history->at++;
  return true;
}
