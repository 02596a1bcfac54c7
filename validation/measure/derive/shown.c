#include "validation/measure/derive/shown.h"

#include "base/maths.h"
#include "colorimetry/reflectance/reflected_light.h"
#include "scenes/geometry/transform.h"

#include <math.h>
#include <string.h>

/* Of the places of a film line's chances. */
enum { LENS = 0, LAMP = 2, DRAWN = 4, EVEN = 7 };

abbe_result abbe_shown_make(const abbe_scene *scene, const abbe_specular_shift *shift,
                            const abbe_shown *base, const char *key, double aspect, double min_nm,
                            double max_nm, abbe_shown *out, abbe_error *error) {
  const abbe_camera *c = &scene->camera;
  double view[16];
  *out = (abbe_shown){0};
  const abbe_object *around = abbe_scene_around_eye(scene);
  if (around != NULL || abbe_scene_is_polarised(scene))
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "%s: %s, and derivatives of a picture are of a camera in the open without "
        "polarisers",
        scene->path != NULL ? scene->path : "the scene",
        around != NULL ? "the camera is in a refractor" : "there is a polariser");
  ABBE_TRY(abbe_specular_make(scene, ABBE_SPECULAR_NO_LIGHT, shift, &out->specular, error));
  abbe_result result = ABBE_OK;
  if (base != NULL) result = abbe_specular_match(&out->specular, &base->specular, key, error);
  if (result == ABBE_OK && scene->environment != NULL)
    result = abbe_upsampling_make(&scene->environment->illuminant, min_nm, max_nm, &out->upsampling,
                                  error);
  if (result != ABBE_OK) abbe_shown_free(out);
  abbe_transform_look_at(c->eye, c->target, c->up, view);
  for (int k = 0; k < 3; k++) {
    out->eye[k] = c->eye[k];
    out->right[k] = view[4 * k];
    out->up[k] = view[4 * k + 1];
    out->forward[k] = -view[4 * k + 2];
  }
  out->half[1] = tan(0.5 * c->fov_y_rad);
  out->half[0] = out->half[1] * aspect;
  return result;
}

void abbe_shown_free(abbe_shown *s) {
  abbe_specular_free(&s->specular);
}

/* The pinhole at a place of the lens, and by how much its film is shifted. */
static void pinhole(const abbe_shown *s, const double lens[2], double eye[3], double moved[2]) {
  const abbe_camera *c = &s->specular.scene->camera;
  const double r = 0.5 * c->aperture * sqrt(lens[0]), phi = 2 * ABBE_PI * lens[1];
  const double x = r * cos(phi), y = r * sin(phi);
  for (int k = 0; k < 3; k++) eye[k] = s->eye[k] + x * s->right[k] + y * s->up[k];
  moved[0] = r > 0 ? x / c->focus : 0;
  moved[1] = r > 0 ? y / c->focus : 0;
}

static void film_ray(const abbe_shown *s, const double at[2], const double lens[2], double o[3],
                     double d[3]) {
  double moved[2];
  pinhole(s, lens, o, moved);
  const double a = (2 * at[0] - 1) * s->half[0] - moved[0];
  const double b = (1 - 2 * at[1]) * s->half[1] - moved[1];
  for (int k = 0; k < 3; k++) d[k] = s->forward[k] + a * s->right[k] + b * s->up[k];
  abbe_vector_normalise(d);
}

/* ---- receivers ---- */

/* Bilinear, repeated; v runs upwards, rows downwards. */
static void sample_texture(const abbe_image *t, const double uv[2], double out[3]) {
  const double x = uv[0] * (double)t->width - 0.5, y = (1 - uv[1]) * (double)t->height - 0.5;
  const double left = floor(x), top = floor(y), fx = x - left, fy = y - top;
  for (int k = 0; k < 3; k++) out[k] = 0;
  for (int i = 0; i < 4; i++) {
    double column = fmod(left + (i & 1), (double)t->width);
    double row = fmod(top + (i >> 1), (double)t->height);
    if (column < 0) column += (double)t->width;
    if (row < 0) row += (double)t->height;
    const float *texel = t->data + ((size_t)row * t->width + (size_t)column) * t->channels;
    const double weight = (i & 1 ? fx : 1 - fx) * (i >> 1 ? fy : 1 - fy);
    for (size_t k = 0; k < 3; k++) out[k] += weight * (double)texel[k];
  }
}

