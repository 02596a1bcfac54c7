/* Receivers that are meshes: the shaders' nearest hit against double precision, triangles against
 * the parallelograms that they tile, and light on a ball in closed form. */
#include "tests/gl/frame.h"
#include "tests/gl/glsl.h"
#include "tests/random.h"

#include "base/maths.h"
#include "scenes/mesh/bvh.h"
#include "scenes/shapes/shape.h"
#include "scenes/view/view.h"

/* ---- the nearest receiver ---- */

enum { RAYS = 4096, FLATS = 3 };

typedef struct receivers {
  float flat[FLATS][6][4]; /* as common.glsl has a parallelogram */
  abbe_mesh mesh;
  double (*triangle)[9];
  abbe_bvh h;
  double (*tiles)[9]; /* two triangles a parallelogram */
} receivers;

/* Parallelogram k: a skew one, facing another way each. */
static void make_flat(int k, receivers *r) {
  const double corner[3] = {-0.2 + 0.1 * k, -0.15, 0.05 * k - 0.1};
  double u[3] = {0.3, 0.02 * k, 0.1}, v[3] = {0.03, 0.25, -0.1 * k}, n[3], du[3], dv[3];
  abbe_vector_cross(u, v, n);
  const double area2 = abbe_vector_dot(n, n);
  abbe_vector_cross(v, n, du);
  abbe_vector_cross(n, u, dv);
  const double *const row[6] = {corner, u, v, n, du, dv};
  for (int i = 0; i < 6; i++)
    for (int c = 0; c < 3; c++)
      r->flat[k][i][c] = (float)(row[i][c] / (i < 3 ? 1 : i == 3 ? sqrt(area2) : area2));
  r->flat[k][0][3] = (float)k;
  r->flat[k][3][3] = (float)(abbe_vector_dot(n, corner) / sqrt(area2));
  for (int c = 0; c < 3; c++) {
    double *a = r->tiles[2 * k], *b = r->tiles[2 * k + 1];
    a[c] = corner[c];
    a[3 + c] = corner[c] + u[c];
    a[6 + c] = b[3 + c] = corner[c] + u[c] + v[c];
    b[c] = corner[c];
    b[6 + c] = corner[c] + v[c];
    a[6 + c] = b[3 + c];
  }
}

static void upload_receivers(receivers *r) {
  const abbe_gl *gl = abbe_context_gl(context);
  float(*triangle)[4] = calloc(3 * r->h.triangle_count, sizeof *triangle);
  float(*corner)[4] = calloc(4 * r->h.triangle_count, sizeof *corner);
  for (size_t i = 0; i < r->h.triangle_count; i++) {
    const uint32_t *f = r->mesh.face[r->h.triangle[i]];
    const uint32_t surface = FLATS;
    for (int k = 0; k < 3; k++) {
      const double *a = r->mesh.position[f[0]];
      triangle[3 * i][k] = (float)a[k];
      triangle[3 * i + 1][k] = (float)(r->mesh.position[f[1]][k] - a[k]);
      triangle[3 * i + 2][k] = (float)(r->mesh.position[f[2]][k] - a[k]);
      for (int c = 0; c < 3; c++) corner[4 * i + (size_t)c][k] = (float)r->mesh.normal[f[c]][k];
    }
    memcpy(&triangle[3 * i + 1][3], &surface, sizeof surface);
  }
  glsl_block(gl, BINDING_RECEIVERS, sizeof r->flat, r->flat);
  glsl_hierarchy(gl, &r->h, (const double(*)[9])r->triangle);
  glsl_texels(gl, UNIT_BVH_TRIANGLES, GL_RGBA32F, 3 * r->h.triangle_count * sizeof *triangle,
              triangle);
  glsl_texels(gl, UNIT_BVH_CORNERS, GL_RGBA32F, 4 * r->h.triangle_count * sizeof *corner, corner);
  free(triangle);
  free(corner);
}

