/* Rays that leave an object, found at nodes and interpolated between them, against Snell's law: a
 * prism's and a ball's stand where it puts them, for the sun and for a lamp nearby, and their flux
 * is all that came in. */
#include "tests/check.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/volume/exits/exit_pages.h"
#include "scenes/volume/half.h"
#include "spectral/optics.h"
#include "tests/validation/lab/filled_volume.h"
#include "tests/validation/trace_scene.h"
#include "validation/lab/exit_fill.h"

#define WEDGE(material)                                                                            \
  CAMERA SUN FLOOR                                                                                 \
      "- {name: wedge, shape: prism, apex: 50, side: 0.1, length: 0.1, material: " material        \
      ", transform: [{rotate: {axis: [1, 2, 3], angle: 40}}, {translate: "                         \
      "[0.1, 0, 0.3]}]}\n"
#define ORB(material)                                                                              \
  CAMERA SUN FLOOR "- {name: orb, shape: sphere, radius: 0.05, levels: 4, material: " material     \
                   ", transform: [{translate: [0, 0, 0.3]}]}\n"

/* The index in a bin's middle, of the made-up glasses: 1.5, and 0.006 over the square of the
 * wavelength in micrometres where it is dispersive. */
static double index_of(size_t bin, bool dispersive) {
  const double um = 0.38 + 0.4 * ((double)bin + 0.5) / ABBE_LIGHT_EXITS_BINS;
  return dispersive ? 1.5 + 0.006 / (um * um) : 1.5;
}

/* Light under way along d bends at the outward normal n; false at total reflection. */
static bool bend(const double d[3], const double n[3], double eta, double out[3]) {
  const double side = abbe_vector_dot(d, n) < 0 ? 1 : -1;
  double wi[3], facing[3];
  for (int k = 0; k < 3; k++) {
    wi[k] = -d[k];
    facing[k] = side * n[k];
  }
  return abbe_optics_refract(wi, facing, eta, out);
}

/* ---- a prism ---- */

/* What is summed up over the rays of one light. */
typedef struct survey {
  const abbe_exact *exact;
  double centre[3], light[3]; /* light: the way it goes */
  double flux, known, square, ghosts, far;
} survey;

/* Where light that came in at a face and way leaves through plane b, by Snell's law alone; from
 * where the ray left, back inside, so that it is known where it came in. */
static bool through(const survey *s, size_t a, size_t b, double n, double out[3]) {
  double in[3];
  return a != b && bend(s->light, s->exact->plane[a], 1 / n, in) &&
         abbe_vector_dot(in, s->exact->plane[b]) > 0 && bend(in, s->exact->plane[b], n, out);
}

/* The plane that a place on the surface lies in. */
static size_t plane_of(const abbe_exact *exact, const double p[3]) {
  size_t best = 0;
  double least = INFINITY;
  for (size_t i = 0; i < exact->count; i++) {
    const double off = fabs(abbe_vector_dot(exact->plane[i], p) - exact->plane[i][3]);
    if (off < least) best = i;
    least = fmin(least, off);
  }
  return best;
}

/* The plane that a way through the body from p meets. */
static size_t plane_on_way(const abbe_exact *exact, const double p[3], const double d[3]) {
  size_t best = 0;
  double least = INFINITY;
  for (size_t i = 0; i < exact->count; i++) {
    const double along = abbe_vector_dot(exact->plane[i], d);
    const double t = (exact->plane[i][3] - abbe_vector_dot(exact->plane[i], p)) / along;
    if (!(along > 1e-9) || !(t < least)) continue;
    least = t;
    best = i;
  }
  return best;
}

/* Rays that Snell's law leads back through two facets to where the light is, and how far they are
 * off the way that it has for these; but for what leaves grazing, which no derivative describes. */
static void look_at_ray(void *user, const abbe_exit_ray *ray, double flux, size_t bin) {
  survey *s = user;
  const double n = index_of(bin, true);
  double place[3], back[3], inside[3], came[3], out[3], off[3];
  s->flux += flux;
  for (int k = 0; k < 3; k++) {
    place[k] = s->centre[k] + ray->place[k];
    back[k] = -ray->way[k];
  }
  const size_t b = plane_of(s->exact, place);
  if (abbe_vector_dot(ray->way, s->exact->plane[b]) < 0.6) return;
  if (!bend(back, s->exact->plane[b], 1 / n, inside)) return;
  const size_t a = plane_on_way(s->exact, place, inside);
  if (!bend(inside, s->exact->plane[a], n, came)) return;
  if (!(abbe_vector_dot(came, s->light) < -cos(0.5)) || !through(s, a, b, n, out)) return;
  abbe_vector_subtract(ray->way, out, off);
  const double far = abbe_vector_length(off);
  s->known += flux;
  if (far > s->far)
    s->ghosts += flux;
  else
    s->square += flux * far * far;
}

