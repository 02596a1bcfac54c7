#include "cli/view/inspect/inspect.h"

#include "base/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Kinds of packets, by the protocol's numbers. */
enum { OPEN, RELOAD, CLOSE, UPDATE, CREATE, UPDATE_2, UPDATE_3, OPEN_2, VECTORS, KINDS };
enum { LONGEST_NAME = 4096 };
#define MOST_BYTES ((size_t)1 << 30) /* of all pictures that were created */

typedef struct packet {
  int kind;
  bool focus;
  const char *name;
  char path[LONGEST_NAME + 1]; /* of a file, without the selector that the first version has */
  int32_t x, y, width, height;
  size_t channels, count;
  const char *channel[ABBE_IMAGE_MAX_CHANNELS];
  uint64_t offset[ABBE_IMAGE_MAX_CHANNELS], stride[ABBE_IMAGE_MAX_CHANNELS];
  const unsigned char *numbers; /* count floats */
} packet;

/* ---- bytes, the least first ---- */

typedef struct reader {
  const unsigned char *at;
  size_t left;
  bool short_of; /* more was wanted than there is */
} reader;

static uint64_t take(reader *r, size_t bytes) {
  uint64_t value = 0;
  r->short_of = r->short_of || r->left < bytes;
  if (r->short_of) return 0;
  for (size_t i = 0; i < bytes; i++) value |= (uint64_t)r->at[i] << 8 * i;
  r->at += bytes;
  r->left -= bytes;
  return value;
}

static const char *take_text(reader *r) {
  const char *text = (const char *)r->at;
  const size_t length = strnlen(text, r->left);
  r->short_of = r->short_of || length == r->left || length > LONGEST_NAME;
  if (r->short_of) return "";
  r->at += length + 1;
  r->left -= length + 1;
  return text;
}

static bool take_channels(reader *r, packet *p) {
  const bool one = p->kind == UPDATE; /* the first version knows no more */
  p->channels = one ? 1 : (size_t)take(r, 4);
  if (p->channels < 1 || p->channels > ABBE_IMAGE_MAX_CHANNELS) return false;
  for (size_t c = 0; c < p->channels; c++) {
    p->channel[c] = take_text(r);
    if (p->channel[c][0] == '\0') return false;
  }
  return true;
}

static bool take_size(reader *r, packet *p) {
  p->width = (int32_t)take(r, 4);
  p->height = (int32_t)take(r, 4);
  return p->width >= 1 && p->height >= 1 && p->width <= ABBE_IMAGE_MAX_SIDE &&
         p->height <= ABBE_IMAGE_MAX_SIDE;
}

/* Where each channel's numbers lie: one channel behind the other, or as the packet says. */
static bool take_numbers(reader *r, packet *p) {
  const uint64_t pixels = (uint64_t)p->width * (uint64_t)p->height;
  for (size_t c = 0; c < p->channels; c++)
    p->offset[c] = p->kind == UPDATE_3 ? take(r, 8) : c * pixels;
  for (size_t c = 0; c < p->channels; c++) p->stride[c] = p->kind == UPDATE_3 ? take(r, 8) : 1;
  p->numbers = r->at;
  p->count = r->left / 4;
  for (size_t c = 0; c < p->channels; c++)
    if (p->offset[c] >= p->count || p->stride[c] > p->count ||
        p->offset[c] + (pixels - 1) * p->stride[c] >= p->count)
      return false;
  return !r->short_of;
}

/* What is wrong with it; NULL: nothing. */
static const char *parse(const unsigned char *bytes, size_t size, packet *p) {
  reader r = {.at = bytes, .left = size};
  if (take(&r, 4) != size) return "its length is another";
  p->kind = (int)take(&r, 1);
  if (p->kind >= KINDS) return "its kind is not known";
  if (p->kind != CLOSE) p->focus = take(&r, 1) == 1;
  p->name = take_text(&r);
  if (r.short_of || p->name[0] == '\0') return "it has no name";
  if (p->kind == CREATE && !take_size(&r, p)) return "its size is none";
  const bool updates = p->kind == UPDATE || p->kind == UPDATE_2 || p->kind == UPDATE_3;
  if ((updates || p->kind == CREATE) && (!take_channels(&r, p) || r.short_of))
    return "its channels are none";
  if (!updates) return NULL;
  p->x = (int32_t)take(&r, 4);
  p->y = (int32_t)take(&r, 4);
  if (!take_size(&r, p)) return "its size is none";
  return take_numbers(&r, p) ? NULL : "it has too few numbers";
}

/* ---- pictures ---- */

static size_t find(const abbe_inspect *s, const char *name) {
  size_t i = 0;
  while (i < s->count && strcmp(s->picture[i].path, name) != 0) i++;
  return i;
}

/* Whether another picture can be made that then takes the place of an old one; where there is no
 * room for both the old one is closed. */
static bool begin_again(abbe_inspect *s, size_t old) {
  const bool full = s->count == ABBE_INSPECT_MOST_PICTURES, is_there = old < s->count;
  if (is_there && full) abbe_inspect_close(s, old);
  return is_there && !full;
}

