#include "gl/device/bindings.h"
#include "gl/eye/lighting.h"
#include "gl/scene/spectra/band_parts.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rays for all lights together, as many for all around, and for a light at the least. */
enum { RAYS = 4096, LEAST_RAYS = 128 };
enum { CELLS = ABBE_PLAN_GLOW_CELLS, ALL_CELLS = CELLS * CELLS * CELLS };
/* In place of a unit. */
enum { ASKS = -1 };
/* Places of a cell, a side, that are asked whether they are inside. */
enum { PLACES = 4, SIDE = CELLS * PLACES };

typedef struct ray {
  float from[4], along[4]; /* glow_rays.glsl */
} ray;

/* A refractor and the rays to it. */
typedef struct asked {
  abbe_glow_pass *pass;
  const abbe_object *object;
  size_t refractor, each;   /* rays of each light, after those of all around */
  double centre[3], radius; /* of a ball that holds it, m */
  ray *ray;
  double *weight; /* [rays] power, or of all around area times solid angle, that it stands for */
  size_t rays, bands;
  float (*band)[4]; /* [rays][bands] as glow_rays.glsl has them */
} asked;

static const abbe_gpu_scene *scene_of(const abbe_glow_pass *pass) {
  return pass->lighting->scene;
}

abbe_result abbe_glow_pass_make(const abbe_lighting *lighting, const abbe_shader_variant *variant,
                                abbe_glow_pass *out, abbe_error *error) {
  const abbe_plan *plan = lighting->scene->plan;
  abbe_gpu *gpu = lighting->scene->gpu;
  abbe_shader_variant rays = *variant;
  char facts[96];
  if (out->lighting != NULL) return ABBE_OK; /* it has stayed */
  *out = (abbe_glow_pass){.lighting = lighting};
  if (!plan->glowing) return ABBE_OK;
  snprintf(facts, sizeof facts, "#define GLOW_RAYS\n%s", abbe_shader_variant_waves(plan));
  rays.pixel_threads = 1;
  rays.exits = plan->eye_exits;
  ABBE_TRY(abbe_gpu_make_buffer(gpu, 8 * ALL_CELLS, NULL, &out->sums, error));
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_RGBA32F, CELLS, CELLS, CELLS * plan->refractor_count, true,
                                 &out->cells, error));
  return abbe_shader_variant_compute(&rays, gpu, "refraction.comp", facts, &out->program, error);
}

void abbe_glow_pass_free(abbe_glow_pass *pass, bool stays) {
  if (stays || pass->lighting == NULL) return;
  abbe_gpu_drop_buffers(scene_of(pass)->gpu, 1, &pass->sums);
  abbe_gpu_drop_textures(scene_of(pass)->gpu, 1, &pass->cells);
  *pass = (abbe_glow_pass){0};
}

/* ---- rays ---- */

/* Number k of values that fill 0 to 1 evenly in four dimensions [Roberts2018]. */
static void fill_evenly(size_t k, double out[4]) {
  double step = 1;
  for (int i = 0; i < 4; i++) {
    step /= 1.1673039782614187;
    out[i] = fmod(0.5 + step * (double)(k + 1), 1);
  }
}

/* z along the axis, turned about it by a share of the circle. */
static void turn(const double axis[3], double z, double share, double across, double out[3]) {
  double other[3] = {0}, x[3], y[3];
  other[fabs(axis[0]) < 0.6 ? 0 : 1] = 1;
  abbe_vector_cross(axis, other, x);
  abbe_vector_normalise(x);
  abbe_vector_cross(axis, x, y);
  for (int c = 0; c < 3; c++)
    out[c] =
        z * axis[c] + across * (cos(2 * ABBE_PI * share) * x[c] + sin(2 * ABBE_PI * share) * y[c]);
}

/* Rays that go along d and fill the ball's width. */
static double aim_across(const asked *a, const double d[3], const double u[4], double from[3]) {
  turn(d, -1.01 * a->radius, u[3], a->radius * sqrt(u[2]), from);
  for (int c = 0; c < 3; c++) from[c] += a->centre[c];
  return ABBE_PI * a->radius * a->radius;
}

