#include "validation/lab/volume_sums.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/maths.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Sums of a pass of unit irradiance: to 2^-33 of it. */
static const double most = 0x1p28;

static void weigh(abbe_volume_sums *s, const float *share, const double beam[3]) {
  for (size_t i = 0; i < s->region->cells; i++) {
    const double part = share != NULL && !s->printed ? (double)share[i] : 1;
    const double size = s->printed ? abbe_volume_region_across(s->region, i, beam)
                                   : part * abbe_volume_region_volume(s->region, i);
    s->weight[i] = part < (double)ABBE_VOLUME_SUMS_LEAST_SPACE ? 0 : 1 / size;
  }
}

abbe_result abbe_volume_sums_make(const abbe_volume_region *region, bool printed,
                                  const float *share, const double beam[3], size_t threads,
                                  abbe_volume_sums *out, abbe_error *error) {
  *out = (abbe_volume_sums){.region = region, .printed = printed, .channels = printed ? 3 : 9};
  ABBE_TRY(abbe_accumulator_make(region->cells * out->channels, threads, most, &out->sums, error));
  out->weight = malloc(region->cells * sizeof *out->weight);
  out->piece = malloc(threads * ABBE_REGION_MOST_PIECES * sizeof *out->piece);
  if (out->weight == NULL || out->piece == NULL) {
    abbe_volume_sums_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sums of %zu cells",
                          region->cells);
  }
  weigh(out, share, beam);
  return ABBE_OK;
}

void abbe_volume_sums_free(abbe_volume_sums *s) {
  if (s == NULL) return;
  abbe_accumulator_free(&s->sums);
  free(s->weight);
  free(s->piece);
  *s = (abbe_volume_sums){0};
}

/* Whether the cell of piece i is new to the ray. */
static bool is_new(const abbe_region_piece *piece, size_t i) {
  for (size_t k = i; k-- > 0;)
    if (piece[k].cell == piece[i].cell) return false;
  return true;
}

static void add_printed(abbe_volume_sums *s, size_t thread, const abbe_region_piece *piece,
                        size_t count, const double d[3], const float flux[3]) {
  for (size_t i = 0; i < count; i++) {
    double p[3];
    if (!is_new(piece, i)) continue;
    abbe_volume_region_middle(s->region, piece[i].cell, p);
    const double away = abbe_vector_dot(p, d) / abbe_vector_length(p);
    if (!(away > 0)) continue; /* it comes from behind */
    const double weight = away * s->weight[piece[i].cell];
    for (size_t c = 0; c < 3; c++)
      abbe_accumulator_add(&s->sums, thread, 3 * piece[i].cell + c,
                           (float)(weight * (double)flux[c]));
  }
}

void abbe_volume_sums_add(abbe_volume_sums *s, size_t thread, const double o[3], const double d[3],
                          double length, const float flux[3]) {
  abbe_region_piece *piece = s->piece + thread * ABBE_REGION_MOST_PIECES;
  const size_t count = abbe_volume_region_walk(s->region, o, d, length, piece);
  if (s->printed) {
    add_printed(s, thread, piece, count, d, flux);
    return;
  }
  for (size_t i = 0; i < count; i++) {
    const double weight = piece[i].length * s->weight[piece[i].cell];
    for (size_t c = 0; c < 9; c++)
      abbe_accumulator_add(&s->sums, thread, 9 * piece[i].cell + c,
                           (float)(weight * (double)flux[c / 3] * d[c % 3]));
  }
}

double abbe_volume_sums_mean(const abbe_volume_sums *s, size_t cell, size_t channel) {
  return abbe_accumulator_mean(&s->sums, cell * s->channels + channel);
}

double abbe_volume_sums_error(const abbe_volume_sums *s, size_t cell, size_t channel) {
  return abbe_accumulator_error(&s->sums, cell * s->channels + channel);
}

double abbe_volume_sums_relative_error(const abbe_volume_sums *s) {
  const size_t first = s->printed ? 1 : 3, count = s->printed ? 1 : 3;
  double values = 0, errors = 0;
  for (size_t i = 0; i < s->region->cells; i++)
    for (size_t c = first; c < first + count; c++) {
      values += pow(abbe_volume_sums_mean(s, i, c), 2);
      errors += pow(abbe_volume_sums_error(s, i, c), 2);
    }
  return values > 0 ? sqrt(errors / values) : 0;
}

double abbe_volume_sums_outflow(const abbe_volume_sums *s, size_t shell) {
  const abbe_volume_region *r = s->region;
  double sum = 0;
  for (size_t i = shell * r->row; i < (shell + 1) * r->row; i++) {
    double p[3];
    abbe_volume_region_middle(r, i, p);
    const double radius = abbe_vector_length(p);
    /* the mean over the shell's thickness of the flux through a sphere */
    const double area = abbe_volume_region_volume(r, i) / (r->radius[shell + 1] - r->radius[shell]);
    for (size_t k = 0; k < 3; k++) sum += area * p[k] / radius * abbe_volume_sums_mean(s, i, 3 + k);
  }
  return sum;
}

/* File: magic, key, nodes, the parts as the machine keeps them, and a hash of all before it. */
static const char magic[16] = "abbe volume 1\n";
enum { HEAD = sizeof magic + 2 * sizeof(uint64_t), TAIL = sizeof(uint64_t) };

