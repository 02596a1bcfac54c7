#include "validation/tracer/checkpoint.h"

#include "base/file.h"
#include "base/number.h"
#include "validation/tracer/light_pass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* File: a line of magic, lines of text that say what the run is, an empty line, then counts,
 * ledger and sums as the machine keeps them, and a hash of all before it. */
static const char magic[] = "abbe checkpoint 6\n";
enum { HEAD = 4096 }; /* bytes that hold all the lines */

/* ---- hash: FNV-1a, 64 bits ---- */

static uint64_t hash(uint64_t h, const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) h = (h ^ p[i]) * 1099511628211u;
  return h;
}

static const uint64_t hash_start = 14695981039346656037u;

static uint64_t hash_doubles(uint64_t h, const double *x, size_t count) {
  return hash(h, x, count * sizeof *x);
}

static uint64_t hash_texture(uint64_t h, const abbe_object *o, const abbe_surface *f) {
  const abbe_image *t = &o->texture;
  if (t->data == NULL) return h;
  const double numbers[] = {(double)t->width, (double)t->height, o->texture_repeat[0],
                            o->texture_repeat[1]};
  h = hash_doubles(h, numbers, sizeof numbers / sizeof *numbers);
  if (f->uv != NULL) h = hash(h, f->uv, o->mesh.vertex_count * sizeof *f->uv);
  return hash(h, t->data, t->width * t->height * t->channels * sizeof *t->data);
}

static uint64_t hash_light(uint64_t h, const abbe_light *l) {
  const double numbers[] = {l->kind,         l->position[0],  l->position[1],  l->position[2],
                            l->direction[0], l->direction[1], l->direction[2], l->radius,
                            l->cone_rad,     l->soft_rad,     l->power};
  h = hash_doubles(h, numbers, sizeof numbers / sizeof *numbers);
  return l->kind == ABBE_LIGHT_RECTANGLE ? hash_doubles(h, l->edge[0], 6) : h;
}

static uint64_t hash_media(uint64_t h, const abbe_media *m) {
  const size_t values = m->refractors * (m->steps + 1);
  h = hash(h, m->n, values * sizeof *m->n);
  if (m->attenuation != NULL) h = hash(h, m->attenuation, values * sizeof *m->attenuation);
  if (m->extraordinary == NULL) return h;
  h = hash(h, m->extraordinary, values * sizeof *m->extraordinary);
  h = hash(h, m->crystal, m->refractors * sizeof *m->crystal);
  return hash(h, m->axis, m->refractors * sizeof *m->axis);
}

/* All that the walks read of the scene. */
static uint64_t hash_scene(const abbe_tracer *t) {
  const abbe_scene *s = t->scene;
  uint64_t h = hash_doubles(hash_start, t->geometry.origin, 3);
  h = hash_doubles(h, &t->geometry.unit, 1);
  h = hash_doubles(h, s->camera.eye, 3);
  h = hash_doubles(h, s->camera.target, 3);
  h = hash_doubles(h, s->camera.up, 3);
  const double loose[] = {s->camera.fov_y_rad, s->ambient, s->background};
  h = hash_doubles(h, loose, 3);
  for (size_t i = 0; i < s->light_count; i++) h = hash_light(h, &s->light[i]);
  if (s->environment != NULL) {
    const abbe_radiance_map *m = &s->environment->map;
    const double size[] = {(double)m->width, (double)m->height};
    h = hash_doubles(h, s->environment->to_map, 9);
    h = hash_doubles(h, size, 2);
    h = hash(h, m->rgb, m->width * m->height * 3 * sizeof *m->rgb);
  }
  h = hash(h, t->sampling.xyz, t->sampling.lights * t->sampling.steps * sizeof *t->sampling.xyz);
  h = hash_media(h, &t->media);
  h = hash(h, t->reflectance.step,
           t->reflectance.sets * t->reflectance.steps * sizeof *t->reflectance.step);
  h = hash(h, t->reflectance.set, s->object_count * sizeof *t->reflectance.set);
  h = hash(h, t->mirrors.reflectance, t->mirrors.count * sizeof *t->mirrors.reflectance);
  h = hash(h, t->mirrors.nk, t->mirrors.count * (t->mirrors.steps + 1) * sizeof *t->mirrors.nk);
  for (size_t i = 0; i < s->object_count; i++) {
    const abbe_object *o = &s->object[i];
    const abbe_surface *f = &t->geometry.surface[i];
    h = hash(h, &f->kind, sizeof f->kind);
    h = hash(h, f->centre, sizeof f->centre);
    h = hash(h, &f->radius, sizeof f->radius);
    h = hash_doubles(h, o->reflectance, 3);
    if (f->position != NULL) h = hash(h, f->position, o->mesh.vertex_count * sizeof *f->position);
    if (f->face != NULL) h = hash(h, f->face, o->mesh.face_count * sizeof *f->face);
    if (f->normal != NULL)
      h = hash(h, f->normal,
               (f->flat ? o->mesh.face_count : o->mesh.vertex_count) * sizeof *f->normal);
    h = hash_texture(h, o, f);
  }
  return h;
}

