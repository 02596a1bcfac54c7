/* Which part of the picture a light's view may reach on a parallelogram; and the picture, in which
 * all else is drawn without light. */
#include "tests/gl/frame.h"
#include "tests/random.h"

#include "gl/plan/examine/examine.h"
#include "gl/renderer_state.h"

enum { WIDTH = 320, HEIGHT = 200, PLACES = 4000 };

static void random_place(uint64_t *random, double size, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = random_between(random, -size, size);
}

static void random_view(uint64_t *random, double distance, double tangent, abbe_view *out) {
  static const double up[3] = {0, 0, 1};
  double from[3], to[3], forward[3];
  random_place(random, distance, from);
  random_place(random, 0.3, to);
  for (int k = 0; k < 3; k++) forward[k] = to[k] - from[k];
  abbe_view_look(from, forward, up, false, out);
  for (int k = 0; k < 4; k++)
    out->window[k] = (k % 2 != 0 ? 1 : -1) * random_between(random, 0.3, 1) * tangent;
  out->near = 0.01;
  out->far = 100;
}

static bool holds(const abbe_view *view, const double p[3], double uvz[3]) {
  return abbe_view_project(view, p, uvz) && uvz[0] >= 0 && uvz[0] < 1 && uvz[1] >= 0 && uvz[1] < 1;
}

GROUP(make_context, free_context);

/* Every place that both views hold lies in the rectangle; and where the eye sees all of the lit
 * part, the rectangle is no wider than the places, but for its margin and what chance leaves out.
 */
TEST(bounds_what_is_lit) {
  uint64_t random = 5;
  int lit = 0, dark = 0;
  for (int turn = 0; turn < 300; turn++) {
    abbe_view light, eye;
    double p[9];
    int rect[4], found[4] = {WIDTH, HEIGHT, 0, 0};
    random_view(&random, 1, 0.4, &light);
    random_view(&random, 2, 0.8, &eye);
    for (int k = 0; k < 3; k++) random_place(&random, 0.5, p + 3 * k);
    const bool any = abbe_lit_window(&light, &eye, p, WIDTH, HEIGHT, rect);
    int places = 0;
    for (int i = 0; i < PLACES; i++) {
      double at[3], uvz[3];
      const double u = random_between(&random, 0, 1), v = random_between(&random, 0, 1);
      for (int k = 0; k < 3; k++) at[k] = p[k] + u * p[3 + k] + v * p[6 + k];
      if (!holds(&light, at, uvz) || !holds(&eye, at, uvz)) continue;
      const int x = (int)(uvz[0] * WIDTH), y = (int)(uvz[1] * HEIGHT);
      assert_true(any);
      assert_true(x >= rect[0] && x < rect[2] && y >= rect[1] && y < rect[3]);
      const int seen[4] = {x, y, x + 1, y + 1};
      for (int k = 0; k < 4; k++)
        if (k < 2 ? seen[k] < found[k] : seen[k] > found[k]) found[k] = seen[k];
      places++;
    }
    lit += places > 0;
    dark += !any;
    if (!any || places < PLACES / 4) continue;
    for (int k = 0; k < 4; k++) assert_true(abs(rect[k] - found[k]) < 2 + WIDTH / 4);
  }
  assert_true(lit > 100);
  assert_true(dark > 50);
}

TEST(square_on_the_axis) {
  static const double origin[3] = {0, 0, 0}, forward[3] = {1, 0, 0}, up[3] = {0, 0, 1};
  static const double square[9] = {2, -1, -1, 0, 2, 0, 0, 0, 2};
  static const double behind[9] = {-2, -1, -1, 0, 2, 0, 0, 0, 2};
  abbe_light lamp = {.kind = ABBE_LIGHT_SPOT, .direction = {1, 0, 0}, .cone_rad = atan(0.1)};
  abbe_view light, eye;
  int rect[4];
  abbe_view_look(origin, forward, up, false, &eye);
  memcpy(eye.window, (double[4]){-1, 1, -1, 1}, sizeof eye.window);
  eye.near = 0.1;
  eye.far = 10;
  assert_true(abbe_lit_window_cone(&lamp, &light));
  /* 0.1 of 1 on either side of the middle, and the rounding and two pixels more. */
  assert_true(abbe_lit_window(&light, &eye, square, 200, 100, rect));
  assert_int_in_range(rect[0], 87, 88);
  assert_int_in_range(rect[1], 42, 43);
  assert_int_in_range(rect[2], 112, 113);
  assert_int_in_range(rect[3], 57, 58);
  assert_false(abbe_lit_window(&light, &eye, behind, 200, 100, rect));
  lamp.cone_rad = 1.3;
  assert_false(abbe_lit_window_cone(&lamp, &light));
  lamp.cone_rad = 0.1;
  lamp.kind = ABBE_LIGHT_POINT;
  assert_false(abbe_lit_window_cone(&lamp, &light));
}

#define NARROW_SPOT                                                                                \
  "lights:\n- {name: lamp, kind: spot, position: [-0.4, 0.1, 0.5], target: [0, 0, 0.1],\n"         \
  "   intensity: 3, cone: 12, soft: 4, illuminant: D65}\n"
#define ROOM                                                                                       \
  "objects:\n- {name: slab, shape: box, size: [0.08, 0.08, 0.02],\n"                               \
  "   transform: [{translate: [0, 0, 0.1]}], material: crown}\n"                                   \
  "- {name: floor, shape: rectangle, width: 3, height: 3, reflectance: 0.5}\n"                     \
  "- {name: block, shape: box, size: [0.1, 0.1, 0.06], reflectance: 0.8,\n"                        \
  "   transform: [{translate: [0.2, 0.1, 0.03]}]}\n"

static void draw(const char *text, bool unlit, size_t samples, abbe_image *picture) {
  abbe_render_desc desc = small_frame;
  desc.width = 96;
  desc.supersample = samples;
  desc.aovs = true;
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  assert_true((renderer->receivers.unlit != 0) == unlit);
  draw_frame(renderer);
  *picture = aovs_of(renderer);
}

/* A second lamp that shines all around, too faint to show, has the picture drawn lit throughout. */
TEST(unlit_where_nothing_shines) {
  static const char narrow[] = CAMERA "ambient: 0.2\n" NARROW_SPOT ROOM;
  static const char wide[] =
      CAMERA "ambient: 0.2\n" NARROW_SPOT
             "- {name: faint, kind: point, position: [0.3, 0.3, 0.5], intensity: 1e-9}\n" ROOM;
  for (size_t samples = 1; samples <= 2; samples++) {
    FILLED(abbe_image, parts, draw(narrow, true, samples, &parts));
    FILLED(abbe_image, whole, draw(wide, false, samples, &whole));
    for (size_t c = 0; c < parts.channels; c++) {
      const double most = image_max(&whole, c);
      assert_true(most > 0);
      for (size_t i = 0; i < parts.width * parts.height; i++) {
        const size_t at = i * parts.channels + c;
        assert_near((double)parts.data[at], (double)whole.data[at], 1e-5 * most);
      }
    }
  }
}
