#include "tests/validation/measure/gem/gem_stones.h"

#include "validation/measure/gem/gem_judgement.h"

static const abbe_gem_view_desc small = {
    .head_rad = 15 * DEG, .side = 32, .repeats = 4, .threads = 2};

static double mean(const abbe_gem_view *view, abbe_gem_amount amount) {
  return abbe_gem_view_amount(view, amount).value;
}

/* Light goes up and down between two faces: R + T^2 R / (1 - R^2) of it comes back. */
TEST(slab_returns_what_its_faces_reflect) {
  static const double index[] = {1.5, 2.417};
  for (int i = 0; i < 2; i++) {
    OWNED(judged, j) = judged_plain(slab, index[i]);
    OWNED(abbe_gem_view, view) = judged_view(&j, &small);
    const double n = index[i], r = pow((n - 1) / (n + 1), 2), back = 2 * r / (1 + r);
    assert_near(mean(&view, ABBE_GEM_ISO), back, 1e-4);
    assert_near(mean(&view, ABBE_GEM_COS), back, 1e-4);
    assert_near(mean(&view, ABBE_GEM_DOWN), 1 - back, 1e-4);
    assert_near(mean(&view, ABBE_GEM_BLUE), back, 1e-4);
    assert_near(mean(&view, ABBE_GEM_RETURN), 0, 1e-6);
  }
  OWNED(judged, j) = judged_plain(slab, 2.42);
  OWNED(abbe_gem_view, view) = judged_view(&j, &small);
  assert_near(mean(&view, ABBE_GEM_ISO), 0.294, 5e-4);
}

