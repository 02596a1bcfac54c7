/* random_material.h: records of every shape for property tests; the same for the same seed. */
#ifndef ABBE_TESTS_SPECTRAL_RANDOM_MATERIAL_H
#define ABBE_TESTS_SPECTRAL_RANDOM_MATERIAL_H

#include "tests/check.h"

#include "spectral/materials/material.h"

static inline double random_in(double low, double high) {
  return low + (high - low) * ((double)rand() / RAND_MAX);
}

/* Letters, and what a format may stumble over: quotes, colons, hashes, umlauts, escapes. */
static inline char *random_text(size_t longest) {
  static const char *const parts[] = {"a",  "B", "7",  ".",  "-",  "_", "(",        " ",
                                      "\"", "'", ": ", " #", "\\", ",", "\xc3\xa4", "\xe2\x82\xac",
                                      "%",  "&", "*",  "!",  "|",  ">", "@",        "{}"};
  char *text = calloc(1, longest + 8);
  assert_non_null(text);
  strcpy(text, "x");
  size_t wanted = 1 + (size_t)rand() % longest;
  while (strlen(text) < wanted)
    strcat(text, parts[(size_t)rand() % (sizeof parts / sizeof *parts)]);
  strcat(text, "z");
  return text;
}

static inline abbe_spectrum *random_spectrum(double low, double high) {
  size_t count = 2 + (size_t)rand() % 40;
  double lambda_nm[64], value[64], at = random_in(200, 500);
  for (size_t i = 0; i < count; i++, at += random_in(0.5, 50)) {
    lambda_nm[i] = at;
    value[i] = random_in(low, high);
  }
  abbe_spectrum *made = NULL;
  OK(abbe_spectrum_make(lambda_nm, value, count, (abbe_interpolation)(rand() % 3), &made, &error));
  return made;
}

static inline abbe_spectrum *scaled_spectrum(const abbe_spectrum *s, double by) {
  double value[64];
  const size_t count = abbe_spectrum_count(s);
  for (size_t i = 0; i < count; i++) value[i] = by * abbe_spectrum_value(s)[i];
  abbe_spectrum *made = NULL;
  OK(abbe_spectrum_make(abbe_spectrum_lambda_nm(s), value, count, abbe_spectrum_interpolation(s),
                        &made, &error));
  return made;
}

static inline void random_terms(abbe_dispersion *d, double power_low) {
  size_t terms = (size_t)rand() % 6;
  d->c[d->count++] = random_in(1, 3);
  for (size_t k = 0; k < terms; k++) {
    d->c[d->count++] = random_in(0, 0.1);
    d->c[d->count++] = power_low < 0 ? floor(random_in(power_low, 3)) : random_in(0, 0.01);
  }
}

/* Each has a real index from 350 to 900 nm. */
static inline abbe_dispersion random_dispersion(void) {
  abbe_dispersion d = {.model = (abbe_dispersion_model)(rand() % ABBE_DISPERSION_MODEL_COUNT)};
  switch (d.model) {
  case ABBE_DISPERSION_CONSTANT:
    d.c[d.count++] = random_in(1, 3);
    break;
  case ABBE_DISPERSION_CAUCHY:
    d.c[d.count++] = random_in(1, 3);
    for (int k = rand() % 4; k > 0; k--) d.c[d.count++] = random_in(0, 0.01);
    break;
  case ABBE_DISPERSION_SELLMEIER:
  case ABBE_DISPERSION_SELLMEIER2:
    random_terms(&d, 0);
    if (rand() % 2) d.c[0] = 0;
    if (d.count == 1) d.c[0] = 1.2;
    break;
  case ABBE_DISPERSION_RII6:
    d = (abbe_dispersion){.model = d.model,
                          .count = 3,
                          .c = {random_in(0, 0.001), random_in(0, 0.1), random_in(100, 300)}};
    break;
  case ABBE_DISPERSION_POLYNOMIAL:
  case ABBE_DISPERSION_POWERS:
    random_terms(&d, -8);
    break;
  case ABBE_DISPERSION_RII4:
    d = (abbe_dispersion){.model = d.model,
                          .count = 11,
                          .c = {random_in(1, 5), random_in(0, 0.2), 0, random_in(0, 0.03), 1,
                                random_in(0, 0.2), 2, random_in(0, 0.2), 2, random_in(-0.1, 0), 2}};
    break;
  case ABBE_DISPERSION_HERZBERGER:
    d = (abbe_dispersion){.model = d.model,
                          .count = 6,
                          .c = {random_in(1, 3), random_in(0, 0.01), random_in(0, 1e-4)}};
    break;
  case ABBE_DISPERSION_RII8:
    d = (abbe_dispersion){.model = d.model,
                          .count = 4,
                          .c = {random_in(0.1, 0.4), random_in(0, 0.1), random_in(0, 0.03)}};
    break;
  case ABBE_DISPERSION_RII9:
    d = (abbe_dispersion){.model = d.model,
                          .count = 6,
                          .c = {random_in(2, 4), random_in(0, 0.1), random_in(0, 0.03),
                                random_in(0, 0.1), 1.5, random_in(0.5, 1)}};
    break;
  default:
    d = (abbe_dispersion){.model = ABBE_DISPERSION_TABULATED, .table = random_spectrum(1.3, 1.4)};
  }
  return d;
}