/* How much of each channel of reflected_light.h. */
static void find_share(const abbe_shown *s, const abbe_specular_hit *h, double share[3]) {
  const abbe_object *o = s->specular.surface[h->object].object;
  double texel[3] = {1, 1, 1};
  if (o->texture.data != NULL && o->mesh.uv != NULL && o->exact.kind != ABBE_EXACT_SPHERE) {
    const uint32_t *v = o->mesh.face[h->face];
    double uv[2];
    for (int k = 0; k < 2; k++)
      uv[k] = o->texture_repeat[k] *
              ((1 - h->side[0] - h->side[1]) * o->mesh.uv[v[0]][k] +
               h->side[0] * o->mesh.uv[v[1]][k] + h->side[1] * o->mesh.uv[v[2]][k]);
    sample_texture(&o->texture, uv, texel);
  }
  for (int k = 0; k < 3; k++)
    share[k] = o->spectrum != NULL ? (k == 0 ? 1 : 0) : o->reflectance[k] * texel[k];
}

static double reflectance_of(const abbe_shown *s, const abbe_specular_hit *h, const double share[3],
                             double lambda_nm) {
  double channel[3];
  abbe_reflectance_channels(s->specular.surface[h->object].object->spectrum, lambda_nm, channel);
  return abbe_vector_dot(share, channel);
}

void abbe_film_of_hit(const abbe_film *film, size_t scene, double lambda_nm, const double lens[2],
                      const abbe_specular_tree *known, abbe_specular_tree *tree, size_t hit) {
  const abbe_shown *s = &film->scene[scene];
  abbe_specular_hit *h = &tree->hit[hit];
  double eye[3], moved[2], d[3];
  pinhole(s, lens, eye, moved);
  abbe_vector_subtract(eye, h->p, d);
  const double away = abbe_vector_length(d), z = -abbe_vector_dot(d, s->forward);
  abbe_vector_normalise(d);
  const double facing = abbe_vector_dot(d, h->n);
  tree->lit = h->flux;
  const bool shown = z > 0 && facing * abbe_vector_dot(h->d, h->n) < 0;
  const bool hidden = abbe_specular_hides(&s->specular, ABBE_SPECULAR_ALL, h->p, d, h->inside,
                                          shown ? away : 0, ABBE_SPECULAR_NOTHING, known, tree);
  h->film[2] = 0;
  if (hidden || !shown) return;
  const double a = -abbe_vector_dot(d, s->right) * away / z + moved[0];
  const double b = -abbe_vector_dot(d, s->up) * away / z + moved[1];
  const double cosine = z / away;
  const double pixel = 4 * s->half[0] * s->half[1] / (double)(film->width * film->height);
  h->film[0] = 0.5 * (a / s->half[0] + 1) * (double)film->width;
  h->film[1] = 0.5 * (1 - b / s->half[1]) * (double)film->height;
  double share[3];
  find_share(s, h, share);
  h->film[2] = reflectance_of(s, h, share, lambda_nm) / ABBE_PI * fabs(facing) /
               (away * away * cosine * cosine * cosine * pixel);
}

/* ---- the light at the end of a path ---- */

typedef struct leaf {
  const abbe_film_line *l;
  const abbe_shown *s;
  const abbe_specular_tree *known;
  abbe_specular_tree *tree;
  size_t scene, hit;
  double n[3];       /* of a receiver, on the side that is seen */
  double share;      /* of the light there that is seen */
  double channel[3]; /* that it reflects */
  double reflectance;
  size_t object; /* that reflects; the scene's count: none */
} leaf;

