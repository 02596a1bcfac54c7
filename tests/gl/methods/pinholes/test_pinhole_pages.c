/* Pinholes for soft light: nothing changes where light is alike all around and nothing is absorbed;
 * what a mirror absorbs and hides is what its shape tells; and what the pages hold agrees with
 * them. */
#include "tests/gl/frame.h"

#include "gl/methods/pinholes/pinhole_samples.h"
#include "validation/lab/known/forms/closed_form.h"

#include "base/maths.h"

#define DOWN                                                                                       \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 28.0724869}\n"
#define SOFT "environment: {uniform: 0.5, size: 256}\n"
#define WHITE_FLOOR                                                                                \
  "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1}\n"
#define WALL(share)                                                                                \
  "- {name: wall, shape: rectangle, width: 0.3, height: 0.5, mirror: " share                       \
  ", transform: [{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.3, 0, 0.15]}]}\n"
#define ROOF                                                                                       \
  "- {name: roof, shape: rectangle, width: 0.5, height: 0.5, mirror: 0.9, transform: "             \
  "[{translate: [0, 0, 0.3]}]}\n"
#define ROUGH_WALL                                                                                 \
  "- {name: wall, shape: rectangle, width: 0.3, height: 0.5, mirror: 0.9, roughness: 0.3"          \
  ", transform: [{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.3, 0, 0.15]}]}\n"
#define MIRROR_BALL(share)                                                                         \
  "- {name: mirror ball, shape: sphere, radius: 0.08, levels: 4, mirror: " share                   \
  ", transform: [{translate: [-0.2, 0.1, 0.1]}]}\n"

enum { SIDE = 48 };

static abbe_render_desc request(abbe_transport transport, size_t pinholes) {
  return (abbe_render_desc){.width = SIDE,
                            .height = SIDE,
                            .supersample = 1,
                            .adaptive = 1,
                            .map_size = 256,
                            .photons = 64,
                            .wavelengths = 1,
                            .transport = transport,
                            .pinholes = pinholes,
                            .space = ABBE_RGB_SPACE_REC709};
}

static void draw_by(const char *text, const abbe_render_desc *desc, abbe_image *out) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, desc);
  *out = picture_of(renderer);
  assert_finite(out);
}

static void draw(const char *text, abbe_transport transport, size_t pinholes, abbe_image *out) {
  const abbe_render_desc desc = request(transport, pinholes);
  draw_by(text, &desc, out);
}

static double at(const abbe_image *p, size_t x, size_t y) {
  return ABBE_PI * (double)p->data[(y * p->width + x) * p->channels + 1];
}

static void place_of(size_t x, size_t y, double p[3]) {
  p[0] = ((double)x + 0.5) / SIDE - 0.5;
  p[1] = 0.5 - ((double)y + 0.5) / SIDE;
  p[2] = 0;
}

GROUP(make_context, free_context);

/* Clear glass and whole mirrors in a room of even light are not there, however few the pinholes;
 * the floor is lit from above alone, so nothing that looks down to it may be. */
TEST(furnace) {
  static const char text[] = DOWN SOFT WHITE_FLOOR WALL("1");
  FILLED(abbe_image, with, draw(text, ABBE_TRANSPORT_PINHOLE, 50, &with));
  FILLED(abbe_image, without, draw(text, ABBE_TRANSPORT_PHOTONS, 0, &without));
  for (size_t i = 0; i < SIDE * SIDE * 3; i++)
    assert_near((double)with.data[i], (double)without.data[i], 2e-5);
}

/* Largest difference to `share` of what the polygon sends, of even light, over all open light. */
static double worst_of(const abbe_image *picture, const double (*corner)[3], double share,
                       size_t columns) {
  double worst = 0;
  for (size_t y = 0; y < SIDE; y++)
    for (size_t x = 0; x < columns; x++) {
      double p[3];
      place_of(x, y, p);
      static const double up[3] = {0, 0, 1};
      const double right =
          0.5 * (ABBE_PI - share * ABBE_PI * abbe_closed_form_polygon(corner, 4, p, up));
      worst = fmax(worst, fabs(at(picture, x, y) / right - 1));
    }
  return worst;
}

/* A mirror on the floor takes what it absorbs. */
TEST(a_mirror_absorbs) {
  const double corner[4][3] = {
      {0.3, -0.25, 0}, {0.3, 0.25, 0}, {0.3, 0.25, 0.3}, {0.3, -0.25, 0.3}};
  abbe_render_desc desc = request(ABBE_TRANSPORT_PINHOLE, 1024);
  FILLED(abbe_image, picture, draw_by(DOWN SOFT WHITE_FLOOR WALL("0.25"), &desc, &picture));
  const double worst = worst_of(&picture, corner, 0.75, 37); /* up to 2 cm before it */
  print_message("off by %.4f at most\n", worst);
  assert_true(worst < 0.02);
}

