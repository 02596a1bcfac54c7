/* yaml.h: reading YAML documents with a line for every complaint.
 *
 * A thin layer over libyaml's document tree: typed getters that check kind, range and finiteness,
 * say file, line, key and value when they refuse, and remember which keys were asked for, so that
 * abbe_yaml_check_keys can name an unknown key and the nearest known one. Aliases are resolved;
 * duplicate keys, several documents, nesting deeper than 64 and files over 16 MiB are refused.
 * It does not write YAML.
 */
#ifndef ABBE_BASE_YAML_YAML_H
#define ABBE_BASE_YAML_YAML_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_yaml abbe_yaml; /* a document */
typedef struct abbe_yaml_node {
  int id;
} abbe_yaml_node; /* index in one document; id 0: absent */

abbe_result abbe_yaml_parse(const char *text, size_t size, const char *name, abbe_yaml **out,
                            abbe_error *error);
abbe_result abbe_yaml_load(const char *path, abbe_yaml **out, abbe_error *error);
void abbe_yaml_free(abbe_yaml *yaml);

abbe_yaml_node abbe_yaml_root(const abbe_yaml *yaml);
/* 1-based line of a node; 0 for an absent node. */
size_t abbe_yaml_line(const abbe_yaml *yaml, abbe_yaml_node node);
bool abbe_yaml_is_mapping(const abbe_yaml *yaml, abbe_yaml_node node);
bool abbe_yaml_is_sequence(const abbe_yaml *yaml, abbe_yaml_node node);
bool abbe_yaml_is_scalar(const abbe_yaml *yaml, abbe_yaml_node node);
/* Whether a sequence or mapping is written in brackets, [ ] or { }. */
bool abbe_yaml_is_flow(const abbe_yaml *yaml, abbe_yaml_node node);
/* The bytes [*from, *to) of the text that the node takes up: with its anchor and quotes, without
 * comments and blank lines after it. Where an alias stands, those of what it names. Meaningless
 * for a text that is not UTF-8. */
void abbe_yaml_span(const abbe_yaml *yaml, abbe_yaml_node node, size_t *from, size_t *to);
/* Text of a scalar (owned by the document), NULL for anything else. */
const char *abbe_yaml_text(const abbe_yaml *yaml, abbe_yaml_node node);

/* Children of a sequence or mapping (pairs of a mapping). */
size_t abbe_yaml_count(const abbe_yaml *yaml, abbe_yaml_node node);
abbe_yaml_node abbe_yaml_item(const abbe_yaml *yaml, abbe_yaml_node sequence, size_t index);
abbe_yaml_node abbe_yaml_key(const abbe_yaml *yaml, abbe_yaml_node mapping, size_t index);
abbe_yaml_node abbe_yaml_value(const abbe_yaml *yaml, abbe_yaml_node mapping, size_t index);

/* The value of key in mapping, or an absent node (id 0); the key counts as known from then on. */
abbe_yaml_node abbe_yaml_get(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key);

/* A child that must be there; ABBE_SCHEMA with a sentence where it is not. */
abbe_result abbe_yaml_require(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                              abbe_yaml_node *out, abbe_error *error);

/* ABBE_SCHEMA where a key that no getter asked for is nearly called `key`, which is missing. */
abbe_result abbe_yaml_refuse_near(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  abbe_error *error);

/* Typed optional getters: an absent key leaves *out as it is (its default). Numbers must be
 * finite and in [min, max]; `exclusive` bounds are the caller's own checks. */
abbe_result abbe_yaml_get_number(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 double min, double max, double *out, abbe_error *error);
abbe_result abbe_yaml_get_count(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                size_t min, size_t max, size_t *out, abbe_error *error);
abbe_result abbe_yaml_get_bool(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key, bool *out,
                               abbe_error *error);
/* *out is malloc'd (or left) and freed by the caller; a previous value is freed first. */
abbe_result abbe_yaml_get_string(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 char **out, abbe_error *error);
/* The same as one printable line (base/text.h): for names, which stand in messages and tables. */
abbe_result abbe_yaml_get_name(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key, char **out,
                               abbe_error *error);
/* One word of a list (names ends with NULL); *out is its index. An unknown word names the nearest.
 */
abbe_result abbe_yaml_get_choice(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 const char *const *names, int *out, abbe_error *error);
/* Exactly count finite numbers in [min, max]. */
abbe_result abbe_yaml_get_numbers(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t count, double min, double max, double *out,
                                  abbe_error *error);
/* Any number of finite numbers; *out is malloc'd (NULL and 0 where the key is absent). */
abbe_result abbe_yaml_get_list(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                               size_t max_count, double **out, size_t *count, abbe_error *error);

/* A scalar node as a finite number in [min, max]. */
abbe_result abbe_yaml_number(const abbe_yaml *yaml, abbe_yaml_node node, const char *what,
                             double min, double max, double *out, abbe_error *error);

/* The same of lengths, in metres, which may have their unit behind them: 6.5mm, 0.2 in
 * (base/number.h). */
abbe_result abbe_yaml_length(const abbe_yaml *yaml, abbe_yaml_node node, const char *what,
                             double min, double max, double *out, abbe_error *error);
abbe_result abbe_yaml_get_length(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 double min, double max, double *out, abbe_error *error);
abbe_result abbe_yaml_get_lengths(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t count, double min, double max, double *out,
                                  abbe_error *error);

/* ABBE_SCHEMA for the first key of mapping that no getter asked for, with the nearest known. */
abbe_result abbe_yaml_check_keys(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *what,
                                 abbe_error *error);

/* "FILE:LINE: " + sentence, with ABBE_SCHEMA. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
abbe_result
abbe_yaml_fail(const abbe_yaml *yaml, abbe_yaml_node node, abbe_error *error, const char *format,
               ...);

#endif
