/* A packet of sixteen interfaces against the one interface of interface.h. */
#include "tests/check.h"
#include "tests/random.h"

#include "validation/trace/transport/interface.h"
#include "validation/trace/walks/scatter.h"

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(uint64_t *seed, float out[3]) {
  float length = 0;
  for (int i = 0; i < 3; i++) {
    out[i] = (float)random_between(seed, -1, 1);
    length += out[i] * out[i];
  }
  for (int i = 0; i < 3; i++) out[i] /= sqrtf(length);
}

static void check_lane(const abbe_scatter *s, size_t k) {
  const float d[3] = {s->d[0][k], s->d[1][k], s->d[2][k]};
  const float n[3] = {s->n[0][k], s->n[1][k], s->n[2][k]};
  const float ng[3] = {s->ng[0][k], s->ng[1][k], s->ng[2][k]};
  float cos_t, out[3], c = fminf(-dot(d, n), 1);
  float share = abbe_interface_reflectance(c, s->eta[k], &cos_t);
  bool reflects = s->chance[k] < share;
  assert_near((double)s->share[k], (double)share, 1e-6);
  assert_int_equal(s->reflects[k], reflects);
  if (reflects)
    abbe_interface_reflect(d, n, c, out);
  else
    abbe_interface_refract(d, n, s->eta[k], c, cos_t, out);
  abbe_interface_keep_side(ng, reflects ? 1 : -1, out);
  float size = s->size[k];
  for (int i = 0; i < 3; i++) size = fmaxf(size, fabsf(s->p[i][k]));
  for (int i = 0; i < 3; i++) {
    assert_near((double)s->out[i][k], (double)out[i], 2e-6);
    float off = (reflects ? 1.0f : -1.0f) * size * ABBE_GEOMETRY_OFFSET * ng[i];
    assert_near((double)s->from[i][k], (double)(s->p[i][k] + off), 1e-6 * (double)size);
  }
}

TEST(every_lane_is_one_interface) {
  static const float etas[] = {1 / 1.5f, 1.5f, 1, 2.4f};
  uint64_t seed = 7;
  size_t reflected = 0;
  for (int turn = 0; turn < 200; turn++) {
    abbe_scatter s = {.size = {0}};
    for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
      float d[3], n[3], bent[3];
      unit(&seed, d);
      unit(&seed, n);
      unit(&seed, bent);
      float side = dot(d, n) < 0 ? 1 : -1, length = 0;
      for (int i = 0; i < 3; i++) {
        n[i] *= side;
        bent[i] = n[i] + 0.2f * bent[i];
        length += bent[i] * bent[i];
      }
      for (int i = 0; i < 3; i++) {
        s.d[i][k] = d[i];
        s.ng[i][k] = n[i];
        s.n[i][k] = bent[i] / sqrtf(length);
        s.p[i][k] = (float)random_between(&seed, 0, 1);
      }
      s.eta[k] = etas[k % 4];
      s.chance[k] = (float)random_between(&seed, 0, 1);
      s.size[k] = k % 2 ? 0 : 3;
      /* a bent normal may face away from the ray: no interface is met so */
      const float bent_n[3] = {s.n[0][k], s.n[1][k], s.n[2][k]};
      for (int i = 0; dot(d, bent_n) > -0.01f && i < 3; i++) s.n[i][k] = n[i];
    }
    abbe_scatter_packet(&s);
    for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
      check_lane(&s, k);
      reflected += s.reflects[k] != 0;
    }
  }
  assert_true(reflected > 200 && reflected < 3000);
}

/* Off mirrors of gold, of one reflectance, and of no normal but the face's, from both sides. */
TEST(every_lane_is_one_mirror) {
  float reflectance[2] = {-1, 0.7f}, nk[6][2] = {{0.2f, 3}, {1.4f, 1.9f}, {0.13f, 4.1f}};
  const abbe_mirrors mirrors = {.count = 2, .steps = 2, .reflectance = reflectance, .nk = nk};
  uint64_t seed = 11;
  for (int turn = 0; turn < 50; turn++) {
    abbe_scatter s = {.size = {0}};
    abbe_mirroring m = {.n = {0}};
    float cos_i[ABBE_RAY_LANES], expected[ABBE_RAY_LANES];
    for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
      const abbe_surface surface = {.index = k % 3 == 0, .sphere = k % 2 == 0, .radius = 2};
      abbe_hit hit = {.surface = &surface};
      float d[3], within = (float)random_between(&seed, 0, 1);
      unit(&seed, d);
      unit(&seed, hit.ng);
      for (int i = 0; i < 3; i++) {
        s.d[i][k] = d[i];
        hit.n[i] = hit.ng[i];
        hit.p[i] = (float)random_between(&seed, -1, 1);
      }
      const uint32_t step = (uint32_t)(k % 2);
      abbe_scatter_meet_mirror(&s, &m, k, &hit, &mirrors, step, within);
      cos_i[k] = fminf(fabsf(dot(d, hit.ng)), 1);
      expected[k] = abbe_mirrors_reflect(&mirrors, surface.index, cos_i[k], step, within);
      assert_near((double)s.size[k], surface.sphere ? 2 : 0, 0);
    }
    abbe_scatter_turn(&s);
    abbe_scatter_packet(&s);
    abbe_scatter_mirror(&s, &m);
    for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
      assert_true(s.reflects[k]);
      check_lane(&s, k);
      assert_near((double)m.share[k], (double)expected[k], 1e-6);
    }
  }
}
