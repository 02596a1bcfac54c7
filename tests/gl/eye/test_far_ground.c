/* Small things near the camera over ground that reaches far: each pixel's radiance in closed form,
 * for ground of ten to a hundred thousand sizes of what stands on it. */
#include "tests/gl/frame.h"

#include "base/maths.h"

/* In units: a card a hundredth of one above the ground, and over it a ball that mirrors a
 * hundredth. */
enum { SIDE = 64 };
static const double height = 0.01, half_card = 0.3, card_x = 0.55, radius = 0.3, share = 0.01;
static const double ball[3] = {0, 0, 0.4}, sun[3] = {0.5, 0.25, -1}, lamp[3] = {-1.2, -0.6, 2.5};
static const double reflectance[2] = {0.9, 0.3}; /* of card and ground */

typedef struct setting {
  double ground; /* its side in units */
  double unit;   /* m */
  double tilt;   /* degrees by which all is turned about x */
  bool far;      /* the light is the sun */
  double eye[3];
} setting;

static void along(const double o[3], double t, const double d[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = o[k] + t * d[k];
}

/* Where the ray meets the ball from outside; infinity where it does not. */
static double meet_ball(const double o[3], const double d[3]) {
  double from[3];
  along(o, -1, ball, from);
  const double b = abbe_vector_dot(from, d) / abbe_vector_dot(d, d);
  const double c = (abbe_vector_dot(from, from) - radius * radius) / abbe_vector_dot(d, d);
  const double t = b * b > c ? -b - sqrt(b * b - c) : -1;
  return t > 1e-9 ? t : INFINITY;
}

enum { NOTHING, CARD, GROUND };

/* The first flat thing on the ray, and where. */
static int meet_flat(const setting *s, const double o[3], const double d[3], double *t) {
  double at[3];
  *t = -o[2] / d[2];
  along(o, *t, d, at);
  if (*t > 1e-9 && fabs(at[0] - card_x) < half_card && fabs(at[1]) < half_card) return CARD;
  *t = (-height - o[2]) / d[2];
  along(o, *t, d, at);
  const bool held = fmax(fabs(at[0]), fabs(at[1])) < 0.5 * s->ground;
  if (*t > 1e-9 && held) return GROUND;
  *t = INFINITY;
  return NOTHING;
}

/* Radiance of a flat place, of 1 W/m2 or 1 W/sr; *mark tells places apart that differ. */
static double flat_light(const setting *s, int flat, const double at[3], int *mark) {
  double to[3], t;
  for (int k = 0; k < 3; k++) to[k] = s->far ? -sun[k] : lamp[k] - at[k];
  const double length2 = abbe_vector_dot(to, to), cosine = to[2] / sqrt(length2);
  const int above = meet_flat(s, at, to, &t);
  const bool dark = meet_ball(at, to) < 1 || (above != NOTHING && t < 1);
  *mark += 10 * flat + 100 * dark;
  return dark ? 0 : reflectance[flat - 1] / ABBE_PI * cosine / (s->far ? 1 : length2);
}

/* What a camera's ray shows. */
static double shown(const setting *s, const double o[3], const double d[3], int *mark) {
  double t, at[3], n[3], turned[3];
  const double to_ball = meet_ball(o, d);
  int flat = meet_flat(s, o, d, &t);
  *mark = 0;
  if (t < to_ball) {
    along(o, t, d, at);
    return flat_light(s, flat, at, mark);
  }
  if (!isfinite(to_ball)) return 0;
  along(o, to_ball, d, at);
  for (int k = 0; k < 3; k++) n[k] = (at[k] - ball[k]) / radius;
  along(d, -2 * abbe_vector_dot(d, n), n, turned);
  *mark = 1;
  flat = meet_flat(s, at, turned, &t);
  along(at, isfinite(t) ? t : 0, turned, at);
  return flat == NOTHING ? 0 : share * flat_light(s, flat, at, mark);
}

/* The pixel's ray, at a place in it; y runs downwards. */
static double pixel(const setting *s, double x, double y, int *mark) {
  static const double up[3] = {0, 0, 1}, target[3] = {0.2, 0, 0.2};
  double window[4] = {-1, 1, -1, 1}, d[3], o[3], forward[3];
  abbe_view view;
  for (int k = 0; k < 3; k++) forward[k] = target[k] - s->eye[k];
  abbe_view_look(s->eye, forward, up, false, &view);
  for (int k = 0; k < 4; k++) view.window[k] = tan(ABBE_PI / 8) * window[k];
  abbe_view_ray(&view, (double[2]){x / SIDE, 1 - y / SIDE}, o, d);
  return shown(s, o, d, mark);
}

static void turn(const setting *s, const double p[3], double by, double out[3]) {
  const double c = cos(s->tilt * ABBE_PI / 180), i = sin(s->tilt * ABBE_PI / 180);
  const double turned[3] = {p[0] * by, (c * p[1] - i * p[2]) * by, (i * p[1] + c * p[2]) * by};
  memcpy(out, turned, sizeof turned);
}

static void draw(const setting *s, abbe_image *out) {
  static const double up[3] = {0, 0, 1}, target[3] = {0.2, 0, 0.2};
  char step[3][256];
  double eye[3], to[3], above[3], light[3];
  turn(s, s->eye, s->unit, eye);
  turn(s, target, s->unit, to);
  turn(s, up, 1, above);
  turn(s, s->far ? sun : lamp, s->far ? 1 : s->unit, light);
  const double at[3][3] = {{ball[0], ball[1], ball[2]}, {card_x, 0, 0}, {0, 0, -height}};
  for (int i = 0; i < 3; i++)
    snprintf(
        step[i], sizeof step[i],
        "transform: [{translate: [%.17g, %.17g, %.17g]}, {rotate: {axis: [1, 0, 0], angle: %g}}]",
        at[i][0] * s->unit, at[i][1] * s->unit, at[i][2] * s->unit, s->tilt);
  const char *text = printed(
      "materials: glass.yaml\ncamera: {eye: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, "
      "%.17g], up: [%.17g, %.17g, %.17g], fov: 45}\n"
      "lights:\n- {name: light, kind: %s: [%.17g, %.17g, %.17g], %s: %.17g}\nobjects:\n"
      "- {name: ball, shape: sphere, radius: %.17g, mirror: %g, %s}\n"
      "- {name: card, shape: rectangle, width: %.17g, height: %.17g, reflectance: %g, %s}\n"
      "- {name: ground, shape: rectangle, width: %.17g, height: %.17g, reflectance: %g, %s}\n",
      eye[0], eye[1], eye[2], to[0], to[1], to[2], above[0], above[1], above[2],
      s->far ? "directional, direction" : "point, position", light[0], light[1], light[2],
      s->far ? "irradiance" : "intensity", s->far ? 1 : s->unit * s->unit, radius * s->unit, share,
      step[0], 2 * half_card * s->unit, 2 * half_card * s->unit, reflectance[0], step[1],
      s->ground * s->unit, s->ground * s->unit, reflectance[1], step[2]);
  abbe_render_desc desc = small_frame;
  desc.space = ABBE_RGB_SPACE_REC709;
  draw_text(text, &desc, out);
}

/* Of pixels that no edge crosses, by a pixel to each side. What the ball mirrors lands elsewhere,
 * and is a hundredth. */
static void check(const setting *s) {
  size_t seen = 0, dark = 0, mirrored = 0, wrong = 0;
  double worst = 0;
  FILLED(abbe_image, picture, draw(s, &picture));
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double x = i % SIDE + 0.5, y = i / SIDE + 0.5;
    int mark, other;
    const double exact = pixel(s, x, y, &mark);
    bool even = true;
    for (int k = 0; k < 8 && even; k++) {
      pixel(s, x + cos(k * ABBE_PI / 4), y + sin(k * ABBE_PI / 4), &other);
      even = other == mark;
    }
    if (!even) continue;
    const double drawn = (double)picture.data[(size_t)i * picture.channels + 1];
    const double most = 0.02 * exact + (mark % 10 == 1 ? 4e-4 : 4e-3) / ABBE_PI;
    seen++;
    dark += mark >= 100 && mark % 10 == 0;
    mirrored += mark % 10 == 1 && mark > 1;
    wrong += !(fabs(drawn - exact) < most);
    if (fabs(drawn - exact) > worst) worst = fabs(drawn - exact);
  }
  if (wrong > 0)
    print_error("ground of %g units of %g m, turned by %g degrees, %s, eye at %g: %zu of %zu "
                "pixels are wrong, by up to %g\n",
                s->ground, s->unit, s->tilt, s->far ? "sun" : "lamp", s->eye[1], wrong, seen,
                worst);
  assert_int_equal(wrong, 0);
  assert_true(seen > 2500 && dark > 20 && mirrored > 20);
}

GROUP(make_context, free_context);

TEST(what_is_near_stands_on_any_ground) {
  static const double ground[] = {10, 1e3, 1e5};
  for (int i = 0; i < 12; i++) {
    const setting s = {
        ground[i % 3], 1, 0, i < 6, {0, i % 6 < 3 ? -3 : -0.6, i % 6 < 3 ? 1.5 : 0.5}};
    check(&s);
  }
}

/* On ground in no plane of two axes, of parts of a millimetre and of a thousand kilometres. */
TEST(sizes_and_slopes_change_nothing) {
  static const double unit[] = {1e-4, 1, 10};
  for (int i = 0; i < 6; i++) {
    const setting s = {i < 3 ? 1e5 : 1e3, unit[i % 3], 33, i % 2 == 0, {0, -3, 1.5}};
    check(&s);
  }
}
