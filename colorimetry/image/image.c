#include "colorimetry/image/image.h"

#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static abbe_result no_memory(size_t width, size_t height, size_t channels, abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY,
                        "there is no memory for an image of %zu x %zu pixels and %zu channels",
                        width, height, channels);
}

static abbe_result check_size(size_t width, size_t height, size_t channels,
                              const char *const *names, abbe_error *error) {
  if (width < 1 || height < 1 || width > ABBE_IMAGE_MAX_SIDE || height > ABBE_IMAGE_MAX_SIDE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an image of %zu x %zu pixels cannot be made; a side is 1 to %d", width,
                          height, ABBE_IMAGE_MAX_SIDE);
  if (channels < 1 || channels > ABBE_IMAGE_MAX_CHANNELS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an image of %zu channels cannot be made; their count is 1 to %d",
                          channels, ABBE_IMAGE_MAX_CHANNELS);
  for (size_t i = 0; i < channels; i++)
    if (names == NULL || names[i] == NULL || names[i][0] == '\0')
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "channel %zu of an image has no name; every channel needs one", i);
  if (width * height > SIZE_MAX / sizeof(float) / channels)
    return no_memory(width, height, channels, error);
  return ABBE_OK;
}

abbe_result abbe_image_make(size_t width, size_t height, size_t channels, const char *const *names,
                            abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  ABBE_TRY(check_size(width, height, channels, names, error));

  abbe_image image = {.width = width, .height = height, .channels = channels};
  image.display_window.x1 = (int32_t)width - 1;
  image.display_window.y1 = (int32_t)height - 1;
  image.data_window = image.display_window;
  image.channel = calloc(channels, sizeof *image.channel);
  image.data = calloc(width * height * channels, sizeof *image.data);
  bool made = image.channel != NULL && image.data != NULL;
  for (size_t i = 0; made && i < channels; i++) {
    image.channel[i] = strdup(names[i]);
    made = image.channel[i] != NULL;
  }
  if (!made) {
    abbe_image_free(&image);
    return no_memory(width, height, channels, error);
  }
  *out = image;
  return ABBE_OK;
}

void abbe_image_free(abbe_image *image) {
  if (image == NULL) return;
  for (size_t i = 0; image->channel != NULL && i < image->channels; i++) free(image->channel[i]);
  free(image->channel);
  free(image->data);
  for (size_t i = 0; i < image->attribute_count; i++) {
    free(image->attribute[i].name);
    free(image->attribute[i].text);
  }
  free(image->attribute);
  *image = (abbe_image){0};
}

abbe_result abbe_image_check_expansion(const char *path, size_t width, size_t height,
                                       size_t channels, size_t file_bytes, size_t free_bytes,
                                       abbe_error *error) {
  const double bytes = (double)width * (double)height * (double)channels * sizeof(float);
  const double mebibyte = 1 << 20;
  if (bytes <= (double)free_bytes || bytes <= ABBE_IMAGE_MAX_EXPANSION * (double)file_bytes)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: its %zu bytes would unfold into %zu x %zu pixels and %zu channels, "
                        "%.0f MiB; above %.0f MiB a picture may take %d times its file's bytes",
                        path, file_bytes, width, height, channels, bytes / mebibyte,
                        (double)free_bytes / mebibyte, ABBE_IMAGE_MAX_EXPANSION);
}

abbe_result abbe_image_check_place(const abbe_image *a, const char *name_a, const abbe_image *b,
                                   const char *name_b, abbe_error *error) {
  const abbe_image_window v = a->display_window, w = b->display_window;
  if (v.x0 == w.x0 && v.y0 == w.y0) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s shows (%d, %d) to (%d, %d) and %s (%d, %d) to (%d, %d), by their "
                        "display windows; they must begin at one place to be compared",
                        name_a, (int)v.x0, (int)v.y0, (int)v.x1, (int)v.y1, name_b, (int)w.x0,
                        (int)w.y0, (int)w.x1, (int)w.y1);
}

static abbe_image_attribute *find_attribute(const abbe_image *image, const char *name) {
  for (size_t i = 0; i < image->attribute_count; i++)
    if (strcmp(image->attribute[i].name, name) == 0) return &image->attribute[i];
  return NULL;
}

static bool append_attribute(abbe_image *image, const char *name, char *text) {
  char *copy = strdup(name);
  abbe_image_attribute *grown =
      copy == NULL
          ? NULL
          : realloc(image->attribute, (image->attribute_count + 1) * sizeof *image->attribute);
  if (grown == NULL) {
    free(copy);
    return false;
  }
  image->attribute = grown;
  image->attribute[image->attribute_count++] = (abbe_image_attribute){copy, text};
  return true;
}

