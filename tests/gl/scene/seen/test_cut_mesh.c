/* What a view sees of a mesh stays: cut where depth grows sixteenfold, in parts that share corners.
 */
#include "tests/check.h"

#include "base/maths.h"
#include "gl/scene/seen/seen_meshes.h"

static const double growth = 16;

/* A square of that side in z = 0, of two faces. */
static void make_square(double side, abbe_mesh *out) {
  OK(abbe_mesh_make(4, 2, true, out, &error));
  static const uint32_t face[2][3] = {{0, 1, 2}, {0, 2, 3}};
  memcpy(out->face, face, sizeof face);
  for (int i = 0; i < 4; i++) {
    out->uv[i][0] = i == 1 || i == 2;
    out->uv[i][1] = i >= 2;
    for (int k = 0; k < 2; k++) out->position[i][k] = side * (out->uv[i][k] - 0.5);
    out->normal[i][2] = 1;
  }
}

/* One that looks slightly down from a height, over a window of a right angle. */
static abbe_view view_from(double high) {
  static const double up[3] = {0, 0, 1}, forward[3] = {0.1, 1, -0.2};
  static const double window[4] = {-1, 1, -1, 1};
  const double origin[3] = {0, 0, high};
  abbe_view v;
  abbe_view_look(origin, forward, up, false, &v);
  memcpy(v.window, window, sizeof window);
  v.near = 0.25 * high;
  v.far = 1e6;
  return v;
}

static double depth_of(const abbe_view *v, const double p[3]) {
  double from[3];
  abbe_vector_subtract(p, v->origin, from);
  return abbe_vector_dot(from, v->forward);
}

/* How many faces of the mesh hold the place, and the coordinates that the last of them has there.
 */
static int held(const abbe_mesh *m, const double at[3], double uv[2]) {
  int count = 0;
  for (size_t i = 0; i < m->face_count; i++) {
    const double *a = m->position[m->face[i][0]], *b = m->position[m->face[i][1]],
                 *c = m->position[m->face[i][2]];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const double v = ((b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0])) / area;
    const double u = ((at[0] - a[0]) * (c[1] - a[1]) - (at[1] - a[1]) * (c[0] - a[0])) / area;
    assert_true(area > 0); /* as they turned before */
    if (u < 0 || v < 0 || u + v > 1) continue;
    count++;
    for (int k = 0; k < 2; k++)
      uv[k] = m->uv[m->face[i][0]][k] + u * (m->uv[m->face[i][1]][k] - m->uv[m->face[i][0]][k]) +
              v * (m->uv[m->face[i][2]][k] - m->uv[m->face[i][0]][k]);
  }
  return count;
}

TEST(what_is_seen_stays) {
  for (double side = 10; side < 2e5; side *= 100) {
    const abbe_view view = view_from(1);
    const double max[3] = {side / 2, side / 2, 0}, min[3] = {-side / 2, -side / 2, 0};
    FREED uint32_t *face_of = NULL;
    FILLED(abbe_mesh, square, make_square(side, &square));
    assert_true(abbe_cut_mesh_needed(&square, min, max, &view));
    MADE(abbe_mesh, cut, abbe_cut_mesh_make(&square, &view, &cut, &face_of, &error));
    for (size_t i = 0; i < cut.face_count; i++) {
      double least = INFINITY, most = -INFINITY;
      assert_true(face_of[i] < 2);
      for (int k = 0; k < 3; k++) {
        const double *p = cut.position[cut.face[i][k]], z = depth_of(&view, p);
        assert_true(p[2] == 0);
        least = fmin(least, z);
        most = fmax(most, z);
      }
      assert_true(least >= view.near * (1 - 1e-12) && most <= growth * least * (1 + 1e-12));
    }
    /* every ray that meets the square meets one part, but for those along an edge */
    for (int i = 0; i < 61 * 61; i++) {
      const double at[2] = {(i % 61 + 0.37) / 61, (i / 61 + 0.41) / 61};
      double o[3], d[3], p[3], uv[2] = {0, 0};
      abbe_view_ray(&view, at, o, d);
      for (int k = 0; k < 3; k++) p[k] = o[k] - o[2] / d[2] * d[k];
      const bool meets = d[2] < 0 && fmax(fabs(p[0]), fabs(p[1])) < 0.499 * side;
      if (!meets && d[2] < 0 && fmax(fabs(p[0]), fabs(p[1])) < 0.501 * side) continue;
      assert_int_equal(held(&cut, p, uv), meets);
      for (int k = 0; k < 2 && meets; k++) assert_near(uv[k], p[k] / side + 0.5, 1e-9);
    }
  }
}

/* An edge with a part on one side alone has none on the other, or ends at the window. */
TEST(parts_share_their_corners) {
  const abbe_view view = view_from(1);
  FREED uint32_t *face_of = NULL;
  size_t alone = 0;
  FILLED(abbe_mesh, square, make_square(1e5, &square));
  MADE(abbe_mesh, cut, abbe_cut_mesh_make(&square, &view, &cut, &face_of, &error));
  for (size_t i = 0; i < 3 * cut.face_count; i++) {
    const double *a = cut.position[cut.face[i / 3][i % 3]];
    const double *b = cut.position[cut.face[i / 3][(i + 1) % 3]];
    bool shared = false;
    for (size_t j = 0; j < 3 * cut.face_count && !shared; j++) {
      const double *p = cut.position[cut.face[j / 3][j % 3]];
      const double *q = cut.position[cut.face[j / 3][(j + 1) % 3]];
      shared = j / 3 != i / 3;
      for (int k = 0; k < 3; k++)
        shared = shared && (float)p[k] == (float)b[k] && (float)q[k] == (float)a[k];
    }
    double middle[3], uvz[3];
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (a[k] + b[k]);
    const bool before = abbe_view_project(&view, middle, uvz);
    const bool seen = before && uvz[0] > 0 && uvz[0] < 1 && uvz[1] > 0 && uvz[1] < 1;
    const bool rim = fmax(fabs(middle[0]), fabs(middle[1])) > 0.4999e5;
    alone += !shared && seen && !rim;
  }
  assert_int_equal(alone, 0);
}

TEST(small_things_are_not_cut) {
  const abbe_view view = view_from(1);
  FILLED(abbe_mesh, square, make_square(1, &square));
  const double move[3] = {0.5, 3, 0};
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) square.position[i][k] += move[k];
  const double min[3] = {0, 2.5, 0}, max[3] = {1, 3.5, 0};
  assert_false(abbe_cut_mesh_needed(&square, min, max, &view));
}
