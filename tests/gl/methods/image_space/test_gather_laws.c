/* What is known of gathers of photons, in units: their bias, and a ring's caustics and their folds.
 */
#include "tests/gl/methods/image_space/floor_map.h"

#include "validation/lab/known/forms/closed_form.h"

GROUP(make_context, free_context);

/* G2. Behind a pane the floor has the lamp's light, h / (h^2 + r^2)^1.5; the seven pixels' Gaussian
 * of a standard deviation of 1.408 texels adds half its square times the Laplacian. */
TEST(gathers_have_their_bias) {
  static const char text[] =
      "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
      "lights: [{name: lamp, kind: spot, position: [0, 0, 0.6], target: [0, 0, 0], intensity: 1, "
      "cone: 60}]\n" FLOOR "- {name: pane, shape: box, size: [0.6, 0.6, 0.001], transform: "
      "[{translate: [0, 0, 0.3]}], material: flat}\n";
  const double h = 0.6, through = 0.9216;
  for (size_t size = 32; size <= 128; size *= 2) {
    abbe_render_desc desc = units;
    floor_map m;
    double off = 0, known = 0;
    desc.map_size = size;
    make_floor_map(text, &desc, &m);
    for (size_t k = 0; k < 16; k++) {
      double at[3], area, light;
      assert_true(texel_at(&m, size / 2 - 2 + k % 4, size / 2 - 2 + k / 4, at, &area, &light));
      const double r2 = at[0] * at[0] + at[1] * at[1], d2 = h * h + r2;
      const double exact = through * h * pow(d2, -1.5), sigma2 = 1.983 * area;
      off += (light / exact - 1) / 16;
      known += 0.5 * sigma2 * (15 * r2 / (d2 * d2) - 6 / d2) / 16;
    }
    print_message(
        "%zu texels: gathered light off by %.4f; half sigma^2 times the Laplacian is %.4f\n", size,
        off, known);
    assert_near(off, known, 0.003 + 0.1 * fabs(known));
    abbe_image_free(&m.image);
  }
}

#define RING_RADIUS 0.05

typedef struct place {
  double height, elevation, lamp[3]; /* radii, degrees */
  double at[2], half;                /* radii */
} place;

static void ring_text(const place *p, char *text, size_t size) {
  const double r = RING_RADIUS, e = p->elevation * ABBE_PI / 180;
  char light[200];
  if (p->elevation > 0)
    snprintf(light, sizeof light, "kind: directional, direction: [%.9g, 0, %.9g], irradiance: 1",
             cos(e), -sin(e));
  else
    snprintf(light, sizeof light,
             "kind: spot, position: [%.9g, %.9g, %.9g], target: [0, 0, 0], cone: 60, intensity: 1",
             r * p->lamp[0], r * p->lamp[1], r * p->lamp[2]);
  snprintf(text, size,
           "materials: default\ncamera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: "
           "8}\nlights: [{name: lamp, %s}]\nobjects:\n"
           "- {name: floor, shape: rectangle, width: 0.5, height: 0.5, reflectance: 1}\n"
           "- {name: ring, shape: lathe, around: 1024, profile: [[%.9g, 0], [%.9g, %.9g], [%.9g, "
           "%.9g], [%.9g, 0]], mirror: 0.9}\n",
           light, 1.01 * r, 1.01 * r, r * p->height, r, r * p->height, r);
}

/* Light in the square by that which is known of one reflection. */
static double ring_light(const place *p, const abbe_render_desc *desc) {
  const double r = RING_RADIUS, at[2] = {r * p->at[0], r * p->at[1]}, half = r * p->half;
  abbe_catacaustic c = {
      .radius = r, .height = r * p->height, .elevation = p->elevation * ABBE_PI / 180};
  char text[1024];
  floor_map m;
  double flux = 0, all = 0;
  size_t branches;
  for (int k = 0; k < 3; k++) c.lamp[k] = r * p->lamp[k];
  ring_text(p, text, sizeof text);
  make_floor_map(text, desc, &m);
  for (size_t i = 0; i < m.image.width * m.image.height; i++) {
    double where[3], area, light;
    if (!texel_at(&m, i % m.image.width, i / m.image.width, where, &area, &light)) continue;
    if (fabs(where[0] - at[0]) > half || fabs(where[1] - at[1]) > half) continue;
    flux += area * light;
    all += area;
  }
  abbe_image_free(&m.image);
  assert_true(all > 0);
  return flux / all / abbe_catacaustic_mean(&c, at, half, 12, 0.9, 1, &branches);
}