static void make_receivers(receivers *r) {
  memset(r, 0, sizeof *r);
  r->tiles = calloc(2 * FLATS, sizeof *r->tiles);
  for (int k = 0; k < FLATS; k++) make_flat(k, r);
  OK(abbe_shape_ring(0.2, 0.06, 48, 24, &r->mesh, &error));
  r->triangle = abbe_bvh_triangles(&r->mesh);
  OK(abbe_bvh_make((const double(*)[9])r->triangle, r->mesh.face_count, &r->h, &error));
  upload_receivers(r);
}

static void receivers_free(receivers *r) {
  abbe_mesh_free(&r->mesh);
  abbe_bvh_free(&r->h);
  free(r->triangle);
  free(r->tiles);
}

/* Parallelogram, FLATS for the mesh, -1 for none; the interpolated normal of a mesh. */
static int nearest(const receivers *r, const double o[3], const double d[3], double t_max,
                   double *t, double n[3]) {
  abbe_bvh_hit hit;
  int found = -1;
  *t = t_max;
  for (int i = 0; i < 2 * FLATS; i++)
    if (abbe_bvh_meet(r->tiles[i], o, d, 0, 0, *t, &hit)) {
      *t = hit.t;
      found = i / 2;
    }
  for (size_t i = 0; i < r->mesh.face_count; i++) {
    if (!abbe_bvh_meet(r->triangle[i], o, d, 0, 0, *t, &hit)) continue;
    const uint32_t *f = r->mesh.face[i];
    *t = hit.t;
    found = FLATS;
    for (int k = 0; k < 3; k++)
      n[k] = (1 - hit.u - hit.v) * r->mesh.normal[f[0]][k] + hit.u * r->mesh.normal[f[1]][k] +
             hit.v * r->mesh.normal[f[2]][k];
    abbe_vector_normalise(n);
  }
  return found;
}

static const char rooms[] =
    "#define LIGHTS 1\n#define REFLECTION_ROOM 64\n#define LIGHT_ROOM 1\n#define REFRACTORS "
    "0\n#define REFRACTOR_ROOM 1\n"
    "#define PLANE_ROOM 1\n#define RECEIVERS 3\n#define RECEIVER_ROOM 3\n#define SURFACE_ROOM 1\n"
    "#define SPECTRUM_ROOM 1\n#define WAVELENGTHS 1\n#define RECEIVER_HIERARCHY\n"
    "#define RECEIVER_ROOT 0\n";

GROUP(make_context, free_context);

/* Single precision: 1e-5 of the size, but for rays that graze a triangle or an edge, which may miss
 * it: one in two hundred. The normal turns by 1e-5 over the radius of the tube. */
