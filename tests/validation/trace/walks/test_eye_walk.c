#include "tests/validation/trace_scene.h"

#include "base/maths.h"
#include "validation/trace/tracer/tracer_state.h"

/* The camera looks straight down at (0.1, 0) of the floor, through so small an angle that all of
 * the picture is one place. */
#define DOWN                                                                                       \
  "materials: glass.yaml\ncamera: {eye: [0.1, 0, 1], target: [0.1, 0, 0], up: [0, 1, 0], fov: "    \
  "0.1}\n"
#define LIGHT(text) "lights:\n- {name: lamp, " text "}\n"
#define SLAB(material)                                                                             \
  "- {name: slab, shape: box, size: [0.4, 0.4, 0.1], transform: [{translate: [0.1, 0, 0.3]}], "    \
  "material: " material "}\n"
#define GROUND "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0}\n"
#define GLASS_ONLY(material)                                                                       \
  "objects:\n"                                                                                     \
  "- {name: ball, shape: sphere, radius: 0.08, transform: [{translate: [0.1, 0, 0.3]}], "          \
  "material: " material "}\n" GROUND

typedef struct fixture {
  abbe_scene scene;
  abbe_tracer *tracer;
  size_t objects;
} fixture;

static void make_with(const char *text, const abbe_trace_desc *desc, size_t objects, fixture *f) {
  f->scene = scene_of(text);
  f->objects = f->scene.object_count;
  if (objects > 0) f->scene.object_count = objects; /* the last ones are not there */
  f->tracer = make_tracer(&f->scene, desc);
}

static void make(const char *text, fixture *f) {
  make_with(text,
            &(abbe_trace_desc){
                .width = 4, .height = 4, .no_map = true, .threads = 1, .space = ABBE_RGB_SPACE_XYZ},
            0, f);
}

static void fixture_free(fixture *f) {
  abbe_tracer_free(f->tracer);
  f->scene.object_count = f->objects;
  abbe_scene_free(&f->scene);
}

/* Mean and standard error of each channel over all pixels and `passes` passes. */
static void look(const fixture *f, uint32_t passes, double mean[3], double error[3]) {
  if (SANITIZED && passes >= 4000) passes /= 8;
  double sum[3] = {0}, square[3] = {0}, count = 0;
  const abbe_trace_camera *c = f->tracer->eye.camera;
  for (uint32_t pass = 0; pass < passes; pass++)
    for (size_t pixel = 0; pixel < c->width * c->height; pixel++) {
      abbe_eye_sample s;
      abbe_eye_walk_pixel(&f->tracer->eye, pixel, pass, &s);
      count++;
      for (int k = 0; k < 3; k++) {
        sum[k] += (double)s.rgb[k];
        square[k] += (double)s.rgb[k] * (double)s.rgb[k];
      }
    }
  for (int k = 0; k < 3; k++) {
    mean[k] = sum[k] / count;
    error[k] = sqrt(fmax(square[k] / count - mean[k] * mean[k], 0) / count);
  }
}

/* The picture is `radiance` times the light's white, to `share` of it. */
static void check_radiance(const char *text, double radiance, double share) {
  double mean[3], error[3];
  FILLED(fixture, f, make(text, &f));
  look(&f, 1, mean, error);
  for (int k = 0; k < 3; k++)
    assert_near(mean[k], radiance * (double)f.tracer->white[0][k], share * radiance + 1e-12);
}

/* A matte floor of reflectance 1/2 returns E / (2 pi). */
TEST(direct_light_on_a_plane) {
  check_radiance(DOWN LIGHT("kind: point, position: [0.1, 0, 0.5], intensity: 3") FLOOR,
                 3 / 0.25 * 0.5 / ABBE_PI, 1e-5);
  /* slanted: I cos^3 / h^2; the picture's place varies by 1e-3 m */
  double tangent = 0.4 / 0.5, cosine = 1 / sqrt(1 + tangent * tangent);
  check_radiance(DOWN LIGHT("kind: point, position: [0.5, 0, 0.5], intensity: 3") FLOOR,
                 3 * pow(cosine, 3) / 0.25 * 0.5 / ABBE_PI, 2e-3);
  check_radiance(DOWN LIGHT("kind: directional, direction: [3, 0, -4], irradiance: 7") FLOOR,
                 7 * 0.8 * 0.5 / ABBE_PI, 1e-5);
}