/* Each shift of the photons' grid has samples of its own, whose errors even out: means of four
 * frames differ by half as much as frames do. */
TEST(frames_have_other_samples) {
  enum { FRAMES = 8, STEP = 6 };
  static double at_place[FRAMES][SIDE][SIDE];
  double one = 0, four = 0, all = 0;
  for (int i = 0; i < FRAMES; i++) {
    abbe_render_desc desc = request(ABBE_TRANSPORT_PINHOLE, 16);
    desc.photon_shift[0] = (i + 0.5) / FRAMES - 0.5;
    FILLED(abbe_image, picture, draw_by(DOWN SOFT WHITE_FLOOR WALL("0"), &desc, &picture));
    for (size_t y = 0; y < SIDE; y += STEP)
      for (size_t x = 0; x < 34; x += STEP) at_place[i][y][x] = at(&picture, x, y);
  }
  for (size_t y = 0; y < SIDE; y += STEP)
    for (size_t x = 0; x < 34; x += STEP) {
      double apart = 0;
      for (int i = 0; i < FRAMES; i++) {
        const double here = at_place[i][y][x];
        apart += (i % 2 == 0 ? here : -here) / (FRAMES / 2);
        one += pow(here - at_place[(i + 1) % FRAMES][y][x], 2) / FRAMES;
        all += here * here / FRAMES;
      }
      four += apart * apart;
    }
  print_message("frames differ by %.4f, means of four by %.3f of that\n", sqrt(one / all),
                sqrt(four / one));
  assert_true(one > 1e-6 * all && four < 0.5 * one);
}

#define LAMP "lights:\n- {name: lamp, kind: point, position: [-0.3, 0, 0.5], intensity: 0.1}\n"

/* Pages of smooth mirrors know no lamps: they stay while one moves, and the picture is that of a
 * renderer made anew. Rough ones show lamps. */
TEST(pages_stay_while_a_lamp_moves) {
  static const char *const walls[] = {DOWN SOFT LAMP WHITE_FLOOR WALL("0.5"),
                                      DOWN SOFT LAMP WHITE_FLOOR ROUGH_WALL};
  for (int rough = 0; rough < 2; rough++) {
    OWNED(abbe_image, kept);
    OWNED(abbe_image, anew);
    const abbe_render_desc desc = request(ABBE_TRANSPORT_PINHOLE, 8);
    OWNED(abbe_scene, scene) = scene_of(walls[rough]);
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    scene.light[0].position[1] += 0.1;
    OK(abbe_renderer_change(renderer, &scene, &desc, &error));
    const abbe_statistics s = draw_frame(renderer);
    assert_true(abbe_statistics_ran(&s, ABBE_PASS_PHOTONS));
    assert_int_equal(s.kept[ABBE_PASS_PINHOLES], !rough);
    kept = picture_of(renderer);
    draw(walls[rough], ABBE_TRANSPORT_PINHOLE, 8, &anew); /* the lamp where it was */
    assert_true(memcmp(kept.data, anew.data, SIDE * SIDE * 3 * sizeof *kept.data) != 0);
    abbe_image_free(&anew);
    HELD(abbe_renderer, other) = drawn_renderer(&scene, &desc);
    anew = picture_of(other);
    assert_same_pixels(&kept, &anew);
    abbe_renderer_redraw(renderer);
    const abbe_statistics again = draw_frame(renderer);
    assert_true(abbe_statistics_ran(&again, ABBE_PASS_PINHOLES));
  }
}

/* With a history what stands still shows the same samples in each frame; without, others. */
TEST(a_history_keeps_samples) {
  abbe_render_desc a = request(ABBE_TRANSPORT_PINHOLE, 16), b = a;
  b.photon_shift[0] = 0.25;
  assert_true(abbe_pinhole_samples_seed(&a) != abbe_pinhole_samples_seed(&b));
  a.history = b.history = 4;
  assert_true(abbe_pinhole_samples_seed(&a) == abbe_pinhole_samples_seed(&b));
}

/* One that lies above shows the floor, which is dark: it hides all that it covers. */
TEST(a_roof_hides) {
  const double corner[4][3] = {
      {-0.25, -0.25, 0.3}, {0.25, -0.25, 0.3}, {0.25, 0.25, 0.3}, {-0.25, 0.25, 0.3}};
  OWNED(abbe_image, picture);
  draw(DOWN SOFT WHITE_FLOOR ROOF, ABBE_TRANSPORT_PINHOLE, 1024, &picture);
  const double worst = worst_of(&picture, corner, 1, 8); /* beside the roof, as seen from above */
  print_message("off by %.4f at most\n", worst);
  assert_true(worst < 0.02);
}