TEST(slab_absorbs_by_its_thickness) {
  static char name[] = "grey";
  const double nm[1] = {500}, per_m[1] = {60};
  abbe_material m =
      FIELDS(.name = name,
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}},
             .min_nm = 300, .max_nm = 800);
  OK(abbe_spectrum_make(nm, per_m, 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  judged j = judged_make(slab, &m, 3);
  abbe_gem_view view = judged_view(&j, &small);
  /* 10 mm wide, 5 mm thick */
  const double a = exp(-60 * 0.005), r = 0.04, t = 1 - r;
  const double down = t * t * a / (1 - r * r * a * a),
               up = r + t * t * r * a * a / (1 - r * r * a * a);
  assert_near(mean(&view, ABBE_GEM_DOWN), down, 1e-4);
  assert_near(mean(&view, ABBE_GEM_ISO), up, 1e-4);
  assert_near(mean(&view, ABBE_GEM_ABSORBED), 1 - up - down, 1e-4);
  abbe_gem_view_free(&view);
  judged_free(&j);
  abbe_spectrum_free(m.attenuation);
}

/* What the colour takes makes no window dark: the slab leaks more than the head is seen in it,
 * until its colour takes all but what the upper face reflects. */
TEST(colour_hides_no_window) {
  static char name[] = "grey";
  static const double nm[1] = {500}, per_m[] = {0, 60, 300, 2000, 1e6};
  for (int i = 0; i < 5; i++) {
    abbe_material m =
        FIELDS(.name = name,
               .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}},
               .min_nm = 300, .max_nm = 800);
    OK(abbe_spectrum_make(nm, &per_m[i], 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
    judged j = judged_make(slab, &m, 3);
    abbe_gem_view view = judged_view(&j, &small);
    abbe_gem_areas areas;
    OK(abbe_gem_view_areas(&view, &areas, &error));
    assert_near(areas.window.value, i < 3, 1e-12);
    assert_near(areas.extinct.value, i >= 3, 1e-12);
    abbe_gem_view_free(&view);
    judged_free(&j);
    abbe_spectrum_free(m.attenuation);
  }
}

/* A right angle sends light back where it came from, and all of it where both faces reflect
 * totally. */
TEST(roof_of_a_right_angle_is_all_blue) {
  static const double index[] = {1.4143, 1.54, 2.417};
  char text[256];
  roof_text(45, text);
  for (int i = 0; i < 3; i++) {
    OWNED(judged, j) = judged_plain(text, index[i]);
    OWNED(abbe_gem_view, view) = judged_view(&j, &small);
    assert_near(mean(&view, ABBE_GEM_BLUE), 1, 2e-4);
    assert_near(mean(&view, ABBE_GEM_COS), 1, 2e-4);
  }
  OWNED(judged, j) = judged_plain(text, 1.40);
  OWNED(abbe_gem_view, view) = judged_view(&j, &small);
  assert_true(mean(&view, ABBE_GEM_DOWN) > 0.3);
}

/* Off the axis' plane the first reflection of the table is no other: of the strongest exit. */
static double strongest_elevation(const char *text, double n, double x, double y) {
  OWNED(judged, j) = judged_plain(text, n);
  static abbe_gem_path path;
  const double o[3] = {x, y, 3}, d[3] = {0, 0, -1};
  double p[3], normal[3], elevation = 0;
  float most = 0;
  assert_true(abbe_gem_path_enter(&j.stone, o, d, p, normal));
  assert_near(normal[2], 1, 1e-12); /* by the table */
  abbe_gem_path_follow(&j.stone, 0, p, normal, d, 0, &path);
  for (size_t i = 1; i < path.count; i++)
    if (path.exit[i].share > most) {
      most = path.exit[i].share;
      elevation = asin((double)path.exit[i].d[2]) / DEG;
    }
  assert_true(most > 0.5f);
  return elevation;
}

static void brilliant_text(double pavilion_deg, char text[1024]) {
  /* its eight mains alone below the girdle, their culet where it was */
  snprintf(text, 1024,
           "GemCad 5.0\ng 96 0.0\na -90.0 1.0 93 " ROUND_INDICES
           "\na -%.9f %.9f 96 84 72 60 48 36 24 12\na 34.5 0.59810595 96 84 72 60 48 36 24 12\n"
           "a 0 0.34945832 96\n",
           pavilion_deg, 0.9 * cos(pavilion_deg * DEG));
}

/* Two faces of slope p turn light by 4 p - 180 degrees: it leaves the table at 45 where
 * n sin(180 - 4 p) = sin 45. */
TEST(table_turns_from_green_to_red_where_it_must) {
  const double n = 2.417, toggle = 45 - asin(sin(45 * DEG) / n) / DEG / 4;
  assert_near(toggle, 40.75, 0.005);
  char text[1024];
  for (int s = -1; s <= 1; s += 2) {
    const double slope = toggle + 0.005 * s;
    roof_text(slope, text);
    const double roof = strongest_elevation(text, n, 0, 0.1);
    assert_true(s < 0 ? roof < 45 : roof > 45);
    /* 180 - 4 p turns by 0.02 of a degree, and what leaves by four times as much */
    assert_near(roof, 45, 0.1);
    brilliant_text(slope, text);
    assert_near(strongest_elevation(text, n, 0, 0.1), roof, 1e-3);
  }
}

TEST(light_everywhere_makes_every_pixel_white) {
  OWNED(judged, j) = judged_plain(design_b, 2.417);
  abbe_gem_view_desc desc = small;
  for (int tilt = -30; tilt <= 30; tilt += 15) {
    desc.tilt_rad = tilt * DEG;
    desc.axis_rad = 45 * DEG;
    OWNED(abbe_gem_view, v) = judged_view(&j, &desc);
    for (size_t i = 0; i < v.side * v.side * v.repeats; i++) {
      const float *a = v.amount + i * ABBE_GEM_AMOUNT_COUNT;
      if (v.hit[i] == 0) continue;
      const double lost = (double)(a[ABBE_GEM_ABSORBED] + a[ABBE_GEM_LEFT]);
      assert_near(a[ABBE_GEM_ISO] + a[ABBE_GEM_DOWN], 1 - lost, 1e-5);
      assert_near(a[ABBE_GEM_GREEN] + a[ABBE_GEM_RED] + a[ABBE_GEM_BLUE] + a[ABBE_GEM_BELOW],
                  1 - lost, 1e-5);
      assert_near(a[ABBE_GEM_RETURN] + a[ABBE_GEM_HEAD], a[ABBE_GEM_ISO], 1e-5);
      assert_true(a[ABBE_GEM_COS] <= a[ABBE_GEM_ISO] + 1e-6f);
      assert_true(lost <= (double)ABBE_GEM_LEAST_SHARE);
    }
  }
}

TEST(shares_of_area_add_up) {
  OWNED(judged, j) = judged_plain(design_b, 1.38);
  OWNED(abbe_gem_view, v) = judged_view(&j, &small);
  abbe_gem_areas areas;
  OK(abbe_gem_view_areas(&v, &areas, &error));
  assert_near(areas.brilliant.value + areas.window.value + areas.extinct.value, 1, 1e-12);
  assert_true(areas.window.value > 0.2); /* below its critical angle */
  assert_true(areas.brilliant.error > 0 && areas.brilliant.error < 0.05);
  abbe_gem_view_free(&v);
  judged_free(&j);
  char text[256];
  roof_text(45, text);
  j = judged_plain(text, 1.54);
  v = judged_view(&j, &small);
  OK(abbe_gem_view_areas(&v, &areas, &error));
  assert_near(areas.extinct.value, 1, 1e-12); /* all from the head */
}

static double apart(abbe_gem_number a, abbe_gem_number b) {
  return fabs(a.value - b.value) / hypot(a.error, b.error);
}

/* Eight mains and mirrors: the same to either side, and about axes a quarter turn apart. */
TEST(tilts_have_the_symmetry_of_the_cut) {
  OWNED(judged, j) = judged_plain(design_b, 2.417);
  abbe_gem_view_desc desc = small;
  desc.side = 64;
  for (int t = 10; t <= 30; t += 20) {
    abbe_gem_number iso[3], window[3];
    static const double axis[3] = {0, 0, 90}, sign[3] = {1, -1, 1};
    for (int k = 0; k < 3; k++) {
      desc.axis_rad = axis[k] * DEG;
      desc.tilt_rad = sign[k] * t * DEG;
      OWNED(abbe_gem_view, v) = judged_view(&j, &desc);
      iso[k] = abbe_gem_view_amount(&v, ABBE_GEM_ISO);
      window[k] = abbe_gem_view_amount(&v, ABBE_GEM_DOWN);
    }
    for (int k = 1; k < 3; k++) {
      assert_true(apart(iso[0], iso[k]) < 5);
      assert_true(apart(window[0], window[k]) < 5);
    }
  }
}

TEST(errors_are_those_of_the_means) {
  OWNED(judged, j) = judged_plain(design_b, 2.417);
  abbe_gem_view_desc desc = small;
  OWNED(abbe_gem_view, coarse) = judged_view(&j, &desc);
  desc.side = 112;
  desc.repeats = 16;
  OWNED(abbe_gem_view, fine) = judged_view(&j, &desc);
  static const abbe_gem_amount amount[] = {ABBE_GEM_ISO, ABBE_GEM_COS, ABBE_GEM_RETURN,
                                           ABBE_GEM_GREEN, ABBE_GEM_RED};
  for (int k = 0; k < 5; k++) {
    const abbe_gem_number a = abbe_gem_view_amount(&coarse, amount[k]);
    const abbe_gem_number b = abbe_gem_view_amount(&fine, amount[k]);
    assert_true(b.error < a.error / 4);
    assert_true(apart(a, b) < 4);
  }
  abbe_gem_areas few, many;
  OK(abbe_gem_view_areas(&coarse, &few, &error));
  OK(abbe_gem_view_areas(&fine, &many, &error));
  assert_true(apart(few.brilliant, many.brilliant) < 4);
  assert_true(apart(few.window, many.window) < 4);
  assert_true(apart(few.extinct, many.extinct) < 4);
  assert_true(apart(abbe_gem_view_contrast(&coarse), abbe_gem_view_contrast(&fine)) < 4);
}

/* A trillion's cut: a triangle of bent sides. */
static const char trillion[] =
    "GemCad 5.0\ng 96 0.0\na -90.0 1.0 96 32 64\na -90.0 1.6 16 48 80\na -41.0 0.694 96 32 64\n"
    "a -39.0 0.72 4 92 28 36 60 68\na 35.0 0.6146 96 32 64\na 33 0.63 6 90 26 38 58 70\n"
    "a 0 0.35 96\n";

enum { MEASURES = 5 };

/* The squares of how many errors the measures of grids of few rays are from those of many. */
static void add_deviations(const char *text, double n, size_t grids, double square[MEASURES]) {
  OWNED(judged, j) = judged_plain(text, n);
  abbe_gem_number fine[MEASURES] = {{0}};
  for (size_t i = 0; i <= grids; i++) {
    abbe_gem_view_desc desc = small;
    desc.side = i == 0 ? 192 : 15 + i;
    OWNED(abbe_gem_view, v) = judged_view(&j, &desc);
    abbe_gem_areas areas;
    OK(abbe_gem_view_areas(&v, &areas, &error));
    const abbe_gem_number number[MEASURES] = {
        areas.window, areas.brilliant, abbe_gem_view_contrast(&v),
        abbe_gem_view_amount(&v, ABBE_GEM_RETURN), abbe_gem_view_amount(&v, ABBE_GEM_ISO)};
    for (int k = 0; k < MEASURES; k++) {
      if (i == 0) fine[k] = number[k];
      if (i == 0) continue;
      const double far = apart(number[k], fine[k]);
      assert_true(far < 3.5);
      square[k] += far * far;
    }
  }
}

/* Of two cuts: so many deviations spread as a normal error's do. */
TEST(errors_say_how_far_grids_are_apart) {
  enum { GRIDS = 40 };
  double square[MEASURES] = {0};
  add_deviations(design_b, 2.417, GRIDS, square);
  add_deviations(trillion, 2.16, GRIDS, square);
  for (int k = 0; k < MEASURES; k++) {
    const double spread = sqrt(square[k] / (2 * GRIDS));
    print_message("measure %d: r.m.s. of %.3f errors\n", k, spread);
    assert_true(spread > 0.8 && spread < 1.15);
  }
}

TEST(threads_change_nothing) {
  OWNED(judged, j) = judged_plain(design_b, 2.417);
  abbe_gem_view_desc desc = small;
  desc.threads = 1;
  OWNED(abbe_gem_view, one) = judged_view(&j, &desc);
  desc.threads = 5;
  OWNED(abbe_gem_view, five) = judged_view(&j, &desc);
  for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++) {
    const abbe_gem_number x = abbe_gem_view_amount(&one, (abbe_gem_amount)a);
    const abbe_gem_number y = abbe_gem_view_at(&five, (abbe_gem_amount)a, 0);
    assert_near(x.value, y.value, 1e-6);
    const abbe_gem_number z = abbe_gem_view_amount(&five, (abbe_gem_amount)a);
    assert_memory_equal(&x, &z, sizeof x);
  }
  assert_memory_equal(one.colour, five.colour, sizeof one.colour);
}

