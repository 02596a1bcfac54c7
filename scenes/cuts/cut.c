#include "scenes/cuts/cut.h"

#include "base/maths.h"
#include "base/text.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* What the bytes 0x80 to 0x9f stand for; 0: nothing. */
static const unsigned short high[32] = {
    0x20ac, 0,      0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017d, 0,      0,      0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0,      0x017e, 0x0178};

static char byte_of(uint32_t code) {
  if (code < 0x20 || code == 0x7f) return ' ';
  if (code < 0x80 || (code >= 0xa0 && code <= 0xff)) return (char)code;
  for (int i = 0; i < 32; i++)
    if (high[i] == code) return (char)(0x80 + i);
  return '?';
}

size_t abbe_cut_text_narrow(const char *utf8, char *out, size_t size) {
  const unsigned char *at = (const unsigned char *)utf8;
  size_t left = strlen(utf8), length = 0;
  while (left > 0 && length + 1 < size) {
    uint32_t code = ABBE_UTF8_REPLACEMENT;
    size_t bytes = abbe_utf8_read(at, left, &code);
    if (bytes == 0) bytes = 1, code = ABBE_UTF8_REPLACEMENT;
    out[length++] = byte_of(code);
    at += bytes;
    left -= bytes;
  }
  out[length] = '\0';
  return length;
}

static uint32_t code_of(unsigned char byte) {
  if (byte < 0x20 || byte == 0x7f) return ' ';
  if (byte < 0x80 || byte > 0x9f) return byte;
  return high[byte - 0x80] != 0 ? high[byte - 0x80] : ABBE_UTF8_REPLACEMENT;
}

char *abbe_cut_text_widen(const char *bytes, size_t size) {
  char *text = malloc(4 * size + 1);
  size_t length = 0;
  if (!text) return NULL;
  for (size_t i = 0; i < size; i++)
    length += abbe_utf8_write(text + length, code_of((unsigned char)bytes[i]));
  text[length] = '\0';
  return text;
}

void abbe_cut_free(abbe_cut *cut) {
  for (int i = 0; i < ABBE_CUT_LINES; i++) {
    free(cut->heading[i]);
    free(cut->footnote[i]);
  }
  for (size_t i = 0; i < cut->tier_count; i++) free(cut->tier[i].instruction);
  for (size_t i = 0; i < cut->facet_count; i++) free(cut->facet[i].name);
  free(cut->tier);
  free(cut->facet);
  memset(cut, 0, sizeof *cut);
}

void abbe_cut_copy_free(abbe_cut *copy) {
  free(copy->tier);
  free(copy->facet);
  *copy = (abbe_cut){0};
}

abbe_result abbe_cut_copy(const abbe_cut *cut, abbe_cut *out, abbe_error *error) {
  abbe_cut own = *cut;
  own.tier = malloc(cut->tier_count * sizeof *own.tier);
  own.facet = malloc(cut->facet_count * sizeof *own.facet);
  if (own.tier == NULL || own.facet == NULL) {
    abbe_cut_copy_free(&own);
    *out = own;
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design of %zu facets",
                          cut->facet_count);
  }
  memcpy(own.tier, cut->tier, cut->tier_count * sizeof *own.tier);
  memcpy(own.facet, cut->facet, cut->facet_count * sizeof *own.facet);
  *out = own;
  return ABBE_OK;
}

/* Makes capacity for one more than count, doubled as it fills; NULL without memory. */
static void *grow(void *list, size_t count, size_t size) {
  const bool full = (count & (count - 1)) == 0;
  return full ? realloc(list, (count > 0 ? 2 * count : 1) * size) : list;
}

abbe_result abbe_cut_add_tier(abbe_cut *cut, double angle_deg, double distance, abbe_error *error) {
  abbe_cut_tier *tier = grow(cut->tier, cut->tier_count, sizeof *tier);
  if (!tier) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a tier");
  cut->tier = tier;
  tier[cut->tier_count++] =
      (abbe_cut_tier){.angle_deg = angle_deg, .distance = distance, .first = cut->facet_count};
  return ABBE_OK;
}