/* The cone from the light to the ball; all around where the light is in it. */
static double aim_cone(const asked *a, const abbe_light *light, const double u[4], double d[3]) {
  double to[3];
  abbe_vector_subtract(a->centre, light->position, to);
  const double sine = a->radius / fmax(abbe_vector_length(to), 1e-30);
  const double least = sine < 1 ? sqrt(1 - sine * sine) : -1, z = 1 - u[0] * (1 - least);
  if (!abbe_vector_normalise(to)) to[2] = 1; /* the light stands in the middle */
  turn(to, z, u[1], sqrt(fmax(1 - z * z, 0)), d);
  return 2 * ABBE_PI * (1 - least) * light->power * abbe_light_profile(light, d);
}

/* The light of a ray; NULL: it comes from all around. */
static const abbe_light *light_of(const asked *a, size_t i) {
  return i < RAYS ? NULL : &scene_of(a->pass)->local->light[(i - RAYS) / a->each];
}

static void aim(asked *a, size_t i) {
  static const double up[3] = {0, 0, 1};
  const abbe_light *l = light_of(a, i);
  double u[4], from[3] = {0}, d[3], kind = 0;
  fill_evenly(l == NULL ? i : (i - RAYS) % a->each, u);
  if (l == NULL) {
    turn(up, 2 * u[0] - 1, u[1], sqrt(fmax(1 - pow(2 * u[0] - 1, 2), 0)), d);
    a->weight[i] = 4 * ABBE_PI * aim_across(a, d, u, from) / RAYS;
  } else if (l->kind == ABBE_LIGHT_DIRECTIONAL) {
    for (int c = 0; c < 3; c++) d[c] = l->direction[c];
    a->weight[i] = l->power * aim_across(a, d, u, from) / (double)a->each;
    kind = 2;
  } else {
    for (int c = 0; c < 3; c++) from[c] = l->position[c];
    a->weight[i] = aim_cone(a, l, u, d) / (double)a->each;
    kind = 1;
  }
  for (int c = 0; c < 3; c++) {
    a->ray[i].from[c] = (float)from[c];
    a->ray[i].along[c] = (float)d[c];
  }
  a->ray[i].from[3] = (float)kind;
}

/* The scene's lights, without those that stand for its environment, and views of one again. */
static size_t own_lights(const abbe_gpu_scene *scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene->plan->light_view_count; i++)
    count += scene->plan->light_view[i].light == i;
  return count - scene->local->environment_lights;
}

static void measure(asked *a) {
  const abbe_mesh *mesh = &a->object->mesh;
  for (int c = 0; c < 3; c++) a->centre[c] = 0.5 * (a->object->min[c] + a->object->max[c]);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double to[3];
    abbe_vector_subtract(mesh->position[i], a->centre, to);
    a->radius = fmax(a->radius, abbe_vector_length(to));
  }
}

/* ---- what they say ---- */

/* Of light of unit power, photons that the material would emit by each band, were all absorbed, in
 * the measure in which the light has Y = 1. A band's share is by its brightness to the scene's
 * white; where absorption varies in it, more is taken of what is absorbed more. */