static uint64_t hash_layout(const abbe_tracer *t) {
  if (t->desc.no_map) return 0;
  const abbe_view *v = &t->layout.view;
  uint64_t h = hash_doubles(hash_start, v->origin, 3);
  h = hash_doubles(h, v->right, 3);
  h = hash_doubles(h, v->up, 3);
  h = hash_doubles(h, v->window, 4);
  return hash_doubles(h, t->layout.knot[0], 2 * (ABBE_MAP_LAYOUT_STEPS + 1));
}

/* The lines that say what the run is; threads do not matter. The request comes first, for tables
 * of the scene depend on it too. */
static void describe(const abbe_tracer *t, char *out, size_t size) {
  const abbe_trace_desc *d = &t->desc;
  abbe_number_format(
      out, size,
      "physics %s, %zu exits, share %.17g, of the eye %zu, %.17g\npicture %zu x %zu\nguides "
      "%s\nmap %zu "
      "x %zu of light %zu\n"
      "range %.17g:%.17g\nbands %zu\nspace %s\nphotons %zu\nseed %u\nscene %016llx\n"
      "layout %016llx\ninstructions %s\n\n",
      d->physics.matched ? "matched" : "full", d->physics.matched ? d->physics.orders : 0,
      d->physics.matched ? d->physics.energy_share : 0,
      d->physics.matched ? d->physics.eye_orders : 0, d->physics.matched ? d->physics.eye_share : 0,
      d->no_picture ? 0 : d->width, d->no_picture ? 0 : d->height,
      d->guides ? "for a filter" : "none", d->no_map ? 0 : d->map_width,
      d->no_map ? 0 : d->map_height, d->no_map ? 0 : d->map_light, d->min_nm, d->max_nm, d->bands,
      abbe_rgb_space_name(d->space), d->photons, (unsigned)d->seed,
      (unsigned long long)hash_scene(t), (unsigned long long)hash_layout(t),
      abbe_geometry_instructions());
}

/* ---- the numbers ---- */

typedef struct counts {
  uint64_t first, end; /* passes; the end is not among them */
  uint64_t photons, light_rays, eye_rays, cuts;
  abbe_whole_sum ledger[ABBE_TRACER_LEDGER];
} counts;

static size_t guides_size(const abbe_tracer *t) {
  return sizeof(abbe_whole_sum) * t->guides.pixels * ABBE_GUIDE_VALUES;
}

static size_t numbers_size(const abbe_tracer *t) {
  return sizeof(counts) + 2 * sizeof(abbe_whole_sum) * (t->picture.values + t->map.values) +
         guides_size(t);
}

typedef struct hashed_stream {
  FILE *stream;
  uint64_t hash;
} hashed_stream;

static void put(hashed_stream *s, const void *data, size_t size) {
  s->hash = hash(s->hash, data, size);
  if (size > 0) fwrite(data, size, 1, s->stream); /* a short write shows in ferror */
}

abbe_result abbe_checkpoint_save(const abbe_tracer *t, const char *path, abbe_error *error) {
  ABBE_REQUIRE(t && path, error);
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  char text[1024];
  describe(t, text, sizeof text);
  abbe_trace_statistics s;
  abbe_tracer_statistics(t, &s);
  counts c = {.first = t->first,
              .end = t->pass,
              .photons = s.photons,
              .light_rays = s.light_rays,
              .eye_rays = s.eye_rays,
              .cuts = s.cuts};
  memcpy(c.ledger, t->ledger, sizeof c.ledger);
  hashed_stream out = {.stream = writer.stream, .hash = hash_start};
  put(&out, magic, strlen(magic));
  put(&out, text, strlen(text));
  put(&out, &c, sizeof c);
  put(&out, t->picture.sum, t->picture.values * sizeof(abbe_whole_sum));
  put(&out, t->picture.square, t->picture.values * sizeof(abbe_whole_sum));
  put(&out, t->guides.sum, guides_size(t));
  put(&out, t->map.sum, t->map.values * sizeof(abbe_whole_sum));
  put(&out, t->map.square, t->map.values * sizeof(abbe_whole_sum));
  uint64_t sum = out.hash;
  put(&out, &sum, sizeof sum);
  return abbe_file_writer_commit(&writer, error);
}