abbe_result abbe_image_set_attribute(abbe_image *image, const char *name, const char *text,
                                     abbe_error *error) {
  if (name == NULL || name[0] == '\0' || text == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an attribute of an image needs a name and a text");
  abbe_image_attribute *known = find_attribute(image, name);
  if (known == NULL && image->attribute_count == ABBE_IMAGE_MAX_ATTRIBUTES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an image has at most %d text attributes; '%.100s' is one more",
                          ABBE_IMAGE_MAX_ATTRIBUTES, name);
  char *copy = strdup(text);
  if (copy != NULL && known != NULL) {
    free(known->text);
    known->text = copy;
    return ABBE_OK;
  }
  if (copy != NULL && append_attribute(image, name, copy)) return ABBE_OK;
  free(copy);
  return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for the attribute '%s'", name);
}

const char *abbe_image_attribute_text(const abbe_image *image, const char *name) {
  const abbe_image_attribute *known = find_attribute(image, name);
  return known == NULL ? NULL : known->text;
}

void abbe_image_count_odd(const abbe_image *image, const size_t *channel, size_t count,
                          abbe_image_odd *out) {
  *out = (abbe_image_odd){0};
  for (size_t p = 0; p < image->width * image->height; p++) {
    bool infinite = false, nan = false;
    for (size_t c = 0; c < count; c++) {
      const float value = image->data[p * image->channels + channel[c]];
      infinite = infinite || isinf(value);
      nan = nan || isnan(value);
    }
    out->infinite += infinite;
    out->nan += nan && !infinite;
  }
}

size_t abbe_image_find_channel(const abbe_image *image, const char *name) {
  for (size_t i = 0; i < image->channels; i++)
    if (strcmp(image->channel[i], name) == 0) return i;
  return (size_t)-1;
}

static abbe_result check_append(const abbe_image *image, const abbe_image *other,
                                abbe_error *error) {
  if (image->width != other->width || image->height != other->height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "channels of %zu x %zu pixels do not belong to a picture of %zu x %zu",
                          other->width, other->height, image->width, image->height);
  for (size_t c = 0; c < other->channels; c++)
    if (abbe_image_find_channel(image, other->channel[c]) != (size_t)-1)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture has a channel '%s' already",
                            other->channel[c]);
  return ABBE_OK;
}

abbe_result abbe_image_append(abbe_image *image, const abbe_image *other, abbe_error *error) {
  const size_t first = image->channels, more = other->channels, all = first + more;
  abbe_image both = {0};
  ABBE_TRY(check_append(image, other, error));
  const char **name = calloc(all + 1, sizeof *name);
  if (name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for channels");
  for (size_t c = 0; c < all; c++)
    name[c] = c < first ? image->channel[c] : other->channel[c - first];
  abbe_result result = abbe_image_make(image->width, image->height, all, name, &both, error);
  free(name);
  for (size_t i = 0; i < other->attribute_count && result == ABBE_OK; i++)
    if (find_attribute(image, other->attribute[i].name) == NULL)
      result = abbe_image_set_attribute(image, other->attribute[i].name, other->attribute[i].text,
                                        error);
  if (result != ABBE_OK) {
    abbe_image_free(&both);
    return result;
  }
  for (size_t p = 0; p < image->width * image->height; p++) {
    memcpy(both.data + p * all, image->data + p * first, first * sizeof(float));
    memcpy(both.data + p * all + first, other->data + p * more, more * sizeof(float));
  }
  const abbe_image old = *image;
  image->channels = all;
  image->channel = both.channel;
  image->data = both.data;
  both.channels = old.channels;
  both.channel = old.channel;
  both.data = old.data;
  abbe_image_free(&both);
  return ABBE_OK;
}

void abbe_image_band_name(double middle_nm, char *out, size_t size) {
  char number[64];
  abbe_number_format(number, sizeof number, "%.6f", middle_nm);
  for (char *c = number; *c != '\0'; c++)
    if (*c == '.') *c = ',';
  snprintf(out, size, "S0.%snm", number);
}

bool abbe_image_band_middle(const char *channel, double *middle_nm) {
  char *comma, *end;
  if (strncmp(channel, "S0.", 3) != 0) return false;
  const double whole = (double)strtol(channel + 3, &comma, 10);
  if (comma == channel + 3 || *comma != ',') return false;
  *middle_nm = whole + (double)strtol(comma + 1, &end, 10) / 1e6;
  return end == comma + 7 && strcmp(end, "nm") == 0;
}
