#include "validation/trace/tracer/checkpoint.h"

#include "base/file.h"
#include "base/number.h"
#include "validation/trace/tracer/tracer_state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* File: a line of magic, lines of text that say what the run is, an empty line, then counts,
 * ledger and sums as the machine keeps them, and a hash of all before it. */
static const char magic[] = "abbe checkpoint 11\n";
/* Bytes that hold all of the head, those of the magic that versions share, and the lines of text.
 */
enum { HEAD = 4096, SAME_MAGIC = 16, TEXT = 1024 };

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
  h = hash_doubles(h, (double[]){l->polariser.kind, l->polariser.angle_rad}, 2);
  return l->kind == ABBE_LIGHT_RECTANGLE ? hash_doubles(h, l->edge[0], 6) : h;
}

static uint64_t hash_haze(uint64_t h, const abbe_haze *haze) {
  const size_t rows = haze->refractors + 1, values = rows * (haze->steps + 1);
  if (!abbe_haze_is(haze)) return h;
  h = hash(h, haze->scattering, values * sizeof *haze->scattering);
  h = hash(h, haze->extinction, values * sizeof *haze->extinction);
  h = hash(h, haze->g, rows * sizeof *haze->g);
  h = hash(h, haze->low, sizeof haze->low);
  return hash(h, haze->high, sizeof haze->high);
}

static uint64_t hash_media(uint64_t h, const abbe_media *m) {
  const size_t values = m->refractors * (m->steps + 1);
  h = hash_haze(h, &m->haze);
  if (m->films.key != 0) h = hash(h, &m->films.key, sizeof m->films.key);
  h = hash(h, m->n, values * sizeof *m->n);
  if (m->attenuation != NULL) h = hash(h, m->attenuation, values * sizeof *m->attenuation);
  if (m->extraordinary == NULL) return h;
  if (m->principal != NULL) {
    h = hash(h, m->principal, 3 * values * sizeof *m->principal);
    h = hash(h, m->frame, m->refractors * sizeof *m->frame);
  }
  if (m->pleochroism != NULL) h = hash(h, m->pleochroism, 3 * values * sizeof *m->pleochroism);
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
  const double loose[] = {s->camera.fov_y_rad, s->ambient, s->background, s->camera.polariser.kind,
                          s->camera.polariser.angle_rad};
  h = hash_doubles(h, loose, 5);
  const double lens[] = {s->camera.aperture, s->camera.focus};
  if (s->camera.aperture > 0) h = hash_doubles(h, lens, 2);
  if (s->transparent) h = hash(h, &s->transparent, sizeof s->transparent);
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
  for (size_t i = 0; i < t->mirrors.count; i++)
    if (abbe_mirrors_is_rough(&t->mirrors, i))
      h = hash(h, &t->mirrors.lobe[i], sizeof t->mirrors.lobe[i]);
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
  const bool usual = d->observer == ABBE_OBSERVER_CIE_1931;
  abbe_number_format(
      out, size,
      "physics %s, %zu exits, share %.17g, of the eye %zu, %.17g\npicture %zu x %zu\nguides %s\n"
      "map %zu x %zu of light %zu\n"
      "range %.17g:%.17g\nbands %zu\nspace %s%s%s\nphotons %zu\nseed %u\nscene %016llx\n"
      "layout %016llx\ninstructions %s\n\n",
      abbe_tracer_physics(t), d->physics.matched ? d->physics.orders : 0,
      d->physics.matched ? d->physics.energy_share : 0,
      d->physics.matched ? d->physics.eye_orders : 0, d->physics.matched ? d->physics.eye_share : 0,
      d->no_picture ? 0 : d->width, d->no_picture ? 0 : d->height,
      d->guides ? "for a filter" : "none", d->no_map ? 0 : d->map_width,
      d->no_map ? 0 : d->map_height, d->no_map ? 0 : d->map_light, d->min_nm, d->max_nm, d->bands,
      abbe_rgb_space_name(d->space), usual ? "" : ", observer ",
      usual ? "" : abbe_observer_name(d->observer), d->photons, (unsigned)d->seed,
      (unsigned long long)hash_scene(t), (unsigned long long)hash_layout(t),
      t->geometry.instructions);
}