/* A spot's cone is where it is, also one of a twentieth of a degree. */
TEST(spots_end_where_they_end) {
  static const double cones[] = {40, 3, 0.05};
  for (int i = 0; i < 3; i++)
    for (int inside = 0; inside < 2; inside++) {
      char text[1024];
      /* the place seen lies off the spot's axis by 0.98 or 1.02 of the cone */
      double off = tan(cones[i] * ABBE_PI / 180 * (inside ? 0.98 : 1.02));
      snprintf(
          text, sizeof text,
          "materials: glass.yaml\ncamera: {eye: [0.1, 0, 1], target: [%.9g, 0, 0], up: [0, 1, 0], "
          "fov: 0.1, size: [1000, 1000]}\n" LIGHT(
              "kind: spot, position: [0.1, 0, 1], direction: [0, 0, -1], intensity: 3, cone: %g")
              FLOOR,
          0.1 + off, cones[i]);
      OWNED(fixture, f) = {0};
      double mean[3], error[3], cosine = cos(atan(off));
      make_with(text, &(abbe_trace_desc){.width = 1, .height = 1, .no_map = true, .threads = 1}, 0,
                &f);
      /* one ray through the middle, rather than all of the picture, which is as wide as the cone */
      f.tracer->camera.half_width = f.tracer->camera.half_height = 1e-9f;
      look(&f, 1, mean, error);
      assert_near(mean[1] / (double)f.tracer->white[0][1],
                  inside ? 3 * pow(cosine, 3) * 0.5 / ABBE_PI : 0, 1e-4);
    }
}

/* A disk of radius R, radiance L, over a place at height h facing it: E = pi L R^2 / (R^2 + h^2);
 * off its axis by x: pi L / 2 (1 - (h^2 + x^2 - R^2) / sqrt((h^2 + x^2 + R^2)^2 - 4 x^2 R^2)). */
TEST(a_disks_irradiance) {
  for (int i = 0; i < 2; i++) {
    const char *text = i ? DOWN LIGHT("kind: disk, position: [0.5, 0, 0.3], direction: [0, 0, -1], "
                                      "radius: 0.2, radiance: 5") FLOOR
                         : DOWN LIGHT("kind: disk, position: [0.1, 0, 0.3], direction: [0, 0, -1], "
                                      "radius: 0.2, radiance: 5") FLOOR;
    double h = 0.3, x = i ? 0.4 : 0, r = 0.2, mean[3], error[3];
    double a = h * h + x * x + r * r;
    double share = 0.5 * (1 - (h * h + x * x - r * r) / sqrt(a * a - 4 * x * x * r * r));
    FILLED(fixture, f, make(text, &f));
    /* from above the eye would see the lamp's dark back */
    float eye[3];
    abbe_geometry_to_frame(&f.tracer->geometry, (double[3]){0.1, 0, 0.2}, eye);
    memcpy(f.tracer->camera.eye, eye, sizeof eye);
    look(&f, 250, mean, error);
    for (int k = 0; k < 3; k++) {
      double white = (double)f.tracer->white[0][k];
      assert_near(mean[k], 5 * share * 0.5 * white, 4 * error[k]);
      assert_true(error[k] < 0.02 * mean[k]);
    }
  }
}

/* Lambert's formula for a polygon of radiance L: E = L / 2 times the sum over its edges of the
 * angle that an edge subtends times the cosine between the receiver's normal and the edge's
 * plane's. */
static double polygon_irradiance(double (*corner)[3], size_t count, const double at[3]) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    double a[3], b[3], across[3];
    abbe_vector_subtract(corner[i], at, a);
    abbe_vector_subtract(corner[(i + 1) % count], at, b);
    abbe_vector_normalise(a);
    abbe_vector_normalise(b);
    abbe_vector_cross(a, b, across);
    const double angle = asin(fmin(abbe_vector_length(across), 1));
    abbe_vector_normalise(across);
    sum += angle * across[2];
  }
  return fabs(sum) / 2;
}

