/* Photons' hits against optics in double precision: a sphere, a prism, a slit. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "gl/photons/photon_paths.h"
#include "spectral/optics.h"

static void trace_photons(const abbe_scene *scene, const abbe_render_desc *desc,
                          abbe_renderer_hits *l) {
  abbe_scene aside = *scene;
  look_aside(&aside);
  HELD(abbe_renderer, renderer) = drawn_renderer(&aside, desc);
  OK(abbe_renderer_read_hits(renderer, 0, 0, NULL, NULL, l, &error));
  assert_true(l->count > 0);
}

static const float *hit(const abbe_renderer_hits *l, size_t photon, size_t order, size_t sample) {
  return l->at + 4 * ((photon * l->slots + order) * l->samples + sample);
}

static void photon_ray(const abbe_renderer_hits *l, size_t photon, double o[3], double d[3]) {
  unsigned cell = l->cell[photon];
  double uv[2] = {((cell & 0xffffu) + 0.5) / (double)l->grid[0],
                  ((cell >> 16) + 0.5) / (double)l->grid[1]};
  abbe_view_ray(&l->view, uv, o, d);
}

/* The ray in the sphere, from wall to wall: the double twin of the shaders' path. */
typedef struct sphere_path {
  const double *centre;
  double radius, n;
  double p[3], d[3], normal[3]; /* where it is inside, and its way */
  double share;                 /* of the light */
} sphere_path;

static bool enter(sphere_path *path, const double o[3], const double d[3]) {
  double oc[3], wi[3];
  for (int k = 0; k < 3; k++) oc[k] = o[k] - path->centre[k];
  double b = abbe_vector_dot(oc, d),
         inside = b * b - abbe_vector_dot(oc, oc) + path->radius * path->radius;
  if (inside <= 0) return false;
  for (int k = 0; k < 3; k++) {
    path->p[k] = o[k] + (-b - sqrt(inside)) * d[k];
    path->normal[k] = (path->p[k] - path->centre[k]) / path->radius;
    wi[k] = -d[k];
  }
  path->share = 1 - abbe_optics_fresnel(abbe_vector_dot(wi, path->normal), 1 / path->n);
  return abbe_optics_refract(wi, path->normal, 1 / path->n, path->d);
}

/* To the next wall: the direction and share that leave there; what stays goes on. */
static void step(sphere_path *path, double out[3], double *out_share) {
  double chord = -2 * path->radius * abbe_vector_dot(path->normal, path->d), wi[3], inward[3];
  for (int k = 0; k < 3; k++) {
    path->p[k] += chord * path->d[k];
    path->normal[k] = (path->p[k] - path->centre[k]) / path->radius;
    inward[k] = -path->normal[k];
    wi[k] = -path->d[k];
  }
  double kept = abbe_optics_fresnel(abbe_vector_dot(wi, inward), path->n);
  *out_share = path->share * (1 - kept);
  abbe_optics_refract(wi, inward, path->n, out);
  abbe_optics_reflect(wi, inward, path->d);
  path->share *= kept;
}

/* Floats of about 1 carry 6e-8; each passage of the sphere stretches small differences by up to
 * its radius over its focal length, and 1 / cosine at the floor: a hundredfold in all, for rays
 * that do not graze. */
static void compare_path(const abbe_renderer_hits *l, size_t photon, sphere_path path,
                         size_t *compared) {
  double o[3], d[3], out[3], share, power = 1;
  photon_ray(l, photon, o, d);
  if (!enter(&path, o, d) || -abbe_vector_dot(d, path.normal) < 0.3) return;
  double c = abbe_vector_dot(d, l->view.forward);
  double flux = power * c * c * c * abbe_view_area(&l->view) / (double)(l->grid[0] * l->grid[1]);
  for (size_t order = 0; order < 3; order++) {
    step(&path, out, &share);
    double t = -path.p[2] / out[2];
    const float *at = hit(l, photon, order, 0);
    if (out[2] > -0.3 || fabs(path.p[0] + t * out[0]) > 0.99 || fabs(path.p[1] + t * out[1]) > 0.99)
      continue;
    if (share < 0.02) continue; /* the path may have ended */
    assert_true(at[3] > 0);
    assert_near(at[0], path.p[0] + t * out[0], 1e-5);
    assert_near(at[1], path.p[1] + t * out[1], 1e-5);
    assert_near(at[2], 0, 1e-6);
    assert_near(at[3] / (share * flux), 1, 1e-4);
    ++*compared;
  }
}

GROUP(make_context, free_context);

TEST(a_sphere_lands_as_double_precision_says) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_render_desc desc = small_frame;
  desc.wavelengths = 1; /* one sample stands in the middle, at 580 nm */
  FILLED(abbe_renderer_hits, l, trace_photons(&scene, &desc, &l));
  sphere_path path = {.centre = scene.object[1].exact.centre,
                      .radius = scene.object[1].exact.radius};
  OK(abbe_material_n(scene.object[1].material, 580, &path.n, &error));
  path.n = (float)path.n; /* as the shaders have it */
  size_t compared = 0;
  for (size_t i = 0; i < l.count; i++) compare_path(&l, i, path, &compared);
  assert_true(compared > l.count / 2);
}

