#include "colorimetry/image/exr.h"

#include "base/number.h"
#include "colorimetry/image/exr_parts.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static _Thread_local bool starved;

static void *allocate(size_t size) {
  void *memory = malloc(size);
  if (memory == NULL) starved = true;
  return memory;
}

void abbe_exr_allocate_by(exr_context_initializer_t *setup) {
  setup->alloc_fn = allocate;
  setup->free_fn = free;
  starved = false;
}

bool abbe_exr_starved(void) {
  const bool was = starved;
  starved = false;
  return was;
}

int64_t abbe_exr_width(exr_attr_box2i_t window) {
  return (int64_t)window.max.x - window.min.x + 1;
}

int64_t abbe_exr_height(exr_attr_box2i_t window) {
  return (int64_t)window.max.y - window.min.y + 1;
}

abbe_result abbe_exr_fail(const abbe_exr_stream *s, exr_result_t rv, abbe_error *error) {
  const char *reason = s->io_errno != 0 ? strerror(s->io_errno)
                       : s->message[0]  ? s->message
                                        : exr_get_default_error_message(rv);
  abbe_result code = s->io_errno != 0                        ? ABBE_IO
                     : rv == EXR_ERR_OUT_OF_MEMORY           ? ABBE_NO_MEMORY
                     : rv == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? ABBE_UNSUPPORTED
                                                             : ABBE_PARSE;
  return abbe_error_set(error, code, "%s: it cannot be read as OpenEXR: %s", s->path, reason);
}

/* ---- codecs ---- */

/* By the header's number: its name; the version of OpenEXR whose C library decodes it, 3.1.8 being
 * 30108; and how many bytes of floats one of the file's can hold at the most. Deflate packs 1032 to
 * 1, the others of its kind less, and halves become floats; what packs by frequencies has no such
 * bound. */
typedef struct codec {
  const char *name;
  int version;
  double best;
} codec;

enum { NO_VERSION = INT32_MAX };

static codec codec_of(int number) {
  enum { HTJ2K = 10, HTJ2K_32 = 11, PACKS = 4096 };
  switch (number) {
  case EXR_COMPRESSION_DWAA:
    return (codec){"DWAA", 30108, INFINITY};
  case EXR_COMPRESSION_DWAB:
    return (codec){"DWAB", 30108, INFINITY};
  case HTJ2K:
  case HTJ2K_32:
    return (codec){"HTJ2K", 30400, INFINITY};
  default:
    return (codec){"an unknown", number > HTJ2K_32 ? NO_VERSION : 0, PACKS};
  }
}

/* The codec's number in the part's header; -1 where none is found. */
static int find_codec(const abbe_exr_stream *s, int part) {
  static const char key[] = "compression\0compression\0\1\0\0"; /* and the size's last byte, 0 */
  enum { HEAD = 1 << 17, STEP = 1 << 12 }; /* a thousand channels and the attributes before */
  unsigned char head[STEP + sizeof key + 1];
  for (off_t from = 0; from < HEAD; from += STEP) {
    const ssize_t size = pread(s->fd, head, sizeof head, from);
    for (ssize_t i = 0; i < STEP && i + (ssize_t)sizeof key < size; i++)
      if (memcmp(head + i, key, sizeof key) == 0 && part-- == 0)
        return head[i + (ssize_t)sizeof key];
  }
  return -1;
}

/* The library may take a codec that is younger than itself for ZIP. */
static abbe_result check_codec(const abbe_exr_stream *s, int number, abbe_error *error) {
  const codec c = codec_of(number);
  int major = 0, minor = 0, patch = 0;
  const char *extra = NULL;
  exr_get_library_version(&major, &minor, &patch, &extra);
  if (major * 10000 + minor * 100 + patch >= c.version) return ABBE_OK;
  if (c.version == NO_VERSION)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: %s compression (number %d) cannot be read; ZIP and PIZ can", s->path,
                          c.name, number);
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "%s: %s compression is read with OpenEXR %d.%d.%d or later, and this one is "
      "%d.%d.%d; ZIP and PIZ can be read",
      s->path, c.name, c.version / 10000, c.version / 100 % 100, c.version % 100, major, minor,
      patch);
}

