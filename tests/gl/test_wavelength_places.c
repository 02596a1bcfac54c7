/* Where each wavelength lands on a wall behind a slit and a prism, in closed form: forty bands of
 * the renderer's map, each held to its own mean place and its own light. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "spectral/optics.h"

enum { BANDS = 40, PARTS = 200 };

/* A prism of 60 degrees; of its triangle, m. */
static const double side = 0.04, height = 0.06, slit = 0.0005, irradiance = 1;

typedef struct setting {
  const char *glass;
  double n_d;   /* for which it is turned to its least deviation */
  double wall;  /* from where that light leaves, m */
  double slant; /* of the wall, degrees; 0: square to that light */
} setting;

typedef struct bench {
  double inward[3][2], offset[3]; /* of the triangle's sides: inside where n . x > offset */
  double leave[2], way[2];        /* of light of n_d */
  double wall[2], along[2];       /* its middle, and unit along it */
} bench;

/* Light of the index n along +x through the origin, which lies on side 0: where it leaves, which
 * way, and the share that passes both sides and what is attenuated between them. */
static double refract_twice(const bench *b, double n, double per_m, double at[2], double d[2]) {
  const double from[3] = {-1, 0, 0}, n0[3] = {-b->inward[0][0], -b->inward[0][1], 0};
  double inside[3], out[3];
  assert_true(abbe_optics_refract(from, n0, 1 / n, inside));
  const double first = abbe_optics_fresnel(from[0] * n0[0] + from[1] * n0[1], 1 / n);
  int to = 0;
  double t = INFINITY;
  for (int k = 1; k < 3; k++) {
    const double slope = b->inward[k][0] * inside[0] + b->inward[k][1] * inside[1];
    const double here = b->offset[k] / slope;
    if (slope < 0 && here < t) t = here, to = k;
  }
  const double n1[3] = {b->inward[to][0], b->inward[to][1], 0};
  const double back[3] = {-inside[0], -inside[1], 0};
  at[0] = t * inside[0], at[1] = t * inside[1];
  const double second = abbe_optics_fresnel(back[0] * n1[0] + back[1] * n1[1], n);
  if (!abbe_optics_refract(back, n1, n, out)) return 0;
  d[0] = out[0], d[1] = out[1];
  return (1 - first) * (1 - second) * exp(-per_m * t);
}

/* On the wall, from its middle, m. */
static double place_of(const bench *b, const double at[2], const double d[2]) {
  const double w[2] = {b->wall[0] - at[0], b->wall[1] - at[1]};
  return (w[1] * d[0] - w[0] * d[1]) / (b->along[0] * d[1] - b->along[1] * d[0]);
}

static void make_bench(const setting *s, bench *b) {
  const double incidence = asin(s->n_d / 2), inradius = side / (2 * sqrt(3));
  const double centre[2] = {inradius * cos(incidence), inradius * sin(incidence)};
  for (int k = 0; k < 3; k++) {
    const double angle = incidence + k * 2 * ABBE_PI / 3;
    b->inward[k][0] = cos(angle), b->inward[k][1] = sin(angle);
    b->offset[k] = b->inward[k][0] * centre[0] + b->inward[k][1] * centre[1] - inradius;
  }
  refract_twice(b, s->n_d, 0, b->leave, b->way);
  const double square = atan2(b->way[1], b->way[0]) + ABBE_PI / 2 + s->slant * ABBE_PI / 180;
  b->along[0] = cos(square), b->along[1] = sin(square);
  for (int k = 0; k < 2; k++) b->wall[k] = b->leave[k] + s->wall * b->way[k];
}

/* Mean place, m, and flux, W, of a band: of light that is spread evenly over the range. */
static double band_in_closed_form(const bench *b, const abbe_material *glass, double from,
                                  double to, double *flux) {
  double sum = 0, moment = 0;
  for (int i = 0; i < PARTS; i++) {
    double n = 1, at[2], d[2] = {1, 0};
    const double lambda_nm = from + (to - from) * (i + 0.5) / PARTS;
    OK(abbe_material_n(glass, lambda_nm, &n, &error));
    const double passes = refract_twice(b, n, abbe_material_attenuation(glass, lambda_nm), at, d);
    sum += passes;
    if (passes > 0) moment += passes * place_of(b, at, d);
  }
  *flux = sum / PARTS * irradiance * slit * height * (to - from) / 400;
  return moment / sum;
}

