#include "base/text.h"

#include "base/number.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <math.h>
#include <string.h>

enum { REPLACEMENT = ABBE_UTF8_REPLACEMENT };

size_t abbe_utf8_read(const unsigned char *c, size_t left, uint32_t *code) {
  size_t count = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : 4;
  if (count == 0 || c[0] > 0xf4 || count > left) return 0;
  static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  *code = count == 1 ? c[0] : c[0] & (0xffu >> (count + 1));
  for (size_t i = 1; i < count; i++) {
    if ((c[i] & 0xc0) != 0x80) return 0;
    *code = *code << 6 | (c[i] & 0x3fu);
  }
  bool wrong = *code < least[count] || *code > 0x10ffff || (*code >= 0xd800 && *code < 0xe000);
  return wrong ? 0 : count;
}

size_t abbe_utf8_write(char *to, uint32_t code) {
  if (code < 0x80) {
    to[0] = (char)code;
    return 1;
  }
  size_t count = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  for (size_t i = count; i-- > 1; code >>= 6) to[i] = (char)(0x80 | (code & 0x3f));
  to[0] = (char)((0xf00u >> count & 0xf0u) | code);
  return count;
}

/* Letters that turn the direction of what follows, end a line, or cannot be seen: what is read is
 * then not what stands there. Of Unicode's format characters (Cf) and separators (Zl, Zp). */
static bool misleads(uint32_t code) {
  static const uint32_t range[][2] = {{0x061c, 0x061c},  {0x200b, 0x200f}, {0x2028, 0x202e},
                                      {0x2060, 0x206f},  {0xfeff, 0xfeff}, {0xfff9, 0xfffb},
                                      {0xe0000, 0xe007f}};
  for (size_t i = 0; i < sizeof range / sizeof *range; i++)
    if (code >= range[i][0] && code <= range[i][1]) return true;
  return false;
}

static uint32_t shown(uint32_t code, bool before_newline, bool lines) {
  if (code == '\n' || code == '\t') return lines ? code : ' ';
  if (code == '\r' && before_newline) return lines ? code : ' ';
  if (code < 0x20) return 0x2400 + code;
  if (code == 0x7f) return 0x2421;
  return (code >= 0x80 && code < 0xa0) || misleads(code) ? REPLACEMENT : code;
}

size_t abbe_utf8_printable(const char *text, size_t length, bool lines, char *out, size_t size) {
  const unsigned char *c = (const unsigned char *)text;
  size_t used = 0;
  for (size_t i = 0; i < length;) {
    uint32_t code = REPLACEMENT;
    char letter[4];
    size_t step = abbe_utf8_read(c + i, length - i, &code);
    if (step == 0) code = REPLACEMENT;
    i += step == 0 ? 1 : step;
    size_t count = abbe_utf8_write(letter, shown(code, i < length && c[i] == '\n', lines));
    if (used + count >= size) break;
    memcpy(out + used, letter, count);
    used += count;
  }
  if (size > 0) out[used] = '\0';
  return used;
}

size_t abbe_utf8_letter(const char *text) {
  uint32_t code;
  return text[0] == '\0' ? 0 : abbe_utf8_read((const unsigned char *)text, strnlen(text, 4), &code);
}

void abbe_utf8_trim(char *text) {
  size_t end = strlen(text), start = end;
  while (start > 0 && end - start < 4) {
    start--;
    if (((unsigned char)text[start] & 0xc0) == 0x80) continue; /* inside a letter */
    if (start + abbe_utf8_letter(text + start) != end) text[start] = '\0';
    return;
  }
}

enum { MAX_LENGTH = 127 };

static size_t smaller(size_t a, size_t b) {
  return a < b ? a : b;
}

static int lower(char c) {
  return tolower((unsigned char)c);
}

/* Edit distance in which swapping two neighbours counts once (optimal string alignment). */
static size_t distance(const char *a, size_t a_length, const char *b, size_t b_length) {
  size_t rows[3][MAX_LENGTH + 1];
  size_t *before = rows[0], *above = rows[1], *here = rows[2];
  for (size_t j = 0; j <= b_length; j++) above[j] = before[j] = j;
  for (size_t i = 1; i <= a_length; i++) {
    here[0] = i;
    for (size_t j = 1; j <= b_length; j++) {
      size_t differs = lower(a[i - 1]) != lower(b[j - 1]);
      here[j] = smaller(above[j - 1] + differs, smaller(above[j], here[j - 1]) + 1);
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1]))
        here[j] = smaller(here[j], before[j - 2] + 1);
    }
    size_t *oldest = before;
    before = above;
    above = here;
    here = oldest;
  }
  return above[b_length];
}

const char *abbe_nearest_word(const char *word, const char *const *candidates, size_t count) {
  size_t length = strlen(word), best = (size_t)-1;
  const char *nearest = NULL;
  if (length > MAX_LENGTH) return NULL;
  for (size_t i = 0; i < count; i++) {
    size_t other = strlen(candidates[i]);
    if (other > MAX_LENGTH) continue;
    size_t longer = length > other ? length : other;
    size_t limit = longer / 3 > 2 ? longer / 3 : 2;
    size_t steps = distance(word, length, candidates[i], other);
    /* two slips must leave more than half of a word: 'zip' is no 'rii' */
    if (steps > limit || steps >= longer || steps >= best) continue;
    if (steps > 1 && 2 * steps >= longer) continue;
    best = steps;
    nearest = candidates[i];
  }
  return nearest;
}

/* What cJSON does not print exactly: more than 15 digits, and -0. */
static bool is_hard(const cJSON *item) {
  const double value = item->valuedouble;
  return cJSON_IsNumber(item) && isfinite(value) &&
         (value != abbe_number_tidy(value) || (value == 0 && signbit(value)));
}

/* From a number to the text of it, which cJSON prints as it is. */
static bool keep_digits(cJSON *item) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  abbe_number_text(item->valuedouble, text);
  char *copy = cJSON_malloc(strlen(text) + 1);
  if (copy == NULL) return false;
  item->valuestring = strcpy(copy, text);
  item->type = (item->type & ~cJSON_Number) | cJSON_Raw;
  return true;
}

static bool keep_all_digits(cJSON *item) {
  if (is_hard(item)) return keep_digits(item);
  for (cJSON *child = item->child; child != NULL; child = child->next)
    if (!keep_all_digits(child)) return false;
  return true;
}

char *abbe_json_text(const struct cJSON *json, bool lines) {
  cJSON *copy = cJSON_Duplicate(json, true);
  const bool kept = copy != NULL && keep_all_digits(copy);
  char *text = !kept ? NULL : lines ? cJSON_Print(copy) : cJSON_PrintUnformatted(copy);
  cJSON_Delete(copy);
  return text;
}