/* A slab's picture is even. One of stripes, three tenths of a pixel wide, has their share of area
 * and their contrast, however coarse the pixels. */
TEST(areas_and_contrast_do_not_depend_on_the_grid) {
  const double share = 0.3;
  OWNED(judged, j) = judged_plain(slab, 1.5);
  abbe_gem_view_desc desc = small;
  desc.head_rad = 0;
  for (size_t side = 16; side <= 64; side *= 2) {
    desc.side = side;
    OWNED(abbe_gem_view, v) = judged_view(&j, &desc);
    assert_near(abbe_gem_view_contrast(&v).value, 0, 1e-3);
    for (size_t i = 0; i < side * side * v.repeats; i++) {
      const size_t pixel = i / v.repeats;
      float *amount = &v.amount[i * ABBE_GEM_AMOUNT_COUNT];
      double x, y;
      abbe_gem_eye_place(side, pixel % side, pixel / side, i % v.repeats, &x, &y);
      amount[ABBE_GEM_RETURN] = x < share;
      amount[ABBE_GEM_DOWN] = 1 - amount[ABBE_GEM_RETURN];
    }
    abbe_gem_areas areas;
    OK(abbe_gem_view_areas(&v, &areas, &error));
    const abbe_gem_number contrast = abbe_gem_view_contrast(&v);
    assert_true(fabs(areas.brilliant.value - share) < 5 * areas.brilliant.error);
    assert_true(areas.brilliant.error < 0.5 / (double)side);
    assert_true(fabs(contrast.value - sqrt((1 - share) / share)) < 5 * contrast.error);
    assert_true(contrast.error < 2 / (double)side);
  }
}