static void load_bench(const setting *s, const bench *b, double middle, double width,
                       abbe_scene *out) {
  char text[4096];
  const double turn = asin(s->n_d / 2) * 180 / ABBE_PI - 30, inradius = side / (2 * sqrt(3));
  const double incidence = asin(s->n_d / 2), jaw = 0.03;
  snprintf(
      text, sizeof text,
      "materials: default\ncamera: {eye: [0, -0.5, 0.3], target: [0, 0, 0], size: [16, 16]}\n"
      "lights:\n- {name: sun, kind: directional, direction: [1, 0, 0], irradiance: %g, illuminant: "
      "E}\n"
      "objects:\n"
      "- {name: prism, shape: prism, apex: 60, side: %g, length: %g, material: %s, transform: [\n"
      "   {rotate: {axis: [1, 0, 0], angle: 90}}, {rotate: {axis: [0, 0, 1], angle: %.9f}},\n"
      "   {translate: [%.9f, %.9f, 0]}]}\n"
      "- {name: left, shape: rectangle, width: %g, height: 0.2, reflectance: 0, transform: [\n"
      "   {rotate: {axis: [0, 1, 0], angle: -90}}, {rotate: {axis: [1, 0, 0], angle: -90}},\n"
      "   {translate: [-0.1, %.9f, 0]}]}\n"
      "- {name: right, shape: rectangle, width: %g, height: 0.2, reflectance: 0, transform: [\n"
      "   {rotate: {axis: [0, 1, 0], angle: -90}}, {rotate: {axis: [1, 0, 0], angle: -90}},\n"
      "   {translate: [-0.1, %.9f, 0]}]}\n"
      "- {name: wall, shape: rectangle, width: %g, height: 0.2, reflectance: 1, transform: [\n"
      "   {rotate: {axis: [1, 0, 0], angle: 90}}, {rotate: {axis: [0, 0, 1], angle: %.9f}},\n"
      "   {translate: [%.9f, %.9f, 0]}]}\n",
      irradiance, side, height, s->glass, turn, inradius * cos(incidence),
      inradius * sin(incidence), 2 * jaw, jaw + slit / 2, 2 * jaw, -jaw - slit / 2, width,
      atan2(b->along[1], b->along[0]) * 180 / ABBE_PI, b->wall[0] + middle * b->along[0],
      b->wall[1] + middle * b->along[1]);
  *out = scene_of(text);
}

/* Along the wall from its middle, m. */
static double place_of_texel(const bench *b, const abbe_map_layout *layout, const double uv[2]) {
  double origin[3], d[3];
  abbe_map_layout_ray(layout, uv, origin, d);
  return place_of(b, origin, d);
}

static void assert_bands_in_place(const setting *s, const abbe_render_desc *desc) {
  bench b;
  abbe_map_layout layout;
  double ends[2], flux;
  make_bench(s, &b);
  /* The glass is known once a scene is loaded. */
  FILLED(abbe_scene, scene, load_bench(s, &b, 0, 1, &scene));
  for (int k = 0; k < 2; k++)
    ends[k] = band_in_closed_form(&b, scene.object[0].material, k ? 779.99 : 380, k ? 780 : 380.01,
                                  &flux);
  abbe_scene_free(&scene);
  const double width = fabs(ends[1] - ends[0]);
  load_bench(s, &b, 0.5 * (ends[0] + ends[1]), 1.2 * width + 0.02, &scene);
  look_aside(&scene);
  abbe_renderer *renderer = drawn_renderer(&scene, desc);
  abbe_renderer_map_layout(renderer, 0, &layout);
  MADE(abbe_image, map, abbe_renderer_read_map_bands(renderer, 0, BANDS, &map, &error));
  abbe_renderer_free(renderer);
  double worst = 0, worst_nm = 0, worst_flux = 0;
  const size_t texels = map.width * map.height;
  double sums[BANDS] = {0}, moments[BANDS] = {0};
  for (size_t k = 0; k < texels; k++) {
    const float *band = map.data + k * map.channels + 3;
    int first = 0;
    while (first < BANDS && band[first] == 0) first++;
    if (first == BANDS) continue;
    const double uv[2] = {((double)(k % map.width) + 0.5) / (double)map.width,
                          1 - ((double)(k / map.width) + 0.5) / (double)map.height};
    const double at = place_of_texel(&b, &layout, uv);
    if (fabs(at - 0.5 * (ends[0] + ends[1])) > 0.6 * width + 0.01) continue; /* beside the wall */
    for (int i = first; i < BANDS; i++) {
      sums[i] += (double)band[i];
      moments[i] += (double)band[i] * at;
    }
  }
  for (int i = 0; i < BANDS; i++) {
    const double from = 380 + 400.0 * i / BANDS, to = 380 + 400.0 * (i + 1) / BANDS;
    const double sum = sums[i], moment = moments[i];
    assert_true(sum > 0);
    const double expected = band_in_closed_form(&b, scene.object[0].material, from, to, &flux);
    const double off = moment / sum - expected, light = sum * (to - from) / flux - 1;
    if (fabs(off) > fabs(worst)) worst = off, worst_nm = from;
    if (fabs(light) > fabs(worst_flux)) worst_flux = light;
  }
  print_message("%s, wall at %g m, slanted by %g: a spectrum of %.0f mm, worst at %.0f nm by %.3f "
                "mm; light %.2f %%\n",
                s->glass, s->wall, s->slant, 1e3 * width, worst_nm, 1e3 * worst, 100 * worst_flux);
  /* Bands lie in their places to a fifth of a millimetre, or to an eighth of a texel where those
   * are wide. */
  assert_near(worst, 0, fmax(2e-4, 0.125 * (1.2 * width + 0.02) / (double)map.width));
  assert_near(worst_flux, 0, 3e-3);
}

GROUP(make_context, free_context);

TEST(each_band_lands_in_its_place) {
  static const setting settings[] = {
      {"sf10", 1.72825, 1, 0},    {"n-bk7", 1.5168, 0.3, -40}, {"n-sf11", 1.78472, 0.3, 0},
      {"n-sf11", 1.78472, 1, 40}, {"sf10", 1.72825, 3, 45},    {"n-sf11", 1.78472, 3, -40},
  };
  const abbe_render_desc desc = {
      .width = 16, .height = 16, .photons = 64, .map_size = 512, .exits = 1};
  for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++)
    if (all_cases() || i % 3 == 1 || i == 3) assert_bands_in_place(&settings[i], &desc);
}