/* Theirs and ours, lines that are not alike. */
static abbe_result refuse(const char *path, const char *theirs, int n, const char *ours, int m,
                          abbe_error *error) {
  const char *text =
      strncmp(theirs, "scene ", 6) == 0
          ? "%s belongs to another scene, or to another state of this one (%.*s, not %.*s): start "
            "anew without --resume"
      : strncmp(theirs, "instructions ", 13) == 0
          ? "%s was made with other instructions of a processor (%.*s, here %.*s), whose last bits "
            "differ: go on with it, and put parts together, where it was made"
          : "%s was made with '%.*s', this run asks for '%.*s': ask for the same, or start anew "
            "without --resume";
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, text, path, n, theirs, m, ours);
}

/* The first line in which two descriptions differ. */
static abbe_result say_difference(const char *path, const char *theirs, const char *ours,
                                  abbe_error *error) {
  while (*theirs != '\n' || *ours != '\n') {
    size_t n = strcspn(theirs, "\n"), m = strcspn(ours, "\n");
    if (n != m || strncmp(theirs, ours, n) != 0)
      return refuse(path, theirs, (int)n, ours, (int)m, error);
    theirs += n + 1;
    ours += m + 1;
  }
  return ABBE_OK;
}

static abbe_result check_text(const abbe_tracer *t, const char *path, char *data, size_t size,
                              size_t *numbers, abbe_error *error) {
  char ours[1024];
  size_t head = strlen(magic);
  if (size < head || memcmp(data, magic, head) != 0) {
    bool other = size > 16 && memcmp(data, magic, 16) == 0;
    return abbe_error_set(error, ABBE_PARSE,
                          other ? "%s is a checkpoint of another version of abbe: start anew"
                                : "%s is not a checkpoint of abbe trace",
                          path);
  }
  char *end = strstr(data, "\n\n");
  if (end == NULL || (size_t)(end - data) > sizeof ours)
    return abbe_error_set(error, ABBE_PARSE, "%s is a broken checkpoint: start anew", path);
  *numbers = (size_t)(end - data) + 2;
  describe(t, ours, sizeof ours);
  return say_difference(path, data + head, ours, error);
}

/* What the file says of itself, before all of it is read: the file of another request may be much
 * larger than this one's. *c: its counts, or no passes where it is cut off. */
static abbe_result read_head(const abbe_tracer *t, const char *path, counts *c, abbe_error *error) {
  char head[HEAD + 1];
  FILE *file;
  *c = (counts){0};
  abbe_result result = abbe_file_open(path, &file, NULL, error);
  if (result != ABBE_OK) return result;
  size_t numbers, size = fread(head, 1, HEAD, file);
  bool failed = ferror(file) != 0;
  fclose(file);
  head[size] = '\0';
  if (failed) return ABBE_OK; /* reading it whole says why */
  result = check_text(t, path, head, size, &numbers, error);
  if (result == ABBE_OK && size >= numbers + sizeof *c) memcpy(c, head + numbers, sizeof *c);
  return result;
}

/* All of a file whose head has been looked at, with its hash checked; malloc'd. */
static abbe_result read_whole(const abbe_tracer *t, const char *path, char **data, size_t *numbers,
                              abbe_error *error) {
  size_t size = 0;
  abbe_result result = abbe_file_read(path, numbers_size(t) + HEAD, data, &size, error);
  if (result != ABBE_OK) return result;
  result = check_text(t, path, *data, size, numbers, error);
  if (result == ABBE_OK) {
    uint64_t sum = 0;
    bool whole = size == *numbers + numbers_size(t) + sizeof sum;
    if (whole) memcpy(&sum, *data + size - sizeof sum, sizeof sum);
    if (whole && sum == hash(hash_start, *data, size - sizeof sum)) {
      counts c;
      memcpy(&c, *data + *numbers, sizeof c);
      whole = c.first <= c.end && c.end <= ABBE_WHOLE_SUM_MOST_PASSES;
    } else
      whole = false;
    if (!whole)
      result = abbe_error_set(error, ABBE_PARSE, "%s is cut off or damaged: start anew", path);
  }
  if (result == ABBE_OK) return ABBE_OK;
  free(*data);
  *data = NULL;
  return result;
}

static void clear(abbe_tracer *t) {
  const size_t size = sizeof(abbe_whole_sum);
  abbe_trace_statistics *s = &t->statistics;
  s->photons = s->light_rays = s->eye_rays = s->cuts = 0;
  t->other_rays = abbe_tracer_walk_rays(t);
  t->first = t->pass = t->picture.passes = t->map.passes = 0;
  memset(t->ledger, 0, sizeof t->ledger);
  if (t->picture.values > 0) memset(t->picture.sum, 0, t->picture.values * size);
  if (t->picture.values > 0) memset(t->picture.square, 0, t->picture.values * size);
  if (t->guides.pixels > 0) memset(t->guides.sum, 0, guides_size(t));
  if (t->map.values > 0) memset(t->map.sum, 0, t->map.values * size);
  if (t->map.values > 0) memset(t->map.square, 0, t->map.values * size);
}