/* R1 to R3, by both methods: of parallel light a nephroid, of a lamp by the wall a cardioid. */
TEST(a_ring_throws_its_caustics) {
  static const place suns[] = {{1, 45, {0}, {0.2, 0}, 0.1}, {1, 45, {0}, {0.75, 0}, 0.07}};
  static const place lamps[] = {{2, 0, {0.95, 0, 4}, {0, 0.05}, 0.1},
                                {2, 0, {0.95, 0, 4}, {-0.6, 0}, 0.07}};
  abbe_render_desc shah = units; /* behind the wall, too, the light sees the floor, or it is lost */
  shah.profile = ABBE_PROFILE_SHAH2007_CIE;
  shah.fill = ABBE_FILL_AUTO;
  shah.map_size = 512;
  abbe_render_desc wyman = units;
  wyman.map_size = 512;
  for (int i = 0; i < 2; i++) {
    const double sun = ring_light(&suns[i], &shah), lamp = ring_light(&lamps[i], &shah);
    wyman.fill = ABBE_FILL_TRIANGLES;
    const double polygons = ring_light(&lamps[i], &wyman);
    wyman.fill = ABBE_FILL_GATHER_LIGHT;
    const double gathered = ring_light(&lamps[i], &wyman);
    print_message("ring, place %d: splats %.3f of the sun's light, %.3f of the lamp's; triangles "
                  "%.3f, gathered %.3f\n",
                  i, sun, lamp, polygons, gathered);
    assert_near(sun, 1, 0.06);
    assert_near(lamp, 1, 0.06);
    assert_near(polygons, 1, 0.06);
    assert_near(gathered, 1, 0.06);
  }
}

/* R4. At a fold light goes by the distance to -1/2, so a texel's by its width to -1/2. */
TEST(folds_sharpen_by_the_root) {
  static const place fold = {1, 45, {0}, {0}, 0};
  static const double origin[3] = {-0.5, 0, 0.5}, down[3] = {1, 0, -1}, up[3] = {0, 1, 0};
  abbe_map_layout layout; /* else texels are as wide as the light asks for */
  abbe_view view;
  const double r = RING_RADIUS, turn = 0.9; /* on the nephroid, off its cusp */
  const double at[2] = {r / 4 * (3 * cos(turn) - cos(3 * turn)),
                        r / 4 * (3 * sin(turn) - sin(3 * turn))};
  char text[1024];
  double peak[3] = {0};
  ring_text(&fold, text, sizeof text);
  abbe_view_look(origin, down, up, true, &view);
  for (int k = 0; k < 4; k++) view.window[k] = k % 2 ? 0.06 : -0.06;
  view.near = 0.2;
  view.far = 1.5;
  abbe_map_layout_make(&view, &layout);
  for (int k = 0; k < 3; k++) {
    abbe_render_desc desc = units;
    floor_map m;
    desc.profile = ABBE_PROFILE_DEFAULT;
    desc.fill = ABBE_FILL_AUTO;
    desc.map_size = (size_t)64 << (2 * k);
    desc.photons = 512;
    desc.map_layout = &layout;
    make_floor_map(text, &desc, &m);
    for (size_t i = 0; i < m.image.width * m.image.height; i++) {
      double where[3], area, light;
      if (!texel_at(&m, i % m.image.width, i / m.image.width, where, &area, &light)) continue;
      if (fabs(where[0] - at[0]) > 0.1 * r || fabs(where[1] - at[1]) > 0.1 * r) continue;
      peak[k] = fmax(peak[k], light);
    }
    abbe_image_free(&m.image);
  }
  print_message("a fold's brightest texel: %.3g, %.3g, %.3g\n", peak[0], peak[1], peak[2]);
  for (int k = 0; k < 2; k++) assert_near(peak[k + 1] / peak[k], 2, 0.4); /* a quarter as wide */
}

/* A place on a fold of the ring's caustic, by the place of the wall at `turn` that sends light
 * there; n: square to it, to its bright side, where light is A d^-1/2 and a rest at the distance d.
 */
typedef struct fold {
  double at[2], n[2], strength, rest;
} fold;

static void find_fold(const abbe_catacaustic *c, double turn, size_t bounces, fold *out) {
  const double wall[2] = {c->radius * cos(turn), c->radius * sin(turn)}, sun = c->elevation;
  double d[2] = {1, 0}, p = INFINITY, along, e[2][2], far[2] = {2e-3, 8e-3};
  for (int k = 0; k < 2 && !(sun > 0); k++) d[k] = wall[k] - c->lamp[k];
  if (!(sun > 0)) p = hypot(d[0], d[1]);
  for (int k = 0; k < 2 && !(sun > 0); k++) d[k] /= p;
  const double cosine = d[0] * cos(turn) + d[1] * sin(turn); /* R1 */
  along = 1 / (2 / (c->radius * cosine) - 1 / p);
  out->n[0] = -(d[1] - 2 * cosine * sin(turn));
  out->n[1] = d[0] - 2 * cosine * cos(turn);
  out->at[0] = wall[0] + along * out->n[1];
  out->at[1] = wall[1] - along * out->n[0];
  for (int i = 0; i < 4; i++) {
    const double off = (i < 2 ? 1 : -1) * far[i % 2] * c->radius;
    const double q[2] = {out->at[0] + off * out->n[0], out->at[1] + off * out->n[1]};
    e[i / 2][i % 2] = 0;
    for (size_t b = 1; b <= bounces; b++)
      e[i / 2][i % 2] += pow(0.9, (double)b) * abbe_catacaustic_irradiance(c, q, b, NULL);
  }
  const int side = e[0][0] > e[1][0] ? 0 : 1;
  for (int k = 0; k < 2; k++) far[k] = 1 / sqrt(far[k] * c->radius);
  for (int k = 0; k < 2; k++) out->n[k] *= side == 0 ? 1 : -1;
  out->strength = (e[side][0] - e[side][1]) / (far[0] - far[1]);
  out->rest = e[side][0] - out->strength * far[0];
}