static void survey_light(const abbe_scene *scene, const abbe_caustic_volume *v,
                         const double to_light[3], double far, survey *out) {
  abbe_light light = {.kind = ABBE_LIGHT_DIRECTIONAL, .power = 1};
  abbe_volume_place place;
  OK(abbe_volume_body_find(&v->body, &scene->object[1], &place, &error));
  *out = (survey){.exact = &scene->object[1].exact, .far = far};
  memcpy(out->centre, place.centre, sizeof out->centre);
  for (int k = 0; k < 3; k++) light.direction[k] = out->light[k] = -to_light[k];
  const abbe_exit_light_desc desc = {
      .light = &light, .object = &scene->object[1], .place = &place, .min_nm = 380, .max_nm = 780};
  OK(abbe_exit_light_rays(v, &desc, look_at_ray, out, &error));
}

/* Of a convex body what light meets of its faces, by the divergence theorem of its bounds' mesh. */
static double area_across(const abbe_mesh *mesh, const double d[3]) {
  double sum = 0;
  for (size_t i = 0; i < mesh->face_count; i++) {
    double n[3];
    const uint32_t *f = mesh->face[i];
    abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], n);
    sum += fabs(abbe_vector_dot(n, d)) / 4;
  }
  return sum;
}

/* In the middle of some of the triangles between nodes. */
static double middle_error(const abbe_scene *scene, const abbe_caustic_volume *v, double far,
                           double *ghosts) {
  double square = 0, known = 0, all = 0;
  *ghosts = 0;
  for (size_t f = 0; f < v->nodes.mesh.face_count; f += v->nodes.mesh.face_count / 20) {
    double to_light[3] = {0};
    survey s;
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) to_light[k] += v->nodes.mesh.corner[v->nodes.mesh.face[f][c]][k];
    abbe_vector_normalise(to_light);
    survey_light(scene, v, to_light, far, &s);
    /* no light is lost or made: the glass is clear, and the body convex; as far as 300 points tell
     */
    assert_near(s.flux / area_across(&scene->object[1].mesh, to_light), 1, 0.07);
    square += s.square;
    known += s.known;
    *ghosts += s.ghosts;
    all += s.flux;
  }
  print_message("%.2f of the light through two facets; ", known / all);
  assert_true(known > 0.08 * all);
  *ghosts /= known;
  return sqrt(square / known);
}

/* Nodes half as far apart: an error of a quarter and less; copies of a beam beside it are what is
 * further off than half the square of the distance between nodes. */
TEST(a_prism_bends_as_snell_has_it) {
  enum { LEVELS = SANITIZED ? 2 : 3 };
  static const size_t nodes[] = {42, 162, 642};
  double error[LEVELS], ghosts[LEVELS];
  OWNED(abbe_scene, scene) = scene_of(WEDGE("crown"));
  for (size_t i = 0; i < LEVELS; i++) {
    abbe_volume_fill_statistics done;
    const double apart = 1.107 / (double)(2 << i);
    const abbe_volume_fill_desc desc =
        FIELDS(.object = 1, .nodes = nodes[i], .exits = 1200,
               .region = {.kind = ABBE_REGION_GRID, .side = 2}, .threads = 2);
    FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
    error[i] = middle_error(&scene, &v, apart * apart / 2, &ghosts[i]);
    print_message("%zu nodes: off by %.2e rad, but for %.2g of it, by more than %.2e; %zu "
                  "sequences, %.2g alone\n",
                  nodes[i], error[i], ghosts[i], apart * apart / 2, done.sequences, done.alone);
    assert_near(done.carried, 1, 0.01);
  }
  for (size_t i = 0; i < LEVELS; i++) assert_true(ghosts[i] < (i == 0 ? 0.05 : 0.01));
  for (size_t i = 1; i < LEVELS; i++)
    assert_true(error[i] < error[i - 1] / 4 || (i == 2 && error[i] < 5e-4)); /* halves' own steps */
}