static abbe_result count_photons(const asked *a, const abbe_illuminant *illuminant, double *photons,
                                 abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(a->pass);
  const abbe_material *m = a->object->material;
  const abbe_wavelengths *w = &scene->tables.all;
  const double first = w->edge_nm[0], last = w->edge_nm[w->count];
  const double path_m = abbe_usual_path(a->object);
  double y = 0, (*seen)[2] = calloc(w->count + 1, sizeof *seen);
  abbe_weights_range white;
  size_t band = 0;
  if (seen == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for glow");
  abbe_weights_range_make_by(scene->plan->desc.observer, abbe_scene_illuminant(scene->local), first,
                             last, &white);
  for (size_t b = 0; b < w->count; b++) photons[b] = 0;
  for (double nm = ceil(first - 0.5); nm < last + 0.5; nm += 1) {
    const double from = fmax(nm - 0.5, first), to = fmin(nm + 0.5, last);
    const double watts = abbe_weights_band_power(illuminant, first, last, from, to);
    const double taken = 1 - exp(-path_m * abbe_material_attenuation(m, nm));
    double xyz[3], weight = 1e-9;
    while (band + 1 < w->count && nm >= w->edge_nm[band + 1]) band++;
    abbe_observer_xyz_of(scene->plan->desc.observer, nm, xyz);
    y += watts * xyz[1];
    photons[band] += watts * nm * abbe_material_excites(m, nm) * abbe_material_yield(m, nm) * taken;
    abbe_weights_range_xyz(&white, from, to, xyz);
    for (int c = 0; c < 3; c++) weight += xyz[c] / fmax(scene->tables.camera.sum[c], 1e-30);
    seen[band][0] += weight;
    seen[band][1] += weight * taken;
  }
  for (size_t b = 0; b < w->count; b++)
    photons[b] *= seen[b][1] > 0 ? seen[b][0] / seen[b][1] / fmax(y, 1e-300) : 0;
  free(seen);
  return ABBE_OK;
}

/* Photons of each ray's bands, were all absorbed of what comes along it; the most of a band. */
static abbe_result share_photons(const asked *a, double *most, abbe_error *error) {
  const abbe_scene *scene = scene_of(a->pass)->local;
  const abbe_illuminant *known = NULL;
  double *photons = calloc(a->bands + 1, sizeof *photons);
  abbe_result result =
      photons != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for glow");
  *most = 0;
  for (size_t i = 0; i < a->rays && result == ABBE_OK; i++) {
    const abbe_light *light = light_of(a, i);
    const abbe_illuminant *own = light != NULL ? &light->illuminant : abbe_scene_illuminant(scene);
    const bool same = known != NULL && known->kind == own->kind && known->spectrum == own->spectrum;
    if (!same) result = count_photons(a, own, photons, error);
    known = own;
    for (size_t b = 0; b < a->bands && result == ABBE_OK; b++) {
      float *band = a->band[i * a->bands + b];
      const double arrive = a->weight[i] * photons[b] * fmax((double)band[3], 0);
      band[0] = (float)arrive;
      *most = fmax(*most, arrive);
    }
  }
  free(photons);
  return result;
}

/* Follows the first of the rays: adds what they excite by that unit to the sums, or, of 0, says
 * what they see; of ASKS what light comes along them. */
static abbe_result follow(asked *a, size_t rays, double unit, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(a->pass);
  abbe_gpu *gpu = scene->gpu;
  const GLuint program = a->pass->program;
  const size_t of_rays = rays * sizeof *a->ray, of_bands = rays * a->bands * sizeof *a->band;
  GLuint buffer = 0;
  ABBE_TRY(abbe_gpu_make_buffer(gpu, of_rays + of_bands, NULL, &buffer, error));
  gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)of_rays, a->ray);
  gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)of_rays, (GLsizeiptr)of_bands,
                         a->band);
  abbe_lighting_use(a->pass->lighting, program);
  abbe_gpu_set_float(gpu, program, "share_limit", scene->plan->eye_share);
  abbe_gpu_set_uint(gpu, program, "glow_rays", rays);
  abbe_gpu_set_int(gpu, program, "glow_refractor", (int)a->refractor);
  abbe_gpu_set_float(gpu, program, "glow_unit", unit);
  abbe_gpu_bind_storage(gpu, BINDING_GLOW, buffer);
  abbe_gpu_bind_storage(gpu, BINDING_GLOW_SUMS, a->pass->sums);
  abbe_gpu_dispatch(gpu, program, (rays * a->bands + ABBE_GPU_GROUP - 1) / ABBE_GPU_GROUP);
  gpu->gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (unit <= 0) {
    gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    gpu->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)of_rays, (GLsizeiptr)of_bands,
                              a->band);
  }
  abbe_gpu_drop_buffers(gpu, 1, &buffer);
  return abbe_gl_check(gpu->gl, "the rays of what glows", error);
}

/* A place of the object's grid along an axis, m; aside, so that it lies on no edge by symmetry. */
static double place_at(const abbe_object *o, int axis, int i) {
  static const double within[3] = {0.5003, 0.5007, 0.5};
  return o->min[axis] + (o->max[axis] - o->min[axis]) * (i + within[axis]) / SIDE;
}

