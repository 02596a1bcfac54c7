/* The wavelengths of the camera's rays: white stays white, and samples of a pixel take others. */
#include "tests/gl/plan/planned.h"

#include "colorimetry/upsampling.h"
#include "gl/scene/spectra/camera_bands.h"
#include "scenes/coating/coating.h"

enum { NODES = 7, COUNT = NODES + 4 + 2 + 1, SETS = ABBE_CAMERA_BAND_SETS };

typedef struct fixture {
  abbe_scene scene;
  abbe_plan plan;
  abbe_spectral_tables tables;
  abbe_camera_band band[2][SETS][COUNT];
  float texel[SETS * COUNT *
              (ABBE_BAND_COLOUR_TEXELS + 2 * ABBE_PART_TEXELS + ABBE_PART_LIGHT_TEXELS)][4];
} fixture;

static void make(const char *text, fixture *f) {
  const abbe_render_desc desc = {.wavelengths = NODES, .min_nm = 400, .max_nm = 700};
  size_t levels;
  assert_int_equal(abbe_camera_bands_count(NODES, &levels), COUNT);
  assert_int_equal(levels, 4);
  memset(f->band, 0, sizeof f->band);
  memset(f->texel, 0, sizeof f->texel);
  f->scene = scene_of(text);
  plan_scene(&f->scene, &desc, &f->plan);
  OK(abbe_spectral_tables_make(&f->scene, &f->plan, &f->tables, &error));
  OK(abbe_camera_bands_fill(&f->scene, &f->plan, &f->tables, f->band[0][0], f->texel, &error));
}

static void done(fixture *f) {
  abbe_spectral_tables_free(&f->tables);
  abbe_plan_free(&f->plan);
  abbe_scene_free(&f->scene);
}

TEST(every_level_of_every_set_is_white) {
  static const size_t count[] = {NODES, 4, 2, 1};
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("murk") BRICK("crown"), &f);
  assert_true(abbe_camera_bands_interleave(&f.plan));
  for (size_t r = 0; r < 2; r++)
    for (size_t set = 0; set < SETS; set++) {
      const abbe_camera_band *at = f.band[r][set];
      for (size_t level = 0; level < 4; at += count[level++])
        for (int c = 0; c < 3; c++) {
          /* samples that share the spectrum take the even bands, or the odd ones */
          const bool halves = set > 0 && count[level] > 2;
          double sum[2] = {0};
          for (size_t i = 0; i < count[level]; i++)
            sum[halves ? i % 2 : 0] += (double)at[i].weight_n[c];
          assert_near(sum[0], 1, 1e-6);
          assert_near(sum[1], halves ? 1 : 0, 1e-6);
        }
    }
  done(&f);
}

/* Of a red, seen by every band, what its own spectrum has there (upsampling.h), summed finely; of
 * the bands of a level together the red itself. */
TEST(a_colour_has_a_spectrum_of_its_own) {
  static const double red[3] = {0.7, 0.1, 0.05};
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown"), &f);
  abbe_upsampling lift;
  abbe_weights_range light;
  double xyz[3] = {0}, all[3] = {0};
  const abbe_illuminant *illuminant = abbe_scene_illuminant(&f.scene);
  OK(abbe_upsampling_make(illuminant, 400, 700, &lift, &error));
  abbe_weights_range_make(illuminant, 400, 700, &light);
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) xyz[c] += lift.to_xyz[3 * c + k] * red[k];
  for (size_t i = 0; i < NODES; i++) {
    const double from = i == 0 ? 400 : 375 + 50 * (double)i,
                 to = i == NODES - 1 ? 700 : 425 + 50 * (double)i;
    double should[3] = {0};
    for (double at = from; at < to; at += 0.5) {
      double step[3];
      abbe_weights_range_xyz(&light, at, at + 0.5, step);
      for (int c = 0; c < 3; c++) should[c] += step[c] * abbe_upsampling_at(&lift, red, at + 0.25);
    }
    for (int c = 0; c < 3; c++) {
      double shown = 0;
      for (int k = 0; k < 3; k++)
        shown += (double)f.texel[ABBE_BAND_COLOUR_TEXELS * i + (size_t)k][c] * xyz[k];
      shown *= (double)f.band[0][0][i].weight_n[c];
      all[c] += shown;
      assert_near(shown, should[c], 1e-4 * xyz[c]);
    }
  }
  for (int c = 0; c < 3; c++) assert_near(all[c], xyz[c], 1e-5 * xyz[c]);
  done(&f);
}

static double index_at(const fixture *f, double lambda_nm) {
  double n = 0;
  const abbe_material *material = f->scene.object[f->plan.refractor_object[0]].material;
  OK(abbe_material_n(material, lambda_nm, &n, &error));
  return n;
}