/* Samples in clusters, and texels between others, are off by less than what one cluster may send,
 * from all samples at all texels; and these are as near to what the shape tells. */
TEST(clusters) {
  const double corner[4][3] = {
      {0.3, -0.25, 0}, {0.3, 0.25, 0}, {0.3, 0.25, 0.3}, {0.3, -0.25, 0.3}};
  static const size_t clusters[] = {ABBE_RENDER_MAX_CLUSTERS, 200, 0};
  abbe_image picture[3];
  double worst[3] = {0};
  for (int k = 0; k < 3; k++) {
    abbe_render_desc desc = request(ABBE_TRANSPORT_PINHOLE, 256);
    desc.clusters = clusters[k];
    draw_by(DOWN SOFT WHITE_FLOOR WALL("0.25"), &desc, &picture[k]);
    for (size_t y = 0; y < SIDE; y++)
      for (size_t x = 0; x < 37; x++) {
        const double off = at(&picture[k], x, y) - at(&picture[0], x, y);
        worst[k] = fmax(worst[k], fabs(off) / (0.5 * ABBE_PI));
      }
    print_message("%zu: off by %.5f of all samples, by %.5f of the shape's\n", clusters[k],
                  worst[k], worst_of(&picture[k], corner, 0.75, 37));
  }
  assert_true(worst[1] < 1.0 / 200 && worst[2] < 1.0 / ABBE_PLAN_CLUSTERS);
  assert_true(worst[2] > 0); /* they are there */
  assert_true(worst_of(&picture[0], corner, 0.75, 37) < 0.02);
  for (int k = 0; k < 3; k++) abbe_image_free(&picture[k]);
}

/* A floor of triangles has the light of a rectangle. */
TEST(a_floor_of_triangles) {
  static const char disk[] = "objects:\n- {name: floor, shape: lathe, around: 64, profile: [[0, "
                             "0], [2, 0]], reflectance: 1}\n";
  OWNED(abbe_image, rectangle);
  FILLED(abbe_image, mesh,
         draw(printed(DOWN SOFT "%s" WALL("0.25"), disk), ABBE_TRANSPORT_PINHOLE, 200, &mesh));
  draw(DOWN SOFT WHITE_FLOOR WALL("0.25"), ABBE_TRANSPORT_PINHOLE, 200, &rectangle);
  double worst = 0, most = 0;
  for (size_t y = 0; y < SIDE; y++)
    for (size_t x = 0; x < 37; x++) {
      worst = fmax(worst, fabs(at(&mesh, x, y) - at(&rectangle, x, y)));
      most = fmax(most, 0.5 * ABBE_PI - at(&mesh, x, y));
    }
  print_message("off by %.5f where the wall takes up to %.3f\n", worst, most);
  assert_true(most > 0.3);
  assert_true(worst < 2e-3);
}

/* A ball beside a black square, in even light: what each place sees of the square is missing. */
TEST(a_ball_is_lit) {
  static const char text[] =
      DOWN SOFT "objects:\n- {name: globe, shape: sphere, radius: 0.3, levels: 5, reflectance: 1}\n"
                "- {name: wall, shape: rectangle, width: 0.5, height: 0.5, mirror: 0, transform: "
                "[{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.45, 0, 0.35]}]}\n";
  static const double corner[4][3] = {
      {0.45, -0.25, 0.1}, {0.45, 0.25, 0.1}, {0.45, 0.25, 0.6}, {0.45, -0.25, 0.6}};
  abbe_render_desc desc = request(ABBE_TRANSPORT_PINHOLE, 400);
  desc.clusters = 200;
  FILLED(abbe_image, picture, draw_by(text, &desc, &picture));
  double worst = 0, most = 0;
  size_t places = 0;
  for (size_t y = 0; y < SIDE; y++)
    for (size_t x = 0; x < SIDE; x++) {
      double d[3], p[3], n[3], to[3];
      place_of(x, y, d);
      d[2] = -2;
      abbe_vector_normalise(d);
      const double b = 2 * d[2], disc = b * b - (4 - 0.09);
      if (disc < 0.01) continue; /* beside the ball, or at its rim */
      const double t = -b - sqrt(disc);
      bool above = true;
      for (int k = 0; k < 3; k++) p[k] = t * d[k] + (k == 2 ? 2 : 0);
      for (int k = 0; k < 3; k++) n[k] = p[k] / 0.3;
      for (int k = 0; k < 4; k++) {
        abbe_vector_subtract(corner[k], p, to);
        above = above && abbe_vector_dot(to, n) > 0;
      }
      if (!above) continue;
      const double seen = abbe_closed_form_polygon(corner, 4, p, n);
      worst = fmax(worst, fabs(at(&picture, x, y) / (0.5 * ABBE_PI) - (1 - seen)));
      most = fmax(most, seen);
      places++;
    }
  print_message("off by %.4f at %zu places that lose up to %.3f\n", worst, places, most);
  assert_true(places > 30 && most > 0.2);
  assert_true(worst < 0.01);
}

