/* learnt.h: a viewer's state with a scene that is learnt as from a job, and hands on it. */
#ifndef ABBE_TESTS_CLI_VIEW_LEARNT_H
#define ABBE_TESTS_CLI_VIEW_LEARNT_H

#include "tests/check.h"

#include "cli/view/state/view_camera.h"
#include "cli/view/state/view_state.h"
#include "scenes/import/scene_file.h"

static const char gem[] = ABBE_SOURCE_DIR "/scenes/gem.yaml";

static inline void see(abbe_view_state *s) {
  abbe_view_state_picture(s, &s->camera);
}

/* What the document's changes make of the scene, learnt as from a job. */
static inline void find(const abbe_view_state *s, abbe_view_outline *out) {
  const abbe_view_document *now = abbe_view_history_now(&s->history);
  const abbe_scene_options options = {.set = (const char *const *)now->set,
                                      .set_count = now->set_count};
  FREED char *text = NULL;
  size_t size;
  MADE(abbe_scene, scene, abbe_scene_load(now->path, &options, &scene, &error));
  OK(abbe_scene_text(now->path, &options, &text, &size, &error));
  OK(abbe_view_outline_make(&scene, text, size, out, &error));
  out->camera = scene.camera;
}

static inline void learn(abbe_view_state *s) {
  static abbe_view_outline outline;
  find(s, &outline);
  abbe_view_state_learn(s, &outline, true);
  see(s);
}

/* The gem in a picture of 512 x 512. */
static inline abbe_view_state *begun(void) {
  static abbe_view_state s;
  char path[sizeof gem];
  memset(&s, 0, sizeof s);
  strcpy(path, gem);
  const abbe_view_document document = {.path = path};
  OK(abbe_view_state_begin(&s, &document, &error));
  abbe_view_state_resize(&s, 512, 512, 0);
  learn(&s);
  return &s;
}

static inline const char *value(const abbe_view_state *s, const char *key) {
  return abbe_view_document_value(abbe_view_history_now(&s->history), key);
}

static inline void drag(abbe_view_state *s, abbe_view_button button, double x0, double y0,
                        double x1, double y1, int modifiers) {
  abbe_view_state_press(s, button, x0, y0, modifiers, 1);
  for (int i = 1; i <= 4; i++)
    abbe_view_state_move(s, x0 + i * (x1 - x0) / 4, y0 + i * (y1 - y0) / 4, 1 + 0.05 * i);
  abbe_view_state_release(s, button, 1.3);
}

/* That file in a window of 512 x 512, learnt. */
static inline void begin_with(abbe_view_state *s, char *path) {
  const abbe_view_document document = {.path = path};
  memset(s, 0, sizeof *s);
  OK(abbe_view_state_begin(s, &document, &error));
  abbe_view_state_resize(s, 512, 512, 0);
  learn(s);
}

#endif
