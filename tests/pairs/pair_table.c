/* Draws the pairs' cases and prints a table of them: pair_table [STONE COMPANY TRANSPORT STAGE]; or
 * traces what they are held against: pair_table --trace. */
#include "tests/pairs/pair_judge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void fail(const abbe_error *error) {
  fprintf(stderr, "%s\n", error->text);
  exit(1);
}

static int trace(void) {
  abbe_error error = {0};
  puts("# Means of two regions of traced pictures, W/(m2 sr), and standard errors: of Y over Y, of "
       "X / Y and of Z / Y;\n# made by script/pairs --trace.\n"
       "stone,company,region,X,Y,Z,error.Y,error.X/Y,error.Z/Y");
  for (size_t stone = 0; stone < PAIR_STONES; stone++)
    for (size_t company = 0; company < PAIR_COMPANIES; company++) {
      pair_light traced;
      if (pair_trace(stone, company, &traced, &error) != ABBE_OK) fail(&error);
      pair_judge_write(stdout, stone, company, &traced);
      fflush(stdout);
    }
  return 0;
}

/* A wavelength; a purple's is the complementary one. */
static void show_nm(double nm) {
  if (nm < 0)
    printf("purple, %.1f", -nm);
  else
    printf("%.1f", nm);
}

static void show(abbe_context *context, const cover_row *row) {
  pair_light traced = {0}, drawn;
  abbe_error error = {0};
  if (pair_judge_read(row->level[PAIR_STONE], row->level[PAIR_COMPANY], &traced, &error) !=
          ABBE_OK ||
      pair_draw(context, row, &drawn, &error) != ABBE_OK)
    fail(&error);
  for (size_t region = 0; region < PAIR_REGIONS; region++) {
    pair_verdict v;
    pair_judge(row, region, &traced, &drawn, &v);
    for (size_t f = 0; f < COVER_FACTORS; f++) printf("| %s ", pair_level_name(f, row->level[f]));
    printf("| %s | ", pair_region_name[region]);
    if (v.saturated) {
      show_nm(v.nm[0]);
      printf(" nm | ");
      show_nm(v.nm[1]);
      printf(" nm ");
    } else {
      printf("pale | CIEDE2000 %.2f ", v.hue);
    }
    printf("| %.2f%s | %.3f | %.3f%s |\n", v.hue_bound, pair_verdict_hue(&v) ? "" : ": wrong",
           v.light, v.light_bound, pair_verdict_light(&v) ? "" : ": wrong");
  }
  fflush(stdout);
}

static bool take(char **words, cover_row *row) {
  for (size_t f = 0; f < COVER_FACTORS; f++) {
    size_t level = 0;
    while (level < pair_levels[f] && strcmp(words[f], pair_level_name(f, level)) != 0) level++;
    if (level == pair_levels[f]) return false;
    row->level[f] = level;
  }
  return true;
}

int main(int count, char **argument) {
  cover_row row[COVER_MOST];
  size_t rows = 1;
  abbe_context *context;
  abbe_error error = {0};
  if (count == 2 && strcmp(argument[1], "--trace") == 0) return trace();
  if (count == 1) {
    rows = cover_make(pair_levels, pair_can, row);
  } else if (count != 1 + COVER_FACTORS || !take(argument + 1, row)) {
    fputs("pair_table [STONE COMPANY TRANSPORT STAGE | --trace]\n", stderr);
    return 2;
  }
  if (abbe_context_make(ABBE_CONTEXT_CPU, &context, &error) != ABBE_OK) fail(&error);
  puts(
      "| stone | company | transport | stage | where | traced | drawn | within | light | within |\n"
      "|---|---|---|---|---|---|---|---|---|---|");
  for (size_t i = 0; i < rows; i++) show(context, &row[i]);
  abbe_context_free(context);
  return 0;
}