TEST(shaders_find_the_nearest_of_both) {
  static float in[RAYS][8], out[RAYS][4], normal[RAYS][4];
  char text[2048];
  uint64_t random = 5;
  size_t odd = 0, met[FLATS + 1] = {0};
  FILLED(receivers, r, make_receivers(&r));
  for (int i = 0; i < RAYS; i++) {
    double o[3], d[3];
    for (int k = 0; k < 3; k++) {
      o[k] = random_between(&random, -0.6, 0.6);
      d[k] = random_between(&random, -0.2, 0.2) - o[k];
    }
    abbe_vector_normalise(d);
    for (int k = 0; k < 3; k++) {
      in[i][k] = (float)o[k];
      in[i][4 + k] = (float)d[k];
    }
    in[i][3] = i % 3 == 0 ? 0.5f : 10; /* as far as they go */
  }
  snprintf(
      text, sizeof text,
      "%s#define HIERARCHY_STACK %zu\n#include \"refractor.glsl\"\n#include \"receiver.glsl\"\n"
      "vec4 f(vec4 a, vec4 b) {\n"
      "  float t;\n  int r = receiver_hit(a.xyz, b.xyz, 0.0, a.w, t), surface = r;\n"
      "  if (receiver_between(a.xyz, b.xyz, 0.0, a.w) != r >= 0) return vec4(-9);\n"
      "  if (r >= 0 && receiver_part(r) != min(r, RECEIVERS)) return vec4(-9);\n"
      "  vec3 n = vec3(0);\n  vec2 uv;\n"
      "  if (r >= RECEIVERS) triangle_at(r - RECEIVERS, a.xyz + t * b.xyz, -b.xyz, n, surface, "
      "uv);\n"
      "  return b.w == 0.0 ? vec4(surface, t, dot(face_n, n), dot(n, b.xyz)) : vec4(n, 0);\n}\n",
      rooms, r.h.depth + 1);
  glsl_evaluate(abbe_context_gl(context), text, (const float(*)[8])in, RAYS, out);
  for (int i = 0; i < RAYS; i++) in[i][7] = 1;
  glsl_evaluate(abbe_context_gl(context), text, (const float(*)[8])in, RAYS, normal);
  for (int i = 0; i < RAYS; i++) {
    double o[3], d[3], n[3] = {0, 0, 0}, t;
    for (int k = 0; k < 3; k++) {
      o[k] = (double)in[i][k];
      d[k] = (double)in[i][4 + k];
    }
    const int found = nearest(&r, o, d, (double)in[i][3], &t, n);
    if (found >= 0) met[found]++;
    assert_true(out[i][0] > -9);
    bool same = (int)out[i][0] == found && fabs((double)out[i][1] - t) < 1e-5;
    /* a normal that is bent away from the viewer is the face's */
    if (same && found == FLATS) {
      assert_true(out[i][3] < 0 && out[i][2] > 0.9f);
      double cosine = 0;
      for (int k = 0; k < 3; k++) cosine += n[k] * (double)normal[i][k];
      if (abbe_vector_dot(n, d) < 0) same = cosine > 1 - 1e-5;
    }
    odd += !same;
  }
  for (int k = 0; k <= FLATS; k++) assert_true(met[k] > RAYS / 50);
  if (odd * 200 >= RAYS) print_error("%zu of %d rays differ\n", odd, RAYS);
  assert_true(odd * 200 < RAYS);
}

/* ---- triangles that tile parallelograms ---- */

typedef struct frame {
  abbe_image picture, map;
  abbe_ledger energy;
} frame;

static void draw(const abbe_scene *scene, const abbe_render_desc *desc, abbe_map_layout *layout,
                 frame *out) {
  HELD(abbe_renderer, renderer) = make_renderer(scene, desc);
  out->energy = draw_frame(renderer).energy;
  assert_true(out->energy.reached > 0 && abbe_ledger_imbalance(&out->energy) < 1e-4);
  out->picture = read_picture(renderer, desc->aovs);
  out->map = map_of(renderer, 0);
  if (layout != NULL) abbe_renderer_map_layout(renderer, 0, layout);
}

static void frame_free(frame *f) {
  abbe_image_free(&f->picture);
  abbe_image_free(&f->map);
}

/* Sum of the differences, relative to the first's. */
static double apart(const abbe_image *a, const abbe_image *b) {
  double differences = 0, sum = 0;
  assert_int_equal(a->width * a->height * a->channels, b->width * b->height * b->channels);
  for (size_t i = 0; i < a->width * a->height * a->channels; i++) {
    differences += fabs((double)a->data[i] - (double)b->data[i]);
    sum += fabs((double)a->data[i]);
  }
  assert_true(sum > 0);
  return differences / sum;
}

#define TEXTURED_FLOOR                                                                             \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5, "            \
  "texture: " ABBE_SOURCE_DIR "/scenes/wood.png, repeat: [2, 3]}\n"
#define CRATE                                                                                      \
  "- {name: crate, shape: box, size: [0.1, 0.12, 0.08], transform: [{rotate: {axis: [0, 0, 1], "   \
  "angle: 20}}, {translate: [-0.3, 0.4, 0.04]}], reflectance: [0.6, 0.5, 0.2]}\n"

/* A rectangle and a box beside a hill, by their parallelograms and by their triangles: through a
 * ball, which sees both, and through a ring, whose light takes multi-refractor paths. The box hides
 * none of that light from the lamp: places that it hides have maps where they are parallelograms.
 */