uint64_t abbe_volume_key(uint64_t h, const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) h = (h ^ p[i]) * 1099511628211u;
  return h;
}

abbe_result abbe_volume_checkpoint_save(const char *path, uint64_t key, uint64_t nodes,
                                        const abbe_kept_bytes *part, size_t parts,
                                        abbe_error *error) {
  unsigned char head[HEAD];
  abbe_file_writer writer = {0};
  memcpy(head, magic, sizeof magic);
  memcpy(head + sizeof magic, &key, sizeof key);
  memcpy(head + sizeof magic + sizeof key, &nodes, sizeof nodes);
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  uint64_t h = abbe_volume_key(ABBE_VOLUME_KEY, head, HEAD);
  fwrite(head, 1, HEAD, writer.stream); /* a short write shows in ferror */
  for (size_t i = 0; i < parts; i++) {
    h = abbe_volume_key(h, part[i].data, part[i].size);
    fwrite(part[i].data, 1, part[i].size, writer.stream);
  }
  fwrite(&h, sizeof h, 1, writer.stream);
  return abbe_file_writer_commit(&writer, error);
}

static abbe_result another(const char *path, abbe_error *error) {
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: it belongs to another object or request, or to another kind of "
                        "processor: start anew without --resume",
                        path);
}

static abbe_result broken(const char *path, abbe_error *error) {
  return abbe_error_set(error, ABBE_PARSE, "%s: it is no checkpoint of a volume, or cut off", path);
}

/* What the file begins with, before all of it is read: one of another request may be much larger
 * than `longest`, this one's. */
static abbe_result read_head(const char *path, size_t longest, abbe_error *error) {
  char head[sizeof magic] = "";
  size_t size = 0;
  FILE *file;
  ABBE_TRY(abbe_file_open(path, &file, &size, error));
  const bool is = fread(head, sizeof head, 1, file) == 1 && memcmp(head, magic, sizeof magic) == 0;
  fclose(file);
  if (!is) return broken(path, error);
  return size > longest ? another(path, error) : ABBE_OK;
}

static bool is_stopped(const volatile int *stop) {
  return stop != NULL && *stop;
}

/* The hash; a megabyte at a time, for it may be long. */
static abbe_result hash_all(const char *data, size_t size, const volatile int *stop, uint64_t *out,
                            abbe_error *error) {
  const size_t step = 1 << 20;
  *out = ABBE_VOLUME_KEY;
  for (size_t at = 0; at < size; at += step) {
    if (is_stopped(stop)) return abbe_error_set(error, ABBE_CANCELLED, "stopped");
    *out = abbe_volume_key(*out, data + at, size - at < step ? size - at : step);
  }
  return ABBE_OK;
}

abbe_result abbe_volume_checkpoint_load(const char *path, uint64_t key, uint64_t *nodes,
                                        const abbe_kept_bytes *part, size_t parts,
                                        const volatile int *stop, abbe_error *error) {
  size_t total = HEAD + TAIL, size;
  uint64_t of = 0, done = 0, sum = 0, hash = 0;
  char *data;
  for (size_t i = 0; i < parts; i++) total += part[i].size;
  abbe_result result = read_head(path, total, error);
  if (result == ABBE_OK) result = abbe_file_read(path, total, &data, &size, error);
  if (result != ABBE_OK) return result;
  if (size < HEAD + TAIL)
    result = broken(path, error);
  else
    result = hash_all(data, size - TAIL, stop, &hash, error);
  if (result == ABBE_OK) {
    memcpy(&of, data + sizeof magic, sizeof of);
    memcpy(&done, data + sizeof magic + sizeof of, sizeof done);
    memcpy(&sum, data + size - TAIL, sizeof sum);
    if (sum != hash || memcmp(data, magic, sizeof magic) != 0)
      result = broken(path, error);
    else if (of != key || size != total)
      result = another(path, error);
  }
  size_t at = HEAD;
  for (size_t i = 0; result == ABBE_OK && i < parts; at += part[i++].size)
    if (part[i].size > 0) memcpy(part[i].data, data + at, part[i].size);
  if (result == ABBE_OK) *nodes = done;
  free(data);
  return result;
}

abbe_result abbe_volume_keeping_begin(abbe_volume_keeping *k, size_t *node, abbe_error *error) {
  uint64_t nodes = 0;
  *node = 0;
  k->saved_s = abbe_clock_seconds();
  if (k->path == NULL || !k->resume || access(k->path, F_OK) != 0) return ABBE_OK;
  ABBE_TRY(abbe_volume_checkpoint_load(k->path, k->key, &nodes, k->part, k->parts, k->stop, error));
  if (nodes > k->nodes || !k->holds(k->user, (size_t)nodes))
    return abbe_error_set(error, ABBE_PARSE, "%s is damaged: start anew without --resume", k->path);
  *node = (size_t)nodes;
  return ABBE_OK;
}

abbe_result abbe_volume_keeping_end_node(abbe_volume_keeping *k, size_t nodes, bool now,
                                         abbe_error *error) {
  if (k->path == NULL || (!now && abbe_clock_seconds() < k->saved_s + k->every_s)) return ABBE_OK;
  ABBE_TRY(abbe_volume_checkpoint_save(k->path, k->key, nodes, k->part, k->parts, error));
  k->saved_s = abbe_clock_seconds();
  return ABBE_OK;
}