/* What the file is by its first bytes; NULL where they are none of these. */
static const char *other_kind(const abbe_exr_stream *s) {
  static const struct {
    const char *first, *name;
  } kinds[] = {{"PF", "a PFM"},      {"Pf", "a PFM"},        {"P5", "a PGM"},   {"P6", "a PPM"},
               {"\x89PNG", "a PNG"}, {"\xff\xd8", "a JPEG"}, {"II*", "a TIFF"}, {"MM", "a TIFF"},
               {"SDPX", "a DPX"},    {"XPDS", "a DPX"},      {"GIF8", "a GIF"}, {"RIFF", "a WebP"},
               {"#?", "a Radiance"}};
  char head[4] = {0};
  if (pread(s->fd, head, sizeof head, 0) != sizeof head) return NULL;
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (memcmp(head, kinds[i].first, strlen(kinds[i].first)) == 0) return kinds[i].name;
  return NULL;
}

abbe_result abbe_exr_fail_open(const abbe_exr_stream *s, exr_result_t rv, abbe_error *error) {
  int number = 0;
  if (rv == EXR_ERR_OUT_OF_MEMORY) return abbe_exr_fail(s, rv, error);
  const char *other = s->io_errno == 0 ? other_kind(s) : NULL;
  if (other != NULL)
    return abbe_error_set(error, ABBE_PARSE, "%s: it is %s file and not OpenEXR", s->path, other);
  for (int part = 0; s->io_errno == 0 && number >= 0; part++) {
    number = find_codec(s, part);
    ABBE_TRY(check_codec(s, number, error));
  }
  return abbe_exr_fail(s, rv, error);
}

/* ---- what can be read, and held ---- */

static abbe_result unsupported(const abbe_exr_stream *s, const char *what, abbe_error *error) {
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: %s; a flat picture, all channels at full resolution, can", s->path,
                        what);
}

static bool is_flat(exr_storage_t storage) {
  return storage == EXR_STORAGE_SCANLINE || storage == EXR_STORAGE_TILED;
}

/* OpenEXR's decoder of PIZ counts the bits of a chunk by an int. */
static abbe_result check_tiles(exr_context_t context, const abbe_exr_stream *s,
                               const abbe_exr_layout *l, abbe_error *error) {
  enum { MOST = 16384 };
  uint32_t w = 0, h = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  if (l->storage != EXR_STORAGE_TILED || l->compression != EXR_COMPRESSION_PIZ) return ABBE_OK;
  const exr_result_t rv = exr_get_tile_descriptor(context, l->part, &w, &h, &levels, &rounding);
  if (rv != 0) return abbe_exr_fail(s, rv, error);
  if (w <= MOST && h <= MOST) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: its tiles of PIZ have %u x %u pixels; up to %d a side can be read",
                        s->path, (unsigned)w, (unsigned)h, MOST);
}

static abbe_result check_channels(const abbe_exr_stream *s, const abbe_exr_layout *l, int all,
                                  abbe_error *error) {
  if (!is_flat(l->storage)) return unsupported(s, "deep data cannot be read", error);
  if (all > ABBE_IMAGE_MAX_CHANNELS)
    return abbe_error_set(error, ABBE_PARSE, "%s: it has %d channels; 1 to %d can be read", s->path,
                          all, ABBE_IMAGE_MAX_CHANNELS);
  for (int i = 0; i < l->channels->num_channels; i++)
    if (l->channels->entries[i].x_sampling != 1 || l->channels->entries[i].y_sampling != 1)
      return unsupported(s, "subsampled channels cannot be read", error);
  return ABBE_OK;
}

/* No more data than the file's bytes can hold at the codec's best, and no window that is wider than
 * a picture may be. */
