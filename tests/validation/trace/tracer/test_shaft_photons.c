/* Photons in haze: what a beam scatters in all, and what of it one pixel sees. */
#include "tests/scenes/scene_text.h"

#include "validation/trace/tracer/tracer_state.h"

enum { STEPS = 2, PHOTONS = 20000 };

#define SCENE                                                                                      \
  "materials: glass.yaml\ncamera: {eye: [0, -1, 0.3], target: [0, 0, 0.3], fov: 60}\n" POINT_LIGHT \
  "medium: {scattering: 1.5, absorption: 0.5, g: 0.3, box: [[-0.5, -0.2, 0], [0.5, 2, 1]]}\n"

static double seen;

static void add(void *user, const abbe_shaft_splat *splat) {
  (void)user;
  assert_int_equal(splat->pixel, 0);
  assert_int_equal(splat->step, 1);
  seen += (double)splat->value / PHOTONS;
}

/* From (-2, 0.1, 0.25) along +x, half a watt each, over 4 m or up to a wall. */
static void shine(abbe_shaft_photons *s, const abbe_geometry *g, double length) {
  const double from[3] = {-2, 0.1, 0.25};
  abbe_light_stretch way = FIELDS(.d = {1, 0, 0}, .length = (float)(length / g->unit), .flux = 0.5f,
                                  .step = 1, .within = 0.5f, .steps = 2, .medium = -1);
  abbe_geometry_to_frame(g, from, way.o);
  seen = 0;
  for (uint32_t i = 0; i < PHOTONS; i++) {
    way.id = i;
    abbe_shaft_photons_take(s, &way);
  }
  abbe_shaft_photons_flush(s);
}

/* In even steps along the beam, which is in the mist from x = -0.5 on. */
static double expected(const abbe_trace_camera *c, const abbe_geometry *g, double end) {
  enum { PARTS = 50000 };
  double sum = 0;
  for (int i = 0; i < PARTS; i++) {
    const double length = end + 0.5, t = length * (i + 0.5) / PARTS;
    const double x[3] = {-0.5 + t, 0.1, 0.25};
    float p[3], distance = 1, d[3] = {0}, per_pixel = 0;
    size_t pixel = 0;
    abbe_geometry_to_frame(g, x, p);
    assert_true(abbe_trace_camera_pixel(c, p, &pixel, &distance, d, &per_pixel));
    const double metres = (double)distance * g->unit;
    const double in_mist = metres * 0.3 / 1.1; /* of the way to the eye: y from 0.1 to -0.2 */
    sum += length / PARTS * 0.5 * 1.5 * exp(-2 * (t + in_mist)) *
           abbe_medium_phase(0.3, -(double)d[0]) * (double)per_pixel / (metres * metres);
  }
  return sum;
}

TEST(a_beam_is_seen_as_bright_as_it_is) {
  const double lambda_nm[STEPS + 1] = {500, 550, 600};
  for (int wall = 0; wall < 2; wall++) {
    abbe_trace_camera camera;
    /* the wall stands across the beam, edge on to the eye; the screen before a part of the beam */
    OWNED(abbe_scene, scene) = scene_of(printed(
        SCENE FLOOR "%s",
        wall ? "- {name: screen, shape: rectangle, width: 0.4, height: 0.4, reflectance: 1, "
               "transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0.2, -0.5, "
               "0.3]}]}\n"
             : ""));
    MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
    MADE(abbe_media, m, abbe_media_make(&g, lambda_nm, STEPS, &m, &error));
    abbe_trace_camera_make(&g, 1, 1, &camera);
    FREED abbe_shaft_photons *s = aligned_alloc(64, (sizeof *s + 63) / 64 * 64);
    memset(s, 0, sizeof *s);
    s->geometry = &g;
    s->media = &m;
    s->camera = &camera;
    s->eye_medium = -1;
    s->seed = 4;
    s->colour = 10;
    s->add = add;
    shine(s, &g, 4);
    double kept = 0;
    for (size_t i = 0; i < s->count; i++) {
      kept += (double)s->photon[i].flux / PHOTONS;
      assert_int_equal(s->photon[i].colour, 11);
      assert_int_equal(s->photon[i].medium, -1);
    }
    assert_int_equal(s->count, PHOTONS);
    assert_near(kept, 0.5 * 0.75 * (1 - exp(-2)), 5e-4);
    const double whole = expected(&camera, &g, 0.5);
    if (wall) { /* behind x = 0 as seen from the eye, by the rule of three */
      assert_near(seen / expected(&camera, &g, 0), 1, 0.03);
    } else {
      assert_near(seen / whole, 1, 0.02);
      /* what is nearer is left to gathers */
      s->near = (float)(1.2 / g.unit);
      shine(s, &g, 4);
      assert_true(seen < 0.2 * whole);
    }
    /* an eye in another medium finds nothing by itself */
    s->eye_medium = 0;
    shine(s, &g, 4);
    assert_near(seen, 0, 0);
    /* a beam that ends before the mist, and one without an end out of it */
    const size_t before = s->count;
    shine(s, &g, 1.4);
    assert_int_equal(s->count, before);
    abbe_shaft_photons_free(s);
  }
}