static double deviations(abbe_gem_number n, double known) {
  return fabs(n.value - known) / n.error;
}

/* A slab of calcite, its axis in the face: between two faces each wave keeps to itself, and of both
 * together the half comes back of 0.1155736 and of 0.0736532. */
TEST(slab_of_calcite_returns_what_each_wave_does) {
  const abbe_material calcite = crystal(1.65834, 1.65834, 1.48613);
  OWNED(judged, j) = judged_make(slab, &calcite, 1);
  abbe_gem_axes lying;
  OK(abbe_gem_axes_read("0,2,0", &lying, &error));
  OK(abbe_gem_stone_turn(&j.stone, &lying, &error));
  OWNED(abbe_gem_view, view) = judged_view(&j, &small);
  assert_true(deviations(abbe_gem_view_amount(&view, ABBE_GEM_ISO), (0.1155736 + 0.0736532) / 2) <
              6);
  assert_near(mean(&view, ABBE_GEM_ISO), (0.1155736 + 0.0736532) / 2, 1e-3);
}

/* Two exponentials, never one of the mean: 10 mm wide, 5 mm thick. */
TEST(slab_of_tourmaline_absorbs_each_wave_by_itself) {
  const double nm[1] = {500}, a_o[1] = {400}, a_e[1] = {60}, n[2] = {1.644, 1.624};
  abbe_material m = crystal(n[0], n[0], n[1]);
  OK(abbe_spectrum_make(nm, a_o, 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  OK(abbe_spectrum_make(nm, a_e, 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation_yz[1], &error));
  judged j = judged_make(slab, &m, 2);
  const abbe_gem_axes lying = {.z = {1, 0, 0}};
  OK(abbe_gem_stone_turn(&j.stone, &lying, &error));
  abbe_gem_view view = judged_view(&j, &small);
  double down = 0;
  for (int wave = 0; wave < 2; wave++) {
    const double r = pow((n[wave] - 1) / (n[wave] + 1), 2),
                 a = exp(-0.005 * (wave == 0 ? a_o[0] : a_e[0]));
    down += 0.5 * (1 - r) * (1 - r) * a / (1 - r * r * a * a);
  }
  assert_true(deviations(abbe_gem_view_amount(&view, ABBE_GEM_DOWN), down) < 6);
  assert_near(mean(&view, ABBE_GEM_DOWN), down, 0.01);
  abbe_gem_view_free(&view);
  judged_free(&j);
  abbe_spectrum_free(m.attenuation);
  abbe_spectrum_free(m.attenuation_yz[1]);
}

/* A quartz brilliant in zircon, peridot and sphene without their colour, by abbe's tracer: the
 * axis upright and lying, of three indices z up and x up. Its lying zircon is known to 0.4 %. */
TEST(brightness_knows_how_a_crystal_lies) {
  static const struct {
    double n[3], upright, lying, off;
  } stones[] = {{{1.925, 1.925, 1.984}, 0.890, 0.851, 0.008},
                {{1.654, 1.672, 1.690}, 0.947, 0.885, 0.008},
                {{1.900, 1.907, 2.034}, 0.903, 0.823, 0.012}};
  const abbe_gem_view_desc view = {.side = 64, .repeats = 4, .threads = 2};
  for (size_t i = 0; i < sizeof stones / sizeof *stones; i++) {
    const double *n = stones[i].n;
    const abbe_material m = crystal(n[0], n[1], n[2]);
    OWNED(judged, j) = judged_make(design_a, &m, 1);
    abbe_gem_orientation up = {0}, down = {.tilt_rad = 90 * DEG};
    OK(abbe_gem_orientation_judge(&j.stone, &j.weights, &view, ABBE_GEM_ISO, &up, &error));
    OK(abbe_gem_orientation_judge(&j.stone, &j.weights, &view, ABBE_GEM_ISO, &down, &error));
    assert_near(up.value.value, stones[i].upright, stones[i].off);
    assert_near(down.value.value, stones[i].lying, stones[i].off);
    assert_true(up.value.error < 0.005 && down.value.error < 0.005);
  }
}

/* Nearly one index is one index. */
TEST(two_indices_that_meet_are_one) {
  const abbe_material near = crystal(1.76, 1.76, 1.76000001);
  judged glass_one = judged_plain(design_a, 1.76);
  OWNED(judged, crystal_one) = judged_make(design_a, &near, 1);
  abbe_gem_view a = judged_view(&glass_one, &small), b = judged_view(&crystal_one, &small);
  assert_true(
      apart(abbe_gem_view_amount(&a, ABBE_GEM_ISO), abbe_gem_view_amount(&b, ABBE_GEM_ISO)) < 4);
  abbe_gem_view_free(&a);
  abbe_gem_view_free(&b);
  judged_free(&glass_one);
}

TEST(axes_that_are_none_are_refused) {
  static const char *const wrong[] = {"1,0", "0,0,0", "1,0,0,", "1,0,0,0,1", "1,0,0,0,1,0,0", "up"};
  abbe_gem_axes axes = {.z = {0, 0, 1}, .x = {0, 0, -2}};
  const abbe_material topaz = crystal(1.607, 1.610, 1.617);
  judged plain = judged_plain(slab, 1.5);
  OWNED(judged, three) = judged_make(slab, &topaz, 1);
  REFUSED(ABBE_INVALID_ARGUMENT, "no axis", abbe_gem_stone_turn(&plain.stone, &axes, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "parallel", abbe_gem_stone_turn(&three.stone, &axes, &error));
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, wrong[i], abbe_gem_axes_read(wrong[i], &axes, &error));
  judged_free(&plain);
}

TEST(wrong_requests_are_refused) {
  OWNED(judged, j) = judged_plain(slab, 1.5);
  static const abbe_gem_view_desc wrong[] = {
      {.side = 4000}, {.repeats = 1}, {.repeats = 65}, {.head_rad = -0.1}, {.head_rad = 0.8}};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    abbe_gem_view view;
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_gem_view_make(&j.stone, &j.weights, &wrong[i], &view, &error));
    assert_true(last_error.text[0] != '\0');
  }
}