/* Off its axis, turned by 30 degrees and tilted: the edges are where width, height and roll put
 * them. */
TEST(a_rectangles_irradiance) {
  const double c = cos(ABBE_PI / 6), s = sin(ABBE_PI / 6), at[] = {0.1, 0, 0};
  for (int i = 0; i < 2; i++) {
    const char *text = i ? DOWN LIGHT("kind: rectangle, position: [0.3, 0.1, 0.3], direction: [-1, "
                                      "0, -1], width: 0.2, height: 0.3, radiance: 5") FLOOR
                         : DOWN LIGHT("kind: rectangle, position: [0.3, 0.1, 0.3], direction: [0, "
                                      "0, -1], width: 0.4, height: 0.1, roll: 30, radiance: 5")
                               FLOOR;
    /* z: the width along -x, as n is down and the height along y; turned from the one to the other.
     * Tilted: the width along -y and the height along z x n. */
    const double d = sqrt(0.5), wide[2][3] = {{-0.2 * c, 0.2 * s, 0}, {0, -0.1, 0}};
    const double high[2][3] = {{0.05 * s, 0.05 * c, 0}, {-0.15 * d, 0, 0.15 * d}};
    double corner[4][3], mean[3], error[3];
    static const int sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int k = 0; k < 4; k++)
      for (int x = 0; x < 3; x++)
        corner[k][x] =
            (double[]){0.3, 0.1, 0.3}[x] + sign[k][0] * wide[i][x] + sign[k][1] * high[i][x];
    FILLED(fixture, f, make(text, &f));
    float eye[3];
    abbe_geometry_to_frame(&f.tracer->geometry, (double[3]){0.1, 0, 0.1}, eye);
    memcpy(f.tracer->camera.eye, eye, sizeof eye);
    look(&f, 250, mean, error);
    for (int k = 0; k < 3; k++) {
      const double white = (double)f.tracer->white[0][k];
      assert_near(mean[k], 5 * polygon_irradiance(corner, 4, at) * 0.5 / ABBE_PI * white,
                  4 * error[k]);
      assert_true(error[k] < 0.02 * mean[k]);
    }
  }
}

TEST(lamps_are_seen_from_the_front) {
#define LAMP(direction)                                                                            \
  LIGHT("kind: disk, position: [0.1, 0, 0.5], direction: [0, 0, " direction                        \
        "], radius: 0.1, radiance: 5")
  check_radiance(DOWN LAMP("1") FLOOR, 5, 1e-6);
  check_radiance(DOWN LAMP("-1") FLOOR, 0, 0);
#define PANEL(direction)                                                                           \
  LIGHT("kind: rectangle, position: [0.1, 0, 0.5], direction: [0, 0, " direction                   \
        "], width: 0.1, height: 0.2, radiance: 5")
  check_radiance(DOWN PANEL("1") FLOOR, 5, 1e-6);
  check_radiance(DOWN PANEL("-1") FLOOR, 0, 0);
}

#define LID(reflectance)                                                                           \
  "- {name: lid, shape: rectangle, width: 0.1, height: 0.1, transform: [{translate: [0.1, 0, "     \
  "0.2]}, {translate: [0.2, 0, 0]}], reflectance: " reflectance "}\n"

/* Behind a lid, behind glass (its light comes as a caustic), on the far side: no light, and just
 * the ambient where there is some. */
