/* What is evaluated over the spectrum once for all passes, and again where a material changes. */
#include "tests/check.h"

#include "gl/plan/examine/examine.h"
#include "gl/scene/spectra/spectral_tables.h"
#include "spectral/formats/material_import.h"
#include "spectral/optics.h"
#include "tests/gl/plan/planned.h"

enum { NODES = 9 };

typedef struct fixture {
  abbe_scene scene;
  abbe_plan plan;
  abbe_spectral_tables tables;
} fixture;

static void make(const char *text, fixture *f) {
  const abbe_render_desc desc = {.wavelengths = NODES, .min_nm = 400, .max_nm = 700};
  f->scene = scene_of(text);
  plan_scene(&f->scene, &desc, &f->plan);
  assert_true(f->plan.caustics);
  OK(abbe_spectral_tables_make(&f->scene, &f->plan, &f->tables, &error));
}

static void done(fixture *f) {
  abbe_spectral_tables_free(&f->tables);
  abbe_spectral_tables_free(&f->tables);
  abbe_plan_free(&f->plan);
  abbe_scene_free(&f->scene);
}

static void check_materials(const fixture *f) {
  const abbe_spectral_tables *t = &f->tables;
  for (size_t i = 0; i < f->plan.refractor_count; i++) {
    const abbe_material *material = f->scene.object[f->plan.refractor_object[i]].material;
    assert_near(t->attenuation_550[i], abbe_material_attenuation(material, 550), 0);
    for (size_t k = 0; k < NODES; k++) {
      double n = 0;
      const double lambda_nm = t->all.lambda_nm[k];
      OK(abbe_material_n(material, lambda_nm, &n, &error));
      assert_near(t->index[i * NODES + k], n, 0);
      assert_near(t->attenuation[i * NODES + k], abbe_material_attenuation(material, lambda_nm), 0);
    }
  }
}

/* Y (channel 1) or a band of all intervals of the first light and refractor. */
static double sum_of(const fixture *f, const float (*row)[4], size_t nodes, int channel) {
  const size_t an_interval = abbe_interval_sums_texels(&f->plan) * (f->tables.steps + 1);
  const size_t last = an_interval - abbe_interval_sums_texels(&f->plan);
  double sum = 0;
  for (size_t i = 0; i <= nodes; i++) sum += (double)row[i * an_interval + last][channel];
  return sum;
}

static const float (*rows_of_all(const fixture *f, const float (*table)[4]))[4] {
  return table + abbe_interval_sums_size(&f->plan, f->tables.steps, f->tables.coarse.count);
}

TEST(every_sampling_holds_all_of_the_light) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("murk"), &f);
  const abbe_spectral_tables *t = &f.tables;
  const size_t coarse = t->coarse.count;
  double all_y = 0, coarse_y = 0, mean = 0;
  assert_true(coarse < NODES && t->tints != NULL);
  check_materials(&f);
  for (size_t i = 0; i < NODES; i++) {
    all_y += (double)t->sample_weight[i][0] + (double)t->sample_weight[i][1];
    coarse_y += (double)t->sample_weight[i][2] + (double)t->sample_weight[i][3];
  }
  for (size_t i = 0; i + 1 < coarse; i++)
    mean += (double)t->interval_weight[i] / (double)(coarse - 1);
  assert_near(all_y, 1, 1e-6);
  assert_near(coarse_y, 1, 1e-6);
  assert_near(mean, 1, 1e-6);
  const float(*table)[4] = (const float(*)[4])t->intervals;
  assert_near(sum_of(&f, table, coarse, 1), 1, 1e-6);
  assert_near(sum_of(&f, rows_of_all(&f, table), NODES, 1), 1, 1e-6);
  done(&f);
}

/* A path lists how much it passed of a tint, by whatever refractor: they attenuate alike. */
TEST(refractors_of_one_tint_have_its_parts) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("murk") BRICK("murk"), &f);
  assert_true(f.plan.tints == 1 && f.plan.refractor_count == 2);
  const float *ball = (const float *)f.tables.tints, *brick = ball + 4 * ABBE_TINT_TEXELS;
  const size_t nodes = f.tables.coarse.count + f.tables.all.count;
  for (size_t i = 0; i < nodes * 2 * 4 * ABBE_TINT_TEXELS; i += 2 * 4 * ABBE_TINT_TEXELS)
    for (size_t k = 0; k < 4 * ABBE_TINT_TEXELS; k++) assert_near(ball[i + k], brick[i + k], 0);
  done(&f);
}