/* Two designs and what GemRay says of them at an index of 1.54, with its eye ten half widths away:
 * ISO and COS, with the shadow of the head and without one. Here the eye is far away. */
TEST(gemray_says_the_same) {
#define TEETH_16 "3 9 15 21 27 33 39 45 51 57 63 69 75 81 87 93\n"
#define TEETH_8 "12 24 36 48 60 72 84 96\n"
#define BETWEEN_8 "6 18 30 42 54 66 78 90\n"
#define TEETH_24 "2 6 10 14 18 22 26 30 34 38 42 46 50 54 58 62 66 70 74 78 82 86 90 94\n"
#define TEETH_OTHER_16 "2 10 14 22 26 34 38 46 50 58 62 70 74 82 86 94\n"
  static const struct {
    const char *text;
    double iso, cos, all, all_cos;
  } stones[] = {{"GemCad 5.0\ng 96 0.0\na -90 1 " TEETH_16 "a -45 0.70710678 " TEETH_16
                 "a -43 0.69535950 " TEETH_8 "a 47 0.75863364 " TEETH_16 "a 42 0.71196544 " TEETH_8
                 "a 27 0.65206207 " BETWEEN_8 "a 0 0.48398214 96\n",
                 0.8217, 0.3468, 0.9564, 0.4808},
                {"GemCad 5.0\ng 96 0.0\na -90 1 " TEETH_24 "a -42 0.67490451 " TEETH_8
                 "a -43 0.68199836 " TEETH_OTHER_16 "a -43.53 0.68873429 " BETWEEN_8
                 "a 32 0.56841384 " TEETH_8 "a 34.5 0.59937128 " TEETH_OTHER_16
                 "a 36.22 0.62315748 " BETWEEN_8 "a 18 0.47933751 " BETWEEN_8 "a 0 0.35029261 96\n",
                 0.6376, 0.4502, 0.9734, 0.7848}};
  const abbe_gem_view_desc fine = {.side = 128, .repeats = 4, .threads = 2};
  for (size_t i = 0; i < sizeof stones / sizeof *stones; i++) {
    OWNED(judged, j) = judged_plain(stones[i].text, 1.54);
    OWNED(abbe_gem_view, view) = judged_view(&j, &fine);
    assert_near(mean(&view, ABBE_GEM_GEMRAY_ISO), stones[i].iso, 0.003);
    assert_near(mean(&view, ABBE_GEM_GEMRAY_COS), stones[i].cos, 0.003);
    assert_near(mean(&view, ABBE_GEM_ISO), stones[i].all, 0.003);
    assert_near(mean(&view, ABBE_GEM_COS), stones[i].all_cos, 0.003);
  }
}