TEST(shadows) {
#define SIDE_LIGHT LIGHT("kind: point, position: [0.5, 0, 0.4], intensity: 3")
  check_radiance(DOWN SIDE_LIGHT FLOOR LID("0.5"), 0, 0);
  check_radiance(DOWN SIDE_LIGHT FLOOR "- {name: ball, shape: sphere, radius: 0.08, transform: "
                                       "[{translate: [0.3, 0, 0.2]}], material: flat}\n",
                 0, 0);
  check_radiance(DOWN LIGHT("kind: point, position: [0.1, 0, -0.5], intensity: 3") FLOOR, 0, 0);
  double mean[3], error[3];
  FILLED(fixture, f, make(DOWN "ambient: 0.3\n" SIDE_LIGHT FLOOR LID("0.5"), &f));
  look(&f, 1, mean, error);
  /* ambient light is white in the picture's space: 1, 1, 1 */
  for (int k = 0; k < 3; k++) assert_near(mean[k], 0.3 * 0.5 / ABBE_PI, 1e-6);
}

#define EVEN_SKY "background: 1\n" LIGHT("kind: point, position: [3, 3, 3], intensity: 1")

/* In uniform light clear glass cannot be seen. */
TEST(a_white_furnace) {
  abbe_trace_desc desc = {.width = 8, .height = 8, .no_map = true, .threads = 1};
  fixture f;
  double mean[3], error[3];
  for (int i = 0; i < 2; i++) {
    make_with(i ? CAMERA EVEN_SKY GLASS_ONLY("crown") : CAMERA EVEN_SKY GLASS_ONLY("flat"), &desc,
              1, &f);
    look(&f, 60, mean, error);
    for (int k = 0; k < 3; k++) {
      assert_near(mean[k], 1, 4 * error[k]);
      assert_true(error[k] > 1e-5 && error[k] < (i ? 0.02 : 0.005));
    }
    fixture_free(&f);
  }
}

/* From within it is brighter by the square of the index, and haze in it, thin or thick, cannot be
 * seen either; nor where a box keeps in more turned paths than wait. */
TEST(a_white_furnace_from_within) {
  static const char *const insides[] = {
      "eye: [0.1, 0, 0.3], target: [0.1, 1, 0.1], inside: true}\n" EVEN_SKY GLASS_ONLY(
          "flat, medium: {scattering: 1}"),
      "eye: [0.1, 0, 0.3], target: [0.1, 1, 0.1], inside: true}\n" EVEN_SKY GLASS_ONLY(
          "flat, medium: {scattering: 30}"),
      "eye: [0.2, 0, 0.2], target: [1.2, 1, 1.2], fov: 6, inside: true}\n" EVEN_SKY
      "objects:\n" BRICK("flat, medium: {scattering: 0.5}") GROUND};
  abbe_trace_desc desc = {.width = 8, .height = 8, .no_map = true, .threads = 1};
  for (int i = 0; i < 3; i++) {
    OWNED(fixture, f) = {0};
    double mean[3], error[3];
    make_with(printed("materials: glass.yaml\ncamera: {%s", insides[i]), &desc, 1, &f);
    if (i == 2) f.tracer->eye.least_branch = 1e-4f;
    look(&f, i == 2 ? 5 : 100, mean, error);
    for (int k = 0; k < 3; k++) {
      assert_near(mean[k], 2.25, 4 * error[k] + 1e-5);
      assert_true(error[k] < 0.02);
    }
  }
}

/* A slab with two rough faces between camera and light: what the faces show of a light without size
 * is what paths find of a small disk. */
TEST(rough_faces_show_lights_of_any_size) {
  static const char *const lights[] = {
      LIGHT("kind: point, position: [1.2, 0, -2.7], intensity: 1"),
      LIGHT("kind: disk, position: [1.2, 0, -2.7], target: [0.1, 0, 0.3], radius: 0.4, radiance: "
            "1.98943679")};
  double mean[2][3], error[2][3];
  for (int i = 0; i < 2; i++) {
    OWNED(fixture, f) = {0};
    make_with(printed(DOWN "%sobjects:\n" SLAB("flat, roughness: 0.6") GROUND, lights[i]),
              &(abbe_trace_desc){.width = 4, .height = 4, .no_map = true, .threads = 1}, 1, &f);
    look(&f, 300, mean[i], error[i]);
  }
  for (int k = 0; k < 3; k++) {
    assert_near(mean[0][k], mean[1][k], 4 * hypot(error[0][k], error[1][k]));
    assert_true(error[0][k] < 0.02 * mean[0][k] && error[1][k] < 0.03 * mean[0][k]);
  }
}