/* What one mirror hides of another counts once: behind a wall that hides it a ball changes nothing.
 */
TEST(hidden_ones) {
  static const char behind[] = "- {name: far ball, shape: sphere, radius: 0.05, levels: 4, mirror: "
                               "0, transform: [{translate: [0.45, 0, 0.06]}]}\n";
  OWNED(abbe_image, without);
  FILLED(abbe_image, with,
         draw(printed("%s%s", DOWN SOFT WHITE_FLOOR WALL("1"), behind), ABBE_TRANSPORT_PINHOLE, 200,
              &with));
  draw(DOWN SOFT WHITE_FLOOR WALL("1"), ABBE_TRANSPORT_PHOTONS, 0, &without);
  for (size_t y = 16; y < 32; y++)
    for (size_t x = 0; x < 36; x++) assert_near(at(&with, x, y), at(&without, x, y), 2e-3);
}

/* Refractors too: a clear ball is not there in even light, but where it shows the dark floor. */
TEST(glass_hides_little) {
  OWNED(abbe_image, glass) = {0}, black = {0}, without = {0};
  static const char ball[] = DOWN SOFT WHITE_FLOOR BALL("flat");
  draw(ball, ABBE_TRANSPORT_PINHOLE, 300, &glass);
  draw(DOWN SOFT WHITE_FLOOR MIRROR_BALL("0"), ABBE_TRANSPORT_PINHOLE, 300, &black);
  draw(ball, ABBE_TRANSPORT_PHOTONS, 0, &without);
  double of_glass = 0, of_black = 0, open = 0.5 * ABBE_PI * SIDE * 10;
  for (size_t y = 0; y < SIDE; y++)
    for (size_t x = 0; x < 10; x++) {
      of_glass += open / (SIDE * 10) - at(&glass, x, y);
      of_black += open / (SIDE * 10) - at(&black, x, y);
      assert_near(at(&without, x, y), 0.5 * ABBE_PI, 1e-3);
      assert_true(at(&glass, x, y) < 0.5 * ABBE_PI + 1e-3);
    }
  print_message("glass hides %.5f, black %.5f\n", of_glass / open, of_black / open);
  assert_true(of_black > 0 && of_glass < 0.5 * of_black);
}

/* Beside what dispersion asks for on coloured receivers: the light is that without pinholes but for
 * what these add. */
TEST(dispersion_on_colours) {
  static const char text[] =
      DOWN "environment: {size: 256, uniform: 0.4, spots: [{elevation: 60, azimuth: 20, radiance: "
           "80, sigma: 3}, {elevation: 40, azimuth: 200, radiance: 2, sigma: 20}]}\n"
           "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: [0.7, "
           "0.5, 0.2]}\n" BALL("crown");
  double sum[2];
  for (int k = 0; k < 2; k++) {
    const abbe_render_desc desc =
        FIELDS(.width = SIDE, .height = SIDE, .supersample = 1, .map_size = 256, .photons = 64,
               .pinholes = k == 1 ? 60 : 0,
               .transport = k == 1 ? ABBE_TRANSPORT_PINHOLE : ABBE_TRANSPORT_PHOTONS);
    OWNED(abbe_scene, scene) = scene_of(text);
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    OWNED(abbe_image, picture) = picture_of(renderer);
    assert_finite(&picture);
    sum[k] = image_sum(&picture, 1);
  }
  print_message("%.4f of the light without\n", sum[1] / sum[0]);
  assert_near(sum[1] / sum[0], 1, 0.05);
}

TEST(refusals) {
  static const struct {
    const char *text, *says;
  } cases[] = {
      {DOWN SOFT WHITE_FLOOR, "at least one mirror"},
      {DOWN SUN WHITE_FLOOR WALL("0.9"), "this scene has none"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_renderer *renderer = NULL;
    const abbe_render_desc desc = {.width = 16, .height = 16, .transport = ABBE_TRANSPORT_PINHOLE};
    OWNED(abbe_scene, scene) = scene_of(cases[i].text);
    REFUSED(ABBE_UNSUPPORTED, cases[i].says,
            abbe_renderer_make(context, &scene, &desc, &renderer, &error));
  }
}