static bool can_be_held(const abbe_exr_stream *s, const abbe_exr_layout *l, int channels) {
  double bytes =
      (double)abbe_exr_width(l->data) * (double)abbe_exr_height(l->data) * channels * sizeof(float);
  const exr_attr_box2i_t window[] = {l->data, l->display};
  for (int i = 0; i < 2; i++)
    if (abbe_exr_width(window[i]) < 1 || abbe_exr_width(window[i]) > ABBE_IMAGE_MAX_SIDE ||
        abbe_exr_height(window[i]) < 1 || abbe_exr_height(window[i]) > ABBE_IMAGE_MAX_SIDE)
      return false;
  return bytes <= codec_of((int)l->compression).best * (double)s->size;
}

abbe_result abbe_exr_check_layout(const abbe_exr_stream *s, const abbe_exr_layout *l, int channels,
                                  abbe_error *error) {
  ABBE_TRY(check_channels(s, l, channels, error));
  if (!can_be_held(s, l, channels))
    return abbe_error_set(
        error, ABBE_PARSE,
        "%s: its header promises %lld x %lld pixels of data, %lld x %lld to be "
        "shown and %d channels, which its %lld bytes cannot hold or which is over "
        "%d a side",
        s->path, (long long)abbe_exr_width(l->data), (long long)abbe_exr_height(l->data),
        (long long)abbe_exr_width(l->display), (long long)abbe_exr_height(l->display), channels,
        (long long)s->size, ABBE_IMAGE_MAX_SIDE);
  const exr_attr_box2i_t window[] = {l->data, l->display};
  for (int i = 0; i < 2; i++)
    ABBE_TRY(abbe_image_check_expansion(s->path, (size_t)abbe_exr_width(window[i]),
                                        (size_t)abbe_exr_height(window[i]), (size_t)channels,
                                        (size_t)s->size, ABBE_EXR_FREE_BYTES, error));
  return ABBE_OK;
}

/* ---- parts ---- */

static exr_result_t read_part(exr_context_t context, int part, abbe_exr_layout *l) {
  l->part = part;
  l->name = NULL;
  exr_get_name(context, part, &l->name); /* a file of one part may have none */
  exr_result_t rv = exr_get_storage(context, part, &l->storage);
  if (rv == 0) rv = exr_get_compression(context, part, &l->compression);
  if (rv == 0) rv = exr_get_data_window(context, part, &l->data);
  if (rv == 0) rv = exr_get_display_window(context, part, &l->display);
  if (rv == 0) rv = exr_get_channels(context, part, &l->channels);
  return rv;
}

/* 3 where it has colours, 2 where it has one channel of luminance, 1 where it is flat. */
static int picture_rank(const abbe_exr_layout *l) {
  static const char names[] = "RGBXYZ";
  unsigned found = 0;
  for (int i = 0; i < l->channels->num_channels; i++) {
    const char *name = l->channels->entries[i].name.str;
    const char *at = name[1] == '\0' ? strchr(names, name[0]) : NULL;
    if (at != NULL) found |= 1u << (at - names);
  }
  if (!is_flat(l->storage)) return 0;
  return (found & 7) == 7 || (found & 56) == 56 ? 3 : (found & 16) != 0 ? 2 : 1;
}

static bool is_wanted(const abbe_exr_layout *l, const char *part) {
  char number[16];
  snprintf(number, sizeof number, "%d", l->part + 1);
  return strcmp(part, number) == 0 || (l->name != NULL && strcmp(part, l->name) == 0);
}

static abbe_result no_such_part(exr_context_t context, const abbe_exr_stream *s, int parts,
                                abbe_error *error) {
  char list[400] = "";
  size_t used = 0;
  for (int i = 0; i < parts && used < sizeof list - 1; i++) {
    const char *name = NULL;
    exr_get_name(context, i, &name);
    const int more = snprintf(list + used, sizeof list - used, "%s%d%s%.60s%s", i == 0 ? "" : ", ",
                              i + 1, name ? " '" : "", name ? name : "", name ? "'" : "");
    used += (size_t)more;
  }
  return abbe_error_set(error, ABBE_NOT_FOUND, "%s: it has no part '%.60s'; there %s %s", s->path,
                        s->part, parts == 1 ? "is" : "are", list);
}

