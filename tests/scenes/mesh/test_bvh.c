/* The BVH against every triangle in turn: in double precision, and as the shaders have it. */
#include "tests/gl/glsl.h"

#include "gl/scene/gpu_scene.h"
#include "scenes/mesh/bvh.h"
#include "scenes/shapes/shape.h"
#include "tests/patience.h"
#include "tests/random.h"

typedef struct soup {
  double (*triangle)[9];
  size_t count;
  double size;
  abbe_bvh h;
} soup;

static void finish(soup *s) {
  assert_non_null(s->triangle);
  OK(abbe_bvh_make((const double(*)[9])s->triangle, s->count, &s->h, &error));
}

static void soup_free(soup *s) {
  abbe_bvh_free(&s->h);
  free(s->triangle);
}

/* What awkward triangles there are: tiny and huge, needles, without area, all at one place. */
static void make_soup(size_t count, double size, soup *s) {
  uint64_t random = count;
  *s = (soup){.count = count, .size = size, .triangle = calloc(count, sizeof *s->triangle)};
  for (size_t i = 0; i < count; i++) {
    double extent = size * pow(10, random_between(&random, -3, 0)), at[3];
    for (int k = 0; k < 3; k++) at[k] = random_between(&random, -size, size);
    for (int k = 0; k < 9; k++) s->triangle[i][k] = at[k % 3] + random_between(&random, 0, extent);
    if (i % 50 == 0) memcpy(s->triangle[i] + 6, s->triangle[i] + 3, 3 * sizeof(double));
    if (i % 50 == 1 && i > 1) memcpy(s->triangle[i], s->triangle[1], sizeof *s->triangle);
  }
  finish(s);
}

static void make_ring(soup *s) {
  MADE(abbe_mesh, mesh, abbe_shape_ring(0.08, 0.02, 64, 32, &mesh, &error));
  *s = (soup){.count = mesh.face_count, .size = 0.1, .triangle = abbe_bvh_triangles(&mesh)};
  finish(s);
}

static void random_ray(const soup *s, uint64_t *random, double o[3], double d[3]) {
  double length = 0;
  for (int k = 0; k < 3; k++) {
    o[k] = (double)(float)random_between(random, -1.5 * s->size, 1.5 * s->size);
    d[k] = random_between(random, -s->size, s->size) - o[k];
    length += d[k] * d[k];
  }
  /* along the axes, too, where a direction's parts are zero */
  if (random_bits(random) % 8 == 0) {
    int axis = (int)(random_bits(random) % 3);
    for (int k = 0; k < 3; k++) d[k] = k == axis ? (random_bits(random) % 2 ? 1 : -1) : 0;
    length = 1;
  }
  for (int k = 0; k < 3; k++) d[k] = (double)(float)(d[k] / sqrt(length));
}

static bool brute_force(const soup *s, const double o[3], const double d[3], int side,
                        abbe_bvh_hit *hit) {
  bool found = false;
  double nearest = INFINITY;
  for (size_t i = 0; i < s->count; i++) {
    if (!abbe_bvh_meet(s->triangle[i], o, d, side, 0, nearest, hit)) continue;
    nearest = hit->t;
    hit->index = i;
    found = true;
  }
  return found;
}

static void compare(const soup *s, size_t rays) {
  uint64_t random = 7;
  size_t hits = 0;
  for (size_t i = 0; i < rays; i++) {
    double o[3], d[3];
    abbe_bvh_hit a = {0}, b = {0};
    int side = (int)(i % 3) - 1;
    random_ray(s, &random, o, d);
    bool met = abbe_bvh_trace(&s->h, (const double(*)[9])s->triangle, o, d, side, 0, INFINITY, &a);
    assert_true(met == brute_force(s, o, d, side, &b));
    if (!met) continue;
    hits++;
    /* the same arithmetic on the same numbers; of two equal triangles either may win */
    assert_true(a.t == b.t && a.u == b.u && a.v == b.v);
  }
  assert_true(hits > rays / 20);
}

GROUP(make_context, free_context);

TEST(nearest_of_all_triangles) {
  OWNED(soup, s) = {0};
  static const size_t counts[] = {1, 2, 5, 300, 3000};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    make_soup(counts[i], i % 2 ? 1 : 1e4, &s);
    if (counts[i] >= 300) compare(&s, 1000);
    assert_true(s.h.node_count < 2 * counts[i] && s.h.depth <= ABBE_BVH_MAX_DEPTH);
    soup_free(&s);
  }
  make_ring(&s);
  compare(&s, 1000);
}