/* Splitting changes how a stone's light is found, not how much there is: against roulette at all
 * interfaces and none above a thousandth, each with less spread than the one before. */
TEST(splitting_keeps_the_mean) {
  static const float least[] = {1, ABBE_EYE_LEAST_BRANCH, 1e-3f};
  double mean[3][3], error[3][3];
  OWNED(fixture, f) = {0};
  make_with(
      DOWN "ambient: 0.5\n" LIGHT("kind: point, position: [0.5, 0, 0.4], intensity: 3") FLOOR
      "- {name: stone, shape: brilliant, diameter: 0.2, transform: [{translate: [0.1, 0, 0.2]}], "
      "material: dense}\n",
      &(abbe_trace_desc){.width = 4, .height = 4, .no_map = true, .threads = 1, .photons = 64}, 0,
      &f);
  for (int i = 0; i < 3; i++) {
    f.tracer->eye.least_branch = least[i];
    look(&f, 2000, mean[i], error[i]);
  }
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 2; i++) {
      assert_near(mean[i][k], mean[2][k], 4 * hypot(error[i][k], error[2][k]));
      assert_true(error[i + 1][k] < error[i][k] && error[i][k] < 0.02 * mean[i][k]);
    }
}

/* Sixteen samples of a pixel: the mean of one, with less than a quarter of its spread, for they are
 * even over the pixel and the spectrum. */
TEST(samples_share_a_pixel) {
  double mean[2][3], error[2][3];
  OWNED(fixture, f) = {0};
  make_with(
      CAMERA "ambient: 0.5\n" LIGHT("kind: point, position: [0.5, 0, 0.4], intensity: 3") FLOOR
      "- {name: ball, shape: sphere, radius: 0.3, transform: [{translate: [0, 0, 0.1]}], material: "
      "crown}\n",
      &(abbe_trace_desc){.width = 1, .height = 1, .no_map = true, .threads = 1, .photons = 64}, 0,
      &f);
  for (int i = 0; i < 2; i++) {
    f.tracer->eye.samples = (const uint8_t[]){i ? 16 : 1};
    look(&f, i ? 4000 : 40000, mean[i], error[i]);
  }
  for (int k = 0; k < 3; k++) {
    assert_near(mean[1][k], mean[0][k], 4 * hypot(error[0][k], error[1][k]));
    /* of a tenth of the passes */
    assert_true(error[1][k] < sqrt(10) / 4 * error[0][k]);
  }
}

/* Along the axis of an absorbing ball: r + (1 - r)^2 k / (1 - r k) with k = exp(-a 2 R), over the
 * spectrum of the sky. */
TEST(absorbing_glass_shows) {
  OWNED(fixture, f) = {0};
  double mean[3], error[3], expected[3] = {0}, white[3] = {0}, r = 0.04;
  make_with(DOWN EVEN_SKY GLASS_ONLY("smoke"),
            &(abbe_trace_desc){.width = 4, .height = 4, .no_map = true, .threads = 1}, 1, &f);
  const abbe_spectral_sampling *s = &f.tracer->sampling;
  for (size_t i = 0; i < s->steps; i++) {
    double nm = 0.5 * (s->lambda_nm[i] + s->lambda_nm[i + 1]);
    double a = fmin(fmax(20 - 15 * (nm - 400) / 300, 5), 20), keep = exp(-a * 0.16);
    for (int k = 0; k < 3; k++) {
      white[k] += (double)f.tracer->colour[i][k];
      expected[k] +=
          (double)f.tracer->colour[i][k] * (r + (1 - r) * (1 - r) * keep / (1 - r * keep));
    }
  }
  look(&f, 200, mean, error);
  for (int k = 0; k < 3; k++) {
    assert_near(mean[k], expected[k] / white[k], 4 * error[k]);
    assert_true(mean[k] < 0.6 && error[k] < 0.01);
  }
}