/* As a crystal's indices are, over the range that has no table. */
static inline bool is_of_crystals(const abbe_dispersion *d) {
  for (double nm = 350; d->table == NULL && nm <= 900; nm++)
    if (!(abbe_dispersion_n(d, nm) <= 10)) return false;
  return true;
}

/* A second index over the range of the first. */
static inline abbe_dispersion random_second(const abbe_dispersion *first) {
  abbe_dispersion d = {.model = ABBE_DISPERSION_TABULATED};
  if (first->table != NULL) {
    double value[64];
    const size_t count = abbe_spectrum_count(first->table);
    for (size_t i = 0; i < count; i++) value[i] = random_in(1.3, 1.4);
    OK(abbe_spectrum_make(abbe_spectrum_lambda_nm(first->table), value, count,
                          (abbe_interpolation)(rand() % 3), &d.table, &error));
    return d;
  }
  do {
    abbe_dispersion_free(&d);
    d = random_dispersion();
  } while (d.table != NULL || !is_of_crystals(&d));
  return d;
}

static inline void random_catalogue(abbe_material_catalogue *c) {
  if (rand() % 2) c->code = strdup("517642.251");
  if (rand() % 2) c->status = strdup(rand() % 2 ? "obsolete" : "standard");
  if (c->status != NULL && rand() % 2) c->melt_frequency = 1 + rand() % 5;
  if (rand() % 2) c->density_g_cm3 = round(random_in(1, 6) * 1000) / 1000;
  if (rand() % 2) c->expansion_per_k[0] = round(random_in(1, 20) * 1e4) / 1e10;
  if (rand() % 2) c->dpgf = random_in(-0.01, 0.05);
  if (rand() % 2)
    for (int i = 0; i < 6; i++) c->thermal[i] = random_in(-1e-6, 1e-6);
  if (rand() % 2) {
    c->rating_count = 6;
    for (int i = 0; i < 6; i++) c->ratings[i] = rand() % 6 - 1;
    c->ratings[rand() % 6] = 2.3;
    c->expansion_per_k[1] = 8.3e-6;
    c->expansion_range_k[2] = 293;
    c->expansion_range_k[3] = 573;
  }
}

static inline abbe_material random_material(size_t number) {
  abbe_material m = {.dispersion = random_dispersion(), .min_nm = 350, .max_nm = 900};
  m.name = strdup(printed("glass-%zu", number));
  m.source = random_text(60);
  m.temperature_c = rand() % 2 ? NAN : round(random_in(-50, 100));
  if (rand() % 2) m.description = random_text(40);
  if (rand() % 2) m.comment = random_text(40);
  if (rand() % 2) m.warning = random_text(200);
  if (rand() % 2) m.published_n_d = random_in(1.3, 2);
  if (rand() % 2) m.published_v_d = random_in(20, 90);
  m.extrapolate = rand() % 2;
  m.n_absolute = number % 5 == 0;
  if (rand() % 2) m.attenuation = random_spectrum(0, 300);
  if (m.dispersion.table != NULL) {
    m.min_nm = abbe_spectrum_lambda_nm(m.dispersion.table)[0];
    m.max_nm =
        abbe_spectrum_lambda_nm(m.dispersion.table)[abbe_spectrum_count(m.dispersion.table) - 1];
  }
  if (rand() % 3 == 0 && is_of_crystals(&m.dispersion))
    m.extraordinary = random_second(&m.dispersion);
  if (m.dispersion.model == ABBE_DISPERSION_CAUCHY && !abbe_material_is_uniaxial(&m))
    for (int i = 0; i < 2; i++) {
      m.outer[i] = m.dispersion;
      m.outer[i].c[0] += i == 0 ? -0.01 : 0.02;
      if (m.attenuation != NULL) m.attenuation_yz[i] = scaled_spectrum(m.attenuation, i + 2);
    }
  if (abbe_material_is_uniaxial(&m) && m.attenuation != NULL)
    m.attenuation_yz[1] = scaled_spectrum(m.attenuation, 0.3);
  random_catalogue(&m.catalogue);
  if (rand() % 2)
    m.fit[0] = (abbe_material_fit){2, {random_in(1, 2), random_in(0, 0.01)}, 1e-4, 380, 780};
  return m;
}

#endif