TEST(triangles_do_as_parallelograms_do) {
  static const char *const texts[] = {CAMERA POINT_LIGHT TEXTURED_FLOOR CRATE HILL BALL("crown"),
                                      CAMERA SUN TEXTURED_FLOOR CRATE HILL RING("flat")};
  for (int i = all_cases() ? 0 : 1; i < 2; i++) {
    abbe_map_layout layout;
    abbe_render_desc desc = small_frame;
    if (i == 1) desc.width = desc.height = desc.photons = 32;
    OWNED(abbe_scene, scene) = scene_of(texts[i]);
    FILLED(frame, flat, draw(&scene, &desc, &layout, &flat));
    scene.object[0].exact.kind = scene.object[1].exact.kind = ABBE_EXACT_NONE;
    desc.map_layout = &layout;
    FILLED(frame, mesh, draw(&scene, &desc, NULL, &mesh));
    scene.object[0].exact.kind = scene.object[1].exact.kind = ABBE_EXACT_PARALLELOGRAMS;
    /* edges are a float's few digits wider or narrower, and light there lands here or there */
    assert_true(apart(&flat.map, &mesh.map) < 1e-5);
    assert_true(apart(&flat.picture, &mesh.picture) < 1e-6);
    assert_near(mesh.energy.deposited / flat.energy.deposited, 1, 1e-4);
    assert_near(mesh.energy.missed / flat.energy.missed, 1, 1e-3);
  }
}

/* ---- a ball in closed form ---- */

/* Of a pane between faces that reflect r = 0.04 each at normal incidence, any number of times. */
static const double pane_passes = (1 - 0.04) / (1 + 0.04), pane_reflects = 2 * 0.04 / (1 + 0.04);

#define UNDER_A_PANE                                                                               \
  "materials: glass.yaml\ncamera: {eye: [0, -1, 0.3], target: [0, 0, 0.15], fov: 14}\n"            \
  "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n" FLOOR        \
  "- {name: pane, shape: box, size: [0.3, 0.3, 0.05], transform: [{translate: [0, 0, 0.5]}], "     \
  "material: flat}\n"                                                                              \
  "- {name: globe, shape: sphere, radius: 0.1, levels: 5, transform: [{translate: [0, 0, 0.15]}]," \
  " reflectance: 0.5}\n"

static const double globe_centre[3] = {0, 0, 0.15}, globe_radius = 0.1;

/* Where the pixel's ray meets the globe, as a unit normal. */
static bool globe_normal(const abbe_camera *camera, size_t side, size_t pixel, double n[3]) {
  double forward[3], o[3], d[3], along = 0, square = 0;
  abbe_view view;
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_view_look(camera->eye, forward, camera->up, false, &view);
  const double y = tan(0.5 * camera->fov_y_rad);
  memcpy(view.window, (const double[4]){-y, y, -y, y}, sizeof view.window);
  const double uv[2] = {((double)(pixel % side) + 0.5) / (double)side,
                        1 - ((double)(pixel / side) + 0.5) / (double)side};
  abbe_view_ray(&view, uv, o, d);
  for (int k = 0; k < 3; k++) {
    along += (o[k] - globe_centre[k]) * d[k];
    square += (o[k] - globe_centre[k]) * (o[k] - globe_centre[k]);
  }
  const double inside = along * along - square + globe_radius * globe_radius;
  for (int k = 0; k < 3; k++)
    n[k] = (o[k] + (-along - sqrt(inside)) * d[k] - globe_centre[k]) / globe_radius;
  return inside > 0;
}

/* Every photon goes straight down, to the globe or past it. Its facets lie at most 2e-4 m within
 * it, and are inclined to it by
 * up to 0.04, which the cosine shows, beside what a texel and a pixel hold. */
