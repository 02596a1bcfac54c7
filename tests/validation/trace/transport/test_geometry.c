#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "validation/trace/transport/geometry.h"

static void ray(const abbe_geometry *g, const double from[3], const double to[3], float o[3],
                float d[3]) {
  double way[3];
  abbe_geometry_to_frame(g, from, o);
  abbe_vector_subtract(to, from, way);
  abbe_vector_normalise(way);
  for (int k = 0; k < 3; k++) d[k] = (float)way[k];
}

/* part: of the sentence that refuses it, or NULL. */
static void make_of(const char *text, const char *part) {
  OWNED(abbe_geometry, g) = {0};
  abbe_error error = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  assert_int_equal(abbe_geometry_make(&scene, &g, &error), part ? ABBE_UNSUPPORTED : ABBE_OK);
  if (part) assert_non_null(strstr(error.text, part));
}

/* A plate of half a diagonal of 0.1 m or so: eight steps off its faces are 2^-15 of that. */
TEST(what_is_thinner_than_its_steps_is_refused) {
#define PLATE(thick)                                                                               \
  CAMERA POINT_LIGHT FLOOR "- {name: plate, shape: box, size: [0.2, 0.2, " thick                   \
                           "], transform: [{translate: [0, 0, 0.2]}], material: crown}\n"
  make_of(PLATE("3e-6"), "'plate' is 3e-06 m thin");
  make_of(PLATE("4e-6"), NULL);
}

/* Solids of curved faces that are flat as foil, which no axis of the world tells once turned. */
TEST(foil_is_refused_however_it_is_turned) {
  static const char *const shape[] = {"sphere, radius: 0.04", "ring, major: 0.04, minor: 0.01"};
  for (int i = 0; i < 8; i++) {
    make_of(
        printed(
            CAMERA POINT_LIGHT FLOOR
            "- {name: foil, shape: %s, transform: [{scale: [1, 1, %s]}, {rotate: {axis: [1, 0.5, "
            "0], angle: %d}}, {translate: [0, 0, 0.2]}], material: crown}\n",
            shape[i % 2], i < 4 ? "1e-6" : "1e-2", i / 2 % 2 * 40),
        i < 4 ? "does not tell its front from its back" : NULL);
  }
}

TEST(hits_a_sphere_from_outside_and_inside) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  float o[3], d[3], next[3];
  abbe_hit hit;
  ray(&g, (double[3]){0, 0, 1}, (double[3]){0.03, 0.01, 0.2}, o, d);
  assert_true(abbe_geometry_hit(&g, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY, &hit));
  double p[3], r[3];
  abbe_geometry_to_world(&g, hit.p, p);
  abbe_vector_subtract(p, scene.object[1].exact.centre, r);
  assert_true(fabs(abbe_vector_length(r) - 0.08) < 1e-8);
  assert_true(d[0] * hit.n[0] + d[1] * hit.n[1] + d[2] * hit.n[2] < 0);
  /* straight on from inside: the other side, not this one again */
  abbe_geometry_leave(&hit, d, next);
  abbe_hit other;
  assert_true(abbe_geometry_hit(&g, ABBE_GEOMETRY_REFRACTORS, next, d, INFINITY, &other));
  assert_true(d[0] * other.n[0] + d[1] * other.n[1] + d[2] * other.n[2] > 0);
  double q[3], chord[3];
  abbe_geometry_to_world(&g, other.p, q);
  abbe_vector_subtract(q, p, chord);
  assert_true(abbe_vector_length(chord) > 0.1);
  assert_true(abbe_geometry_occluded(&g, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY));
  assert_false(abbe_geometry_occluded(&g, ABBE_GEOMETRY_RECEIVERS, o, d, 1));
}

/* A closed mesh is left as often as it is entered, also along its edges and through its corners:
 * watertight. */
TEST(no_ray_slips_between_faces) {
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  const abbe_object *gem = &scene.object[g.refractor_object[0]];
  double middle[3];
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (gem->min[k] + gem->max[k]);
  for (size_t i = 0; i < gem->mesh.face_count; i++)
    for (int corner = 0; corner < 3; corner++)
      for (int step = 0; step <= 8; step++) {
        const double *a = gem->mesh.position[gem->mesh.face[i][corner]];
        const double *b = gem->mesh.position[gem->mesh.face[i][(corner + 1) % 3]];
        double to[3];
        for (int k = 0; k < 3; k++) to[k] = a[k] + (b[k] - a[k]) * step / 8;
        float o[3], d[3];
        abbe_hit hit;
        ray(&g, middle, to, o, d);
        assert_true(abbe_geometry_hit(&g, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY, &hit));
      }
}

/* The same hits, relative to the size, for scenes from 1e-4 to 1e5 m and far from the origin. */
TEST(size_and_place_do_not_matter) {
  float expected[3] = {0};
  const double sizes[] = {1, 1e-4, 1e5}, places[] = {0, 0, 1e6};
  for (int i = 0; i < 3; i++) {
    OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR RING("crown"));
    for (size_t j = 0; j < scene.object_count; j++) {
      abbe_object *o = &scene.object[j];
      for (size_t v = 0; v < o->mesh.vertex_count; v++)
        for (int k = 0; k < 3; k++)
          o->mesh.position[v][k] = sizes[i] * o->mesh.position[v][k] + places[i];
      for (int k = 0; k < 3; k++) {
        o->min[k] = sizes[i] * o->min[k] + places[i];
        o->max[k] = sizes[i] * o->max[k] + places[i];
      }
    }
    MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
    double from[3] = {0.05, 0.06, 0.5}, to[3] = {0.08, 0, 0.2};
    for (int k = 0; k < 3; k++) {
      from[k] = sizes[i] * from[k] + places[i];
      to[k] = sizes[i] * to[k] + places[i];
    }
    float o[3], d[3];
    abbe_hit hit;
    ray(&g, from, to, o, d);
    assert_true(abbe_geometry_hit(&g, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY, &hit));
    for (int k = 0; k < 3; k++) {
      if (i == 0)
        expected[k] = hit.n[k];
      else
        assert_true(fabsf(hit.n[k] - expected[k]) < 1e-4f);
    }
  }
}