/* ---- a ball ---- */

typedef struct ball {
  double lamp[3], radius; /* from its centre */
  double flux, square, cross, paraxial;
} ball;

/* From where a ray leaves the ball, Snell's law back to where it came in, and on to the lamp: how
 * far that is from where the lamp is, as an angle. Straight through alone. */
static void look_at_ball_ray(void *user, const abbe_exit_ray *ray, double flux, size_t bin) {
  ball *b = user;
  double back[3], n[3], inside[3], in[3], m[3], out[3], to_lamp[3];
  (void)bin;
  for (int k = 0; k < 3; k++) {
    back[k] = -ray->way[k];
    n[k] = ray->place[k];
  }
  abbe_vector_normalise(n);
  if (!bend(back, n, 1 / 1.5, inside)) return;
  const double length = -2 * b->radius * abbe_vector_dot(inside, n);
  for (int k = 0; k < 3; k++) m[k] = in[k] = b->radius * n[k] + length * inside[k];
  abbe_vector_normalise(m);
  if (!bend(inside, m, 1.5, out)) return;
  abbe_vector_subtract(b->lamp, in, to_lamp);
  abbe_vector_normalise(to_lamp);
  const double off = acos(fmin(abbe_vector_dot(to_lamp, out), 1));
  if (off > 0.2) return; /* reflected somewhere */
  b->flux += flux;
  b->square += flux * off * off;
  double axis[3];
  memcpy(axis, b->lamp, sizeof axis);
  abbe_vector_normalise(axis);
  const double along = abbe_vector_dot(in, axis);
  const double side = sqrt(fmax(b->radius * b->radius - along * along, 0));
  if (along < 0 || side > 0.2 * b->radius) return;
  /* where it comes nearest to the axis */
  const double c = abbe_vector_dot(ray->way, axis), pa = abbe_vector_dot(ray->place, axis),
               pd = abbe_vector_dot(ray->place, ray->way);
  const double t = (c * pa - pd) / (1 - c * c);
  b->paraxial += flux;
  b->cross -= flux * (pa + t * c);
}

/* A lamp at a distance D: a ball of n focuses its light at f D / (D - f), f = n R / (2 (n - 1)). */
TEST(lamps_nearby_are_lamps_nearby) {
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(ORB("flat"));
  const abbe_volume_fill_desc desc =
      FIELDS(.object = 1, .exits = 1200, .nodes = 162,
             .region = {.kind = ABBE_REGION_GRID, .side = 2}, .threads = 2);
  FILLED(abbe_caustic_volume, v, fill_volume(&scene, &desc, &v, &done));
  abbe_light light = {.kind = ABBE_LIGHT_POINT, .power = 1};
  abbe_volume_place place;
  OK(abbe_volume_body_find(&v.body, &scene.object[1], &place, &error));
  for (double far = 4; far < 20; far *= 2) {
    const double f = 1.5 / (2 * 0.5);
    ball b = {.lamp = {0.2, 0.5, 0.8}, .radius = 0.05};
    abbe_vector_normalise(b.lamp);
    for (int k = 0; k < 3; k++) {
      b.lamp[k] *= far * b.radius;
      light.position[k] = place.centre[k] + b.lamp[k];
    }
    const abbe_exit_light_desc seen = {
        .light = &light, .object = &scene.object[1], .place = &place, .min_nm = 380, .max_nm = 780};
    OK(abbe_exit_light_rays(&v, &seen, look_at_ball_ray, &b, &error));
    const double focus = b.cross / b.paraxial / b.radius, off = sqrt(b.square / b.flux);
    print_message("a lamp at %g radii: focus at %.3f, Gauss has %.3f; off by %.2e rad\n", far,
                  focus, f * far / (far - f), off);
    assert_near(focus, f * far / (far - f), 0.06);
    assert_true(off < 0.01);
  }
}

/* ---- light around it ---- */