TEST(light_lands_on_a_ball_behind_a_pane) {
  enum { SIDE = 48 };
  const abbe_render_desc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .supersample = 1,
                                 .adaptive = 1, /* known at pixels' middles */
                                 .photons = 192,
                                 .map_size = 256,
                                 .energy_share = 1e-6,
                                 .exits = ABBE_RENDER_MAX_EXITS,
                                 .space = ABBE_RGB_SPACE_XYZ,
                                 .aovs = true};
  size_t on_globe = 0, seen = 0;
  OWNED(abbe_scene, scene) = scene_of(UNDER_A_PANE);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  const abbe_ledger e = draw_frame(renderer).energy;
  assert_true(abbe_ledger_imbalance(&e) < 1e-4);
  assert_near(e.deposited / e.reached, pane_passes, 1e-3);
  MADE(abbe_renderer_hits, hits,
       abbe_renderer_read_hits(renderer, 0, 0, NULL, NULL, &hits, &error));
  for (size_t i = 0; i < hits.count * hits.slots * hits.samples; i++) {
    const float *p = hits.at + 4 * i;
    if (p[3] <= 0) continue;
    const double aside = hypot((double)p[0], (double)p[1]);
    const double up = (double)p[2] - globe_centre[2];
    if (aside < globe_radius - 5e-4) {
      assert_true(hypot(aside, up) < globe_radius + 1e-6);
      assert_true(hypot(aside, up) > globe_radius - 2e-4 && up > 0);
      on_globe++;
    } else if (aside > globe_radius) {
      assert_near(p[2], 0, 1e-6);
    }
  }
  assert_true(on_globe > hits.count / 4);
  OWNED(abbe_image, picture) = aovs_of(renderer);
  const size_t caustic = abbe_image_find_channel(&picture, "caustic.Y");
  const size_t direct = abbe_image_find_channel(&picture, "direct.Y");
  double sum = 0, expected = 0, worst = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    double n[3];
    if (!globe_normal(&scene.camera, SIDE, i, n) || n[2] < 0.2 || n[1] > -0.2) continue;
    const double known = 0.5 / acos(-1) * pane_passes * n[2];
    const double found = (double)picture.data[i * picture.channels + caustic];
    assert_true(picture.data[i * picture.channels + direct] == 0);
    sum += found;
    expected += known;
    seen++;
    worst = fmax(worst, fabs(found / known - 1) * n[2]);
  }
  assert_true(seen > 100);
  assert_near(sum / expected, 1, 5e-3);
  assert_true(worst < 0.045);
}

/* The eye looks along y into a pane; a moon in its back is all that the pane can mirror, and
 * nothing lies behind. By its planes, and by its triangles, which asks for multi-refractor paths.
 */
#define MOON_BEHIND_THE_EYE                                                                        \
  "materials: glass.yaml\ncamera: {eye: [0, -1, 0.3], target: [0, 0, 0.3], fov: 12}\n"             \
  "ambient: 0.2\nlights:\n- {name: sun, kind: directional, direction: [0, 1, -1], "                \
  "irradiance: 1}\nobjects:\n"                                                                     \
  "- {name: card, shape: rectangle, width: 0.02, height: 0.02, transform: [{translate: [0.075, "   \
  "-0.2, 0.375]}], reflectance: 0.5}\n"                                                            \
  "- {name: moon, shape: sphere, radius: 0.3, levels: 4, transform: [{translate: [0, -2, 0.3]}],"  \
  " reflectance: 0.5}\n"                                                                           \
  "- {name: pane, shape: box, size: [0.4, 0.05, 0.4], transform: [{translate: [0, 0, 0.3]}], "     \
  "material: flat}\n"

TEST(a_pane_mirrors_what_is_behind_the_eye) {
  const double known = pane_reflects * 0.5 * 0.2 / acos(-1);
  OWNED(abbe_scene, scene) = scene_of(MOON_BEHIND_THE_EYE);
  for (int i = 0; i < 2; i++) {
    abbe_render_desc desc = small_frame;
    desc.space = ABBE_RGB_SPACE_XYZ;
    desc.model = i == 0 ? ABBE_MODEL_CONVEX : ABBE_MODEL_BVH;
    desc.width = desc.height = 16;
    desc.energy_share = 1e-6;
    desc.exits = ABBE_RENDER_MAX_EXITS;
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    OWNED(abbe_image, picture) = picture_of(renderer);
    for (size_t k = 0; k < 8 * 8; k++) {
      const size_t pixel = (4 + k / 8) * 16 + 4 + k % 8; /* the middle, which shows no card */
      assert_near(picture.data[pixel * picture.channels + 1] / known, 1, 2e-3);
    }
  }
}
