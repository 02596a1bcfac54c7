#include "validation/trace/walks/camera.h"

#include "scenes/geometry/transform.h"

static const double rays_of_sample = 32; /* in a cut stone, about */
static const double more_for_glass = 4;

static bool shows_refractor(const abbe_geometry *g, const abbe_trace_camera *c, size_t x,
                            size_t y) {
  float d[3];
  abbe_hit hit;
  abbe_trace_camera_ray(c, (float)x + 0.5f, (float)y + 0.5f, d);
  return abbe_geometry_hit(g, ABBE_GEOMETRY_ALL, c->eye, d, INFINITY, &hit) &&
         (hit.surface->kind & ABBE_GEOMETRY_SPECULAR) != 0;
}

/* Whether the pixel or one next to it is marked as showing a refractor in its middle. */
static bool is_near(const uint8_t *middle, size_t width, size_t height, size_t x, size_t y) {
  for (size_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; j++)
    for (size_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; i++)
      if (middle[j * width + i] & 1) return true;
  return false;
}

void abbe_eye_samples_share(const abbe_geometry *g, const abbe_trace_camera *c, double rays,
                            size_t threads, uint8_t *samples) {
  size_t width = c->width, height = c->height, found = 0;
#pragma omp parallel for num_threads((int)threads)
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x < width; x++) samples[y * width + x] = shows_refractor(g, c, x, y);
  /* the second bit: the pixel or a neighbour */
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x < width; x++)
      if (is_near(samples, width, height, x, y)) {
        samples[y * width + x] |= 2;
        found++;
      }
  /* the more of the picture is glass, the less of it waits for the photons alone */
  rays *= 1 + more_for_glass * (double)found / (double)(width * height);
  double each = fmin(rays / (rays_of_sample * (double)found), ABBE_EYE_MOST_SAMPLES);
  uint8_t many = each >= 1 ? (uint8_t)lround(each) : 1; /* not a number where nothing shows one */
  for (size_t i = 0; i < width * height; i++) samples[i] = samples[i] > 1 ? many : 1;
}

float abbe_eye_samples_depth(const abbe_geometry *g, const abbe_trace_camera *c) {
  enum { PLACES = 32 };
  float sum = 0, d[3];
  size_t count = 0;
  for (size_t i = 0; i < PLACES * PLACES; i++) {
    abbe_hit hit;
    const float x = ((float)(i % PLACES) + 0.5f) / PLACES,
                y = ((float)(i / PLACES) + 0.5f) / PLACES;
    abbe_trace_camera_ray(c, x * (float)c->width, y * (float)c->height, d);
    if (!abbe_geometry_hit(g, ABBE_GEOMETRY_ALL, c->eye, d, INFINITY, &hit)) continue;
    for (int k = 0; k < 3; k++) sum += (hit.p[k] - c->eye[k]) * d[k];
    count++;
  }
  return count > 0 ? sum / (float)count : 1;
}

void abbe_trace_camera_make(const abbe_geometry *geometry, size_t width, size_t height,
                            abbe_trace_camera *out) {
  const abbe_camera *c = &geometry->scene->camera;
  double view[16];
  abbe_transform_look_at(c->eye, c->target, c->up, view);
  *out = (abbe_trace_camera){.width = width,
                             .height = height,
                             .lens = (float)(0.5 * c->aperture / geometry->unit),
                             .focus = (float)(c->focus / geometry->unit)};
  abbe_geometry_to_frame(geometry, c->eye, out->eye);
  for (int k = 0; k < 3; k++) {
    out->right[k] = (float)view[4 * k];
    out->up[k] = (float)view[4 * k + 1];
    out->forward[k] = (float)-view[4 * k + 2];
  }
  double tangent = tan(0.5 * c->fov_y_rad);
  out->half_height = (float)tangent;
  out->half_width = (float)(tangent * (double)width / (double)height);
  out->pixel_area = (float)(4 * tangent * tangent / ((double)height * (double)height));
}
