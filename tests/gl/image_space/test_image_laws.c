/* What is known of photons in image space and of caustics mapping, in units: a gather's bias, a
 * flat mirror's light, a mirror ball's, a ring's caustics and their folds, and frames that move or
 * are noisy. */
#include "tests/gl/frame.h"

#include "scenes/geometry/vector.h"
#include "validation/known/forms/catacaustic.h"

#define PI 3.14159265358979323846

static const abbe_render_desc units = {.profile = ABBE_PROFILE_WYMAN2006_CIE,
                                       .width = 16,
                                       .height = 16,
                                       .photons = 1024,
                                       .map_size = 128,
                                       .fill = ABBE_FILL_GATHER_LIGHT,
                                       .space = ABBE_RGB_SPACE_XYZ};

/* A map on the level plane z = 0: where its texels' corners lie, and what they hold. */
typedef struct floor_map {
  abbe_image image;
  abbe_view view;
} floor_map;

static void make_floor_map(const char *text, const abbe_render_desc *desc, floor_map *out) {
  abbe_scene scene = {0};
  abbe_map_layout layout;
  *out = (floor_map){0};
  load_text(text, &scene);
  abbe_renderer *renderer = make_renderer(&scene, desc);
  draw_frame(renderer);
  read_map(renderer, 0, &out->image);
  abbe_renderer_map_layout(renderer, 0, &layout);
  out->view = layout.view;
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

/* At texels, the first row at the top; false where the ray does not come down to the floor. */
static bool floor_at(const floor_map *m, double column, double row, double out[3]) {
  const double uv[2] = {column / (double)m->image.width, 1 - row / (double)m->image.height};
  double o[3], d[3];
  abbe_view_ray(&m->view, uv, o, d);
  if (!(d[2] < 0)) return false;
  for (int k = 0; k < 3; k++) out[k] = o[k] - d[k] * o[2] / d[2];
  return true;
}

/* Of a texel: its middle on the floor, its area there, m2, and its irradiance. */
static bool texel_at(const floor_map *m, size_t x, size_t y, double at[3], double *area,
                     double *light) {
  double corner[4][3], diagonal[2][3], across[3];
  for (int k = 0; k < 4; k++)
    if (!floor_at(m, (double)x + (k == 1 || k == 2), (double)y + (k > 1), corner[k])) return false;
  if (!floor_at(m, (double)x + 0.5, (double)y + 0.5, at)) return false;
  abbe_vector_subtract(corner[2], corner[0], diagonal[0]);
  abbe_vector_subtract(corner[3], corner[1], diagonal[1]);
  abbe_vector_cross(diagonal[0], diagonal[1], across);
  *area = 0.5 * abbe_vector_length(across);
  *light = (double)m->image.data[(y * m->image.width + x) * m->image.channels + 1] / *area;
  return true;
}

/* G2. Behind a pane the floor has the lamp's light, h / (h^2 + r^2)^1.5; the seven pixels' Gaussian
 * of a standard deviation of 1.408 texels adds half its square times the Laplacian. */
static void gathers_have_their_bias(void **state) {
  (void)state;
  static const char text[] =
      "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
      "lights: [{name: lamp, kind: spot, position: [0, 0, 0.6], target: [0, 0, 0], intensity: 1, "
      "cone: 60}]\n" FLOOR
      "- {name: pane, shape: box, size: [0.6, 0.6, 0.001], transform: [{translate: [0, 0, 0.3]}], "
      "material: flat}\n";
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
    print_message("%zu texels: gathered light off by %.4f; half sigma^2 times the Laplacian is "
                  "%.4f\n",
                  size, off, known);
    assert_near(off, known, 0.003 + 0.1 * fabs(known));
    abbe_image_free(&m.image);
  }
}

/* M1 and P3. A flat mirror's light is that of the lamp's image, to its edges and no farther. */
static const double mirror_centre[3] = {0.1, 0, 0.15}, mirror_lamp[3] = {0.05, 0.03, 0.6};
#define FLAT_MIRROR                                                                                \
  CAMERA POINT_LIGHT FLOOR                                                                         \
      "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.8, transform: "       \
      "[{rotate: {axis: [0, 1, 0], angle: 60}}, {translate: [0.1, 0, 0.15]}]}\n"