/* Every triangle is in one leaf, and every box holds what is below it. */
TEST(boxes_hold_their_triangles) {
  FILLED(soup, s, make_soup(1000, 1, &s));
  size_t seen = 0;
  for (size_t i = 0; i < s.h.node_count; i++) {
    const abbe_bvh_node *n = &s.h.node[i];
    assert_true(n->count <= 4);
    for (int k = 0; k < n->count; k++, seen++)
      for (int c = 0; c < 9; c++) {
        double x = s.triangle[s.h.triangle[n->first + k]][c];
        assert_true((double)n->min[c % 3] <= x && x <= (double)n->max[c % 3]);
      }
    for (int child = 0; n->count == 0 && child < 2; child++)
      for (int k = 0; k < 3; k++) {
        assert_true(n->min[k] <= s.h.node[n->first + child].min[k]);
        assert_true(n->max[k] >= s.h.node[n->first + child].max[k]);
      }
  }
  assert_int_equal(seen, s.count);
}

/* What rays pay: the boxes' surfaces by the root's. Where most of a node is empty it is cut there.
 */
TEST(boxes_are_tight) {
  FILLED(soup, s, make_ring(&s));
  double area = 0, whole = 0;
  for (size_t i = 0; i < s.h.node_count; i++) {
    double side[3];
    for (int k = 0; k < 3; k++) side[k] = (double)s.h.node[i].max[k] - (double)s.h.node[i].min[k];
    area += side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
    if (i == 0) whole = area;
  }
  print_message("ring: %.1f areas of the root\n", area / whole);
  assert_true(area < 30 * whole);
  soup_free(&s);
  s = (soup){.count = 64, .triangle = calloc(64, sizeof *s.triangle)};
  uint64_t random = 5;
  for (size_t i = 0; i < s.count; i++)
    for (int c = 0; c < 9; c++)
      s.triangle[i][c] = random_between(&random, 0, 1) + (c % 3 == 0 && i % 2 ? 100 : 0);
  finish(&s);
  const abbe_bvh_node *child = s.h.node + s.h.node->first;
  assert_true(child[0].max[0] < child[1].min[0] || child[1].max[0] < child[0].min[0]);
}

TEST(equal_triangles_end_in_leaves) {
  soup s = {.count = 100000, .triangle = calloc(100000, sizeof *s.triangle)};
  for (size_t i = 0; i < s.count; i++) s.triangle[i][3] = s.triangle[i][7] = 1;
  finish(&s);
  assert_true(s.h.depth <= ABBE_BVH_MAX_DEPTH);
  soup_free(&s);
  assert_int_equal(abbe_bvh_make(NULL, 0, &s.h, NULL), ABBE_GEOMETRY);
}

/* Whoever stops it is not asked again, whenever that is; who does not changes nothing. */
TEST(it_ends_when_it_is_told_to) {
  FILLED(soup, s, make_soup(100000, 1, &s));
  patience p = {.most = SIZE_MAX};
  abbe_watch watch = {patience_lasts, &p, false};
  abbe_bvh h;
  const double(*triangle)[9] = (const double(*)[9])s.triangle;
  abbe_watch_set(&watch);
  OK(abbe_bvh_make(triangle, s.count, &h, &error));
  assert_int_equal(h.node_count, s.h.node_count);
  assert_memory_equal(h.node, s.h.node, h.node_count * sizeof *h.node);
  abbe_bvh_free(&h);
  const size_t all = p.asked;
  assert_true(all > 16); /* of some levels' sweeps */
  for (size_t most = 0; most < all; most += 1 + all / 5) {
    p = (patience){.most = most};
    watch.over = false;
    assert_int_equal(abbe_bvh_make(triangle, s.count, &h, NULL), ABBE_CANCELLED);
    assert_int_equal(p.asked, most + 1);
    assert_null(h.node);
  }
  uint32_t(*texel)[4] = calloc(abbe_bvh_nodes_count(&s.h), sizeof *texel);
  p = (patience){.most = 1}; /* of the nodes' cones */
  watch.over = false;
  assert_int_equal(abbe_bvh_nodes_pack(&s.h, triangle, 0, 0, texel, NULL), ABBE_CANCELLED);
  assert_int_equal(p.asked, 2);
  abbe_watch_set(NULL);
  free(texel);
}

