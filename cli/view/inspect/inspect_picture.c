#include "cli/view/inspect/inspect.h"

#include "base/file.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/screen/screen_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const size_t absent = (size_t)-1;

/* ---- reading ---- */

/* A path's ending without the part behind it. */
static bool ends(const char *path, const char *ending) {
  const size_t length = abbe_exr_file_length(path), n = strlen(ending);
  return length >= n && strncasecmp(path + length - n, ending, n) == 0;
}

/* Numbers that are encoded for a screen become light: by what the picture states, else as sRGB. */
static void decode(abbe_image *image) {
  double xy[8], curve[5], to_xyz[9];
  abbe_rgb_encoding_srgb(xy, curve);
  if (image->xy[7] > 0) memcpy(xy, image->xy, sizeof xy);
  if (image->curve[0] > 0) memcpy(curve, image->curve, sizeof curve);
  memcpy(image->xy, xy, sizeof xy);
  abbe_rgb_space_chromaticities_to_xyz(xy, to_xyz, NULL);
  for (size_t i = 0; i < image->width * image->height; i++) {
    float *pixel = image->data + 3 * i;
    double rgb[3];
    for (int k = 0; k < 3; k++) rgb[k] = (double)pixel[k];
    if (image->transfer != 0) abbe_rgb_encoding_hdr_light(image->transfer, to_xyz + 3, rgb);
    for (int k = 0; k < 3; k++)
      pixel[k] = (float)(image->transfer != 0 ? rgb[k] : abbe_rgb_encoding_light(curve, rgb[k]));
  }
  memset(image->curve, 0, sizeof image->curve);
  image->transfer = 0;
}

/* Of a picture whose file has levels the finest that has few enough numbers; of scan lines as many
 * as have. */
static abbe_result read_exr(const char *path, size_t most, abbe_inspect_picture *p,
                            abbe_error *error) {
  abbe_exr_levels l;
  ABBE_TRY(abbe_exr_open(path, &p->reader, error));
  abbe_exr_find_levels(p->reader, &l);
  while (p->coarse + 1 < l.count &&
         (l.width >> p->coarse) * (l.height >> p->coarse) > most / l.channels)
    p->coarse++;
  p->width = l.width;
  p->height = l.height;
  if (p->coarse > 0) return abbe_exr_read_level(p->reader, p->coarse, NULL, &p->image, error);
  ABBE_TRY(abbe_exr_read_first(p->reader, most, &p->image, error));
  return abbe_exr_read_on(p->reader, 0, &p->image, &p->read, error);
}

static bool is_partly_read(const abbe_inspect_picture *p) {
  return p->reader != NULL && p->coarse == 0;
}

static void end_reading(abbe_inspect_picture *p) {
  abbe_exr_close(p->reader);
  p->reader = NULL;
}

static abbe_result read_image(const char *path, size_t most, abbe_inspect_picture *p,
                              abbe_error *error) {
  const bool png = ends(path, ".png");
  if (ends(path, ".exr")) return read_exr(path, most, p, error);
  if (ends(path, ".hdr") || ends(path, ".pic")) {
    ABBE_TRY(abbe_picture_file_read(path, &p->image, error));
  } else if (png || ends(path, ".avif")) {
    ABBE_TRY((png ? abbe_png_read : abbe_avif_read)(path, &p->image, error));
    p->encoded = true;
    decode(&p->image);
  } else {
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: pictures that can be looked at are .exr, .hdr, .pic, .png and .avif",
                          path);
  }
  p->width = p->image.width;
  p->height = p->image.height;
  return ABBE_OK;
}

abbe_result abbe_inspect_source_take(const abbe_inspect_picture *p, size_t level,
                                     const size_t window[4], abbe_inspect_source *out,
                                     abbe_error *error) {
  *out = (abbe_inspect_source){.image = &p->image, .level = p->coarse};
  if (level >= p->coarse) return ABBE_OK;
  size_t part[4];
  for (int k = 0; k < 4; k++) { /* levels may be rounded down */
    const size_t most = (k % 2 == 0 ? p->width : p->height) >> level;
    part[k] = window[k] >> level < most ? window[k] >> level : most > 0 ? most - 1 : 0;
  }
  ABBE_TRY(abbe_exr_read_level(p->reader, level, part, &out->own, error));
  *out = (abbe_inspect_source){&out->own, out->own, level, part[0], part[1]};
  return ABBE_OK;
}