abbe_result abbe_exr_layout_find(exr_context_t context, const abbe_exr_stream *s,
                                 abbe_exr_layout *out, abbe_error *error) {
  abbe_exr_layout l = {0};
  int best = -1;
  exr_result_t rv = exr_get_count(context, &l.parts);
  for (int i = 0; rv == 0 && i < l.parts; i++) {
    rv = read_part(context, i, &l);
    if (rv != 0) break;
    const int rank = s->part == NULL ? picture_rank(&l) : is_wanted(&l, s->part) ? 1 : -1;
    if (rank <= best) continue;
    best = rank;
    *out = l;
  }
  if (rv != 0) return abbe_exr_fail(s, rv, error);
  if (best < 0) return no_such_part(context, s, l.parts, error);
  ABBE_TRY(check_codec(s, find_codec(s, out->part), error));
  ABBE_TRY(check_tiles(context, s, out, error));
  return abbe_exr_check_layout(s, out, out->channels->num_channels, error);
}

static const char *part_text(exr_context_t context, int part, const char *name) {
  const exr_attribute_t *a = NULL;
  if (exr_get_attribute_by_name(context, part, name, &a) != 0) return NULL;
  return a->type == EXR_ATTR_STRING ? a->string->str : NULL;
}

static bool shares_a_channel(const exr_attr_chlist_t *a, const exr_attr_chlist_t *b) {
  for (int i = 0; i < a->num_channels; i++)
    for (int k = 0; k < b->num_channels; k++)
      if (strcmp(a->entries[i].name.str, b->entries[k].name.str) == 0) return true;
  return false;
}

abbe_result abbe_exr_find_data(exr_context_t context, const abbe_exr_stream *s,
                               const abbe_exr_layout *picture, abbe_exr_layout *out, size_t *parts,
                               abbe_error *error) {
  abbe_exr_layout l = {.parts = picture->parts};
  if (picture->storage != EXR_STORAGE_SCANLINE) return ABBE_OK;
  for (int i = 0; i < l.parts; i++) {
    const char *id = part_text(context, i, ABBE_EXR_ID_NAME);
    if (i == picture->part || id == NULL || strcmp(id, "data") != 0) continue;
    const exr_result_t rv = read_part(context, i, &l);
    if (rv != 0) return abbe_exr_fail(s, rv, error);
    if (l.storage != picture->storage || l.compression != picture->compression ||
        memcmp(&l.data, &picture->data, sizeof l.data) != 0 ||
        shares_a_channel(l.channels, picture->channels))
      continue;
    *out = l;
    *parts = 2;
    break;
  }
  return ABBE_OK;
}

/* A power of two; *unit stays what it is where the text is none. */
static bool read_unit(const char *text, double *unit) {
  const char *end;
  int exponent;
  double value;
  if (!abbe_number_read(text, &end, &value) || *end != '\0' || !isfinite(value) ||
      frexp(value, &exponent) != 0.5)
    return false;
  *unit = value;
  return true;
}

abbe_result abbe_exr_unit_read(exr_context_t context, int part, const abbe_exr_stream *s,
                               double *unit, abbe_error *error) {
  const char *text = part_text(context, part, ABBE_EXR_UNIT_NAME);
  *unit = 1;
  if (text == NULL || read_unit(text, unit)) return ABBE_OK;
  return abbe_error_set(error, ABBE_PARSE, "%s: %s is '%.40s'; a power of two is right", s->path,
                        ABBE_EXR_UNIT_NAME, text);
}

/* The layout of Ocean: CHANNEL.wavelength is what light the channel has, in metres or as a text
 * with m or nm. It is called as its wavelength is in the spectral layout; where the text says
 * anything else, it keeps its name. */
