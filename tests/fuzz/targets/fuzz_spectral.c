/* Names of a picture's channels that are bands of a spectrum, and re-radiation between them as a
 * material's record. Input: the unit's text, then a name a line. */
#include "tests/fuzz/keeps.h"

#include "colorimetry/spectral_picture/reradiation.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

const char *const fuzz_words[] = {
    "S0.500,0nm\n",       "T.400,0nm\n",      "T.500nm\n",  "T.400,0nm.500,0nm\n",
    "T.400nm.600,25nm\n", "stderr.T.400nm\n", "S1.500nm\n", "w420nm\n",
    "a.T.700nm\n",        "S0.500THz\n",      "e-3",        "um",
    "W.m^-2.sr^-1\n",     "mW.cm^-2.nm^-1\n", NULL};

enum { MOST = 24, NAME = 80 };

/* Unlike names of the lines of a text, to its end or so many. */
static size_t names_of(const char *text, char name[MOST][NAME], const char *list[MOST]) {
  size_t count = 0;
  while (*text != '\0' && count < MOST) {
    const size_t length = strcspn(text, "\n");
    snprintf(name[count], NAME, "%.*s", (int)length, text);
    text += length + (text[length] == '\n');
    bool known = name[count][0] == '\0';
    for (size_t i = 0; i < count; i++) known = known || strcmp(name[i], name[count]) == 0;
    list[count] = name[count];
    count += !known;
  }
  return count;
}

static void check_bands(const abbe_spectral_channels *c, size_t channels) {
  for (size_t i = 0; i < c->terms; i++)
    FUZZ_PROMISE(c->channel[i] < channels && (c->error[i] < channels || c->error[i] == (size_t)-1));
  for (size_t i = 0; i < c->count; i++) {
    FUZZ_PROMISE(c->lambda_nm[i] > 0 && isfinite(c->lambda_nm[i]));
    FUZZ_PROMISE(i == 0 || c->lambda_nm[i] > c->lambda_nm[i - 1]);
    FUZZ_PROMISE(c->edge_nm[i] <= c->lambda_nm[i] && c->lambda_nm[i] <= c->edge_nm[i + 1]);
  }
  for (size_t i = c->count; i < c->terms; i++)
    FUZZ_PROMISE(c->between[i - c->count][0] < c->count && c->between[i - c->count][1] < c->count);
}

/* What a matrix becomes is a record's key that is read, or is refused with a sentence. */
static void check_record(const char *value) {
  abbe_error error = {0};
  abbe_material_table table = {0};
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  if (to == NULL) return;
  fprintf(to,
          "materials:\n- {name: glow, model: constant, coefficients: [1.5], source: made up,\n"
          "   attenuation_per_m: [[200, 9], [2000, 9]], fluorescence: %s}\n",
          value);
  if (fclose(to) != 0) return;
  if (abbe_material_table_parse(text, size, "glow", &table, &error) == ABBE_OK)
    fuzz_keeps(&table);
  else
    FUZZ_PROMISE(error.text[0] != '\0');
  abbe_material_table_free(&table);
  free(text);
}

int fuzz_input(const uint8_t *data, size_t size) {
  static char text[2048], name[MOST][NAME];
  const char *list[MOST];
  abbe_error error = {0};
  abbe_image image = {0};
  abbe_spectral_channels bands = {0};
  char *matrix = NULL;
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  char *first = strchr(text, '\n');
  if (first == NULL) return 0;
  *first = '\0';
  const size_t count = names_of(first + 1, name, list);
  if (count == 0 || abbe_image_make(1, 2, count, list, &image, NULL) != ABBE_OK) return 0;
  for (size_t i = 0; i < 2 * count; i++) image.data[i] = 0.01f * (float)(i % count + 1);
  if (text[0] != '\0') abbe_image_set_attribute(&image, "emissiveUnits", text, NULL);
  if (FUZZED(abbe_spectral_channels_find(&image, NULL, "it", &bands, &error), &error) == ABBE_OK)
    check_bands(&bands, count);
  else
    FUZZ_PROMISE(error.text[0] != '\0' && bands.count == 0);
  abbe_spectral_channels_free(&bands);
  error = (abbe_error){0};
  if (FUZZED(abbe_reradiation_text(&image, "it", &matrix, &error), &error) == ABBE_OK) {
    fuzz_same(matrix, strlen(matrix));
    check_record(matrix);
  } else {
    FUZZ_PROMISE(error.text[0] != '\0');
  }
  free(matrix);
  abbe_image_free(&image);
  return 0;
}