/* Colour of a light of power 1: straight ones of all wavelengths, else the line's own. */
static void colour_of(const leaf *f, size_t row, double out[3]) {
  const abbe_film *film = f->l->film;
  const bool straight = f->tree->hit[f->hit].met == 0;
  const size_t lights = f->s->specular.scene->light_count;
  const float *one = film->colour[row * film->sampling->steps + f->l->step];
  const double(*all)[3] =
      straight && row < lights ? (const double(*)[3])film->white[f->object * lights + row] : NULL;
  for (int c = 0; c < 3; c++) {
    out[c] = all == NULL ? f->reflectance * (double)one[c] : 0;
    for (int j = 0; j < 3 && all != NULL; j++) out[c] += f->channel[j] * all[j][c];
  }
}

static void add(const leaf *f, size_t row, double radiance) {
  double colour[3];
  colour_of(f, row, colour);
  for (int c = 0; c < 3; c++) f->tree->shown[c] += f->share * radiance * colour[c];
}

/* The first light's spectrum, whose colour becomes white. */
static void add_white(const leaf *f, double radiance) {
  double colour[3];
  colour_of(f, 0, colour);
  for (int c = 0; c < 3; c++)
    f->tree->shown[c] += f->share * radiance * abbe_vector_dot(f->l->film->whiten + 3 * c, colour);
}

static void add_surroundings(const leaf *f, const double d[3], double share) {
  const abbe_scene *scene = f->s->specular.scene;
  double rgb[3];
  abbe_environment_radiance(scene->environment, d, rgb);
  add(f, scene->light_count,
      share * abbe_upsampling_at(&f->s->upsampling, rgb, f->l->wave[f->scene].lambda_nm));
}

/* Of the medium that a place is in. Radiance over its square is the same all along a path. */
static double index_at(const leaf *f, uint64_t inside) {
  return inside != 0 ? f->l->wave[f->scene].n[63 - __builtin_clzll(inside)] : 1;
}

static bool hides(const leaf *f, const double d[3], double limit) {
  const abbe_specular_hit *h = &f->tree->hit[f->hit];
  return abbe_specular_hides(&f->s->specular, ABBE_SPECULAR_ALL, h->p, d, h->inside, limit,
                             ABBE_SPECULAR_NOTHING, f->known, f->tree);
}

static void add_lamp(const leaf *f, size_t index) {
  const abbe_light *light = &f->s->specular.scene->light[index];
  const double *p = f->tree->hit[f->hit].p;
  double d[3], away[3], limit = 4 * f->s->specular.far, power = light->power;
  for (int k = 0; k < 3; k++) d[k] = -light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    double place[3];
    abbe_specular_place_on(light, f->l->chance + LAMP, place);
    abbe_vector_subtract(place, p, d);
    limit = abbe_vector_length(d);
    abbe_vector_normalise(d);
    power *= (abbe_light_has_size(light) ? abbe_light_area(light) : 1) / (limit * limit);
  }
  for (int k = 0; k < 3; k++) away[k] = -d[k];
  const double facing = abbe_vector_dot(f->n, d);
  const double e = facing > 0 ? power * facing * abbe_light_profile(light, away) : 0;
  const bool hidden = hides(f, d, e > 0 ? limit : 0);
  if (e > 0 && !hidden) add(f, index, e / ABBE_PI);
}

/* One direction drawn by the surroundings' radiance, and one by the cosine, which goes on through
 * refractors and off mirrors; straight ones weighted by the balance heuristic [VeachGuibas1995]. */