/* Over black, a slab shows what it mirrors of the sky: 2 r / (1 + r) with all inner reflections;
 * r alone where matched physics follow no inner reflection. */
TEST(a_slab_mirrors_the_sky) {
  abbe_trace_desc desc = {.width = 4, .height = 4, .no_map = true, .threads = 1};
  double r = 0.04, mean[3], error[3];
  for (int matched = 0; matched < 2; matched++) {
    OWNED(fixture, f) = {0};
    desc.physics = (abbe_physics){.matched = matched == 1, .orders = 1};
    make_with(DOWN EVEN_SKY "objects:\n" GROUND SLAB("flat"), &desc, 0, &f);
    look(&f, 400, mean, error);
    for (int k = 0; k < 3; k++)
      assert_near(mean[k], matched ? r : 2 * r / (1 + r), 4 * error[k] + 1e-6);
  }
}

/* What absorbs in the scene has these attenuations, 1/m. */
static void absorb_by(abbe_scene *scene, const double *nm, const double *per_m, size_t count) {
  for (size_t i = 0; i < scene->table.count; i++) {
    abbe_spectrum **a = &scene->table.material[i].attenuation;
    if (*a == NULL) continue;
    abbe_spectrum_free(*a);
    OK(abbe_spectrum_make(nm, per_m, count, ABBE_INTERPOLATION_LINEAR, a, &error));
  }
}

/* Straight down through a block that lets 0.8 % through, on a floor in ambient light: paths end by
 * roulette below 2 %, and their mean stays Beer-Lambert's. */
TEST(dark_glass_keeps_its_mean) {
  OWNED(fixture, f) = {0};
  const double r = 0.04, left = exp(-0.4 * 12);
  const double want = 0.5 / ABBE_PI * (1 - r) * (1 - r) * left / (1 - r * r * left * left);
  double mean[3], error[3];
  f.scene = scene_of(DOWN "ambient: 1\n" LIGHT(
      "kind: point, position: [3, 3, 3], intensity: 1e-12") "objects:\n- {name: floor, shape: "
                                                            "rectangle, width: 9, height: 9, "
                                                            "reflectance: 0.5}\n"
                                                            "- {name: block, shape: box, size: "
                                                            "[0.4, 0.4, 0.4], transform: "
                                                            "[{translate: [0.1, 0, 0.3]}], "
                                                            "material: smoke}\n");
  f.objects = f.scene.object_count;
  absorb_by(&f.scene, (double[]){300, 900}, (double[]){12, 12}, 2);
  f.tracer = make_tracer(
      &f.scene,
      &(abbe_trace_desc){.width = 4, .height = 4, .no_map = true, .threads = 1, .photons = 1});
  look(&f, 20000, mean, error);
  for (int k = 0; k < 3; k++) {
    assert_true(error[k] < 0.02 * want);
    assert_near(mean[k], want, 4 * error[k]);
  }
}

/* The sun on a floor under glass whose absorption comes and goes every 80 nm, seen through the
 * glass: gathered light is weakened as its own wavelength is, both ways, and not as the path's that
 * gathers it, which may be up to 25 nm off. */