/* A 60-degree prism of n = 1.5 in parallel light that passes it symmetrically. */
#define PRISM_SCENE                                                                                \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [-1, -3, 1], target: [2, 0, 0.5]}\n"                                              \
  "lights:\n- {name: beam, kind: directional, irradiance: 1,\n"                                    \
  "   direction: [%.15g, 0, %.15g]}\n"                                                             \
  "objects:\n"                                                                                     \
  "- {name: wall, shape: rectangle, width: 4, height: 4, reflectance: 0.5,\n"                      \
  "   transform: [{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [%g, 0, 0]}]}\n"            \
  "- {name: prism, shape: prism, apex: 60, side: 0.2, length: 0.2, material: %s,\n"                \
  "   transform: [{translate: [0, 0, 1]}]}\n"

static void trace_prism(const char *glass, double wall_x, abbe_renderer_hits *l) {
  double pi = acos(-1), up = asin(1.5 * sin(pi / 6)) - pi / 6;
  OWNED(abbe_scene, scene) = scene_of(printed(PRISM_SCENE, cos(up), sin(up), wall_x, glass));
  /* Each wavelength on its own: every photon takes all seven. */
  abbe_render_desc desc = small_frame;
  desc.fill = ABBE_FILL_NONE;
  trace_photons(&scene, &desc, l);
}

/* Whether the photon meets the entrance face well above the prism's middle: then it leaves through
 * the other face, and not through the base. */
static bool enters_high(const abbe_renderer_hits *l, size_t photon) {
  double o[3], d[3], normal[3] = {-cos(acos(-1) / 6), 0, 0.5};
  photon_ray(l, photon, o, d);
  double inradius = 0.2 / (2 * sqrt(3)), apex_z = 1 + 0.2 / sqrt(3);
  double offset = inradius + normal[2]; /* of the face: the middle is at z = 1 */
  double t = (offset - abbe_vector_dot(normal, o)) / abbe_vector_dot(normal, d);
  double y = o[1] + t * d[1], z = o[2] + t * d[2];
  return z > 1.01 && z < apex_z - 0.01 && fabs(y) < 0.09;
}

TEST(a_prism_deviates_least_as_the_formula_says) {
  FILLED(abbe_renderer_hits, near, trace_prism("flat", 1, &near));
  FILLED(abbe_renderer_hits, far, trace_prism("flat", 1.5, &far));
  assert_int_equal(near.count, far.count);
  const double half = acos(-1) / 6, expected = 2 * (asin(1.5 * sin(half)) - half);
  assert_near(expected * 180 / acos(-1), 37.18, 0.01);
  size_t compared = 0;
  for (size_t i = 0; i < near.count; i++) {
    double o[3], d[3], way[3];
    size_t k = 0;
    while (k < far.count && far.cell[k] != near.cell[i]) k++;
    assert_true(k < far.count);
    if (!enters_high(&near, i)) continue;
    photon_ray(&near, i, o, d);
    for (int c = 0; c < 3; c++)
      way[c] = (double)hit(&far, k, 0, 0)[c] - (double)hit(&near, i, 0, 0)[c];
    /* Two hits half a metre apart, each a float's few 1e-7 m off. */
    double cosine = abbe_vector_dot(way, d) / sqrt(abbe_vector_dot(way, way));
    assert_near(acos(cosine), expected, 4e-6);
    compared++;
  }
  assert_true(compared > 100);
}

static double mean_height(const abbe_renderer_hits *l, size_t sample) {
  double sum = 0, flux = 0;
  for (size_t i = 0; i < l->count; i++) {
    const float *at = hit(l, i, 0, sample);
    if (!enters_high(l, i)) continue;
    assert_true(at[3] > 0);
    sum += (double)at[3] * (double)at[2];
    flux += (double)at[3];
  }
  assert_true(flux > 0);
  return sum / flux;
}

/* The beam comes from below and is bent down: the more, the lower on the wall. */
TEST(violet_is_bent_more_than_red) {
  FILLED(abbe_renderer_hits, l, trace_prism("crown", 1, &l));
  assert_int_equal(l.samples, 7);
  for (size_t sample = 1; sample < 7; sample++)
    assert_true(mean_height(&l, sample) > mean_height(&l, sample - 1) + 1e-3);
}

static void sum_flux(const abbe_renderer_hits *l, size_t sample, double *flux, size_t *hits) {
  *flux = *hits = 0;
  for (size_t path = 0; path < l->count * l->slots; path++) {
    const size_t i = path * l->samples + sample;
    *flux += (double)l->at[4 * i + 3];
    *hits += l->path[i] != 0;
    for (int k = 0; k < 4 && l->path[i] == 0; k++) assert_true(l->at[4 * i + k] == 0);
  }
}

/* 70 wavelengths are more than a batch takes, and no multiple of it: the last batch holds what a
 * full one has of them, and nothing of the batch before it. */