/* ---- the numbers ---- */

static size_t numbers_size(const abbe_tracer *t) {
  const size_t sums = ABBE_TRACER_LEDGER + t->guides.pixels * ABBE_GUIDE_VALUES +
                      3 * (t->picture.values + t->map.values);
  return sizeof(abbe_pass_counts) + sums * sizeof(abbe_whole_sum);
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
  abbe_file_writer writer = {0};
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  char text[TEXT];
  describe(t, text, sizeof text);
  abbe_pass_counts counts;
  abbe_pass_counts_get(t, &counts);
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS];
  abbe_pass_sums_spans((abbe_tracer *)t, span); /* which are read alone */
  hashed_stream out = {.stream = writer.stream, .hash = hash_start};
  put(&out, magic, strlen(magic));
  put(&out, text, strlen(text));
  put(&out, &counts, sizeof counts);
  for (int i = 0; i < ABBE_PASS_SUMS_PARTS; i++)
    put(&out, span[i].sum, span[i].count * sizeof *span[i].sum);
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
          ? "%s was made with other instructions of a processor or another Embree (%.*s, here "
            "%.*s), "
            "whose last bits differ: go on with it, and put parts together, where it was made"
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
  char ours[TEXT];
  size_t head = strlen(magic);
  if (size < head || memcmp(data, magic, head) != 0) {
    bool other = size > SAME_MAGIC && memcmp(data, magic, SAME_MAGIC) == 0;
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

bool abbe_checkpoint_is(const char *path) {
  char head[SAME_MAGIC];
  FILE *file;
  if (path == NULL || abbe_file_open(path, &file, NULL, NULL) != ABBE_OK) return false;
  const bool is =
      fread(head, 1, sizeof head, file) == sizeof head && memcmp(head, magic, sizeof head) == 0;
  fclose(file);
  return is;
}

/* What the file says of itself, before all of it is read: the file of another request may be much
 * larger than this one's. *c: its counts, or no passes where it is cut off. */
static abbe_result read_head(const abbe_tracer *t, const char *path, abbe_pass_counts *c,
                             abbe_error *error) {
  char head[HEAD + 1];
  FILE *file;
  *c = (abbe_pass_counts){0};
  ABBE_TRY(abbe_file_open(path, &file, NULL, error));
  size_t numbers = 0, size = fread(head, 1, HEAD, file);
  bool failed = ferror(file) != 0;
  fclose(file);
  head[size] = '\0';
  if (failed) return ABBE_OK; /* reading it whole says why */
  ABBE_TRY(check_text(t, path, head, size, &numbers, error));
  if (size >= numbers + sizeof *c) memcpy(c, head + numbers, sizeof *c);
  return ABBE_OK;
}

/* Whether the sums are such as the passes can have, which a file that is forged need not hold. */
static bool sums_hold(const char *numbers, size_t size) {
  abbe_pass_counts c;
  memcpy(&c, numbers, sizeof c);
  if (!abbe_pass_counts_hold(&c)) return false;
  const size_t passes = abbe_pass_counts_passes(&c);
  for (size_t at = sizeof c; at < size; at += sizeof(abbe_whole_sum)) {
    abbe_whole_sum sum;
    memcpy(&sum, numbers + at, sizeof sum);
    if (!abbe_pass_sums_hold(sum, passes)) return false;
  }
  return true;
}

/* All of a file whose head has been looked at, with its hash checked; malloc'd. */
static abbe_result read_whole(const abbe_tracer *t, const char *path, char **data, size_t *numbers,
                              abbe_error *error) {
  size_t size = 0;
  ABBE_TRY(abbe_file_read(path, numbers_size(t) + HEAD, data, &size, error));
  abbe_result result = check_text(t, path, *data, size, numbers, error);
  if (result == ABBE_OK) {
    uint64_t sum = 0;
    bool whole = size == *numbers + numbers_size(t) + sizeof sum;
    if (whole) memcpy(&sum, *data + size - sizeof sum, sizeof sum);
    if (!whole || sum != hash(hash_start, *data, size - sizeof sum) ||
        !sums_hold(*data + *numbers, numbers_size(t)))
      result = abbe_error_set(error, ABBE_PARSE, "%s is cut off or damaged: start anew", path);
  }
  if (result == ABBE_OK) return ABBE_OK;
  free(*data);
  *data = NULL;
  return result;
}

/* The sums of the file to those that are there; the tracer's passes become those of `all`, and its
 * rays more by the file's. */
static void add_part(abbe_tracer *t, const char *numbers, const abbe_pass_counts *all) {
  abbe_pass_counts c, present;
  memcpy(&c, numbers, sizeof c);
  abbe_pass_counts_get(t, &present);
  abbe_pass_counts_set(t, &(abbe_pass_counts){.first = all->first,
                                              .end = all->end,
                                              .step = all->step,
                                              .whole = all->whole,
                                              .photons = present.photons + c.photons,
                                              .light_rays = present.light_rays + c.light_rays,
                                              .eye_rays = present.eye_rays + c.eye_rays,
                                              .cuts = present.cuts + c.cuts});
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS];
  abbe_pass_sums_spans(t, span);
  const char *at = numbers + sizeof c;
  for (int k = 0; k < ABBE_PASS_SUMS_PARTS; k++)
    for (size_t i = 0; i < span[k].count; i++, at += sizeof(abbe_whole_sum)) {
      abbe_whole_sum more;
      memcpy(&more, at, sizeof more);
      span[k].sum[i] += more;
    }
}