const float *abbe_inspect_source_pixel(const abbe_inspect_source *s, size_t x, size_t y) {
  const size_t most[2] = {s->image->width - 1, s->image->height - 1};
  const size_t at[2] = {(x >> s->level) - s->x0, (y >> s->level) - s->y0};
  const size_t px = at[0] < most[0] ? at[0] : most[0], py = at[1] < most[1] ? at[1] : most[1];
  return s->image->data + (py * s->image->width + px) * s->image->channels;
}

/* ---- what is in it ---- */

/* "w420nm" becomes "S0.420nm", where the picture has no other bands and each name differs in its
 * number alone. */
static abbe_result rename_bands(abbe_inspect_picture *p, abbe_error *error) {
  abbe_spectral_unread unread;
  abbe_spectral_channels_find_unread(&p->image, NULL, &unread);
  const char *first = unread.first[ABBE_SPECTRAL_UNREAD_NAMED];
  if (p->bands.count > 0 || unread.count[ABBE_SPECTRAL_UNREAD_NAMED] < 2) return ABBE_OK;
  const size_t letters = strcspn(first, "0123456789");
  char *before = strndup(first, letters);
  abbe_result result = before != NULL ? ABBE_OK : ABBE_NO_MEMORY;
  for (size_t c = 0; c < p->image.channels && result == ABBE_OK; c++) {
    char name[64];
    double nm;
    const char *own = p->image.channel[c];
    if (strncmp(own, before, letters) != 0) continue;
    snprintf(name, sizeof name, "S0.%.40s", own + letters);
    if (abbe_spectral_channel_parse(name, &nm) != ABBE_SPECTRAL_EMISSIVE) continue;
    char *text = strdup(name);
    if (text == NULL) result = ABBE_NO_MEMORY;
    if (text == NULL) break;
    free(p->image.channel[c]);
    p->image.channel[c] = text;
    p->renamed = true;
  }
  free(before);
  if (result != ABBE_OK) return abbe_error_set(error, result, "%s: no memory", p->path);
  return p->renamed ? abbe_spectral_channels_find(&p->image, NULL, p->path, &p->bands, error)
                    : ABBE_OK;
}

/* One pass: what is not finite, and how great the rest is. */
static void look_for_odd(abbe_inspect_picture *p) {
  const abbe_image *image = &p->image;
  float most = 65504; /* as abbe_relight_make */
  p->odd = (abbe_image_odd){0};
  for (size_t i = 0; i < image->width * image->height; i++) {
    bool infinite = false, nan = false;
    for (size_t c = 0; c < image->channels; c++) {
      const float v = fabsf(image->data[i * image->channels + c]);
      if (v <= most) continue;
      infinite = infinite || isinf(v);
      nan = nan || isnan(v);
      if (isfinite(v)) most = v;
    }
    if ((infinite || nan) && p->odd.infinite + p->odd.nan == 0) {
      p->odd_at[0] = i % image->width << p->coarse;
      p->odd_at[1] = i / image->width << p->coarse;
    }
    p->odd.infinite += infinite;
    p->odd.nan += nan && !infinite;
  }
  p->most = (double)most;
}

static void add(abbe_inspect_picture *p, abbe_inspect_kind kind, const char *name,
                const size_t channel[3]) {
  abbe_inspect_entry *e = &p->entry[p->count];
  *e = (abbe_inspect_entry){.kind = kind};
  for (int k = 0; k < 3; k++) e->channel[k] = channel != NULL ? channel[k] : absent;
  p->name[p->count++] = name;
}

/* The other two of a channel R or X, in its layer. */
static bool find_triple(const abbe_image *image, size_t first, size_t channel[3]) {
  const char *own = image->channel[first];
  const size_t length = strlen(own);
  if (length > 1 && own[length - 2] != '.') return false;
  const char last = own[length - 1];
  if ((last != 'R' && last != 'X') || length > 250) return false;
  channel[0] = first;
  for (int k = 1; k < 3; k++) {
    char name[256];
    snprintf(name, sizeof name, "%.*s%c", (int)length - 1, own, (last == 'R' ? "RGB" : "XYZ")[k]);
    channel[k] = abbe_image_find_channel(image, name);
    if (channel[k] == absent) return false;
  }
  return true;
}

/* The space of the triple that begins with that channel. */
static abbe_result find_space(const abbe_inspect_picture *p, size_t first, abbe_picture_space *out,
                              abbe_error *error) {
  const char *own = p->image.channel[first];
  return abbe_picture_space_find(&p->image, own[strlen(own) - 1] == 'X', p->path, out, error);
}