/* How far inside the mirror's edges the ray from the lamp's image to p passes, m; outside: below 0.
 * *light: what comes there. */
static double inside_mirror(const double p[3], double *light) {
  const double n[3] = {sin(PI / 3), 0, 0.5}, along[3] = {0.5, 0, -sin(PI / 3)};
  double to[3], image[3], ray[3], at[3];
  abbe_vector_subtract(mirror_lamp, mirror_centre, to);
  for (int k = 0; k < 3; k++) image[k] = mirror_lamp[k] - 2 * abbe_vector_dot(to, n) * n[k];
  abbe_vector_subtract(p, image, ray);
  abbe_vector_subtract(mirror_centre, image, to);
  const double t = abbe_vector_dot(to, n) / abbe_vector_dot(ray, n);
  for (int k = 0; k < 3; k++) at[k] = image[k] + t * ray[k] - mirror_centre[k];
  *light = 0.8 * image[2] * pow(abbe_vector_dot(ray, ray), -1.5);
  return 0.05 - fmax(fabs(abbe_vector_dot(at, along)), fabs(at[1]));
}

static void a_facets_light_has_edges(void **state) {
  (void)state;
  static const abbe_fill fills[] = {ABBE_FILL_QUADS, ABBE_FILL_TRIANGLES};
  for (int f = 0; f < 2; f++) {
    abbe_render_desc desc = units;
    floor_map m;
    size_t within = 0, without = 0;
    double worst = 0, stray = 0, mean = 0;
    desc.fill = fills[f];
    desc.map_size = 512;
    make_floor_map(FLAT_MIRROR, &desc, &m);
    for (size_t i = 0; i < m.image.width * m.image.height; i++) {
      double at[3], area, light, known, least = INFINITY, most = -INFINITY;
      if (!texel_at(&m, i % m.image.width, i / m.image.width, at, &area, &light)) continue;
      for (int k = 0; k < 9; k++) { /* a texel and a half around */
        double near[3], ignored;
        if (!floor_at(&m, (double)(i % m.image.width) + 0.5 + 1.5 * (k % 3 - 1),
                      (double)(i / m.image.width) + 0.5 + 1.5 * (k / 3 - 1), near))
          continue;
        const double inside = inside_mirror(near, &ignored);
        least = fmin(least, inside);
        most = fmax(most, inside);
      }
      inside_mirror(at, &known);
      if (least > 0) {
        worst = fmax(worst, fabs(light / known - 1));
        mean += light / known;
        within++;
      } else if (most < 0) {
        stray = fmax(stray, light);
        without++;
      }
    }
    print_message("%s: %zu texels within, %.4f of the light, off by %.3f; outside %.2g\n",
                  abbe_fill_name(fills[f]), within, mean / (double)within, worst, stray);
    assert_true(within > 20 && without > 1000);
    assert_near(mean / (double)within, 1, 0.02);
    assert_true(worst < 0.15 && stray < 1e-3);
    abbe_image_free(&m.image);
  }
}

/* M2. A small mirror ball far away sends rho E0 R^2 / 4 into every direction. */
static void a_ball_shines_alike_everywhere(void **state) {
  (void)state;
  enum { RINGS = 4 };
  static const char text[] =
      "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
      "lights: [{name: lamp, kind: spot, position: [0, 0, 2], target: [0, 0, 0], intensity: 4, "
      "cone: 20}]\n"
      "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5}\n"
      "- {name: ball, shape: sphere, radius: 0.02, levels: 6, mirror: 0.8, transform: "
      "[{translate: [0, 0, 0.2]}]}\n";
  const double away = 1.8, intensity = 0.8 * 4 / (away * away) * 0.02 * 0.02 / 4;
  abbe_render_desc desc = units;
  floor_map m;
  double ratio[RINGS] = {0};
  size_t count[RINGS] = {0};
  desc.photons = 2048;
  desc.map_size = 64;
  make_floor_map(text, &desc, &m);
  for (size_t i = 0; i < 64 * 64; i++) {
    double at[3], area, light;
    if (!texel_at(&m, i % 64, i / 64, at, &area, &light)) continue;
    const double r = hypot(at[0], at[1]), d2 = r * r + 0.04;
    const int ring = (int)floor((r - 0.12) / 0.08);
    if (ring < 0 || ring >= RINGS || r < 0.12) continue;
    ratio[ring] += light / (intensity * 0.2 * pow(d2, -1.5));
    count[ring]++;
  }
  for (int k = 0; k < RINGS; k++) {
    print_message("ball, ring %d: %.3f of its light, %zu texels\n", k, ratio[k] / (double)count[k],
                  count[k]);
    assert_true(count[k] > 10);
    assert_near(ratio[k] / (double)count[k], 1, 0.1);
  }
  abbe_image_free(&m.image);
}