/* All places above where a line along z meets the face are on its other side. */
static void cross_face(const abbe_object *o, const uint32_t *face, bool *inside) {
  const double *p[3] = {o->mesh.position[face[0]], o->mesh.position[face[1]],
                        o->mesh.position[face[2]]};
  const double area =
      (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
  int from[2], to[2];
  for (int c = 0; c < 2; c++) {
    const double step = (o->max[c] - o->min[c]) / SIDE;
    const double low = fmin(fmin(p[0][c], p[1][c]), p[2][c]) - o->min[c];
    const double high = fmax(fmax(p[0][c], p[1][c]), p[2][c]) - o->min[c];
    from[c] = (int)fmax(floor(low / step) - 1, 0);
    to[c] = (int)fmin(floor(high / step) + 1, SIDE - 1);
  }
  for (int y = from[1]; y <= to[1] && area != 0; y++)
    for (int x = from[0]; x <= to[0]; x++) {
      const double at[2] = {place_at(o, 0, x), place_at(o, 1, y)};
      double z = 0;
      bool meets = true;
      for (int i = 0; i < 3; i++) {
        const double *b = p[(i + 1) % 3], *c = p[(i + 2) % 3];
        const double share =
            ((b[0] - at[0]) * (c[1] - at[1]) - (b[1] - at[1]) * (c[0] - at[0])) / area;
        meets = meets && share >= 0;
        z += share * p[i][2];
      }
      for (int k = SIDE - 1; meets && k >= 0 && place_at(o, 2, k) > z; k--)
        inside[(k * SIDE + y) * SIDE + x] ^= true;
    }
}

/* Which places of the grid are inside the object: [z][y][x], SIDE each. */
static void find_inside(const abbe_object *o, bool *inside) {
  if (o->exact.kind != ABBE_EXACT_SPHERE && o->exact.kind != ABBE_EXACT_CONVEX) {
    for (size_t f = 0; f < o->mesh.face_count; f++) cross_face(o, o->mesh.face[f], inside);
    return;
  }
  for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
    const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
    double p[3];
    for (int c = 0; c < 3; c++) p[c] = place_at(o, c, at[c]);
    inside[i] = abbe_object_contains(o, p);
  }
}

/* Share of a cell that is inside the object. */
static float share_inside(const bool *inside, const size_t at[3]) {
  size_t count = 0;
  for (size_t k = 0; k < PLACES * PLACES * PLACES; k++) {
    const size_t x = PLACES * at[0] + k % PLACES, y = PLACES * at[1] + k / PLACES % PLACES;
    count += inside[((PLACES * at[2] + k / PLACES / PLACES) * SIDE + y) * SIDE + x];
  }
  return (float)count / (PLACES * PLACES * PLACES);
}

/* The source in each cell, of what the sums hold. */
static abbe_result fill_cells(const asked *a, double unit, abbe_error *error) {
  const abbe_gl *gl = scene_of(a->pass)->gpu->gl;
  GLuint sum[ALL_CELLS][2];
  float(*out)[4] = calloc(ALL_CELLS, sizeof *out);
  bool *inside = calloc((size_t)SIDE * SIDE * SIDE, sizeof *inside);
  double volume = 1;
  if (out == NULL || inside == NULL) {
    free(out);
    free(inside);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for glow");
  }
  find_inside(a->object, inside);
  for (int c = 0; c < 3; c++) volume *= (a->object->max[c] - a->object->min[c]) / CELLS;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, a->pass->sums);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof sum, sum);
  for (size_t i = 0; i < ALL_CELLS; i++) {
    const size_t at[3] = {i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS};
    const double photons = ((double)sum[i][1] * 0x1p32 + (double)sum[i][0]) / unit;
    out[i][1] = share_inside(inside, at);
    if (out[i][1] > 0) out[i][0] = (float)(photons / (4 * ABBE_PI * volume));
  }
  abbe_gpu_bind_array(scene_of(a->pass)->gpu, a->pass->program, "glow_cells", UNIT_GLOW,
                      a->pass->cells);
  gl->ActiveTexture(GL_TEXTURE0 + UNIT_GLOW);
  gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)(CELLS * a->refractor), CELLS, CELLS,
                    CELLS, GL_RGBA, GL_FLOAT, out);
  free(out);
  free(inside);
  return ABBE_OK;
}

