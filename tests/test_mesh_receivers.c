/* Receivers that are meshes: the shaders' nearest hit against double precision, triangles against
 * the parallelograms that they tile, and light on a ball in closed form. */
#include "tests/frame.h"
#include "tests/glsl.h"
#include "tests/random.h"

#include "scenes/hierarchy.h"
#include "scenes/shape.h"
#include "scenes/vector.h"

/* ---- the nearest receiver ---- */

enum { RAYS = 4096, FLATS = 3 };

typedef struct receivers {
  float flat[FLATS][6][4]; /* as common.glsl has a parallelogram */
  abbe_mesh mesh;
  double (*triangle)[9];
  abbe_hierarchy h;
  double (*tiles)[9]; /* two triangles a parallelogram */
} receivers;

static GLuint uniform_block(GLuint binding, const void *data, size_t size) {
  const abbe_gl *gl = abbe_context_gl(context);
  GLuint buffer = 0;
  gl->GenBuffers(1, &buffer);
  gl->BindBuffer(GL_UNIFORM_BUFFER, buffer);
  gl->BufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)size, data, GL_STATIC_DRAW);
  gl->BindBufferBase(GL_UNIFORM_BUFFER, binding, buffer);
  return buffer;
}

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
  uniform_block(3, r->flat, sizeof r->flat);
  glsl_texels(gl, 7, r->h.node_count * sizeof *r->h.node, r->h.node);
  glsl_texels(gl, 8, 3 * r->h.triangle_count * sizeof *triangle, triangle);
  glsl_texels(gl, 9, 4 * r->h.triangle_count * sizeof *corner, corner);
  free(triangle);
  free(corner);
}

static void make_receivers(receivers *r) {
  memset(r, 0, sizeof *r);
  r->tiles = calloc(2 * FLATS, sizeof *r->tiles);
  for (int k = 0; k < FLATS; k++) make_flat(k, r);
  assert_int_equal(abbe_shape_ring(0.2, 0.06, 48, 24, &r->mesh, NULL), ABBE_OK);
  r->triangle = abbe_hierarchy_triangles(&r->mesh);
  assert_int_equal(
      abbe_hierarchy_make((const double(*)[9])r->triangle, r->mesh.face_count, &r->h, NULL),
      ABBE_OK);
  upload_receivers(r);
}

static void free_receivers(receivers *r) {
  abbe_mesh_free(&r->mesh);
  abbe_hierarchy_free(&r->h);
  free(r->triangle);
  free(r->tiles);
}

/* Parallelogram, FLATS for the mesh, -1 for none; the interpolated normal of a mesh. */
static int nearest(const receivers *r, const double o[3], const double d[3], double t_max,
                   double *t, double n[3]) {
  abbe_hierarchy_hit hit;
  int found = -1;
  *t = t_max;
  for (int i = 0; i < 2 * FLATS; i++)
    if (abbe_hierarchy_meet(r->tiles[i], o, d, 0, 0, *t, &hit)) {
      *t = hit.t;
      found = i / 2;
    }
  for (size_t i = 0; i < r->mesh.face_count; i++) {
    if (!abbe_hierarchy_meet(r->triangle[i], o, d, 0, 0, *t, &hit)) continue;
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
    "#define LIGHTS 1\n#define LIGHT_ROOM 1\n#define REFRACTORS 0\n#define REFRACTOR_ROOM 1\n"
    "#define PLANE_ROOM 1\n#define RECEIVERS 3\n#define RECEIVER_ROOM 3\n#define SURFACE_ROOM 1\n"
    "#define SPECTRUM_ROOM 1\n#define WAVELENGTHS 1\n#define RECEIVER_HIERARCHY\n"
    "#define RECEIVER_ROOT 0\n";

/* Single precision: 1e-5 of the size, but for rays that graze a triangle or an edge, which may miss
 * it: one in two hundred. The normal turns by 1e-5 over the radius of the tube. */
static void shaders_find_the_nearest_of_both(void **state) {
  (void)state;
  static float in[RAYS][8], out[RAYS][4], normal[RAYS][4];
  char text[2048];
  receivers r;
  uint64_t random = 5;
  size_t odd = 0, met[FLATS + 1] = {0};
  make_receivers(&r);
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
  free_receivers(&r);
}

/* ---- triangles that tile parallelograms ---- */

typedef struct frame {
  abbe_image picture, map;
  abbe_ledger energy;
} frame;

static void draw(const abbe_scene *scene, const abbe_render_desc *desc, abbe_map_layout *layout,
                 frame *out) {
  abbe_renderer *renderer = make_renderer(scene, desc);
  out->energy = draw_frame(renderer).energy;
  assert_true(out->energy.reached > 0 && abbe_ledger_imbalance(&out->energy) < 1e-4);
  read_picture(renderer, desc->layers, &out->picture);
  read_map(renderer, 0, &out->map);
  if (layout != NULL) abbe_renderer_map_layout(renderer, 0, layout);
  abbe_renderer_free(renderer);
}

static void free_frame(frame *f) {
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
  "angle: 20}}, {translate: [0.09, 0.05, 0.04]}], reflectance: [0.6, 0.5, 0.2]}\n"

/* A rectangle and a box, by their parallelograms and by their triangles: through a ball, which sees
 * both, and through a ring, whose light goes the general way. */
static void triangles_do_as_parallelograms_do(void **state) {
  (void)state;
  static const char *const texts[] = {CAMERA POINT_LIGHT TEXTURED_FLOOR CRATE BALL("crown"),
                                      CAMERA SUN TEXTURED_FLOOR CRATE RING("flat")};
  for (int i = 0; i < 2; i++) {
    abbe_scene scene = {0};
    abbe_map_layout layout;
    abbe_render_desc desc = small_frame;
    frame flat, mesh;
    load_text(texts[i], &scene);
    draw(&scene, &desc, &layout, &flat);
    scene.object[0].exact.kind = scene.object[1].exact.kind = ABBE_EXACT_NONE;
    desc.map_layout = &layout;
    draw(&scene, &desc, NULL, &mesh);
    scene.object[0].exact.kind = scene.object[1].exact.kind = ABBE_EXACT_PARALLELOGRAMS;
    /* edges are a float's few digits wider or narrower, and light there lands here or there */
    assert_true(apart(&flat.map, &mesh.map) < 1e-5);
    assert_true(apart(&flat.picture, &mesh.picture) < 1e-6);
    assert_near(mesh.energy.deposited / flat.energy.deposited, 1, 1e-4);
    assert_near(mesh.energy.missed / flat.energy.missed, 1, 1e-3);
    free_frame(&flat);
    free_frame(&mesh);
    abbe_scene_free(&scene);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shaders_find_the_nearest_of_both),
      cmocka_unit_test(triangles_do_as_parallelograms_do),
  };
  return cmocka_run_group_tests(tests, make_context, free_context);
}