static void add_sky(const leaf *f) {
  const abbe_environment *drawn = f->l->film->scene[0].specular.scene->environment;
  const double *chance = f->l->chance;
  const abbe_specular_hit own = f->tree->hit[f->hit];
  const double n = index_at(f, own.inside);
  double d[3], pdf, rgb[3], x[3], y[3];
  abbe_environment_sample(drawn, chance + DRAWN, d, &pdf, rgb);
  double cosine = abbe_vector_dot(f->n, d) / ABBE_PI;
  const bool hidden = hides(f, d, cosine > 0 ? 4 * f->s->specular.far : 0);
  if (cosine > 0 && !hidden) add_surroundings(f, d, cosine / (pdf + cosine));
  const double r = sqrt(chance[EVEN]), phi = 2 * ABBE_PI * chance[EVEN + 1];
  abbe_light_upright(f->n, x, y);
  for (int k = 0; k < 3; k++)
    d[k] = r * (cos(phi) * x[k] + sin(phi) * y[k]) + sqrt(1 - r * r) * f->n[k];
  const size_t first = f->tree->count;
  abbe_specular_view(&f->s->specular, &f->l->wave[f->scene], own.p, d, own.inside,
                     (uint16_t)(f->hit + 1), f->l->film->interfaces, f->known, f->tree);
  for (size_t i = first; i < f->tree->count; i++) {
    const abbe_specular_hit *h = &f->tree->hit[i];
    if (h->object != ABBE_SPECULAR_NOTHING) continue;
    cosine = sqrt(1 - r * r) / ABBE_PI;
    const double straight = cosine / (abbe_environment_pdf(drawn, h->d) + cosine);
    add_surroundings(f, h->d, h->flux * (h->met > 0 ? n * n : straight));
  }
}

/* Of a row of a light's map, linear between the texels' middles. */
static void add_texels(const abbe_derivative_desc *q, const double (*map)[3], const double uv[2],
                       double by, double xyz[3]) {
  const double x = uv[0] * (double)q->width - 0.5, y = (1 - uv[1]) * (double)q->height - 0.5;
  const double left = floor(x), top = floor(y), fx = x - left, fy = y - top;
  for (int k = 0; k < 4; k++) {
    const double column = left + k % 2, row = top + k / 2;
    if (!(column >= 0 && row >= 0 && column < (double)q->width && row < (double)q->height))
      continue;
    const double weight = by * (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy);
    const double *texel = map[(size_t)row * q->width + (size_t)column];
    for (int c = 0; c < 3; c++) xyz[c] += weight * texel[c];
  }
}

/* What a lamp throws onto the receiver through refractors and off mirrors, on its own side: its map
 * over the texel's area there, in a moved scene with the map's change by the key's step. */
static void add_caustic(const leaf *f, size_t light) {
  const abbe_film *film = f->l->film;
  const abbe_derivative_desc *q = &film->light[light];
  const abbe_specular_hit *h = &f->tree->hit[f->hit];
  if (q->base == NULL) return;
  const abbe_specular *s =
      f->scene == 0 ? q->base : &q->key[(f->scene - 1) / 2].moved[(f->scene - 1) % 2];
  const abbe_map_layout *layout = &q->layout;
  double uv[2], d[3], xyz[3] = {0}, rgb[3];
  if (abbe_specular_is_dark(s, h->p, h->object, f->known, f->tree) ||
      !abbe_map_layout_project(layout, h->p, uv))
    return;
  abbe_map_layout_ray(layout, uv, (double[3]){0}, d);
  double area = 1;
  for (int axis = 0; axis < 2; axis++) {
    const size_t side = axis == 0 ? q->width : q->height;
    area *= abbe_map_layout_texel_size(layout, axis, side, side / 2);
  }
  if (!layout->view.orthographic) {
    double way[3];
    abbe_vector_subtract(h->p, layout->view.origin, way);
    const double z = abbe_vector_dot(way, layout->view.forward);
    area *= z * z * z / abbe_vector_length(way);
  }
  const double facing = -abbe_vector_dot(f->n, d);
  if (!(facing > 0)) return;
  const double(*map)[3] = (const double(*)[3])f->l->map[light];
  add_texels(q, map, uv, 1, xyz);
  if (f->scene > 0) {
    const size_t key = (f->scene - 1) / 2;
    const double step = f->l->line.step[key] * (f->scene % 2 == 1 ? -1 : 1);
    add_texels(q, map + (1 + key) * q->width * q->height, uv, step, xyz);
  }
  abbe_rgb_space_apply(film->from_xyz, xyz, rgb);
  const double share = f->share * f->reflectance * facing / (ABBE_PI * area);
  for (int c = 0; c < 3; c++) f->tree->shown[c] += share * rgb[c];
}