static float float_of(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* Child c of the inner node at `at`, as the shaders read it, against its triangles: whether a ray
 * along d leaves it out, and what its box holds. Returns how many are below. */
static size_t check_packed(const soup *s, uint32_t (*texel)[4], size_t at, int c, const double d[3],
                           bool above, size_t *left_out) {
  const uint32_t *box = texel[at + (size_t)c], *cone = texel[at + 2] + 2 * c;
  const int32_t code = (int32_t)box[3];
  double along = 0;
  for (int k = 0; k < 3; k++)
    along += d[k] * (int16_t)(k < 2 ? cone[0] >> 16 * k & 0xffff : cone[1] & 0xffff);
  const bool out = above || along > (double)(int16_t)(cone[1] >> 16);
  if (code >= 0)
    return check_packed(s, texel, (size_t)code, 0, d, out, left_out) +
           check_packed(s, texel, (size_t)code, 1, d, out, left_out);
  const size_t first = (size_t)~code >> 3, count = (size_t)~code & 7;
  for (size_t i = first; i < first + count; i++) {
    const double *t = s->triangle[s->h.triangle[i]];
    abbe_bvh_hit hit;
    for (int k = 0; k < 9; k++) {
      double low = (double)float_of(texel[0][k % 3]), cell = (double)float_of(texel[1][k % 3]);
      assert_true(low + cell * (box[k % 3] & 0xffff) < t[k]);
      assert_true(low + cell * (box[k % 3] >> 16) > t[k]);
    }
    double o[3];
    for (int k = 0; k < 3; k++) o[k] = (t[k] + t[3 + k] + t[6 + k]) / 3 - s->size * d[k];
    if (out) assert_false(abbe_bvh_meet(t, o, d, 1, 0, INFINITY, &hit));
  }
  *left_out += out ? count : 0;
  return count;
}

/* Packed boxes hold their triangles, and cones leave out no face that a ray meets from outside. */
TEST(packed_nodes_leave_nothing_out) {
  soup s[2];
  make_soup(3000, 1e4, &s[0]);
  make_ring(&s[1]);
  for (int which = 0; which < 2; which++) {
    uint64_t random = 3;
    size_t left_out = 0, seen = 0;
    uint32_t(*texel)[4] = calloc(abbe_bvh_nodes_count(&s[which].h), sizeof *texel);
    OK(abbe_bvh_nodes_pack(&s[which].h, (const double(*)[9])s[which].triangle, 0, 0, texel,
                           &error));
    for (int i = 0; i < 20; i++) {
      double o[3], d[3];
      random_ray(&s[which], &random, o, d);
      for (int c = 0; c < 2; c++)
        seen += check_packed(&s[which], texel, (size_t)texel[0][3], c, d, false, &left_out);
    }
    assert_int_equal(seen, 20 * s[which].count);
    /* of a closed surface half is turned away */
    print_message("%zu of %zu left out\n", left_out, seen);
    if (which == 1) assert_true(left_out > 0.4 * (double)seen);
    free(texel);
    soup_free(&s[which]);
  }
}

/* Returns the triangles as shaders read them. */
static float (*upload(const soup *s))[4] {
  const abbe_gl *gl = abbe_context_gl(context);
  float(*triangle)[4] = calloc(3 * s->count, sizeof *triangle);
  for (size_t i = 0; i < s->count; i++)
    for (int k = 0; k < 3; k++) {
      const double *from = s->triangle[s->h.triangle[i]];
      triangle[3 * i][k] = (float)from[k];
      triangle[3 * i + 1][k] = (float)(from[3 + k] - from[k]);
      triangle[3 * i + 2][k] = (float)(from[6 + k] - from[k]);
    }
  glsl_hierarchy(gl, &s->h, (const double(*)[9])s->triangle);
  glsl_texels(gl, 8, GL_RGBA32F, 3 * s->count * sizeof *triangle, triangle);
  return triangle;
}

static void make_trees(const soup *s, abbe_ray_trees *trees) {
  size_t root;
  uint32_t(*texel)[4] = calloc(abbe_bvh_nodes_count(&s->h), sizeof *texel);
  OK(abbe_bvh_nodes_pack(&s->h, (const double(*)[9])s->triangle, 0, 0, texel, &error));
  OK(abbe_ray_trees_add(trees, (const uint32_t(*)[4])texel, 0, &root, &error));
  assert_int_equal(root, 0);
  free(texel);
}

/* Of so many rays side by side, all together or one after another. */
static void meet_here(const abbe_ray_trees *trees, const float (*triangle)[4], const float (*in)[8],
                      bool together, abbe_rays *rays) {
  for (int k = 0; k < ABBE_RAYS; k++) {
    for (int i = 0; i < 3; i++) {
      rays->o[i][k] = in[k][i];
      rays->d[i][k] = in[k][4 + i];
    }
    rays->side[k] = in[k][3];
    rays->t_min[k] = 0;
    rays->t[k] = 1e30F;
    rays->triangle[k] = -1;
  }
  if (together) abbe_ray_trees_meet(trees, 0, triangle, (1u << ABBE_RAYS) - 1, rays);
  for (int k = 0; k < ABBE_RAYS && !together; k++)
    abbe_ray_trees_meet(trees, 0, triangle, 1u << k, rays);
}

/* Single precision: a hit lies 1e-5 of the scene's size from the true one, but for rays that graze
 * a triangle or its edge, which may miss it: one in two hundred; and what the processor's threads
 * meet for a shader, from the shader's, but for one in two thousand. */
TEST(the_shaders_find_the_same) {
  enum { RAYS = 4096 };
  static float in[RAYS][8], out[RAYS][4];
  soup s[2];
  make_soup(3000, 1, &s[0]);
  make_ring(&s[1]);
  for (int which = 0; which < 2; which++) {
    uint64_t random = 11;
    size_t odd = 0, unlike = 0, hits = 0;
    abbe_ray_trees trees = {0};
    abbe_rays here;
    for (size_t i = 0; i < RAYS; i++) {
      double o[3], d[3];
      random_ray(&s[which], &random, o, d);
      for (int k = 0; k < 3; k++) {
        in[i][k] = (float)o[k];
        in[i][4 + k] = (float)d[k];
      }
      in[i][3] = (float)((int)(i % 3) - 1);
    }
    float(*triangle)[4] = upload(&s[which]);
    make_trees(&s[which], &trees);
    glsl_evaluate(
        abbe_context_gl(context),
        printed("#define HIERARCHY_STACK %zu\n#include \"hierarchy.glsl\"\n"
                "vec4 f(vec4 a, vec4 b) {\n"
                "  TriangleHit h, any;\n  h.t = any.t = 1e30;\n"
                "  bool met = hierarchy_hit(0, a.xyz, b.xyz, a.w, 0.0, false, h);\n"
                "  bool some = hierarchy_hit(0, a.xyz, b.xyz, a.w, 0.0, true, any);\n"
                "  return met != some ? vec4(-2) : met ? vec4(h.t, h.u, h.v, 1) : vec4(-1);\n}\n",
                s[which].h.depth + 1),
        (const float(*)[8])in, RAYS, out);
    for (size_t i = 0; i < RAYS; i++) {
      double o[3], d[3];
      abbe_bvh_hit hit;
      for (int k = 0; k < 3; k++) {
        o[k] = (double)in[i][k];
        d[k] = (double)in[i][4 + k];
      }
      bool met = brute_force(&s[which], o, d, (int)in[i][3], &hit);
      hits += met;
      assert_true(out[i][3] > -2);
      bool same = met == (out[i][3] > 0) &&
                  (!met || fabs((double)out[i][0] - hit.t) < 1e-5 * s[which].size);
      odd += !same;
      const size_t lane = i % ABBE_RAYS;
      if (lane == 0)
        meet_here(&trees, (const float(*)[4])triangle, (const float(*)[8])in + i,
                  i / ABBE_RAYS % 2 > 0, &here);
      met = here.triangle[lane] >= 0;
      unlike += met != (out[i][3] > 0) ||
                (met && fabs((double)out[i][0] - (double)here.t[lane]) > 1e-5 * s[which].size);
    }
    abbe_ray_trees_free(&trees);
    free(triangle);
    print_message("%zu of %d rays differ, %zu here\n", odd, RAYS, unlike);
    assert_true(unlike * 2000 < RAYS);
    assert_true(hits > RAYS / 20);
    assert_true(odd * 200 < RAYS);
  }
  soup_free(&s[0]);
  soup_free(&s[1]);
}

/* A box has six, a ring one; a box without normals that break, one. */
TEST(parts_end_where_normals_break) {
  uint32_t group[8192];
  MADE(abbe_mesh, mesh, abbe_shape_box((double[3]){1, 2, 3}, &mesh, &error));
  assert_int_equal(abbe_bvh_parts(&mesh, group), 6);
  for (size_t i = 0; i < mesh.face_count; i++)
    for (size_t k = 0; k < mesh.face_count; k++) {
      const double *a = mesh.normal[mesh.face[i][0]], *b = mesh.normal[mesh.face[k][0]];
      assert_true((group[i] == group[k]) == (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]));
    }
  OK(abbe_mesh_compute_normals(&mesh, ABBE_NORMALS_SMOOTH, &error));
  assert_int_equal(abbe_bvh_parts(&mesh, group), 1);
  abbe_mesh_free(&mesh);
  OK(abbe_shape_ring(0.08, 0.02, 64, 32, &mesh, &error));
  assert_int_equal(abbe_bvh_parts(&mesh, group), 1);
}