abbe_result abbe_checkpoint_load(abbe_tracer *t, const char *path, abbe_error *error) {
  char *data = NULL;
  size_t numbers = 0;
  abbe_pass_counts c;
  ABBE_TRY(read_head(t, path, &c, error));
  ABBE_TRY(read_whole(t, path, &data, &numbers, error));
  abbe_pass_sums_clear(t);
  memcpy(&c, data + numbers, sizeof c);
  add_part(t, data + numbers, &c);
  free(data);
  return ABBE_OK;
}

/* ---- parts ---- */

/* Who has which pass: the number of a part, from 1 on; 0: nobody. */
typedef struct parts {
  const char *const *path;
  abbe_pass_counts *counts; /* counts of each */
  uint32_t *owner;          /* [ABBE_WHOLE_SUM_MOST_PASSES] */
  size_t end;               /* behind the last pass that somebody has */
  size_t whole;             /* passes that there are to be, */
  const char *teller;       /* by whose word; NULL: it is requested */
  size_t passes;            /* that there are */
} parts;

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

/* Claims the passes of a part as its own. */
static abbe_result own(parts *p, size_t part, abbe_error *error) {
  const abbe_pass_counts *c = &p->counts[part];
  char text[64];
  for (size_t i = (size_t)c->first; i < c->end; i += (size_t)c->step) {
    const uint32_t other = p->owner[i];
    p->owner[i] = (uint32_t)part + 1;
    if (i >= p->end) p->end = i + 1;
    if (other == 0) continue;
    size_t last = i;
    while (last + c->step < c->end && p->owner[last + c->step] == other) last += (size_t)c->step;
    const bool all = c->step == 1 || last == i;
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT, "%s and %s both hold %s%s", p->path[other - 1], p->path[part],
        passes_text(i, all ? last : i, text, sizeof text), all ? "" : " and others");
  }
  return ABBE_OK;
}