TEST(a_last_batch_holds_its_own_wavelengths_alone) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  look_aside(&scene);
  abbe_render_desc desc = small_frame;
  desc.wavelengths = 70;
  desc.fill = ABBE_FILL_NONE;
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  abbe_renderer_hits whole, last;
  OK(abbe_renderer_read_hits(renderer, 0, 6, NULL, NULL, &whole, &error));
  assert_int_equal(whole.samples, 64);
  OK(abbe_renderer_read_hits(renderer, 0, 64, NULL, NULL, &last, &error));
  for (size_t sample = 0; sample < last.samples; sample++) {
    double flux, expected = 0;
    size_t hits, wanted = 0;
    sum_flux(&last, sample, &flux, &hits);
    if (sample < 6) sum_flux(&whole, 58 + sample, &expected, &wanted);
    assert_int_equal(hits, wanted);
    assert_near(flux, expected, 1e-9 * expected);
    assert_true((hits > 0) == (sample < 6));
  }
  abbe_renderer_hits_free(&whole);
  abbe_renderer_hits_free(&last);
}

/* The shipped prism's spectrum on its wall runs from violet, deviated most, to red. */
TEST(the_shipped_prism_makes_a_spectrum) {
  OWNED(abbe_scene, scene) = shipped_scene("prism");
  FILLED(abbe_renderer_hits, l, trace_photons(&scene, &small_frame, &l));
  double before = 0;
  for (size_t sample = 0; sample < l.samples; sample++) {
    double sum = 0, flux = 0;
    for (size_t i = 0; i < l.count; i++) {
      const float *at = hit(&l, i, 0, sample);
      if (at[3] <= 0 || at[1] < 0.2f) continue; /* not on the wall, which stands behind */
      sum += (double)at[3] * atan2((double)at[1], (double)at[0]);
      flux += (double)at[3];
    }
    assert_true(flux > 0);
    if (sample > 0) assert_true(sum / flux < before);
    before = sum / flux;
  }
}

static bool by_device;

bool __real_abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v);
bool __wrap_abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v);
bool __wrap_abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v) {
  return !by_device && __real_abbe_photon_paths_serve(pass, v);
}

/* A hill far away is traversed; what lands on the floor beside it lands in the same place. Both by
 * the device, which alone follows light to hills. */
TEST(a_hill_moves_no_hit_on_the_floor) {
  static const char *const balls[] = {BALL("flat"), RING("flat")};
  size_t on_hill = 0;
  by_device = true;
  for (int k = 0; k < 2; k++) {
    abbe_scene scene = scene_of(printed("%s%s", CAMERA POINT_LIGHT FLOOR, balls[k]));
    FILLED(abbe_renderer_hits, alone, trace_photons(&scene, &small_frame, &alone));
    abbe_scene_free(&scene);
    scene = scene_of(printed("%s%s", CAMERA POINT_LIGHT FLOOR HILL, balls[k]));
    FILLED(abbe_renderer_hits, beside, trace_photons(&scene, &small_frame, &beside));
    abbe_scene_free(&scene);
    assert_int_equal(alone.count, beside.count);
    assert_int_equal(alone.slots, beside.slots);
    size_t on_floor = 0;
    for (size_t i = 0; i < alone.count; i++) {
      size_t j = 0;
      while (j < beside.count && beside.cell[j] != alone.cell[i]) j++;
      assert_true(j < beside.count);
      for (size_t slot = 0; slot < alone.slots; slot++) {
        const float *a = hit(&alone, i, slot, 0), *b = hit(&beside, j, slot, 0);
        if (b[3] <= 0) continue; /* nothing, or in the hill's shadow */
        on_hill += b[2] > 1e-4f;
        if (b[2] > 1e-4f) continue;
        assert_memory_equal(a, b, 3 * sizeof *a);
        assert_near(b[3] / a[3], 1, 1e-6); /* another program may multiply in another order */
        on_floor++;
      }
    }
    assert_true(on_floor > alone.count);
  }
  by_device = false;
  assert_true(on_hill > 0);
}

/* The prism's slit is 2 by 30 mm, 0.6 m before the lamp of 40 W/sr and within its cone. Its light
 * does not depend on how many cells there are, nor on where they lie: 2 in 1024 rays of the view's
 * fit, and what 8 x 8 rays tell of cells that the jaws cut. */
TEST(a_slit_lets_its_light_through_whatever_the_grid) {
  static const size_t grids[] = {20, 33, 64, 150};
  double expected = 40 * 0.002 * 0.03 / (0.6 * 0.6) * (1 - 1.5 * (0.03 * 0.03 / 12) / (0.6 * 0.6));
  OWNED(abbe_scene, scene) = shipped_scene("prism");
  for (size_t i = 0; i < 8; i++) {
    abbe_render_desc desc = small_frame;
    desc.photons = grids[i % 4];
    desc.photon_shift[0] = i < 4 ? 0 : 0.4;
    desc.photon_shift[1] = i < 4 ? 0 : -0.3;
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    assert_near(draw_frame(renderer).energy.reached / expected, 1, i < 4 ? 2e-3 : 8e-3);
  }
}