/* S1 to S3 of the band of channel S0. */
static bool find_stokes(const abbe_image *image, size_t s0, size_t channel[4]) {
  channel[0] = s0;
  for (int k = 1; k < 4; k++) {
    char name[64];
    snprintf(name, sizeof name, "S%d%.60s", k, image->channel[s0] + 2);
    channel[k] = abbe_image_find_channel(image, name);
  }
  return image->channel[s0][0] == 'S' && channel[1] != absent && channel[2] != absent;
}

/* Bands that hold no light that the eye sees have no colour. */
static void list_spectrum(abbe_inspect_picture *p) {
  const abbe_inspect_entry entry = {.kind = ABBE_INSPECT_SPECTRUM};
  abbe_inspect_mix mix = {0};
  abbe_error why = {0};
  if (abbe_inspect_mix_make(p, &entry, &(abbe_inspect_look){0}, &mix, &why) == ABBE_OK)
    add(p, ABBE_INSPECT_SPECTRUM, "colour of the bands", NULL);
  else
    snprintf(p->note, sizeof p->note, "%s", why.text);
  abbe_inspect_mix_free(&mix);
}

static abbe_result list_entries(abbe_inspect_picture *p, abbe_error *error) {
  const abbe_image *image = &p->image;
  size_t channel[3], stokes[4];
  p->entry = calloc(2 * image->channels + 4, sizeof *p->entry);
  p->name = calloc(2 * image->channels + 4, sizeof *p->name);
  if (p->entry == NULL || p->name == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its channels", p->path);
  abbe_error why = {0};
  for (int layered = 0; layered < 2; layered++) { /* those of no layer first */
    for (size_t c = 0; c < image->channels; c++) {
      const bool own = image->channel[c][0] == '\0' || image->channel[c][1] == '\0';
      if (own == (layered == 1) || !find_triple(image, c, channel)) continue;
      if (find_space(p, c, &p->space, &why) == ABBE_OK)
        add(p, ABBE_INSPECT_COLOUR, own ? "colour" : image->channel[c], channel);
      else
        snprintf(p->note, sizeof p->note, "%s", why.text);
    }
    if (layered == 0 && p->bands.count >= 2) list_spectrum(p);
  }
  if (p->bands.count > 0) add(p, ABBE_INSPECT_BAND, "one band", NULL);
  if (p->bands.count > 0 && find_stokes(image, p->bands.channel[0], stokes)) {
    add(p, ABBE_INSPECT_DEGREE, "degree of polarisation", NULL);
    add(p, ABBE_INSPECT_ANGLE, "angle of polarisation", NULL);
  }
  for (size_t c = 0; c < image->channels; c++)
    add(p, ABBE_INSPECT_CHANNEL, image->channel[c], (const size_t[3]){c, absent, absent});
  return ABBE_OK;
}

static void free_picture(abbe_inspect_picture *p) {
  end_reading(p);
  abbe_inspect_tiles_free(p);
  abbe_inspect_mix_free(&p->mix);
  abbe_inspect_mix_free(&p->minus);
  abbe_spectral_channels_free(&p->bands);
  abbe_image_free(&p->image);
  free(p->entry);
  free(p->name);
  free(p->own);
  *p = (abbe_inspect_picture){0};
}

static const char waiting[] = "waiting for pictures";

static abbe_result begin_picture(abbe_inspect *s, const char *path, abbe_inspect_picture **out,
                                 abbe_error *error) {
  if (s->count == ABBE_INSPECT_MOST_PICTURES)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE, "%s: at most %d pictures are looked at at once",
                          path, ABBE_INSPECT_MOST_PICTURES);
  abbe_inspect_picture *p = *out = &s->picture[s->count];
  *p = (abbe_inspect_picture){.own = strdup(path), .serial = ++s->made};
  p->path = p->own;
  return p->own != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
}

static abbe_result end_picture(abbe_inspect *s, abbe_inspect_picture *p, abbe_result result,
                               abbe_error *error) {
  if (result == ABBE_OK)
    result = abbe_spectral_channels_find(&p->image, NULL, p->path, &p->bands, error);
  if (result == ABBE_OK) result = rename_bands(p, error);
  if (result == ABBE_OK) result = list_entries(p, error);
  if (result != ABBE_OK) {
    free_picture(p);
    return result;
  }
  if (is_partly_read(p) && p->read == 1) end_reading(p);
  look_for_odd(p);
  if (s->count == 1) s->other = 1;
  s->count++;
  if (s->count > 1 && strcmp(s->picture[0].path, waiting) == 0) abbe_inspect_close(s, 0);
  return ABBE_OK;
}