TEST(what_is_gathered_passes_coloured_glass_twice) {
  enum { KNOTS = 105, PASSES = 8, SIDE = 16 };
  static const abbe_trace_desc desc = {.width = SIDE,
                                       .height = SIDE,
                                       .no_map = true,
                                       .photons = 1 << 17,
                                       .space = ABBE_RGB_SPACE_XYZ};
  double nm[KNOTS], per_m[KNOTS], want[3] = {0}, sum[3] = {0};
  const double r = 0.04;
  OWNED(fixture, f) = {0};
  f.scene = scene_of(
      "materials: glass.yaml\n"
      "camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 5}\n"
      "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n" FLOOR
      "- {name: slab, shape: box, size: [0.4, 0.4, 0.1], transform: [{translate: [0, 0, 0.3]}], "
      "material: smoke}\n");
  f.objects = f.scene.object_count;
  for (int k = 0; k < KNOTS; k++) {
    nm[k] = 320 + 5 * k;
    per_m[k] = 20 + 15 * cos(2 * ABBE_PI * nm[k] / 80);
  }
  absorb_by(&f.scene, nm, per_m, KNOTS);
  f.tracer = make_tracer(&f.scene, &desc);
  const abbe_spectral_sampling *s = &f.tracer->sampling;
  for (size_t i = 0; i < s->steps; i++) {
    const double at = (0.5 * (s->lambda_nm[i] + s->lambda_nm[i + 1]) - nm[0]) / 5;
    const size_t k = (size_t)at;
    const double left = exp(-0.1 * (per_m[k] + (at - (double)k) * (per_m[k + 1] - per_m[k])));
    const double passes = (1 - r) * (1 - r) * left / (1 - r * r * left * left);
    for (int c = 0; c < 3; c++)
      want[c] += (double)s->xyz[i][c] * passes * passes * 0.5 / ABBE_PI / (double)s->steps;
  }
  run_passes(f.tracer, PASSES);
  MADE(abbe_image, picture, abbe_tracer_picture(f.tracer, &picture, &error));
  for (int c = 0; c < 3; c++) {
    sum[c] = channel_sum(&picture, c == 0 ? "X" : c == 1 ? "Y" : "Z") / (SIDE * SIDE);
    print_message("gathered through coloured glass: %.4f of its light\n", sum[c] / want[c]);
    assert_near(sum[c], want[c], 0.02 * want[c]);
  }
}

/* Bands hold watts a nanometre: over all of them what a receiver of that reflectance returns. */
TEST(bands_add_up) {
  OWNED(fixture, f) = {0};
  abbe_eye_sample s;
  make_with(DOWN LIGHT("kind: point, position: [0.1, 0, 0.5], intensity: 3") FLOOR,
            &(abbe_trace_desc){.width = 4, .height = 4, .no_map = true, .threads = 1, .bands = 16},
            0, &f);
  abbe_eye_walk_pixel(&f.tracer->eye, 5, 0, &s);
  double sum = 0;
  for (int i = 0; i < 16; i++) sum += (double)s.band[i] * 25;
  assert_near(sum, 3 / 0.25 * 0.5 / ABBE_PI, 1e-4);
  fixture_free(&f);
  /* through glass each path has one wavelength, and so one band: the mean is the same */
  make_with(DOWN EVEN_SKY GLASS_ONLY("crown"),
            &(abbe_trace_desc){.width = 4, .height = 4, .no_map = true, .threads = 1, .bands = 16},
            1, &f);
  double square = 0, mean = 0;
  enum { COUNT = 3200 };
  for (uint32_t i = 0; i < COUNT; i++) {
    abbe_eye_walk_pixel(&f.tracer->eye, i % 16, i / 16, &s);
    double all = 0;
    for (int b = 0; b < 16; b++) all += (double)s.band[b] * 25;
    mean += all / COUNT;
    square += all * all / COUNT;
  }
  double error = sqrt((square - mean * mean) / COUNT);
  assert_near(mean, 1, 4 * error);
  assert_true(error < 0.02);
}

TEST(a_sample_repeats_itself) {
  abbe_eye_sample a, b;
  FILLED(fixture, f, make(CAMERA POINT_LIGHT FLOOR RING("crown"), &f));
  int differ = 0, refract = 0;
  for (size_t pixel = 0; pixel < 16; pixel++) {
    abbe_eye_walk_pixel(&f.tracer->eye, pixel, 7, &a);
    abbe_eye_walk_pixel(&f.tracer->eye, pixel, 7, &b);
    assert_memory_equal(a.rgb, b.rgb, sizeof a.rgb);
    abbe_eye_walk_pixel(&f.tracer->eye, pixel, 8, &b);
    differ += memcmp(a.rgb, b.rgb, sizeof a.rgb) != 0;
    refract += a.refractor;
    assert_true(a.rays >= 1);
  }
  assert_true(differ > 8);
  assert_true(refract > 0 && refract < 16);
}
