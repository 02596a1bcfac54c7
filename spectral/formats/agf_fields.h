/* agf_fields.h: the words and numbers of a line of a Zemax catalogue. Internal to spectral/. */
#ifndef ABBE_SPECTRAL_FORMATS_AGF_FIELDS_H
#define ABBE_SPECTRAL_FORMATS_AGF_FIELDS_H

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_AGF_MAX_FIELDS = 16 };

/* Numbers of a record that may go on over several lines. NaN stands for '-'. */
typedef struct abbe_agf_numbers {
  double value[ABBE_AGF_MAX_FIELDS];
  size_t count;
  bool bad;    /* something in it was no number */
  bool commas; /* it had decimal commas */
} abbe_agf_numbers;

/* What parts fields: blanks, tabs and commas. */
bool abbe_agf_is_blank(char c);
const char *abbe_agf_skip(const char *c);
/* The next field into text, cut to fit; past it. */
const char *abbe_agf_word(const char *c, char *text, size_t size);
/* Adds all that follow. */
void abbe_agf_numbers_read(const char *c, abbe_agf_numbers *to);
/* Number i, or otherwise where it is not there or not known. */
double abbe_agf_number(const abbe_agf_numbers *numbers, size_t i, double otherwise);

#endif
