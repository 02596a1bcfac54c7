#include "validation/lab/exit_fill.h"

#include "base/maths.h"
#include "validation/lab/volume_sums.h"
#include "validation/trace/transport/random.h"

#include <stdlib.h>
#include <string.h>

enum { SALT = 0x737063, MOST_FACES_OF_LINE = 256 };

typedef struct tally {
  const abbe_geometry *g;
  const abbe_volume_region *region;
  const double *centre;
  abbe_region_piece *piece;
  double *whole, *inner; /* [cells] lengths of lines */
} tally;

static void add(tally *t, const double o[3], const double d[3], double from, double to,
                double *sum) {
  double p[3], q[3];
  for (int k = 0; k < 3; k++) {
    p[k] = o[k] + from * d[k];
    q[k] = p[k] - t->centre[k];
  }
  const size_t count = abbe_volume_region_walk(t->region, q, d, to - from, t->piece);
  for (size_t i = 0; i < count; i++) sum[t->piece[i].cell] += t->piece[i].length;
}

/* The parts of a line inside the surface. */
static void cut_line(tally *t, const double o[3], const double d[3]) {
  float at[3], way[3];
  double entered = 0, done = 0;
  int depth = 0;
  abbe_geometry_to_frame(t->g, o, at);
  for (int k = 0; k < 3; k++) way[k] = (float)d[k];
  for (int i = 0; i < MOST_FACES_OF_LINE; i++) {
    abbe_hit hit;
    double world[3], along[3];
    if (!abbe_geometry_hit(t->g, ABBE_GEOMETRY_OBJECTS, at, way, INFINITY, &hit)) return;
    abbe_geometry_to_world(t->g, hit.p, world);
    abbe_vector_subtract(world, o, along);
    done = abbe_vector_dot(along, d);
    const bool enters = way[0] * hit.ng[0] + way[1] * hit.ng[1] + way[2] * hit.ng[2] < 0;
    if (enters && depth++ == 0) entered = done;
    if (!enters && depth > 0 && --depth == 0) add(t, o, d, entered, done, t->inner);
    abbe_geometry_leave(&hit, way, at);
  }
}

static void make_line(uint32_t i, const double centre[3], double radius, double o[3], double d[3]) {
  float random[4];
  double x[3], y[3];
  abbe_random4(i, 0, 0, SALT, random);
  d[2] = 2 * (double)random[0] - 1;
  const double across = sqrt(fmax(1 - d[2] * d[2], 0)), turn = 2 * ABBE_PI * (double)random[1];
  d[0] = across * cos(turn);
  d[1] = across * sin(turn);
  const double other[3] = {fabs(d[0]) < 0.6, fabs(d[0]) >= 0.6, 0};
  abbe_vector_cross(d, other, x);
  abbe_vector_normalise(x);
  abbe_vector_cross(d, x, y);
  const double r = radius * sqrt((double)random[2]), a = 2 * ABBE_PI * (double)random[3];
  for (int k = 0; k < 3; k++)
    o[k] = centre[k] + r * (cos(a) * x[k] + sin(a) * y[k]) - 4 * radius * d[k];
}

abbe_result abbe_volume_space_measure(const abbe_geometry *g, const abbe_volume_region *region,
                                      const double centre[3], double radius, size_t lines,
                                      float *share, abbe_error *error) {
  tally t = {.g = g, .region = region, .centre = centre};
  t.piece = malloc(ABBE_REGION_MOST_PIECES * sizeof *t.piece);
  t.whole = calloc(region->cells, sizeof *t.whole);
  t.inner = calloc(region->cells, sizeof *t.inner);
  const bool room = t.piece != NULL && t.whole != NULL && t.inner != NULL;
  for (uint32_t i = 0; room && i < lines; i++) {
    double o[3], d[3];
    make_line(i, centre, 1.2 * radius, o, d);
    add(&t, o, d, 0, INFINITY, t.whole);
    cut_line(&t, o, d);
  }
  for (size_t i = 0; room && i < region->cells; i++)
    share[i] = t.whole[i] > 0 ? (float)fmin(fmax(1 - t.inner[i] / t.whole[i], 0), 1) : 1;
  free(t.piece);
  free(t.whole);
  free(t.inner);
  return room ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a region's space");
}

