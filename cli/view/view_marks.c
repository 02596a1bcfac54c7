#include "cli/view/view_app.h"

#include "cli/view/state/view_camera.h"

#include <math.h>

static bool show_line(const abbe_view_state *s, const double a[3], const double b[3],
                      abbe_ui_colour colour, double wide) {
  double p[2], q[2];
  if (!abbe_view_camera_project(&s->pictured, s->width, s->height, a, p) ||
      !abbe_view_camera_project(&s->pictured, s->width, s->height, b, q))
    return false;
  abbe_ui_line(p[0], p[1], q[0], q[1], colour, wide);
  return true;
}

/* The facets through which the pixel's light has come in, the cells of these, and the straight ends
 * of some paths: from the light, and from where they entered to the pixel. */
static void draw_feed(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  const abbe_view_feed *feed = abbe_view_session_feed(app);
  if (feed == NULL) return;
  const size_t every = feed->ray_count / 12 + 1;
  for (size_t i = 0; i + 1 < feed->sight.count; i++)
    show_line(s, feed->sight.place[i], feed->sight.place[i + 1], 0x30e0a0ff, 1.5);
  for (size_t i = 0; i < feed->ray_count; i += every) {
    show_line(s, feed->ray[i].light, feed->ray[i].entry, 0xa0ffe9b0, 1);
    show_line(s, feed->ray[i].entry, feed->point, 0xc0ffffff, 1);
  }
  for (size_t i = 0; i < feed->edge_count; i++)
    show_line(s, feed->edge[i][0], feed->edge[i][1], 0x307fe3b0, 1.5);
  for (size_t i = 0; i < feed->ray_count; i++) {
    double p[2];
    if (abbe_view_camera_project(&s->pictured, s->width, s->height, feed->ray[i].entry, p))
      abbe_ui_box(p[0] - 1, p[1] - 1, p[0] + 1, p[1] + 1, 0x20ffe08a);
  }
}

void abbe_view_marks_draw(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  abbe_view_handle handle;
  abbe_ui_clip(app->area[0], app->area[1]);
  for (size_t i = 0; abbe_view_state_handle(s, i, &handle); i++) {
    const bool light = handle.kind == ABBE_VIEW_LIGHT_HANDLE;
    const bool near = hypot(handle.xy[0] - app->input.mouse[0],
                            handle.xy[1] - app->input.mouse[1]) < ABBE_VIEW_HANDLE_PIXELS;
    const abbe_ui_colour colour = light ? 0x30ffd98a : 0x509fc4ff;
    abbe_ui_circle(handle.xy[0], handle.xy[1], near ? 8 : 6, colour, near ? 2.5 : 1.5);
    if (near)
      abbe_ui_label(handle.xy[0] + 13, handle.xy[1] - 8, colour,
                    light ? s->outline.light[handle.index].name
                          : s->outline.object[handle.index].name);
  }
  if (!s->picked) return;
  draw_feed(app);
  const double x = (double)s->pixel[0] + 0.5, y = (double)s->pixel[1] + 0.5;
  abbe_ui_circle(x, y, 5, 0x00ffffff, 1.5);
  abbe_ui_circle(x, y, 6.5, 0x40000000, 1);
}