static void add_receiver(leaf *f) {
  const abbe_scene *scene = f->s->specular.scene;
  const abbe_specular_hit *h = &f->tree->hit[f->hit];
  const bool straight = h->met == 0;
  const double side = abbe_vector_dot(h->d, h->n) < 0 ? 1 : -1;
  for (int k = 0; k < 3; k++) f->n[k] = side * h->n[k];
  f->object = h->object;
  find_share(f->s, h, f->channel);
  f->reflectance = reflectance_of(f->s, h, f->channel, f->l->wave[f->scene].lambda_nm);
  for (size_t i = 0; i < scene->light_count; i++) add_lamp(f, i);
  if (scene->ambient > 0) add_white(f, scene->ambient / ABBE_PI);
  for (size_t i = 0; i < scene->light_count && !straight; i++) add_caustic(f, i);
  if (scene->environment != NULL) add_sky(f);
}

static void add_leaf(leaf *f) {
  const abbe_scene *scene = f->s->specular.scene;
  const abbe_specular_hit *h = &f->tree->hit[f->hit];
  f->share = f->tree->lit = h->flux;
  f->object = scene->object_count;
  f->reflectance = f->channel[0] = 1;
  if (h->object == ABBE_SPECULAR_NOTHING) {
    if (h->met == 0 && scene->transparent) return;
    if (scene->background > 0) add_white(f, scene->background);
    if (scene->environment != NULL) add_surroundings(f, h->d, 1);
  } else if (h->object >= ABBE_SPECULAR_LAMP) {
    const size_t light = h->object - ABBE_SPECULAR_LAMP;
    if (abbe_vector_dot(h->d, scene->light[light].direction) < 0)
      add(f, light, scene->light[light].power);
  } else {
    const double n = index_at(f, h->inside);
    f->share /= n * n;
    add_receiver(f);
  }
}

/* ---- lines on the film ---- */

static void look(const abbe_line *line, size_t scene, const double at[2],
                 const abbe_specular_tree *known, abbe_specular_tree *out) {
  const abbe_film_line *l = (const abbe_film_line *)line;
  const abbe_shown *s = &l->film->scene[scene];
  double o[3], d[3];
  film_ray(s, at, l->chance + LENS, o, d);
  abbe_specular_view(&s->specular, &l->wave[scene], o, d, 0, 0, l->film->interfaces, known, out);
  memcpy(out->at, at, sizeof out->at);
  memset(out->shown, 0, sizeof out->shown);
  const size_t leaves = out->count;
  for (size_t i = 0; i < leaves && !out->failed; i++) {
    leaf f = {.l = l, .s = s, .known = known, .tree = out, .scene = scene, .hit = i};
    add_leaf(&f);
  }
}

static void deposit(const abbe_line *line, size_t row, const abbe_specular_tree *tree,
                    double factor) {
  const abbe_film_line *l = (const abbe_film_line *)line;
  const size_t width = l->film->width, pixels = width * l->film->height;
  const double x = floor(tree->at[0] * (double)width),
               y = floor(tree->at[1] * (double)l->film->height);
  if (!(x >= 0 && y >= 0 && x < (double)width && y < (double)l->film->height)) return;
  double *to = l->picture[row * pixels + (size_t)y * width + (size_t)x];
  for (int c = 0; c < 3; c++) to[c] += factor * line->weight * (double)pixels * tree->shown[c];
}

/* Both ways, so half of the difference each. */
static double only_in(const abbe_line *line, const abbe_specular_tree *tree,
                      const abbe_specular_tree *other) {
  (void)line;
  double sum = 0;
  for (int c = 0; c < 3; c++) sum += 0.5 * fabs(tree->shown[c] - other->shown[c]);
  return sum;
}

void abbe_film_line_begin(abbe_film_line *l) {
  l->line.film = true;
  l->line.look = look;
  l->line.deposit = deposit;
  l->line.only_in = only_in;
}
