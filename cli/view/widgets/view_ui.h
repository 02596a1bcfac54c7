/* view_ui.h: panels, widgets and lines on a picture, by Dear ImGui in the current OpenGL context.
 *
 * The implementation is the C++ bridge view_ui.cpp; no exception leaves it, and it decides nothing.
 * Pixels run from the upper left corner. Whoever makes a window or a framebuffer hands events in.
 * Texts are UTF-8. Every widget is known by its label, so that scripts find it. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_WIDGETS_VIEW_UI_H
#define ABBE_CLI_VIEW_WIDGETS_VIEW_UI_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_ui_input {
  double width, height; /* pixels of the whole window */
  double seconds;       /* since the frame before */
  double mouse[2];
  bool button[3]; /* left, right, middle */
  double wheel;   /* clicks since the frame before */
  bool shift, control;
  char text[32]; /* typed since the frame before */
  bool enter, backspace, escape;
} abbe_ui_input;

/* 0xRRGGBB; the upper byte is transparency, 0: none. */
typedef unsigned abbe_ui_colour;

/* ABBE_GL where the context does not do. */
abbe_result abbe_ui_make(abbe_error *error);
void abbe_ui_free(void);
void abbe_ui_begin(const abbe_ui_input *input);
/* Draws into framebuffer 0 or what is bound. */
void abbe_ui_end(void);
/* Whether the pointer is a widget's, not the picture's. */
bool abbe_ui_has_pointer(void);
bool abbe_ui_has_keys(void);

/* Its background is what is there. */
void abbe_ui_panel_begin(const char *name, double x, double y, double width, double height);
void abbe_ui_panel_end(void);
/* Whether the section is open; it is at first if `open`. */
bool abbe_ui_section(const char *label, bool open);
void abbe_ui_text(abbe_ui_colour colour, const char *text);
/* A name at the left and its value at a fixed place, or behind a long name. */
void abbe_ui_pair(const char *name, const char *value);
/* Widgets of one label are separated by the scope that they are in. */
void abbe_ui_scope_begin(const char *id);
void abbe_ui_scope_end(void);
void abbe_ui_gap(void);
void abbe_ui_beside(void);
bool abbe_ui_button(const char *label);
/* Changes *value; *began (may be NULL): the hand has just taken hold of it. */
bool abbe_ui_slider(const char *label, double *value, double min, double max, const char *format,
                    bool logarithmic, bool *began);
/* Whether the pointer is over the widget that was drawn last; the text stands beside it then. */
bool abbe_ui_tip(const char *text);
/* colours[count] (may be NULL) are shown beside the names. A name of NULL parts those before it
 * from those behind it. */
bool abbe_ui_choose(const char *label, const char *const *names, const abbe_ui_colour *colours,
                    size_t count, size_t *index);

/* An empty place of the panel for a drawing; false where it is out of view. */
bool abbe_ui_place(const char *label, double width, double height, double *x, double *y);
/* Lines and texts go no farther than this to the right and down until the panel begins. */
void abbe_ui_clip(double width, double height);
/* Lines and texts: over the panel that is open, else under all panels. */
void abbe_ui_line(double x0, double y0, double x1, double y1, abbe_ui_colour colour, double width);
void abbe_ui_circle(double x, double y, double radius, abbe_ui_colour colour, double width);
void abbe_ui_box(double x0, double y0, double x1, double y1, abbe_ui_colour colour);
void abbe_ui_label(double x, double y, abbe_ui_colour colour, const char *text);
double abbe_ui_panel_width(void);

/* Where the widget of that label was drawn last; false where it was not or is out of view. */
bool abbe_ui_find(const char *label, double *x, double *y, double *width, double *height);
/* The widget of that label scrolls itself into view, when it is drawn next. */
void abbe_ui_seek(const char *label);

#ifdef __cplusplus
}
#endif
#endif