/* Four bands of the range, three and then the last. */
TEST(bands_tile_the_light) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown"), &f);
  double sum = 0;
  for (size_t first = 0; first < 4; first += 3) {
    float(*table)[4] = NULL;
    OK(abbe_spectral_tables_intervals(&f.tables, &f.scene, &f.plan, 4, first, &table, &error));
    for (int c = 0; c < 3 && first + (size_t)c < 4; c++)
      sum += sum_of(&f, rows_of_all(&f, (const float(*)[4])table), NODES, c);
    free(table);
  }
  assert_near(sum, 1, 1e-6);
  done(&f);
}

TEST(remade_tables_follow_the_material) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("crown") RING("dense"), &f);
  const double before = f.tables.index[0];
  f.scene.object[1].material = f.scene.object[2].material;
  abbe_spectral_tables_free(&f.tables);
  OK(abbe_spectral_tables_make(&f.scene, &f.plan, &f.tables, &error));
  assert_true(f.tables.index[0] > before + 0.5);
  check_materials(&f);
  done(&f);
}

TEST(an_unknown_index_is_an_error) {
  fixture f;
  make(CAMERA POINT_LIGHT FLOOR BALL("narrow"), &f);
  abbe_spectral_tables_free(&f.tables);
  f.plan.desc.max_nm = 710;
  REFUSED(ABBE_OUT_OF_RANGE, "narrow",
          abbe_spectral_tables_make(&f.scene, &f.plan, &f.tables, &error));
  done(&f);
}

TEST(coarse_nodes_reach_both_ends_in_order) {
  for (size_t n = 5; n <= ABBE_RENDER_MAX_WAVELENGTHS; n++) {
    assert_int_equal(abbe_spectral_tables_node(n, 5, 0), 0);
    assert_int_equal(abbe_spectral_tables_node(n, 5, 4), n - 1);
    for (size_t k = 0; k < 4; k++)
      assert_true(abbe_spectral_tables_node(n, 5, k) < abbe_spectral_tables_node(n, 5, k + 1));
  }
}

/* Of lines each is a node: all light is there, at the beginning or at the end of an interval. */
TEST(lines_are_nodes_and_nothing_lies_between) {
  static const struct {
    const char *illuminant;
    size_t lines;
  } lamps[] = {{"mercury", 6}, {"sodium", 2}, {"632.8nm", 1}};
  for (size_t i = 0; i < sizeof lamps / sizeof *lamps; i++) {
    double line[ABBE_ILLUMINANT_MOST_LINES];
    const char *text = printed(
        CAMERA "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: "
               "1, illuminant: %s}\n" FLOOR BALL("crown"),
        lamps[i].illuminant);
    fixture f;
    const abbe_render_desc desc = {0};
    f.scene = scene_of(text);
    plan_scene(&f.scene, &desc, &f.plan);
    assert_int_equal(f.plan.lines, lamps[i].lines);
    OK(abbe_spectral_tables_make(&f.scene, &f.plan, &f.tables, &error));
    const abbe_spectral_tables *t = &f.tables;
    const size_t nodes = t->all.count;
    assert_int_equal(nodes, lamps[i].lines);
    assert_int_equal(t->coarse.count, nodes);
    assert_int_equal(abbe_illuminant_lines(&f.scene.light[0].illuminant, line), nodes);
    for (size_t k = 0; k < nodes; k++) assert_near(t->all.lambda_nm[k], line[k], 1.001e-3);
    const float(*table)[4] = (const float(*)[4])t->intervals;
    assert_near(sum_of(&f, table, nodes, 1), 1, 1e-6);
    const size_t texels = abbe_interval_sums_texels(&f.plan), an_interval = texels * (t->steps + 1);
    for (size_t row = 0; row <= nodes && nodes > 1; row++)
      for (size_t k = 0; k <= t->steps; k++) {
        const float along = table[row * an_interval + k * texels][3];
        assert_true(along == 0 || along == 1);
      }
    done(&f);
  }
}