/* One exit at the angle a to the eye's line, whatever way the eye looks: e counts from the plane
 * across that line, and the head is dark within 10 degrees of it. */
TEST(gemray_s_weights_are_of_the_angle_to_the_eye) {
  const double eye[3] = {0.6, 0, 0.8}, across[3] = {-0.8, 0, 0.6};
  const struct {
    double angle_deg;
    bool lit;
  } exits[] = {{5, false}, {9.9, false}, {10.1, true}, {40, true}, {89, true}, {91, false}};
  const abbe_gem_light light = abbe_gem_light_make(eye, 15 * ABBE_DEGREE);
  FREED abbe_gem_path *path = calloc(1, sizeof *path);
  path->count = 1;
  path->exit[0].share = 0.5f;
  for (size_t i = 0; i < sizeof exits / sizeof *exits; i++) {
    const double a = exits[i].angle_deg * ABBE_DEGREE, lit = exits[i].lit ? 0.5 : 0;
    float amount[ABBE_GEM_AMOUNT_COUNT];
    for (int k = 0; k < 3; k++) path->exit[0].d[k] = (float)(cos(a) * eye[k] + sin(a) * across[k]);
    abbe_gem_light_judge(&light, path, amount);
    assert_near((double)amount[ABBE_GEM_GEMRAY_ISO], lit, 1e-7);
    assert_near((double)amount[ABBE_GEM_GEMRAY_COS], lit * cos(a), 1e-6);
    assert_near((double)amount[ABBE_GEM_GEMRAY_SC2], lit * 2 * cos(a) * sqrt(1 - cos(a) * cos(a)),
                1e-6);
  }
}