/* What it sends back along rays from all around that meet it, in the mean, and how many of them do:
 * a ball as large and as bright stands for it on receivers. */
static void shine(const asked *a) {
  abbe_glow_pass *pass = a->pass;
  const size_t r = a->refractor;
  double xyz[3] = {0}, met = 0;
  for (size_t i = 0; i < RAYS; i++) {
    met += (double)a->band[i * a->bands][3];
    for (size_t b = 0; b < a->bands; b++)
      for (int c = 0; c < 3; c++) xyz[c] += (double)a->band[i * a->bands + b][c];
  }
  for (int c = 0; c < 3; c++) pass->ball[r][c] = (float)a->centre[c];
  pass->ball[r][3] = (float)(a->radius * sqrt(met / RAYS));
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++)
      pass->light[r][c] += scene_of(pass)->rgb_from_xyz[3 * k + c] * (float)(xyz[k] / fmax(met, 1));
}

/* The first rays find what light there is, the second what of it excites the refractor, the third
 * what of that they see. */
static abbe_result light_up(asked *a, abbe_error *error) {
  abbe_glow_pass *pass = a->pass;
  double most;
  for (int c = 0; c < 3; c++) {
    pass->low[a->refractor][c] = (float)a->object->min[c];
    pass->size[a->refractor][c] = (float)(a->object->max[c] - a->object->min[c]);
  }
  measure(a);
  for (size_t i = 0; i < a->rays; i++) aim(a, i);
  ABBE_TRY(follow(a, a->rays, ASKS, error));
  ABBE_TRY(share_photons(a, &most, error));
  if (!(most > 0)) return ABBE_OK;
  const double unit = 0x1p31 / most; /* that of a ray fits in a word */
  abbe_gpu_clear_buffer(scene_of(pass)->gpu, pass->sums);
  ABBE_TRY(follow(a, a->rays, unit, error));
  ABBE_TRY(fill_cells(a, unit, error));
  pass->low[a->refractor][3] = 1;
  ABBE_TRY(follow(a, RAYS, 0, error));
  shine(a);
  return ABBE_OK;
}

static abbe_result light_refractor(abbe_glow_pass *pass, size_t refractor, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const size_t lights = own_lights(scene), each = RAYS / (lights > 0 ? lights : 1);
  asked a = {.pass = pass,
             .object = &scene->local->object[scene->plan->refractor_object[refractor]],
             .refractor = refractor,
             .each = each > LEAST_RAYS ? each : LEAST_RAYS,
             .bands = scene->tables.all.count};
  a.rays = RAYS + lights * a.each;
  a.ray = calloc(a.rays, sizeof *a.ray);
  a.weight = calloc(a.rays, sizeof *a.weight);
  a.band = calloc(a.rays * a.bands, sizeof *a.band);
  const bool made = a.ray != NULL && a.weight != NULL && a.band != NULL;
  const abbe_result result =
      made ? light_up(&a, error) : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for glow");
  free(a.ray);
  free(a.weight);
  free(a.band);
  return result;
}

abbe_result abbe_glow_pass_run(abbe_glow_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_plan *plan = scene->plan;
  if (!plan->glowing || pass->lit) return ABBE_OK;
  abbe_gpu_start_lap(scene->gpu);
  memset(pass->low, 0, sizeof pass->low);
  memset(pass->light, 0, sizeof pass->light);
  for (size_t r = 0; r < plan->refractor_count; r++) {
    const abbe_material *m = scene->local->object[plan->refractor_object[r]].material;
    if (!plan->mirror[r] && abbe_material_is_fluorescent(m))
      ABBE_TRY(light_refractor(pass, r, error));
  }
  pass->lit = !scene->gpu->stopped;
  abbe_gpu_book_lap(scene->gpu, ABBE_PASS_EYE_GLOW);
  return ABBE_OK;
}