abbe_result abbe_inspect_open(abbe_inspect *s, const char *path, abbe_error *error) {
  const size_t most = s->most_numbers > 0 ? s->most_numbers : ABBE_INSPECT_MOST_NUMBERS;
  abbe_inspect_picture *p = NULL;
  ABBE_TRY(begin_picture(s, path, &p, error));
  return end_picture(s, p, read_image(p->path, most, p, error), error);
}

abbe_result abbe_inspect_read_on(abbe_inspect *s, double seconds, bool *whole, abbe_error *error) {
  abbe_result result = ABBE_OK;
  *whole = true;
  for (size_t i = 0; i < s->count; i++) {
    abbe_inspect_picture *p = &s->picture[i];
    if (!*whole || !is_partly_read(p)) continue;
    const int halves = ilogb(p->read);
    result = abbe_exr_read_on(p->reader, seconds, &p->image, &p->read, error);
    *whole = result != ABBE_OK || p->read == 1;
    if (*whole) end_reading(p);
    if (*whole) look_for_odd(p);
    if (*whole || ilogb(p->read) > halves)
      abbe_inspect_touch(s, i, (const size_t[4]){0, 0, p->width - 1, p->height - 1});
  }
  return result;
}

abbe_result abbe_inspect_create(abbe_inspect *s, const char *name, const size_t size[3],
                                const char *const *channel, abbe_error *error) {
  abbe_inspect_picture *p = NULL;
  ABBE_TRY(begin_picture(s, name, &p, error));
  p->sent = true;
  p->width = size[0];
  p->height = size[1];
  return end_picture(s, p, abbe_image_make(size[0], size[1], size[2], channel, &p->image, error),
                     error);
}

abbe_result abbe_inspect_await(abbe_inspect *s, abbe_error *error) {
  static const char *const names[] = {"Y"};
  if (s->count > 0) return ABBE_OK;
  return abbe_inspect_create(s, waiting, (const size_t[3]){16, 16, 1}, names, error);
}

void abbe_inspect_close(abbe_inspect *s, size_t at) {
  free_picture(&s->picture[at]);
  s->count--;
  memmove(&s->picture[at], &s->picture[at + 1], (s->count - at) * sizeof *s->picture);
  s->picture[s->count] = (abbe_inspect_picture){0};
  if (s->at == at)
    s->look = (abbe_inspect_look){.exposure = s->look.exposure, .view = s->look.view};
  if (s->other == at) s->look.difference = false;
  if (s->at > at || s->at == s->count) s->at -= s->at > 0;
  if (s->other > at || s->other == s->count) s->other -= s->other > 0;
  for (size_t i = 0; i < s->count; i++) s->picture[i].look.display = NULL;
  if (s->look.difference) s->picture[s->at].other = s->other;
}

void abbe_inspect_replace(abbe_inspect *s, size_t at) {
  const size_t last = s->count - 1;
  if (at == last) return;
  if (s->at == at || s->other == at) s->look.difference = false;
  free_picture(&s->picture[at]);
  s->picture[at] = s->picture[last];
  s->picture[last] = (abbe_inspect_picture){0};
  abbe_inspect_close(s, last);
}

void abbe_inspect_free(abbe_inspect *inspect) {
  for (size_t i = 0; i < inspect->count; i++) free_picture(&inspect->picture[i]);
  *inspect = (abbe_inspect){0};
}

/* ---- weights ---- */

bool abbe_inspect_is_colour(abbe_inspect_kind kind) {
  return kind == ABBE_INSPECT_COLOUR || kind == ABBE_INSPECT_SPECTRUM;
}

/* The band that is nearest. */
static size_t nearest(const abbe_spectral_channels *c, double nm) {
  size_t best = 0;
  for (size_t i = 1; i < c->count; i++)
    if (fabs(c->lambda_nm[i] - nm) < fabs(c->lambda_nm[best] - nm)) best = i;
  return c->channel[best];
}