#define RING_RADIUS 0.05

typedef struct place {
  double height, elevation, lamp[3]; /* radii, degrees */
  double at[2], half;                /* radii */
} place;

static void ring_text(const place *p, char *text, size_t size) {
  const double r = RING_RADIUS, e = p->elevation * PI / 180;
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
  abbe_catacaustic c = {.radius = r, .height = r * p->height, .elevation = p->elevation * PI / 180};
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
static void a_ring_throws_its_caustics(void **state) {
  (void)state;
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
static void folds_sharpen_by_the_root(void **state) {
  (void)state;
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
    desc.map_size = (size_t)128 << (2 * k);
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
static void folds_have_their_peaks(void **state) {
  (void)state;
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
    const double r = RING_RADIUS, middle = (kind == 0 ? 120 : 45) * PI / 180;
    abbe_catacaustic c = {
        .radius = r, .height = r * of[kind].height, .elevation = of[kind].elevation * PI / 180};
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

/* A mirror `at` m off its place, seen by what it sends to the floor alone. */
static void load_moved(double at, double share, abbe_scene *out) {
  char text[1024];
  snprintf(text, sizeof text,
           "materials: glass.yaml\ncamera: {eye: [0.9, 0, 0.6], target: [0.34, 0, 0], fov: "
           "22}\n" POINT_LIGHT FLOOR
           "- {name: mirror, shape: rectangle, width: 0.06, height: 0.06, mirror: %.9g, transform: "
           "[{rotate: {axis: [0, 1, 0], angle: 60}}, {translate: [0.09, %.9g, 0.15]}]}\n",
           share, at);
  load_text(text, out);
}

/* The next frame's picture, light's middle and variance in it, in pixels across; less `dark`. */
static void moments(abbe_renderer *renderer, const abbe_image *dark, double out[2]) {
  abbe_image picture = {0};
  double sum = 0, first = 0, second = 0;
  abbe_renderer_redraw(renderer);
  draw_frame(renderer);
  read_picture(renderer, false, &picture);
  for (size_t i = 0; i < picture.width * picture.height; i++) {
    const double way = (double)(i % picture.width);
    const double light = (double)picture.data[picture.channels * i + 1] -
                         (dark != NULL ? (double)dark->data[dark->channels * i + 1] : 0);
    sum += light;
    first += light * way;
    second += light * way * way;
  }
  out[0] = first / sum;
  out[1] = second / sum - out[0] * out[0];
  abbe_image_free(&picture);
}

/* T3. Of v pixels a frame, four frames lag by 1.5 v and spread by 1.25 v^2 more. */
static void motion_lags(void **state) {
  (void)state;
  enum { FRAMES = 8 };
  abbe_render_desc desc = units;
  abbe_scene scene[FRAMES], dark[FRAMES];
  double own[FRAMES][2], kept[FRAMES][2];
  abbe_image black[FRAMES];
  desc.width = desc.height = 128;
  desc.supersample = desc.upsample = 1;
  desc.photons = 1400;
  desc.wavelengths = 1;
  desc.fill = ABBE_FILL_GATHER_EYE;
  for (int pass = 0; pass < 2; pass++) {
    abbe_renderer *renderer = NULL;
    desc.history = pass == 0 ? 1 : 4;
    for (int k = 0; k < FRAMES; k++) {
      abbe_error error = {0};
      if (pass == 0) {
        load_moved(0.003 * k - 0.01, 0, &dark[k]);
        load_moved(0.003 * k - 0.01, 0.8, &scene[k]);
        abbe_renderer *other = make_renderer(&dark[k], &desc);
        draw_frame(other);
        read_picture(other, false, &black[k]);
        abbe_renderer_free(other);
      }
      if (renderer == NULL)
        renderer = make_renderer(&scene[k], &desc);
      else
        assert_ok(abbe_renderer_change(renderer, &scene[k], &desc, &error), &error);
      moments(renderer, &black[k], pass == 0 ? own[k] : kept[k]);
    }
    abbe_renderer_free(renderer);
  }
  double lag = 0, more = 0, v = (own[FRAMES - 1][0] - own[1][0]) / (FRAMES - 2);
  for (int k = 4; k < FRAMES; k++) {
    double spread = 0;
    for (int i = 0; i < 4; i++) spread += own[k - i][1] / 4;
    lag += (own[k][0] - kept[k][0]) / (FRAMES - 4);
    more += (kept[k][1] - spread) / (FRAMES - 4);
  }
  print_message("%.3f pixels a frame: lag %.3f of them, variance %.3f of their square\n", v,
                lag / v, more / (v * v));
  assert_true(fabs(v) > 1);
  assert_near(lag / v, 1.5, 0.1);
  assert_near(more / (v * v), 1.25, 0.15);
  for (int k = 0; k < FRAMES; k++) {
    abbe_scene_free(&scene[k]);
    abbe_scene_free(&dark[k]);
    abbe_image_free(&black[k]);
  }
}

/* Mean over texels of the variance over frames whose grids lie anywhere. */
static double noise(const abbe_scene *scene, size_t history) {
  enum { SAMPLES = 24, SIDE = 96 };
  static double sum[2 * SIDE * SIDE];
  double variance = 0;
  unsigned seed = 12345;
  abbe_render_desc desc = units;
  abbe_renderer *renderer = NULL;
  memset(sum, 0, sizeof sum);
  desc.photons = 96;
  desc.map_size = SIDE;
  desc.history = history;
  for (size_t k = 0; k < (SAMPLES + 1) * history; k++) {
    abbe_error error = {0};
    abbe_image map = {0};
    for (int axis = 0; axis < 2; axis++) {
      seed = seed * 1664525u + 1013904223u;
      desc.photon_shift[axis] = (double)(seed >> 8) / 0x1p24 - 0.5;
    }
    if (renderer == NULL)
      renderer = make_renderer(scene, &desc);
    else
      assert_ok(abbe_renderer_change(renderer, scene, &desc, &error), &error);
    draw_frame(renderer);
    if (k < history || k % history != history - 1) continue;
    read_map(renderer, 0, &map);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
      const double light = (double)map.data[map.channels * i + 1];
      sum[2 * i] += light / SAMPLES;
      sum[2 * i + 1] += light * light / SAMPLES;
    }
    abbe_image_free(&map);
  }
  for (size_t i = 0; i < SIDE * SIDE; i++) variance += sum[2 * i + 1] - sum[2 * i] * sum[2 * i];
  abbe_renderer_free(renderer);
  return variance / (SIDE * SIDE);
}

/* T4. Frames whose noise is independent leave a quarter of its variance. */
static void noise_goes_by_four(void **state) {
  (void)state;
  abbe_scene scene = {0};
  load_text(CAMERA POINT_LIGHT FLOOR BALL("flat"), &scene);
  const double one = noise(&scene, 1), four = noise(&scene, 4);
  print_message("variance of four frames: %.3f of one's\n", four / one);
  assert_near(four / one, 0.25, 0.07);
  abbe_scene_free(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gathers_have_their_bias),
      cmocka_unit_test(a_facets_light_has_edges),
      cmocka_unit_test(a_ball_shines_alike_everywhere),
      cmocka_unit_test(a_ring_throws_its_caustics),
      cmocka_unit_test(folds_sharpen_by_the_root),
      cmocka_unit_test(folds_have_their_peaks),
      cmocka_unit_test(motion_lags),
      cmocka_unit_test(noise_goes_by_four),
  };
  return cmocka_run_group_tests(tests, make_context, free_context);
}
