#include "validation/trace/walks/scatter.h"

#include "base/maths.h"
#include "validation/trace/transport/interface.h"

SIDE_BY_SIDE void abbe_scatter_packet(abbe_scatter *s) {
  for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
    float eta = s->eta[k],
          c = -(s->d[0][k] * s->n[0][k] + s->d[1][k] * s->n[1][k] + s->d[2][k] * s->n[2][k]);
    c = c < 1 ? c : 1;
    float cos_t, share = abbe_interface_reflectance(c, eta, &cos_t);
    bool reflects = s->chance[k] < share;
    float along_n = reflects ? 2 * c : eta * c - cos_t, stretch = reflects ? 1 : eta;
    float out[3];
    for (int i = 0; i < 3; i++) out[i] = stretch * s->d[i][k] + along_n * s->n[i][k];
    /* light stays on the right side of the face where its normal is bent */
    float side = reflects ? 1.0f : -1.0f;
    float scale = 1 / sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3; i++) out[i] *= scale;
    float along = side * (out[0] * s->ng[0][k] + out[1] * s->ng[1][k] + out[2] * s->ng[2][k]);
    float push = along > 0 ? 0 : side * (1e-3f - along);
    for (int i = 0; i < 3; i++) out[i] += push * s->ng[i][k];
    scale = along > 0 ? 1 : 1 / sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    float a = fabsf(s->p[0][k]), b = fabsf(s->p[1][k]), e = fabsf(s->p[2][k]), size = s->size[k];
    size = size > a ? size : a;
    size = size > b ? size : b;
    size = size > e ? size : e;
    float offset = side * size * ABBE_GEOMETRY_OFFSET;
    for (int i = 0; i < 3; i++) {
      s->out[i][k] = out[i] * scale;
      s->from[i][k] = s->p[i][k] + offset * s->ng[i][k];
    }
    s->share[k] = share;
    s->reflects[k] = reflects;
  }
}

SIDE_BY_SIDE void abbe_scatter_turn(abbe_scatter *s) {
  for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
    float along = 0, shaded = 0;
    for (int i = 0; i < 3; i++) {
      along += s->d[i][k] * s->ng[i][k];
      shaded += s->d[i][k] * s->n[i][k];
    }
    const float side = along < 0 ? 1.0f : -1.0f;
    const int bent = (shaded < 0) == (along < 0);
    for (int i = 0; i < 3; i++) {
      const float n = bent ? s->n[i][k] : s->ng[i][k];
      s->n[i][k] = side * n;
      s->ng[i][k] *= side;
    }
  }
}

SIDE_BY_SIDE void abbe_scatter_mirror(const abbe_scatter *s, abbe_mirroring *m) {
  for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
    float c = -(s->d[0][k] * s->n[0][k] + s->d[1][k] * s->n[1][k] + s->d[2][k] * s->n[2][k]);
    c = c < 1 ? c : 1;
    const float metal = abbe_mirrors_metal(c, m->n[k], m->k[k]);
    m->share[k] = m->grey[k] >= 0 ? m->grey[k] : metal;
  }
}