/* XYZ as weights become those of ACEScg. */
static void to_acescg(abbe_inspect_mix *mix, double factor) {
  double matrix[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (int k = 0; k < 9; k++) matrix[k] *= factor;
  for (size_t i = 0; i < mix->count; i++)
    abbe_rgb_space_apply(matrix, mix->weight[i], mix->weight[i]);
}

/* A light of 1 W/(m2 sr nm) at all wavelengths is Y = 1 where the light is not known, as `display`
 * has it. */
static abbe_result mix_bands(const abbe_inspect_picture *p, const abbe_inspect_look *look,
                             abbe_inspect_mix *mix, abbe_error *error) {
  const bool reflective = p->bands.kind == ABBE_SPECTRAL_REFLECTIVE;
  abbe_spectral_view view = look->view;
  if (!reflective && view.from == NULL) view.to = NULL;
  ABBE_TRY(abbe_spectral_colour_weights(&p->bands, &view, p->path, mix->weight, error));
  memcpy(mix->channel, p->bands.channel, mix->count * sizeof *mix->channel);
  double even = 0;
  for (size_t i = 0; i < mix->count; i++) even += mix->weight[i][1] / p->bands.unit.factor;
  const bool absolute = !reflective && view.from == NULL;
  mix->unit = !absolute ? 0 : p->renamed ? 0 : even;
  to_acescg(mix, absolute ? 1 / even : 1);
  return ABBE_OK;
}

static void mix_colour(const abbe_inspect_picture *p, const abbe_inspect_entry *entry,
                       abbe_inspect_mix *mix) {
  abbe_picture_space space = p->space;
  find_space(p, entry->channel[0], &space, NULL);
  memcpy(mix->channel, entry->channel, sizeof entry->channel);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) mix->weight[i][k] = space.to_xyz[3 * k + i];
  to_acescg(mix, 1);
}

abbe_result abbe_inspect_mix_make(const abbe_inspect_picture *p, const abbe_inspect_entry *entry,
                                  const abbe_inspect_look *look, abbe_inspect_mix *out,
                                  abbe_error *error) {
  abbe_inspect_mix mix = {.kind = entry->kind, .count = 1};
  if (entry->kind == ABBE_INSPECT_COLOUR) mix.count = 3;
  if (entry->kind == ABBE_INSPECT_SPECTRUM) mix.count = p->bands.terms;
  mix.channel = calloc(mix.count + 4, sizeof *mix.channel);
  mix.weight = calloc(mix.count + 4, sizeof *mix.weight);
  if (mix.channel == NULL || mix.weight == NULL) {
    abbe_inspect_mix_free(&mix);
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its channels", p->path);
  }
  abbe_result result = ABBE_OK;
  for (int k = 0; k < 3; k++) mix.weight[0][k] = 1;
  if (entry->kind == ABBE_INSPECT_COLOUR)
    mix_colour(p, entry, &mix);
  else if (entry->kind == ABBE_INSPECT_SPECTRUM)
    result = mix_bands(p, look, &mix, error);
  else
    mix.channel[0] = entry->kind == ABBE_INSPECT_CHANNEL ? entry->channel[0]
                                                         : nearest(&p->bands, look->wavelength_nm);
  if (entry->kind == ABBE_INSPECT_DEGREE || entry->kind == ABBE_INSPECT_ANGLE)
    find_stokes(&p->image, mix.channel[0], mix.channel);
  if (result == ABBE_OK)
    *out = mix;
  else
    abbe_inspect_mix_free(&mix);
  return result;
}

void abbe_inspect_mix_free(abbe_inspect_mix *mix) {
  free(mix->channel);
  free(mix->weight);
  *mix = (abbe_inspect_mix){0};
}

static double polarised(const abbe_inspect_mix *mix, const float *pixel) {
  double s[4];
  for (int k = 0; k < 4; k++) s[k] = mix->channel[k] != absent ? (double)pixel[mix->channel[k]] : 0;
  if (mix->kind == ABBE_INSPECT_ANGLE) return 0.5 * atan2(s[2], s[1]) * 180 / acos(-1);
  return s[0] > 0 ? sqrt(s[1] * s[1] + s[2] * s[2] + s[3] * s[3]) / s[0] : 0;
}

void abbe_inspect_mix_at(const abbe_inspect_mix *mix, const abbe_inspect_picture *p,
                         const float *pixel, double out[3]) {
  if (mix->kind == ABBE_INSPECT_DEGREE || mix->kind == ABBE_INSPECT_ANGLE) {
    out[0] = out[1] = out[2] = polarised(mix, pixel);
    return;
  }
  const bool colour = abbe_inspect_is_colour(mix->kind);
  out[0] = out[1] = out[2] = 0;
  for (size_t i = 0; i < mix->count; i++) {
    double v = (double)pixel[mix->channel[i]];
    /* infinities of several signs make no colour */
    if (colour && isinf(v)) v = copysign(p->most, v);
    for (int k = 0; k < 3; k++) out[k] += mix->weight[i][k] * v;
  }
}