static void add(const char **from, abbe_whole_sum *to, size_t count) {
  for (size_t i = 0; i < count; i++, *from += sizeof *to) {
    abbe_whole_sum more;
    memcpy(&more, *from, sizeof more);
    to[i] += more;
  }
}

/* The passes of the file behind those that are there. */
static void add_part(abbe_tracer *t, const char *numbers) {
  counts c;
  const char *at = numbers + sizeof c;
  memcpy(&c, numbers, sizeof c);
  if (t->pass == t->first) t->first = (size_t)c.first;
  t->pass = (size_t)c.end;
  t->picture.passes = t->map.passes = t->pass - t->first;
  t->statistics.photons += c.photons;
  t->statistics.light_rays += c.light_rays;
  t->statistics.eye_rays += c.eye_rays;
  t->statistics.cuts += c.cuts;
  for (size_t i = 0; i < ABBE_TRACER_LEDGER; i++) t->ledger[i] += c.ledger[i];
  add(&at, t->picture.sum, t->picture.values);
  add(&at, t->picture.square, t->picture.values);
  add(&at, t->guides.sum, t->guides.pixels * ABBE_GUIDE_VALUES);
  add(&at, t->map.sum, t->map.values);
  add(&at, t->map.square, t->map.values);
}

abbe_result abbe_checkpoint_load(abbe_tracer *t, const char *path, abbe_error *error) {
  ABBE_REQUIRE(t && path, error);
  char *data = NULL;
  size_t numbers = 0;
  counts c;
  abbe_result result = read_head(t, path, &c, error);
  if (result == ABBE_OK) result = read_whole(t, path, &data, &numbers, error);
  if (result != ABBE_OK) return result;
  clear(t);
  add_part(t, data + numbers);
  free(data);
  return ABBE_OK;
}

/* ---- parts ---- */

typedef struct part {
  const char *path;
  size_t first, end;
} part;

static int by_first(const void *a, const void *b) {
  const part *x = a, *y = b;
  if (x->first != y->first) return x->first < y->first ? -1 : 1;
  return (x->end > y->end) - (x->end < y->end);
}

static abbe_result find_parts(const abbe_tracer *t, const char *const *path, size_t count,
                              part *out, abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    counts c;
    const abbe_result result = read_head(t, path[i], &c, error);
    if (result != ABBE_OK) return result;
    out[i] = (part){path[i], (size_t)c.first, (size_t)c.end};
    if (c.first >= c.end)
      return abbe_error_set(error, ABBE_PARSE, "%s is cut off or holds no pass: trace it anew",
                            path[i]);
  }
  qsort(out, count, sizeof *out, by_first);
  return ABBE_OK;
}

/* Passes from and to, both included, in words. */
static const char *passes_text(size_t from, size_t to, char *text, size_t size) {
  if (from == to)
    snprintf(text, size, "pass %zu", from);
  else
    snprintf(text, size, "passes %zu to %zu", from, to);
  return text;
}

static const char *be(size_t from, size_t to) {
  return from == to ? "is" : "are";
}

static abbe_result check_parts(const part *p, size_t count, abbe_error *error) {
  char text[64];
  if (p[0].first > 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s %s missing: the first part that is there begins with pass %zu, in %s",
                          passes_text(0, p[0].first - 1, text, sizeof text), be(0, p[0].first - 1),
                          p[0].first, p[0].path);
  for (size_t i = 1; i < count; i++) {
    const part *a = &p[i - 1], *b = &p[i];
    if (b->first < a->end)
      return abbe_error_set(
          error, ABBE_INVALID_ARGUMENT, "%s and %s both hold %s", a->path, b->path,
          passes_text(b->first, (a->end < b->end ? a->end : b->end) - 1, text, sizeof text));
    if (b->first > a->end)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s %s missing, between %s and %s",
                            passes_text(a->end, b->first - 1, text, sizeof text),
                            be(a->end, b->first - 1), a->path, b->path);
  }
  return ABBE_OK;
}

abbe_result abbe_checkpoint_merge(abbe_tracer *t, const char *const *path, size_t count,
                                  abbe_error *error) {
  ABBE_REQUIRE(t && path, error);
  if (count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there are no parts to merge");
  part *p = calloc(count, sizeof *p);
  if (p == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu parts", count);
  abbe_result result = find_parts(t, path, count, p, error);
  if (result == ABBE_OK) result = check_parts(p, count, error);
  if (result == ABBE_OK) clear(t);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    char *data = NULL;
    size_t numbers = 0;
    result = read_whole(t, p[i].path, &data, &numbers, error);
    if (result == ABBE_OK) add_part(t, data + numbers);
    free(data);
    if (result != ABBE_OK) clear(t);
  }
  free(p);
  return result;
}
