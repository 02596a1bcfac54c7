/* Where an exported scene is seen from, and what is around it: by each program's own rules, points
 * are at the same pixels, and light comes from the same directions. */
#include "tests/scenes/export/export_text.h"

#include "base/maths.h"
#include "colorimetry/image/exr.h"

#include <cjson/cJSON.h>

/* ---- cameras ---- */

static const double points[][3] = {
    {0, 0, 0.05}, {0.2, 0.1, 0}, {-0.15, 0.3, 0.2}, {0.05, -0.1, 0.3}};

static void abbe_pixel(const abbe_camera *c, const double p[3], double at[2]) {
  double forward[3], right[3], up[3], way[3];
  const double tangent = tan(0.5 * c->fov_y_rad), w = (double)c->width, h = (double)c->height;
  abbe_vector_subtract(c->target, c->eye, forward);
  abbe_vector_normalise(forward);
  abbe_vector_cross(forward, c->up, right);
  abbe_vector_normalise(right);
  abbe_vector_cross(right, forward, up);
  abbe_vector_subtract(p, c->eye, way);
  const double depth = abbe_vector_dot(way, forward);
  at[0] = 0.5 * w + 0.5 * h * abbe_vector_dot(way, right) / (depth * tangent);
  at[1] = 0.5 * h - 0.5 * h * abbe_vector_dot(way, up) / (depth * tangent);
}

/* Coordinates in a frame made as look-at functions make it: side = up x dir. */
static void look(const double v[9], const double p[3], double out[3]) {
  double dir[3], side[3], up[3], way[3];
  abbe_vector_subtract(v + 3, v, dir);
  abbe_vector_normalise(dir);
  abbe_vector_cross(v + 6, dir, side);
  abbe_vector_normalise(side);
  abbe_vector_cross(dir, side, up);
  abbe_vector_subtract(p, v, way);
  out[0] = abbe_vector_dot(way, side);
  out[1] = abbe_vector_dot(way, up);
  out[2] = abbe_vector_dot(way, dir);
}

static double tangent_of(double degrees) {
  return tan(0.5 * degrees * 3.14159265358979323846 / 180);
}

/* pbrt: its side axis is up x dir, which the Scale turns; fov is of the shorter side. */
static void pbrt_pixel(const char *text, double w, double h, const double p[3], double at[2]) {
  double scale[3], v[9], fov, c[3];
  numbers_after(text, "\nScale", scale, 3);
  numbers_after(text, "\nLookAt", v, 9);
  numbers_after(text, "\"float fov\"", &fov, 1);
  look(v, p, c);
  const double frame = w / h, x = frame > 1 ? frame : 1, y = frame > 1 ? 1 : 1 / frame;
  at[0] = w * (scale[0] * c[0] / (c[2] * tangent_of(fov)) + x) / (2 * x);
  at[1] = h * (y - scale[1] * c[1] / (c[2] * tangent_of(fov))) / (2 * y);
}

/* Columns right, up, back and place; the angle along y. */
static void column_pixel(const double m[12], double fov_rad, double w, double h, const double p[3],
                         double at[2]) {
  double way[3];
  abbe_vector_subtract(p, m + 9, way);
  const double depth = -abbe_vector_dot(way, m + 6) * tan(0.5 * fov_rad);
  at[0] = 0.5 * w + 0.5 * h * abbe_vector_dot(way, m) / depth;
  at[1] = 0.5 * h - 0.5 * h * abbe_vector_dot(way, m + 3) / depth;
}

static void blender_pixel(const char *text, double w, double h, const double p[3], double at[2]) {
  double m[15];
  numbers_after(text, "\ncamera(", m, 15);
  assert_near(m[13], w, 0);
  assert_near(m[14], h, 0);
  assert_non_null(strstr(text, "sensor_fit = 'VERTICAL'"));
  column_pixel(m, m[12], w, h, p, at);
}

/* y is up: a point (x, y, z) is at (x, z, -y). */
static void gltf_pixel(const char *text, double w, double h, const double p[3], double at[2]) {
  const double turned[3] = {p[0], p[2], -p[1]};
  double m[16], columns[12], fov;
  cJSON *root = cJSON_Parse(text), *node;
  assert_non_null(root);
  cJSON_ArrayForEach(node, cJSON_GetObjectItem(root, "nodes")) {
    if (cJSON_GetObjectItem(node, "camera") == NULL) continue;
    for (int i = 0; i < 16; i++)
      m[i] = cJSON_GetArrayItem(cJSON_GetObjectItem(node, "matrix"), i)->valuedouble;
  }
  const cJSON *camera = cJSON_GetArrayItem(cJSON_GetObjectItem(root, "cameras"), 0);
  const cJSON *view = cJSON_GetObjectItem(camera, "perspective");
  fov = cJSON_GetObjectItem(view, "yfov")->valuedouble;
  assert_near(cJSON_GetObjectItem(view, "aspectRatio")->valuedouble, w / h, 1e-12);
  for (int c = 0; c < 4; c++) memcpy(columns + 3 * c, m + 4 * c, 3 * sizeof *m);
  column_pixel(columns, fov, w, h, turned, at);
  cJSON_Delete(root);
}