/* Of 400 to 700 by 50: bands from 400, 425, 475 ... 675, 700. */
TEST(shares_stand_a_quarter_apart) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown"), &f);
  for (size_t i = 0; i < NODES; i++) {
    const double from = i == 0 ? 400 : 375 + 50 * (double)i, wide = i % (NODES - 1) == 0 ? 25 : 50;
    assert_near((double)f.band[0][0][i].weight_n[3], index_at(&f, 400 + 50 * (double)i), 1e-7);
    for (size_t share = 0; share < ABBE_CAMERA_BAND_SHARES; share++)
      assert_near((double)f.band[0][1 + share][i].weight_n[3],
                  index_at(&f, from + ((double)share + 0.5) / 4 * wide), 1e-7);
  }
  done(&f);
}

/* Four samples of a pixel, each with the weights of its own, leave of a spectrum what four times as
 * many wavelengths do: a line of light that is narrower than a band shows less of the wrong
 * colours. Y of what lies below 500 nm, against the integral. */
TEST(together_they_tell_a_spectrum_better) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown"), &f);
  abbe_weights_range range;
  double all[3], below[3], one = 0, four = 0;
  const double edge = index_at(&f, 500.5);
  abbe_weights_range_make(abbe_scene_illuminant(&f.scene), 400, 700, &range);
  abbe_weights_range_xyz(&range, 400, 700, all);
  abbe_weights_range_xyz(&range, 400, 500.5, below);
  for (size_t i = 0; i < NODES; i++) {
    if ((double)f.band[0][0][i].weight_n[3] > edge) one += (double)f.band[0][0][i].weight_n[1];
    for (size_t share = 1; share < SETS; share++)
      if ((double)f.band[0][share][i].weight_n[3] > edge)
        four += 0.25 * (double)f.band[0][share][i].weight_n[1];
  }
  const double truth = below[1] / all[1];
  assert_true(fabs(four - truth) < 0.35 * fabs(one - truth));
  done(&f);
}

/* The tables' films, interpolated at angles between theirs as shaders do, beside the function: of a
 * photon's wavelength, of a band that is one line's, and beyond total reflection. */
static double film_error(const char *coating, double n) {
  enum { AT = 997, ANGLES = 2 * ABBE_FILM_ANGLES + 1 };
  const abbe_render_desc desc = {.wavelengths = NODES, .min_nm = 400, .max_nm = 700};
  OWNED(abbe_scene, scene) =
      scene_of(printed(CAMERA POINT_LIGHT FLOOR BALL("flat, coating: %s"), coating));
  FILLED(abbe_plan, plan, plan_scene(&scene, &desc, &plan));
  FILLED(abbe_spectral_tables, tables,
         OK(abbe_spectral_tables_make(&scene, &plan, &tables, &error)));
  FREED float(*texel)[4] = calloc(abbe_film_tables_texels(&scene, &plan), sizeof *texel);
  OK(abbe_film_tables_fill(&scene, &plan, &tables, texel, &error));
  assert_true(plan.filmed && texel[0][0] == 0);
  double worst = 0;
  for (size_t i = 0; i < NODES; i++)
    for (int k = 0; k < AT; k++) {
      const double c = (k + 0.5) / AT, inside = sqrt(1 - (1 - c * c) / n / n), deep = n * n - 1;
      const double beyond = sqrt(1 - (1 + deep * c * c) / n / n), glass[2] = {n, 0},
                   air[2] = {1, 0};
      abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
      abbe_film_light light;
      double exact[4], t;
      const abbe_coating *film = scene.object[plan.refractor_object[0]].coatings->coating;
      OK(abbe_coating_at(film, tables.all.lambda_nm[i], layer, &error));
      abbe_film_light_at(layer, film->count, false, 1, glass, c, tables.all.lambda_nm[i], &light);
      abbe_film_unpolarised(&light, &exact[0], &exact[2]);
      abbe_film_light_at(layer, film->count, true, n, air, inside, tables.all.lambda_nm[i], &light);
      abbe_film_unpolarised(&light, &exact[1], &t);
      assert_near(t, exact[2], 1e-9);
      abbe_film_light_at(layer, film->count, true, n, air, beyond, tables.all.lambda_nm[i], &light);
      abbe_film_unpolarised(&light, &exact[3], &t);
      for (int which = 0; which < 4; which++) {
        const double x = ABBE_FILM_ANGLES * (1 + (which < 3 ? c : -c / (1 + sqrt(1 - c * c))));
        const float(*at)[4] = (const float(*)[4])texel + 2 + i * ANGLES + (size_t)x;
        const int column = which < 3 ? which : 1;
        const double f = x - floor(x),
                     here = (1 - f) * (double)at[0][column] + f * (double)at[1][column];
        worst = fmax(worst, fabs(here - exact[which]));
      }
    }
  return worst;
}

TEST(films_are_near_their_function) {
  static const struct {
    const char *coating;
    double most;
  } rows[] = {{"{layers: [[1.38, 99.6]]}", 1e-3},
              {"{layers: [[2.4, 120]]}", 1e-3},
              {"{layers: [[[0.42, 2.4], 10]]}", 1e-3},
              {"{layers: [[1.38, 1], [2.15, 2], [1.7, 1]], quarter: 550}", 1e-3},
              {"{layers: [[2.4, 2000]]}", 2e-3}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const double found = film_error(rows[i].coating, 1.5);
    print_message("%s: %.2g\n", rows[i].coating, found);
    assert_true(found < rows[i].most);
  }
}