/* At a node the cells hold what photons bring there, in any light's colour. */
TEST(cells_hold_what_photons_bring) {
  OWNED(abbe_caustic_volume, exits);
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(WEDGE("crown"));
  const abbe_region_desc region = {.kind = ABBE_REGION_OCTAHEDRAL, .side = 8, .shells = 4};
  const abbe_volume_fill_desc desc = {.object = 1,
                                      .nodes = 12,
                                      .exits = 16000,
                                      .asymmetric = true, /* else its images are between nodes */
                                      .region = region,
                                      .threads = 2},
                              by_photons = FIELDS(.object = 1, .nodes = 12, .region = region,
                                                  .photons = 1 << 15, .passes = 1, .threads = 2);
  fill_volume(&scene, &desc, &exits, &done);
  FILLED(abbe_caustic_volume, values, fill_volume(&scene, &by_photons, &values, &done));
  const size_t count = 9 * exits.region.cells, node = 5;
  FREED float *value = malloc(count * sizeof *value);
  assert_non_null(value);
  abbe_volume_place place;
  OK(abbe_volume_body_find(&exits.body, &scene.object[1], &place, &error));
  abbe_light light = {.kind = ABBE_LIGHT_DIRECTIONAL, .power = 1};
  for (int k = 0; k < 3; k++) light.direction[k] = -exits.nodes.direction[node][k];
  const abbe_exit_light_desc seen = {
      .light = &light, .object = &scene.object[1], .place = &place, .min_nm = 380, .max_nm = 780};
  OK(abbe_exit_light_fill(&exits, &seen, value, &error));
  double off = 0, all = 0, now[3] = {0}, then[3] = {0}, white[3];
  for (size_t i = 0; i < count; i++) {
    const double x = abbe_half_value(values.value[node * count + i]);
    off += fabs((double)value[i] - x);
    all += fabs(x);
    now[i % 9 / 3] += fabs((double)value[i]);
  }
  print_message("cells differ by %.3f of their light\n", off / all);
  assert_true(off < 0.12 * all);
  light.illuminant = (abbe_illuminant){.kind = ABBE_ILLUMINANT_A};
  OK(abbe_exit_light_fill(&exits, &seen, value, &error));
  for (size_t i = 0; i < count; i++) then[i % 9 / 3] += fabs((double)value[i]);
  abbe_weights_white(ABBE_OBSERVER_CIE_1931, &light.illuminant, 380, 780, white);
  /* what leaves it has nearly the light's own colour */
  for (int c = 0; c < 3; c++) {
    assert_near(now[c] / now[1], exits.white[c], 0.03);
    assert_near(then[c] / then[1], white[c], 0.03);
  }
}

TEST(threads_change_nothing) {
  abbe_caustic_volume v[3];
  abbe_volume_fill_statistics done;
  OWNED(abbe_scene, scene) = scene_of(WEDGE("murk"));
  abbe_volume_fill_desc desc = {.object = 1, .nodes = 12, .exits = 500};
  for (size_t i = 0; i < 3; i++) {
    desc.threads = i == 0 ? 1 : 2;
    desc.seed = i == 2;
    fill_volume(&scene, &desc, &v[i], &done);
    assert_true(done.carried > 0.5 && done.carried < 0.99); /* it absorbs */
  }
  assert_int_equal(v[0].exits.count, v[1].exits.count);
  const size_t bytes = v[0].exits.count * sizeof *v[0].exits.exit;
  assert_memory_equal(v[0].exits.exit, v[1].exits.exit, bytes);
  assert_memory_not_equal(v[0].exits.point, v[2].exits.point,
                          v[0].exits.points * sizeof *v[0].exits.point);
  for (size_t i = 0; i < 3; i++) abbe_caustic_volume_free(&v[i]);
}

TEST(requests) {
  abbe_caustic_volume v;
  abbe_volume_fill_statistics done;
  int calls = 0;
  OWNED(abbe_scene, scene) = scene_of(WEDGE("crown"));
  abbe_volume_fill_desc desc = {.object = 1, .exits = 10, .nodes = 1};
  REFUSED(ABBE_INVALID_ARGUMENT, "nodes", abbe_volume_fill(&scene, &desc, &v, &done, &error));
  desc.nodes = 12;
  desc.kind = ABBE_VOLUME_PRINTED;
  REFUSED(ABBE_INVALID_ARGUMENT, "printed", abbe_volume_fill(&scene, &desc, &v, &done, &error));
  desc.kind = ABBE_VOLUME_VECTOR;
  desc.progress = stop_at_once;
  desc.user = &calls;
  REFUSED(ABBE_CANCELLED, "", abbe_volume_fill(&scene, &desc, &v, &done, &error));
  assert_int_equal(calls, 1);
  assert_null(v.exits.exit);
  OWNED(abbe_scene, coated) = scene_of(WEDGE("crown, coating: {layers: [[1.38, 99.6]]}"));
  desc.progress = NULL;
  REFUSED(ABBE_UNSUPPORTED, "'wedge' has a coating",
          abbe_volume_fill(&coated, &desc, &v, &done, &error));
}