abbe_result abbe_cut_add_facet(abbe_cut *cut, double index, abbe_error *error) {
  if (cut->tier_count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a facet needs a tier before it");
  if (cut->facet_count == ABBE_CUT_MAX_FACETS)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "more than %d facets; no stone has so many",
                          ABBE_CUT_MAX_FACETS);
  abbe_cut_facet *facet = grow(cut->facet, cut->facet_count, sizeof *facet);
  if (!facet) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a facet");
  cut->facet = facet;
  facet[cut->facet_count++] = (abbe_cut_facet){.index = index, .tier = cut->tier_count - 1};
  cut->tier[cut->tier_count - 1].count++;
  return ABBE_OK;
}

void abbe_cut_place(abbe_cut *cut) {
  for (size_t i = 0; i < cut->facet_count; i++) {
    abbe_cut_facet *f = &cut->facet[i];
    const abbe_cut_tier *tier = &cut->tier[f->tier];
    const double angle = fabs(tier->angle_deg) * ABBE_PI / 180;
    const double turn = 2 * ABBE_PI * fmod(f->index - cut->offset, cut->gear) / cut->gear;
    const double side = fabs(tier->angle_deg) == 90 ? 1 : sin(angle);
    const double up = fabs(tier->angle_deg) == 90 ? 0 : cos(angle);
    f->n[0] = side * sin(turn);
    f->n[1] = side * cos(turn);
    f->n[2] = signbit(tier->angle_deg) ? -up : up;
    f->d = tier->distance;
  }
}

double abbe_cut_angle(const double n[3]) {
  const double angle = atan2(hypot(n[0], n[1]), fabs(n[2])) * 180 / ABBE_PI;
  return signbit(n[2]) ? -angle : angle;
}

double abbe_cut_index(const abbe_cut *cut, const double n[3]) {
  const double teeth = abs(cut->gear), whole = 1e-6, level = 1e-12;
  const bool flat = hypot(n[0], n[1]) <= level * fabs(n[2]);
  double index = cut->offset + (flat ? 0 : atan2(n[0], n[1]) * cut->gear / (2 * ABBE_PI));
  if (fabs(index - round(index)) <= whole) index = round(index);
  index = fmod(index, teeth);
  return index > 0 ? index : index + teeth;
}

const char *abbe_cut_facet_name(const abbe_cut *cut, size_t facet) {
  const abbe_cut_tier *tier = &cut->tier[cut->facet[facet].tier];
  for (size_t i = facet + 1; i-- > tier->first;)
    if (cut->facet[i].name) return cut->facet[i].name;
  for (size_t i = facet + 1; i < tier->first + tier->count; i++)
    if (cut->facet[i].name) return cut->facet[i].name;
  return "";
}

bool abbe_cut_facet_is_girdle(const abbe_cut_facet *facet) {
  return fabs(facet->n[2]) < sin(ABBE_CUT_GIRDLE_DEG * ABBE_PI / 180);
}

static abbe_result check_facet(const abbe_cut *cut, size_t i, abbe_error *error) {
  const abbe_cut_facet *f = &cut->facet[i];
  const double rounding = 1e-9;
  if (!(f->d >= 1 / ABBE_CUT_FAR && f->d <= ABBE_CUT_FAR))
    return abbe_error_set(error, ABBE_SCHEMA,
                          "facet %zu lies %g from the centre; it must be above 0, from %g to %g",
                          i + 1, f->d, 1 / ABBE_CUT_FAR, ABBE_CUT_FAR);
  if (!isfinite(f->index) || !(fabs(abbe_vector_length(f->n) - 1) < rounding))
    return abbe_error_set(error, ABBE_SCHEMA, "facet %zu faces no direction", i + 1);
  return ABBE_OK;
}

abbe_result abbe_cut_check(const abbe_cut *cut, abbe_error *error) {
  if (cut->gear == 0 || abs(cut->gear) > ABBE_CUT_MAX_GEAR || !isfinite(cut->offset))
    return abbe_error_set(error, ABBE_SCHEMA, "a gear has 1 to %d teeth, and this one %d",
                          ABBE_CUT_MAX_GEAR, cut->gear);
  if (cut->facet_count < 4)
    return abbe_error_set(error, ABBE_SCHEMA, "%zu facets enclose nothing; a stone has at least 4",
                          cut->facet_count);
  for (size_t i = 0; i < cut->facet_count; i++) ABBE_TRY(check_facet(cut, i, error));
  return ABBE_OK;
}