/* The most light of a texel near a fold, and the variance of a texel's box along its normal, m2,
 * times 12. */
static double fold_peak(const floor_map *m, const fold *f, double *width2) {
  double most = 0, nearest = INFINITY;
  for (size_t i = 0; i < m->image.width * m->image.height; i++) {
    const size_t x = i % m->image.width, y = i / m->image.width;
    double at[3], area, light, side[2][3];
    if (!texel_at(m, x, y, at, &area, &light)) continue;
    const double to[2] = {at[0] - f->at[0], at[1] - f->at[1]};
    const double off = to[0] * f->n[0] + to[1] * f->n[1],
                 beside = to[1] * f->n[0] - to[0] * f->n[1];
    if (fabs(off) > 4 * sqrt(area) || fabs(beside) > sqrt(area)) continue;
    most = fmax(most, light);
    if (hypot(off, beside) > nearest) continue;
    nearest = hypot(off, beside);
    *width2 = 0;
    for (int k = 0; k < 2; k++) {
      if (!floor_at(m, (double)x + 0.5 + 0.5 * (k == 0), (double)y + 0.5 + 0.5 * (k == 1), side[k]))
        continue;
      const double along = 2 * ((side[k][0] - at[0]) * f->n[0] + (side[k][1] - at[1]) * f->n[1]);
      *width2 += along * along;
    }
  }
  return most;
}

/* G2. The seven pixels' Gaussian of a fold A d^-1/2 peaks at 1.021 A sigma^-1/2, in the mean along
 * it; a box of width w at 2 A w^-1/2, where its edge lies on the fold. */
TEST(folds_have_their_peaks) {
  enum { PLACES = 40 };
  static const place of[2] = {{2, 0, {0.95, 0, 4}, {0}, 0}, {1, 45, {0}, {0}, 0}};
  static const double origin[3] = {-0.5, 0, 0.5}, down[3] = {1, 0, -1}, up[3] = {0, 1, 0};
  abbe_map_layout layout;
  abbe_view view;
  abbe_view_look(origin, down, up, true, &view);
  for (int k = 0; k < 4; k++) view.window[k] = k % 2 ? 0.06 : -0.06;
  view.near = 0.2;
  view.far = 1.5;
  abbe_map_layout_make(&view, &layout);
  for (int kind = 0; kind < 2; kind++) {
    const double r = RING_RADIUS, middle = (kind == 0 ? 120 : 45) * ABBE_PI / 180;
    abbe_catacaustic c = {.radius = r,
                          .height = r * of[kind].height,
                          .elevation = of[kind].elevation * ABBE_PI / 180};
    abbe_render_desc desc = units;
    char text[1024];
    floor_map m;
    double mean = 0, most = 0;
    for (int k = 0; k < 3; k++) c.lamp[k] = r * of[kind].lamp[k];
    desc.map_size = 512;
    if (kind == 1) {
      desc.profile = ABBE_PROFILE_DEFAULT;
      desc.fill = ABBE_FILL_AUTO;
      desc.photons = 512;
      desc.map_layout = &layout;
    }
    ring_text(&of[kind], text, sizeof text);
    make_floor_map(text, &desc, &m);
    for (int i = 0; i < PLACES; i++) {
      fold f;
      double width2 = 0;
      find_fold(&c, middle + 0.2 * (i + 0.5 - PLACES / 2) / PLACES, 1, &f);
      const double peak = fold_peak(&m, &f, &width2);
      const double factor = kind == 0 ? 1.021 / sqrt(1.408) : 2;
      const double ratio = (peak - f.rest) / (factor * f.strength * pow(width2, -0.25));
      mean += ratio / PLACES;
      most = fmax(most, ratio);
    }
    print_message("%s: %.3f of a fold's peak in the mean, %.3f at the most\n",
                  kind == 0 ? "gathered" : "texels", mean, most);
    if (kind == 0)
      assert_near(mean, 1, 0.05);
    else
      assert_near(most, 1, 0.1);
    abbe_image_free(&m.image);
  }
}
