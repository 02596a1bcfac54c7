/* The colours of bands that are attenuated, against integrals over the whole spectrum: of stones of
 * 1 to 20 mm, of paths through two of them, and of a metal that reflects once or thrice. */
#include "tests/gl/plan/planned.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/difference.h"
#include "gl/scene/spectra/camera_bands.h"
#include "spectral/optics.h"

enum { FINE = 2000, SETS = ABBE_CAMERA_BAND_SETS };

static const size_t wavelengths[] = {1, 4, 5, 7, 8, 9, 31};
static const char *const stone[] = {"ruby", "emerald", "sapphire-blue", "amethyst", "tanzanite"};

enum { COUNTS = sizeof wavelengths / sizeof *wavelengths };

typedef struct fixture {
  abbe_scene scene;
  abbe_plan plan;
  abbe_spectral_tables tables;
  abbe_camera_band *band;
  float (*texel)[4];
  size_t count, surfaces;
} fixture;

static void make(const char *objects, size_t count, fixture *f) {
  const abbe_render_desc desc = {.wavelengths = count};
  size_t levels;
  const char *text = printed(
      "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR "%s", objects);
  *f = (fixture){0};
  f->scene = scene_of(text);
  plan_scene(&f->scene, &desc, &f->plan);
  assert_true(f->plan.band_parts);
  f->surfaces = f->plan.refractor_count;
  f->count = abbe_camera_bands_count(count, &levels);
  f->band = calloc(f->surfaces * SETS * f->count, sizeof *f->band);
  f->texel = calloc(abbe_camera_bands_texels(&f->plan), sizeof *f->texel);
  assert_true(f->band != NULL && f->texel != NULL);
  OK(abbe_spectral_tables_make(&f->scene, &f->plan, &f->tables, &error));
  OK(abbe_camera_bands_fill(&f->scene, &f->plan, &f->tables, f->band, f->texel, &error));
}

static void done(fixture *f) {
  free(f->band);
  free(f->texel);
  abbe_spectral_tables_free(&f->tables);
  abbe_plan_free(&f->plan);
  abbe_scene_free(&f->scene);
}

/* What is passed: metres inside each surface, or times that it reflects; of a pleochroic stone by a
 * field along the axis. */
typedef struct passage {
  double by[2];
  int axis;
} passage;

/* As the shaders sum it (camera_bands.glsl): band i of a set, X, Y and Z of a white of 1 each. */
static void add_band(const fixture *f, size_t set, size_t i, const passage *p, double xyz[3]) {
  const size_t at = set * f->count + i, apart = SETS * f->count;
  const float(*parts)[4] = (const float(*)[4])f->texel + ABBE_BAND_COLOUR_TEXELS * apart;
  const float(*light)[4] =
      parts + ABBE_PART_TEXELS * f->surfaces * apart + ABBE_PART_LIGHT_TEXELS * at;
  for (size_t part = 0; part < 8; part++) {
    double left = 1;
    for (size_t r = 0; r < f->surfaces; r++) {
      const abbe_camera_band *band = &f->band[r * apart + at];
      const size_t along = f->plan.pleochroic ? f->surfaces * (size_t)(p->axis + 1) : 0;
      const size_t after = along > 0 ? ABBE_PART_LIGHT_TEXELS * apart : 0;
      const double by =
          (double)parts[after + ABBE_PART_TEXELS * ((r + along) * apart + at) + part / 4][part % 4];
      const double metal = !f->plan.mirror[r] || band->surface[3] < 0
                               ? 0
                               : abbe_optics_fresnel_conductor(1, (double)band->surface[2],
                                                               (double)band->surface[3]);
      left *= f->plan.mirror[r] ? pow(1 - by * (1 - metal), p->by[r]) : exp(-by * p->by[r]);
    }
    for (size_t c = 0; c < 3; c++) xyz[c] += (double)light[2 * c + part / 4][part % 4] * left;
  }
}

static double left_at(const fixture *f, const passage *p, double lambda_nm) {
  double left = 1;
  for (size_t r = 0; r < f->surfaces; r++) {
    const abbe_object *o = &f->scene.object[f->plan.refractor_object[r]];
    double n, k;
    if (!f->plan.mirror[r]) {
      left *=
          exp(-p->by[r] * (f->plan.pleochroic
                               ? abbe_material_attenuation_along(o->material, p->axis, lambda_nm)
                               : abbe_material_attenuation(o->material, lambda_nm)));
    } else {
      OK(abbe_material_nk(o->conductor, lambda_nm, &n, &k, &error));
      left *= pow(abbe_optics_fresnel_conductor(1, n, k), p->by[r]);
    }
  }
  return left;
}

static void integrate(const fixture *f, const passage *p, double xyz[3]) {
  abbe_weights_range range;
  const double from = f->plan.desc.min_nm, width = (f->plan.desc.max_nm - from) / FINE;
  abbe_weights_range_make(abbe_scene_illuminant(&f->scene), from, f->plan.desc.max_nm, &range);
  for (int i = 0; i < FINE; i++) {
    double light[3];
    abbe_weights_range_xyz(&range, from + width * i, from + width * (i + 1), light);
    for (int c = 0; c < 3; c++) xyz[c] += light[c] * left_at(f, p, from + width * (i + 0.5));
  }
}

/* Every level of every set, in CIEDE2000 against the integral, under the light's white; and
 * dominant wavelengths, where there is one (from 640 nm on hues hardly differ). Fewer than three
 * bands of a sample have too few parts for two materials, or for the colours of several axes. */
static void hold(const fixture *f, const passage *p, const char *what, double *worst) {
  const bool two = (p->by[0] > 0 && p->by[1] > 0) || f->plan.pleochroic;
  const double *white = f->tables.camera.sum;
  double xyz[3] = {0}, lab[3], xy[2], white_xy[2];
  abbe_dominant wanted, got;
  integrate(f, p, xyz);
  abbe_difference_lab(xyz, white, lab);
  assert_true(abbe_chromaticity_xy(xyz, xy) && abbe_chromaticity_xy(white, white_xy));
  const bool hued = abbe_chromaticity_dominant(xy, white_xy, ABBE_OBSERVER_CIE_1931, &wanted) &&
                    wanted.purity > 0.1 && wanted.lambda_nm < 640;
  for (size_t set = 0; set < SETS; set++)
    for (size_t first = 0, n = f->tables.all.count, ended = 0; !ended;
         ended = n == 1, first += n, n = (n + 1) / 2) {
      double sum[3] = {0}, to[3];
      const bool halves = set > 0 && n > 2 && abbe_camera_bands_interleave(&f->plan);
      const size_t bands = halves ? (n + 1) / 2 : n; /* of a sample */
      for (size_t i = 0; i < n; i++) add_band(f, set, first + i, p, sum);
      for (int c = 0; c < 3; c++) sum[c] *= (halves ? 0.5 : 1) * white[c];
      abbe_difference_lab(sum, white, to);
      const double off = abbe_difference_ciede2000(lab, to);
      if (two && bands < 3) continue;
      *worst = fmax(*worst, off);
      if (off >= (!two ? 0.02 : bands < 7 ? 0.75 : 0.25))
        fail_msg("%s: %zu wavelengths, %zu bands of set %zu are %.3f CIEDE2000 off", what,
                 f->tables.all.count, n, set, off);
      if (!hued) continue;
      assert_true(abbe_chromaticity_xy(sum, xy));
      assert_true(abbe_chromaticity_dominant(xy, white_xy, ABBE_OBSERVER_CIE_1931, &got));
      assert_near(got.lambda_nm, wanted.lambda_nm, 2);
    }
}

/* Spheres of 6 mm: the colours hold for paths that are not usual, too. */
static void hold_stones(const char *company) {
  static const double length_m[] = {0.001, 0.003, 0.006, 0.01, 0.02};
  double worst = 0;
  for (size_t s = 0; s < sizeof stone / sizeof *stone; s++)
    for (size_t k = 0; k < COUNTS; k++) {
      fixture f;
      make(printed("- {name: stone, shape: sphere, radius: 0.003, centre: [0, 0, 0.2], material: "
                   "%s}\n%s",
                   stone[s], company),
           wavelengths[k], &f);
      for (size_t i = 0; i < sizeof length_m / sizeof *length_m; i++)
        for (int axis = 0; axis < 3; axis++)
          hold(&f, &(passage){{length_m[i], 0}, axis}, stone[s], &worst);
      done(&f);
    }
  print_message("stones are at most %.3f CIEDE2000 off\n", worst);
}

TEST(stones_have_their_colour_at_any_length) {
  hold_stones("");
}

/* Each sample takes every second band, and of its neighbours a share. */
TEST(stones_beside_glass_have_their_colour) {
  hold_stones(
      "- {name: b, shape: sphere, radius: 0.003, centre: [0.1, 0, 0.2], material: n-bk7}\n");
}

TEST(paths_through_two_stones_have_their_colour) {
  double worst = 0;
  for (size_t k = 0; k < COUNTS; k++) {
    fixture f;
    make("- {name: a, shape: sphere, radius: 0.003, centre: [0, 0, 0.2], material: ruby}\n"
         "- {name: b, shape: sphere, radius: 0.003, centre: [0.1, 0, 0.2], material: emerald}\n",
         wavelengths[k], &f);
    hold(&f, &(passage){{0.002, 0.009}, 0}, "ruby, then emerald", &worst);
    hold(&f, &(passage){{0.006, 0.001}, 2}, "ruby, then emerald", &worst);
    done(&f);
  }
  print_message("through two stones, %.3f\n", worst);
}

TEST(metals_have_their_colour_however_often_they_reflect) {
  double worst = 0;
  for (size_t k = 0; k < COUNTS; k++) {
    fixture f;
    make("- {name: a, shape: sphere, radius: 0.003, centre: [0, 0, 0.2], mirror: gold}\n"
         "- {name: b, shape: sphere, radius: 0.003, centre: [0.1, 0, 0.2], material: ruby}\n",
         wavelengths[k], &f);
    hold(&f, &(passage){{1, 0}, 0}, "gold", &worst);
    hold(&f, &(passage){{3, 0}, 0}, "gold, thrice", &worst);
    hold(&f, &(passage){{1, 0.004}, 0}, "ruby in gold", &worst);
    done(&f);
  }
  print_message("off gold, %.3f\n", worst);
}