GROUP(make_folder, drop_folder);

TEST(cameras_show_the_same_pixels) {
  static void (*const pixel[])(const char *, double, double, const double *,
                               double *) = {pbrt_pixel, gltf_pixel, blender_pixel};
  static const size_t sizes[][2] = {{300, 200}, {200, 300}, {256, 256}};
  OWNED(abbe_scene, scene) =
      scene_of("materials: glass.yaml\ncamera: {eye: [0.3, -1, 0.5], target: [0.02, 0, 0.05], up: "
               "[0.2, 0, 1], fov: 40}\n" POINT_LIGHT FLOOR BALL("crown"));
  for (int target = 0; target < ABBE_SCENE_EXPORT_COUNT; target++)
    for (int s = 0; s < 3; s++) {
      scene.camera.width = sizes[s][0];
      scene.camera.height = sizes[s][1];
      char *text = written(&scene, (abbe_scene_export_target)target);
      for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        double expected[2], got[2];
        abbe_pixel(&scene.camera, points[i], expected);
        pixel[target](text, (double)sizes[s][0], (double)sizes[s][1], points[i], got);
        assert_near(got[0], expected[0], 1e-4);
        assert_near(got[1], expected[1], 1e-4);
      }
      done(text);
    }
}

/* ---- surroundings ---- */

/* Clarberg's map as pbrt has it: the middle is +z, the corners are -z, u = 1 is +x. */
static void square_to_sphere(double across, double down, double out[3]) {
  const double u = 2 * across - 1, v = 2 * down - 1, s = 1 - fabs(u) - fabs(v);
  const double r = 1 - fabs(s);
  const double phi = (r == 0 ? 1 : (fabs(v) - fabs(u)) / r + 1) * 3.14159265358979323846 / 4;
  out[0] = copysign(cos(phi), u) * r * sqrt(2 - r * r);
  out[1] = copysign(sin(phi), v) * r * sqrt(2 - r * r);
  out[2] = copysign(1 - r * r, s);
}

/* Mean radiance survives, and what is bright stands where each program looks for it. */
TEST(surroundings_stand_where_they_were) {
  static const abbe_scene_export_target all[] = {ABBE_SCENE_EXPORT_PBRT, ABBE_SCENE_EXPORT_BLENDER};
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA FLOOR BALL("flat") "environment: {size: 64, uniform: 0.1, softboxes: [{azimuth: 30, "
                                "elevation: 40, width: 20, height: 20, radiance: 9}]}\n");
  const double pi = 3.14159265358979323846;
  const double to[3] = {cos(40 * pi / 180) * cos(30 * pi / 180),
                        cos(40 * pi / 180) * sin(30 * pi / 180), sin(40 * pi / 180)};
  for (size_t t = 0; t < 2; t++) {
    double mean = 0, weights = 0, middle[3] = {0};
    done(written(&scene, all[t]));
    MADE(abbe_image, image,
         abbe_exr_read(printed("%s/it-environment.exr", folder), &image, &error));
    for (size_t i = 0; i < image.width * image.height; i++) {
      const double u = ((double)(i % image.width) + 0.5) / (double)image.width;
      const double v = ((double)(i / image.width) + 0.5) / (double)image.height;
      const double phi = 2 * pi * u, theta = pi * v, green = (double)image.data[3 * i + 1];
      const double weight = t == 0 ? 1 : sin(theta);
      double d[3];
      if (t == 0) square_to_sphere(u, v, d);
      /* Cycles: u = 0.5 - atan2(y, x) / 2 pi */
      const double cycles[3] = {cos(pi - phi) * sin(theta), sin(pi - phi) * sin(theta), cos(theta)};
      if (t > 0) memcpy(d, cycles, sizeof d);
      mean += weight * green;
      weights += weight;
      if (green > 4)
        for (int k = 0; k < 3; k++) middle[k] += weight * d[k];
    }
    assert_near(mean / weights, scene.environment->mean[1], 0.02 * scene.environment->mean[1]);
    assert_true(abbe_vector_normalise(middle));
    assert_true(abbe_vector_dot(middle, to) > cos(1.5 * pi / 180));
  }
  clear_folder();
}