/* What is asked for, and light of other kinds, keep the even spacing. */
TEST(wavelengths_are_even_where_not_all_light_is_of_lines) {
  double line[ABBE_PLAN_MOST_LINES];
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA "lights:\n- {name: lamp, kind: point, position: [0, 0, 1], intensity: 1, "
                      "illuminant: hydrogen}\n- {name: laser, kind: point, position: [0, 1, 1], "
                      "intensity: 1, illuminant: 632.8nm}\n" FLOOR BALL("crown"));
  assert_int_equal(abbe_spectral_needs_lines(&scene, 380, 780, line), 6);
  assert_near(line[3], 632.8, 0);
  assert_int_equal(abbe_spectral_needs_lines(&scene, 480, 640, line), 2);
  const abbe_render_desc asked = {.wavelengths = 7};
  FILLED(abbe_plan, plan, plan_scene(&scene, &asked, &plan));
  assert_int_equal(plan.lines, 0);
  assert_int_equal(plan.desc.wavelengths, 7);
  abbe_scene_free(&scene);
  scene = scene_of(
      CAMERA
      "lights:\n- {name: lamp, kind: point, position: [0, 0, 1], intensity: 1, illuminant: "
      "hydrogen}\n- {name: day, kind: point, position: [0, 1, 1], intensity: 1}\n" FLOOR BALL(
          "crown"));
  assert_int_equal(abbe_spectral_needs_lines(&scene, 380, 780, line), 0);
}

/* What mirrors reflect at the renderer's wavelengths, against sums over the metal's whole spectrum.
 */

enum { MIRROR_NODES_NODES = 7, FINE = 4000 };

static abbe_material_table table;
static abbe_object gold;
static abbe_wavelengths w;
static abbe_mirror_node node[MIRROR_NODES_NODES];
static const abbe_illuminant white = {.kind = ABBE_ILLUMINANT_D65};
static abbe_weights_range range;

static void mirror_nodes_make(void) {
  OK(abbe_material_table_load(NULL, &table, &error));
  OK(abbe_material_table_find(&table, "gold", &gold.conductor, &error));
  gold.mirror = true;
  OK(abbe_wavelengths_make(MIRROR_NODES_NODES, 380, 780, &w, &error));
  abbe_weights_range_make(&white, 380, 780, &range);
  OK(abbe_mirror_nodes_fill(&gold, &w, &range, node, &error));
}

static void drop(void) {
  abbe_wavelengths_free(&w);
  abbe_material_table_free(&table);
}

/* At normal incidence. */
static double node_reflects(const abbe_mirror_node *at) {
  return abbe_mirror_reflected(at->n, at->k, at->factor);
}

static double straight_at(double lambda_nm) {
  double n, k;
  OK(abbe_material_nk(gold.conductor, lambda_nm, &n, &k, &error));
  return abbe_optics_fresnel_conductor(1, n, k);
}

/* Y of what a white light has after so many reflections; polygon: by the nodes. */
static double reflected_y(bool polygon, int times) {
  double sum = 0, xyz[3];
  for (int i = 0; i < FINE; i++) {
    const double a = 380 + 400.0 * i / FINE, b = 380 + 400.0 * (i + 1) / FINE, at = 0.5 * (a + b);
    const double place = (at - 380) / 400 * (MIRROR_NODES_NODES - 1), t = place - floor(place);
    const size_t k = (size_t)place;
    abbe_weights_range_xyz(&range, a, b, xyz);
    sum += xyz[1] * (polygon ? (1 - t) * pow(node_reflects(&node[k]), times) +
                                   t * pow(node_reflects(&node[k + 1]), times)
                             : pow(straight_at(at), times));
  }
  return sum;
}

GROUP(mirror_nodes_make, drop);

TEST(seven_nodes_tell_a_metals_light) {
  const double once = reflected_y(true, 1) / reflected_y(false, 1);
  const double twice = reflected_y(true, 2) / reflected_y(false, 2);
  print_message("gold at seven nodes: %.5f of the light, %.5f of it reflected twice\n", once,
                twice);
  assert_near(once, 1, 2e-3);
  assert_near(twice, 1, 0.02); /* squares of what is straight between two nodes */
}

TEST(a_number_is_reflected_as_it_is) {
  const abbe_object grey = {.mirror = true, .mirror_reflectance = 0.7};
  abbe_mirror_node at[MIRROR_NODES_NODES];
  OK(abbe_mirror_nodes_fill(&grey, &w, &range, at, &error));
  for (int i = 0; i < MIRROR_NODES_NODES; i++) {
    assert_true(at[i].k < 0);
    assert_near(node_reflects(&at[i]), 0.7, 1e-15);
  }
  assert_near(abbe_mirror_reflected(0, -1, abbe_mirror_factor(0, -1, 0.7)), 0.7, 1e-15);
}