/* Points on an object's surface: even by area, on the surface, of every wavelength by its chance.
 */

#define PI 3.14159265358979323846
enum { COUNT = 8192 };

static void make_points(const char *objects, abbe_scene *scene, abbe_lone_object *lone,
                        abbe_exit_points *points) {
  static double unit_map[1][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const abbe_body_symmetry none = {1, unit_map};
  *scene = scene_of(printed("%s%s", CAMERA SUN FLOOR, objects));
  OK(abbe_lone_object_make(scene, 1, 0, lone, &error));
  OK(abbe_exit_points_make(lone, &none, COUNT, 380, 780, 0, points, &error));
  assert_int_equal(points->count, COUNT);
}

static void free_points(abbe_scene *scene, abbe_lone_object *lone, abbe_exit_points *points) {
  abbe_exit_points_free(points);
  abbe_lone_object_free(lone);
  abbe_scene_free(scene);
}

TEST(a_ball) {
  abbe_scene scene = {0};
  abbe_lone_object lone;
  abbe_exit_points points;
  double mean[3] = {0}, square[3] = {0};
  make_points(BALL("crown"), &scene, &lone, &points);
  assert_near(points.area, 4 * PI * 0.08 * 0.08, 1e-6);
  const abbe_surface *s = &lone.geometry.surface[0];
  for (size_t i = 0; i < COUNT; i++)
    for (int k = 0; k < 3; k++) {
      const abbe_exit_point *p = &points.point[i];
      assert_near((double)p->place[k],
                  (double)s->centre[k] + (double)s->radius * (double)p->normal[k], 1e-6);
      mean[k] += (double)p->normal[k] / COUNT;
      square[k] += (double)p->normal[k] * (double)p->normal[k] / COUNT;
    }
  for (int k = 0; k < 3; k++) {
    assert_near(mean[k], 0, 1e-3); /* at random 6e-3 */
    assert_near(square[k], 1.0 / 3, 1e-3);
  }
  free_points(&scene, &lone, &points);
}

/* Faces have points by their areas; wavelengths and decisions are even. */
TEST(a_brick) {
  static const double size[3] = {0.1, 0.08, 0.06};
  abbe_scene scene = {0};
  abbe_lone_object lone;
  abbe_exit_points points;
  double side[3] = {0}, bin = 0, expected = 0, chance[ABBE_LIGHT_EXITS_BINS], first = 0;
  make_points(BRICK("crown"), &scene, &lone, &points);
  const double area = 2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  assert_near(points.area, area, 1e-6);
  for (size_t i = 0; i < COUNT; i++) {
    const abbe_exit_point *p = &points.point[i];
    for (int k = 0; k < 3; k++) side[k] += fabs((double)p->normal[k]) / COUNT;
    bin += (double)p->bin / COUNT;
    first += (double)p->chance[0] / COUNT;
    for (int k = 0; k < ABBE_EXIT_WALK_CHANCES; k++)
      assert_true(p->chance[k] >= 0 && p->chance[k] < 1);
  }
  for (int k = 0; k < 3; k++)
    assert_near(side[k], 2 * size[(k + 1) % 3] * size[(k + 2) % 3] / area, 2e-3);
  abbe_light_exits_chances(380, 780, chance);
  for (size_t i = 0; i < ABBE_LIGHT_EXITS_BINS; i++) expected += (double)i * chance[i];
  assert_near(bin, expected, 0.2);
  assert_near(first, 0.5, 2e-3);
  free_points(&scene, &lone, &points);
}

/* A sheet of metal reflects on both sides. */
TEST(an_open_mirror) {
  abbe_scene scene = {0};
  abbe_lone_object lone;
  abbe_exit_points points;
  size_t up = 0;
  make_points("- {name: pane, shape: rectangle, width: 0.1, height: 0.2, mirror: 0.9, transform: "
              "[{translate: [0, 0, 0.2]}]}\n",
              &scene, &lone, &points);
  assert_near(points.area, 0.04, 1e-7);
  for (size_t i = 0; i < COUNT; i++) up += points.point[i].normal[2] > 0;
  assert_int_equal(up, COUNT / 2);
  free_points(&scene, &lone, &points);
}