static abbe_result create(abbe_inspect *s, const packet *p, abbe_error *error) {
  const size_t width = (size_t)p->width, height = (size_t)p->height;
  const size_t old = find(s, p->name);
  double bytes = (double)width * (double)height * (double)p->channels * sizeof(float);
  for (size_t i = 0; i < s->count; i++)
    if (s->picture[i].sent && i != old)
      bytes += (double)(s->picture[i].width * s->picture[i].height) *
               (double)s->picture[i].image.channels * sizeof(float);
  if (bytes > (double)MOST_BYTES)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "%s: with this picture of %zu x %zu and %zu channels those that were "
                          "sent would have %.0f MiB; %zu are the most",
                          p->name, width, height, p->channels, bytes / (1 << 20), MOST_BYTES >> 20);
  const bool again = begin_again(s, old);
  ABBE_TRY(abbe_inspect_create(s, p->name, (const size_t[3]){width, height, p->channels},
                               p->channel, error));
  if (again) abbe_inspect_replace(s, old);
  return ABBE_OK;
}

static abbe_result open_file(abbe_inspect *s, packet *p, abbe_error *error) {
  snprintf(p->path, sizeof p->path, "%s", p->name);
  char *colon = p->kind == OPEN && access(p->path, F_OK) != 0 ? strrchr(p->path, ':') : NULL;
  if (colon != NULL) *colon = '\0';
  p->name = p->path;
  return find(s, p->path) < s->count ? ABBE_OK : abbe_inspect_open(s, p->path, error);
}

static abbe_result reload(abbe_inspect *s, const packet *p, abbe_error *error) {
  const size_t old = find(s, p->name);
  if (old == s->count || s->picture[old].sent) return ABBE_OK;
  const bool again = begin_again(s, old);
  ABBE_TRY(abbe_inspect_open(s, p->name, error));
  if (again) abbe_inspect_replace(s, old);
  return ABBE_OK;
}

/* Bands that are named in another way are called as the layout has them. */
static size_t find_channel(const abbe_inspect_picture *p, const char *name) {
  char own[64];
  const size_t channel = abbe_image_find_channel(&p->image, name);
  if (channel != (size_t)-1 || !p->renamed) return channel;
  snprintf(own, sizeof own, "S0.%.40s", name + strcspn(name, "0123456789"));
  return abbe_image_find_channel(&p->image, own);
}

static abbe_result update(abbe_inspect *s, const packet *p, abbe_error *error) {
  const size_t at = find(s, p->name);
  abbe_inspect_picture *to = &s->picture[at];
  bool whole;
  if (at == s->count)
    return abbe_error_set(error, ABBE_NOT_FOUND, "%s: no picture of this name is there", p->name);
  /* Lines that are read later would lie over what is sent now. */
  ABBE_TRY(abbe_inspect_read_on(s, INFINITY, &whole, error));
  const int64_t x1 = (int64_t)p->x + p->width, y1 = (int64_t)p->y + p->height;
  if (to->coarse > 0 || p->x < 0 || p->y < 0 || x1 > (int64_t)to->width || y1 > (int64_t)to->height)
    return abbe_error_set(
        error, ABBE_OUT_OF_RANGE, "%s: %d x %d pixels from %d, %d on are not in its %zu x %zu",
        p->name, (int)p->width, (int)p->height, (int)p->x, (int)p->y, to->width, to->height);
  for (size_t c = 0; c < p->channels; c++) {
    const size_t channel = find_channel(to, p->channel[c]);
    if (channel == (size_t)-1)
      return abbe_error_set(error, ABBE_NOT_FOUND, "%s: it has no channel '%.60s'", p->name,
                            p->channel[c]);
    for (int32_t y = 0; y < p->height; y++)
      for (int32_t x = 0; x < p->width; x++) {
        const uint64_t pixel = (uint64_t)y * (uint64_t)p->width + (uint64_t)x;
        reader number = {.at = p->numbers + 4 * (p->offset[c] + pixel * p->stride[c]), .left = 4};
        const uint32_t bits = (uint32_t)take(&number, 4);
        float value;
        memcpy(&value, &bits, sizeof value);
        to->image.data[((size_t)(p->y + y) * to->width + (size_t)(p->x + x)) * to->image.channels +
                       channel] = value;
        if (isfinite(value)) to->most = fmax(to->most, fabs((double)value));
      }
  }
  abbe_inspect_touch(s, at,
                     (const size_t[4]){(size_t)p->x, (size_t)p->y, (size_t)x1 - 1, (size_t)y1 - 1});
  return ABBE_OK;
}

abbe_result abbe_inspect_take_packet(abbe_inspect *s, const unsigned char *bytes, size_t size,
                                     size_t *focus, abbe_error *error) {
  packet p = {.kind = KINDS};
  const char *wrong = parse(bytes, size, &p);
  if (wrong != NULL)
    return abbe_error_set(error, ABBE_PARSE, "a packet of kind %d and %zu bytes is refused: %s",
                          p.kind, size, wrong);
  if (s == NULL) return ABBE_OK;
  const size_t old = find(s, p.name);
  abbe_result result = ABBE_OK;
  if (p.kind == CLOSE && old < s->count) abbe_inspect_close(s, old);
  if (p.kind == CREATE) result = create(s, &p, error);
  if (p.kind == OPEN || p.kind == OPEN_2) result = open_file(s, &p, error);
  if (p.kind == RELOAD) result = reload(s, &p, error);
  if (p.kind == UPDATE || p.kind == UPDATE_2 || p.kind == UPDATE_3) result = update(s, &p, error);
  if (p.kind == VECTORS)
    result = abbe_error_set(error, ABBE_UNSUPPORTED, "%s: drawings over it are not shown", p.name);
  const size_t at = find(s, p.name);
  if (result == ABBE_OK && p.focus && at < s->count) *focus = at;
  return result;
}
