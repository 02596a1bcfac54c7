#include "spectral/formats/agf_fields.h"

#include "base/number.h"
#include "base/utf8.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool abbe_agf_is_blank(char c) {
  return c == ' ' || c == '\t' || c == ',';
}

const char *abbe_agf_skip(const char *c) {
  while (abbe_agf_is_blank(*c)) c++;
  return c;
}

static const char *field_end(const char *c) {
  while (*c != '\0' && !abbe_agf_is_blank(*c)) c++;
  return c;
}

const char *abbe_agf_word(const char *c, char *text, size_t size) {
  c = abbe_agf_skip(c);
  const char *end = field_end(c);
  size_t length = (size_t)(end - c) < size - 1 ? (size_t)(end - c) : size - 1;
  memcpy(text, c, length);
  text[length] = '\0';
  abbe_utf8_trim(text);
  return end;
}

/* Length of 1,5168 where that is all between two blanks; 0 where a comma parts two numbers. */
static size_t decimal_comma(const char *c) {
  static const char digits[] = "0123456789";
  size_t sign = *c == '-' || *c == '+', whole = strspn(c + sign, digits);
  const char *comma = c + sign + whole;
  size_t part = *comma == ',' ? strspn(comma + 1, digits) : 0;
  if (whole == 0 || part == 0) return 0;
  const char *end = comma + 1 + part;
  if (*end == 'e' || *end == 'E') {
    end += 1 + (end[1] == '-' || end[1] == '+');
    end += strspn(end, digits);
  }
  return *end == '\0' || *end == ' ' || *end == '\t' ? (size_t)(end - c) : 0;
}

void abbe_agf_numbers_read(const char *c, abbe_agf_numbers *to) {
  const char *end = c;
  for (c = abbe_agf_skip(c); *c != '\0' && to->count < ABBE_AGF_MAX_FIELDS;
       c = abbe_agf_skip(end)) {
    double value = NAN;
    char text[64];
    bool parted = memchr(end, ',', (size_t)(c - end)) != NULL;
    size_t length = parted ? 0 : decimal_comma(c);
    const char *field = c, *past = c;
    end = length > 0 ? c + length : field_end(c);
    if (length > 0 && length < sizeof text) {
      snprintf(text, sizeof text, "%.*s", (int)length, c);
      *strchr(text, ',') = '.';
      field = past = text;
      to->commas = true;
    }
    bool unknown = (c[0] == '-' || c[0] == '?') && (c[1] == '\0' || abbe_agf_is_blank(c[1]));
    bool good = abbe_number_read(field, &past, &value) &&
                (*past == '\0' || abbe_agf_is_blank(*past)) && isfinite(value);
    to->bad = to->bad || (!good && !unknown);
    to->value[to->count++] = good ? value : NAN;
  }
}

double abbe_agf_number(const abbe_agf_numbers *l, size_t i, double otherwise) {
  return i < l->count && isfinite(l->value[i]) ? l->value[i] : otherwise;
}