/* Passes from and to are missing, of the p->whole that there are to be. */
static void say_gap(const parts *p, size_t from, size_t to, char *out, size_t size) {
  char text[64];
  const char *next = to + 1 < p->end ? p->path[p->owner[to + 1] - 1] : NULL;
  passes_text(from, to, text, sizeof text);
  if (next == NULL)
    snprintf(out, size, "%s %s missing: there are to be %zu, as %s%s", text, be(from, to), p->whole,
             p->teller != NULL ? p->teller : "is asked for", p->teller != NULL ? " says" : "");
  else if (from == 0)
    snprintf(out, size, "%s %s missing: the first part that is there begins with pass %zu, in %s",
             text, be(from, to), to + 1, next);
  else
    snprintf(out, size, "%s %s missing, between %s and %s", text, be(from, to),
             p->path[p->owner[from - 1] - 1], next);
}

/* Counts the passes that are there, and says the first that are not, and how many are not. */
static void find_gap(parts *p, char *out, size_t size) {
  size_t from = p->whole, to = p->whole;
  for (size_t i = 0; i < p->whole; i++) {
    p->passes += p->owner[i] > 0;
    if (p->owner[i] == 0 && from == p->whole) from = to = i;
    if (p->owner[i] == 0 && i == to + 1) to = i;
  }
  if (from < p->whole) say_gap(p, from, to, out, size);
  const size_t said = strlen(out), missing = p->whole - p->passes;
  if (missing > to - from + 1)
    snprintf(out + said, size - said, "; in all %zu of %zu are missing", missing, p->whole);
}

static abbe_result find_parts(const abbe_tracer *t, parts *p, size_t count, abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    abbe_pass_counts *c = &p->counts[i];
    ABBE_TRY(read_head(t, p->path[i], c, error));
    if (!abbe_pass_counts_hold(c) || c->first == c->end)
      return abbe_error_set(error, ABBE_PARSE, "%s is cut off or holds no pass: trace it anew",
                            p->path[i]);
    ABBE_TRY(own(p, i, error));
    if (c->whole > p->whole) {
      p->whole = (size_t)c->whole;
      p->teller = p->path[i];
    }
  }
  if (p->end > p->whole) p->whole = p->end;
  return ABBE_OK;
}

/* A part whose trace goes on elsewhere may have been written anew since its head was read. */
static abbe_result add_parts(abbe_tracer *t, const parts *p, size_t count, abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    const abbe_pass_counts all = {.end = p->passes, .step = 1, .whole = p->whole};
    char *data = NULL;
    size_t numbers = 0;
    abbe_result result = read_whole(t, p->path[i], &data, &numbers, error);
    if (result != ABBE_OK) return result;
    if (memcmp(data + numbers, &p->counts[i], sizeof *p->counts) == 0)
      add_part(t, data + numbers, &all);
    else
      result =
          abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                         "%s was written while it was read: wait for its trace to end", p->path[i]);
    free(data);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

abbe_result abbe_checkpoint_merge(abbe_tracer *t, const char *const *path, size_t count,
                                  abbe_checkpoint_merging *how, abbe_error *error) {
  if (count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there are no parts to merge");
  char lacks[sizeof how->lacks] = "";
  parts p = {.path = path,
             .whole = how != NULL ? how->whole : 0,
             .counts = calloc(count, sizeof *p.counts),
             .owner = calloc(ABBE_WHOLE_SUM_MOST_PASSES, sizeof *p.owner)};
  abbe_result result =
      p.counts != NULL && p.owner != NULL
          ? find_parts(t, &p, count, error)
          : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu parts", count);
  if (result == ABBE_OK) find_gap(&p, lacks, sizeof lacks);
  if (how != NULL) memcpy(how->lacks, lacks, sizeof lacks);
  if (lacks[0] != '\0' && !(how != NULL && how->incomplete))
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s; trace them, or take what is there with --incomplete", lacks);
  if (result == ABBE_OK) {
    abbe_pass_sums_clear(t);
    result = add_parts(t, &p, count, error);
    if (result != ABBE_OK) abbe_pass_sums_clear(t);
  }
  free(p.counts);
  free(p.owner);
  return result;
}