static abbe_result name_band(const exr_attribute_t *a, const abbe_exr_stream *s, abbe_image *image,
                             abbe_error *error) {
  const char *dot = strrchr(a->name, '.');
  double metres = NAN;
  char name[64], digits[32];
  const char *end = "";
  if (dot == NULL || strcmp(dot, ".wavelength") != 0) return ABBE_OK;
  size_t c = 0;
  while (c < image->channels && (strlen(image->channel[c]) != (size_t)(dot - a->name) ||
                                 memcmp(image->channel[c], a->name, (size_t)(dot - a->name)) != 0))
    c++;
  if (c == image->channels) return ABBE_OK;
  if (a->type == EXR_ATTR_FLOAT) metres = (double)a->f;
  if (a->type == EXR_ATTR_DOUBLE) metres = a->d;
  if (a->type == EXR_ATTR_STRING) {
    if (!abbe_number_read(a->string->str, &end, &metres)) return ABBE_OK;
    end += strspn(end, " ");
    if (strcmp(end, "nm") == 0) metres *= 1e-9;
    if (strcmp(end, "nm") != 0 && strcmp(end, "m") != 0 && *end != '\0') return ABBE_OK;
  }
  if (!(metres > 1e-12 && metres < 1))
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: its attribute %s is no wavelength in metres, such as 5.5e-7",
                          s->path, a->name);
  abbe_number_format(digits, sizeof digits, "%.6g", 1e9 * metres); /* what a float has */
  abbe_number_read(digits, &end, &metres);
  abbe_image_band_name(metres, name, sizeof name);
  char *text = strdup(name);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", s->path);
  free(image->channel[c]);
  image->channel[c] = text;
  return ABBE_OK;
}

/* Texts that are the file's, not the picture's. */
static bool is_own(const char *name) {
  return strcmp(name, ABBE_EXR_STORAGE_NAME) == 0 || strcmp(name, ABBE_EXR_UNIT_NAME) == 0 ||
         strcmp(name, "name") == 0;
}

abbe_result abbe_exr_attributes_read(exr_context_t context, int part, const abbe_exr_stream *s,
                                     abbe_image *image, abbe_error *error) {
  int32_t count = 0;
  bool aces = false;
  exr_result_t rv = exr_get_attribute_count(context, part, &count);
  for (int32_t i = 0; rv == 0 && i < count; i++) {
    const exr_attribute_t *a = NULL;
    rv = exr_get_attribute_by_index(context, part, EXR_ATTR_LIST_FILE_ORDER, i, &a);
    if (rv != 0) break;
    if (a->type == EXR_ATTR_CHROMATICITIES && strcmp(a->name, "chromaticities") == 0) {
      const exr_attr_chromaticities_t *c = a->chromaticities;
      const double xy[8] = {c->red_x,  c->red_y,  c->green_x, c->green_y,
                            c->blue_x, c->blue_y, c->white_x, c->white_y};
      memcpy(image->xy, xy, sizeof xy);
    }
    if (a->type == EXR_ATTR_INT && strcmp(a->name, "acesImageContainerFlag") == 0) aces = a->i == 1;
    ABBE_TRY(name_band(a, s, image, error));
    if (a->type != EXR_ATTR_STRING || is_own(a->name)) continue;
    if (image->attribute_count == ABBE_IMAGE_MAX_ATTRIBUTES)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: it has more than %d text attributes, which is as many as can be "
                            "read",
                            s->path, ABBE_IMAGE_MAX_ATTRIBUTES);
    ABBE_TRY(abbe_image_set_attribute(image, a->name, a->string->str, error));
  }
  if (rv != 0) return abbe_exr_fail(s, rv, error);
  if (!aces) return ABBE_OK;
  /* An ACES container has AP0, whatever else the file says [ColorInterop2026]. */
  memset(image->xy, 0, sizeof image->xy);
  return abbe_image_set_attribute(image, ABBE_EXR_ID_NAME, "lin_ap0_scene", error);
}
