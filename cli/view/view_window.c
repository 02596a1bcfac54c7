#include "cli/view/view_app.h"

#include "base/clock.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EVENTS = 64 };

/* An event of the pointer: it has moved there, or a button has changed there. */
typedef struct pointer_event {
  double at[2];
  int button; /* button of the input; below 0: none */
  bool down;
} pointer_event;

typedef struct window {
  GLFWwindow *handle;
  abbe_view_session session;
  abbe_ui_input input;
  pointer_event event[MOST_EVENTS]; /* [events] that no frame has seen yet */
  size_t events;
} window;

static abbe_result fail(const char *what, abbe_error *error) {
  const char *why = NULL;
  glfwGetError(&why);
  return abbe_error_set(error, ABBE_GL, "%s%s%s; without a display, --script leads the viewer",
                        what, why != NULL ? ": " : "", why != NULL ? why : "");
}

static int modifiers_of(int mods) {
  return ((mods & GLFW_MOD_SHIFT) != 0 ? ABBE_VIEW_SHIFT : 0) |
         ((mods & GLFW_MOD_CONTROL) != 0 ? ABBE_VIEW_CONTROL : 0);
}

/* By what is written on the key: in other layouts z is where y is in the first. */
static int character_of(int key, int code) {
  const char *name = glfwGetKeyName(key, code);
  if (name == NULL || name[0] == '\0' || name[1] != '\0') return 0;
  return name[0] == '=' ? '+' : tolower((unsigned char)name[0]);
}

static void on_key(GLFWwindow *handle, int key, int code, int action, int mods) {
  window *w = glfwGetWindowUserPointer(handle);
  const bool down = action != GLFW_RELEASE;
  if (key == GLFW_KEY_ENTER) w->input.enter = down;
  if (key == GLFW_KEY_BACKSPACE) w->input.backspace = down;
  if (key == GLFW_KEY_ESCAPE) w->input.escape = down;
  if (abbe_ui_has_keys()) return;
  const int character = key == GLFW_KEY_F1 ? 'h' : character_of(key, code);
  if (character != 0)
    abbe_view_app_key(&w->session, character, down, modifiers_of(mods), abbe_clock_seconds());
}

/* Which key has it, layouts tell. */
static void on_character(GLFWwindow *handle, unsigned character) {
  window *w = glfwGetWindowUserPointer(handle);
  if (character == '?' && !abbe_ui_has_keys())
    abbe_view_app_key(&w->session, '?', true, 0, abbe_clock_seconds());
}

static void on_wheel(GLFWwindow *handle, double across, double along) {
  window *w = glfwGetWindowUserPointer(handle);
  (void)across;
  w->input.wheel += along;
}

static void wake(void) {
  glfwPostEmptyEvent();
}

/* Moves without a button in between are one; there is always space for that. */
static void push(window *w, const pointer_event *e) {
  pointer_event *last = w->events > 0 ? &w->event[w->events - 1] : NULL;
  if (e->button < 0 && last != NULL && last->button < 0)
    *last = *e;
  else if (w->events + (e->button < 0) < MOST_EVENTS)
    w->event[w->events++] = *e;
}

static void on_move(GLFWwindow *handle, double x, double y) {
  push(glfwGetWindowUserPointer(handle), &(pointer_event){.at = {x, y}, .button = -1});
}

static void on_button(GLFWwindow *handle, int button, int action, int mods) {
  window *w = glfwGetWindowUserPointer(handle);
  const double *at = w->events > 0 ? w->event[w->events - 1].at : w->input.mouse;
  pointer_event e = {.at = {at[0], at[1]}, .button = button, .down = action == GLFW_PRESS};
  (void)mods;
  if (button < 3) push(w, &e); /* left, right, middle, as the input has them */
}

/* One event a frame: a click that is shorter is down for one, and a widget knows in the frame
 * before that the pointer is on it. */
static void read_pointer(window *w) {
  GLFWwindow *h = w->handle;
  if (w->events > 0) {
    const pointer_event e = w->event[0];
    memcpy(w->input.mouse, e.at, sizeof e.at);
    if (e.button >= 0) w->input.button[e.button] = e.down;
    memmove(w->event, w->event + 1, --w->events * sizeof e);
  }
  w->input.shift = glfwGetKey(h, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                   glfwGetKey(h, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
  w->input.control = glfwGetKey(h, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
                     glfwGetKey(h, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS;
}

static void loop(window *w, const abbe_gl *gl) {
  double last = abbe_clock_seconds();
  while (!glfwWindowShouldClose(w->handle)) {
    int width, height;
    const double now = abbe_clock_seconds();
    read_pointer(w);
    glfwGetFramebufferSize(w->handle, &width, &height);
    w->input.seconds = now - last;
    last = now;
    const bool seen = width > 0 && height > 0 && !glfwGetWindowAttrib(w->handle, GLFW_ICONIFIED);
    if (seen) {
      w->input.width = width;
      w->input.height = height;
      gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
      gl->Viewport(0, 0, width, height);
      abbe_view_app_frame(&w->session, &w->input, now);
      glfwSwapBuffers(w->handle);
    }
    w->input.wheel = 0;
    w->input.text[0] = '\0';
    const double wait = seen ? abbe_view_app_wait(&w->session, abbe_clock_seconds()) : 1;
    if (wait > 0 && w->events == 0)
      glfwWaitEventsTimeout(wait);
    else
      glfwPollEvents();
  }
}

abbe_result abbe_view_window_run(const abbe_view_app_desc *desc, size_t width, size_t height,
                                 abbe_error *error) {
  abbe_context *context = NULL;
  abbe_view_app_desc own = *desc;
  if (!glfwInit()) return fail("there is no display", error);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  /* as the worker's own context, for two ways to OpenGL in a process disturb each other */
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  window *w = calloc(1, sizeof *w);
  abbe_result result = w != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  if (result == ABBE_OK) w->handle = glfwCreateWindow((int)width, (int)height, "Abbe", NULL, NULL);
  if (result == ABBE_OK && w->handle == NULL) result = fail("there is no window", error);
  if (result == ABBE_OK) {
    glfwMakeContextCurrent(w->handle);
    glfwSwapInterval(0);
    const abbe_context_host host = {.lookup = (abbe_gl_lookup)glfwGetProcAddress};
    result = abbe_context_adopt(&host, &context, error);
  }
  own.wake = wake;
  if (result == ABBE_OK) result = abbe_view_app_begin(&w->session, &own, context, error);
  if (result == ABBE_OK) {
    glfwSetWindowUserPointer(w->handle, w);
    glfwSetKeyCallback(w->handle, on_key);
    glfwSetCharCallback(w->handle, on_character);
    glfwSetScrollCallback(w->handle, on_wheel);
    glfwSetCursorPosCallback(w->handle, on_move);
    glfwSetMouseButtonCallback(w->handle, on_button);
    glfwGetCursorPos(w->handle, &w->input.mouse[0], &w->input.mouse[1]);
    loop(w, abbe_context_gl(context));
    abbe_view_app_end(&w->session);
  }
  abbe_context_free(context);
  free(w);
  glfwTerminate();
  return result;
}