abbe_result abbe_lone_object_make(const abbe_scene *scene, size_t object, size_t light,
                                  abbe_lone_object *out, abbe_error *error) {
  *out = (abbe_lone_object){0};
  if (scene->light_count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no light of its own, whose colour the volume would have");
  if (object >= scene->object_count || light >= scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "object %zu in light %zu: the scene has %zu objects and %zu lights",
                          object + 1, light + 1, scene->object_count, scene->light_count);
  out->object = scene->object[object];
  out->light = (abbe_light){.name = scene->light[light].name,
                            .kind = ABBE_LIGHT_DIRECTIONAL,
                            .direction = {0, 0, -1},
                            .power = 1,
                            .illuminant = scene->light[light].illuminant};
  out->scene = *scene;
  out->scene.object = &out->object;
  out->scene.object_count = 1;
  out->scene.light = &out->light;
  out->scene.light_count = 1;
  out->scene.environment = NULL;
  out->scene.soft_light = NULL;
  out->scene.environment_lights = 0;
  ABBE_TRY(abbe_volume_body_make(&out->object, &out->body, error));
  ABBE_TRY(abbe_volume_body_find(&out->body, &out->object, &out->place, error));
  return abbe_geometry_make(&out->scene, &out->geometry, error);
}

void abbe_lone_object_free(abbe_lone_object *lone) {
  if (lone == NULL) return;
  abbe_geometry_free(&lone->geometry);
  *lone = (abbe_lone_object){0};
}

double abbe_lone_object_depth(const abbe_lone_object *lone) {
  return fabs(abbe_object_distance(&lone->object, lone->place.centre));
}

static uint64_t materials_key(const abbe_media *m, const abbe_mirrors *r, uint64_t h) {
  const size_t values = m->refractors * (m->steps + 1);
  h = abbe_volume_key(h, m->n, values * sizeof *m->n);
  if (m->attenuation != NULL)
    h = abbe_volume_key(h, m->attenuation, values * sizeof *m->attenuation);
  if (m->extraordinary != NULL) {
    h = abbe_volume_key(h, m->extraordinary, values * sizeof *m->extraordinary);
    if (m->principal != NULL) {
      h = abbe_volume_key(h, m->principal, 3 * values * sizeof *m->principal);
      h = abbe_volume_key(h, m->frame, m->refractors * sizeof *m->frame);
    }
    if (m->pleochroism != NULL)
      h = abbe_volume_key(h, m->pleochroism, 3 * values * sizeof *m->pleochroism);
    h = abbe_volume_key(h, m->axis, m->refractors * sizeof *m->axis);
  }
  if (m->films.count > 0) h = abbe_volume_key(h, &m->films.key, sizeof m->films.key);
  h = abbe_volume_key(h, r->reflectance, r->count * sizeof *r->reflectance);
  return abbe_volume_key(h, r->nk, r->count * (r->steps + 1) * sizeof *r->nk);
}

uint64_t abbe_lone_object_key(const abbe_lone_object *lone, const abbe_media *media,
                              const abbe_mirrors *mirrors, uint64_t h) {
  const abbe_geometry *g = &lone->geometry;
  const abbe_surface *s = &g->surface[0];
  const abbe_mesh *mesh = &lone->object.mesh;
  const double ball[4] = {(double)s->radius, (double)s->centre[0], (double)s->centre[1],
                          (double)s->centre[2]};
  h = materials_key(media, mirrors, h);
  h = abbe_volume_key(h, g->instructions, strlen(g->instructions));
  h = abbe_volume_key(h, g->origin, sizeof g->origin);
  h = abbe_volume_key(h, &g->unit, sizeof g->unit);
  h = abbe_volume_key(h, &s->kind, sizeof s->kind);
  h = abbe_volume_key(h, ball, sizeof ball);
  if (s->sphere) return h;
  h = abbe_volume_key(h, s->position, mesh->vertex_count * sizeof *s->position);
  h = abbe_volume_key(h, s->face, mesh->face_count * sizeof *s->face);
  return abbe_volume_key(h, s->normal,
                         (s->flat ? mesh->face_count : mesh->vertex_count) * sizeof *s->normal);
}
