#include "validation/sweep/studies/transport_table.h"

#include "base/file.h"
#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const columns[] = {
#define NAME(code, column) column,
    ABBE_TRANSPORT_NUMBERS(NAME)
#undef NAME
};

static const char *transport_of(const abbe_render_desc *d) {
  if (!abbe_method_of(d->profile)->presets) return abbe_profile_name(d->profile);
  return abbe_transport_name(d->transport == ABBE_TRANSPORT_AUTO ? ABBE_TRANSPORT_PHOTONS
                                                                 : d->transport);
}

static void region_of(const abbe_transport_contestant *c, char *out, size_t size) {
  const abbe_region_desc *r = &c->fill.region;
  *out = '\0';
  if (!abbe_transport_looks_up(c)) return;
  if (c->fill.exits > 0)
    snprintf(out, size, "rays %zu", c->fill.exits);
  else if (r->kind == ABBE_REGION_GRID)
    snprintf(out, size, "grid %zu", r->side);
  else if (r->kind == ABBE_REGION_GEODESIC)
    snprintf(out, size, "shells %zux%zu", r->shells, (size_t)20 << 2 * r->levels);
  else
    snprintf(out, size, "shells %zux%zux%zu", r->shells, r->side, r->side);
  if (c->fill.joins)
    abbe_number_format(out + strlen(out), size - strlen(out), " joined %g", c->fill.tolerance);
}

static const char *const lookups[] = {
#define NAME(code, name) name,
    ABBE_VOLUME_LOOKUPS(NAME)
#undef NAME
};
static const char *const footprints[] = {
#define NAME(code, name) name,
    ABBE_FOOTPRINTS(NAME)
#undef NAME
};

abbe_result abbe_transport_table_save(const abbe_transport_study *s, const char *path,
                                      abbe_error *error) {
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  FILE *to = writer.stream;
  fprintf(to, "# scene: %s\ntransport,footprint,region,lookup", s->scene);
  for (int k = 0; k < ABBE_TRANSPORT_NUMBER_COUNT; k++) fprintf(to, ",%s", columns[k]);
  fprintf(to, ",front_time,front_bytes\n");
  for (size_t i = 0; i < s->count; i++) {
    const abbe_transport_row *row = &s->row[i];
    const abbe_render_desc *d = &row->contestant.render;
    char text[ABBE_NUMBER_TEXT_SIZE], region[64];
    region_of(&row->contestant, region, sizeof region);
    fprintf(to, "%s,%s,%s,%s", transport_of(d), d->pinholes > 0 ? footprints[d->footprint] : "",
            region, abbe_transport_looks_up(&row->contestant) ? lookups[d->lookup] : "");
    for (int k = 0; k < ABBE_TRANSPORT_NUMBER_COUNT; k++)
      fprintf(to, ",%s", isfinite(row->number[k]) ? abbe_number_text(row->number[k], text) : "");
    fprintf(to, ",%s,%s\n", row->on_time ? "yes" : "", row->on_bytes ? "yes" : "");
  }
  return abbe_file_writer_commit(&writer, error);
}

static void print_name(const abbe_transport_row *row, FILE *out) {
  const abbe_transport_contestant *c = &row->contestant;
  char region[64];
  region_of(c, region, sizeof region);
  fprintf(out, "| %s", transport_of(&c->render));
  if (c->render.pinholes > 0)
    fprintf(out, " %zu, footprint %s", c->render.pinholes, footprints[c->render.footprint]);
  if (!abbe_transport_looks_up(c)) return;
  abbe_number_write(out, ", %g nodes, %s", row->number[ABBE_TRANSPORT_NODES_NUMBER], region);
  if (c->render.lookup != ABBE_VOLUME_LOOKUP_AUTO) fprintf(out, ", %s", lookups[c->render.lookup]);
}

static void print_all(const abbe_transport_study *s, FILE *out) {
  static const abbe_transport_number shown[] = {
      ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER, ABBE_TRANSPORT_BYTES_MEMORY_NUMBER,
      ABBE_TRANSPORT_BYTES_DISK_NUMBER,   ABBE_TRANSPORT_BYTES_GPU_NUMBER,
      ABBE_TRANSPORT_MOVED_MS_NUMBER,     ABBE_TRANSPORT_OVER_NONE_NUMBER,
      ABBE_TRANSPORT_CAUSTIC_DE_NUMBER,   ABBE_TRANSPORT_CAUSTIC_RMSE_NUMBER,
      ABBE_TRANSPORT_NODE_ERROR_NUMBER,   ABBE_TRANSPORT_MID_ERROR_NUMBER,
      ABBE_TRANSPORT_LIMIT_RMSE_NUMBER,   ABBE_TRANSPORT_POP_NUMBER,
      ABBE_TRANSPORT_PAYS_AFTER_NUMBER};
  fprintf(out,
          "| %s | precompute, s | bytes | on disk | on the device | moved light, ms | over none "
          "| CIEDE2000 | relative RMSE | at nodes | between | to the limit | pop | pays after "
          "| front of |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
          s->scene);
  for (size_t i = 0; i < s->count; i++) {
    const abbe_transport_row *row = &s->row[i];
    char text[ABBE_SWEEP_SHORT];
    print_name(row, out);
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++)
      fprintf(out, " | %s", abbe_sweep_number_short(row->number[shown[k]], text));
    fprintf(out, " |%s%s |\n", row->on_time ? " time" : "", row->on_bytes ? " bytes" : "");
  }
}

/* ---- at equal bytes ---- */

typedef enum kind { NONE, GRID, TRIANGLES, TEXELS, JOINED, RAYS, KINDS } kind;

static kind kind_of(const abbe_transport_contestant *c) {
  if (!abbe_transport_looks_up(c) || c->fill.kind == ABBE_VOLUME_PRINTED) return NONE;
  if (c->fill.exits > 0) return RAYS;
  if (c->fill.joins) return JOINED;
  return c->fill.region.kind == ABBE_REGION_GRID       ? GRID
         : c->fill.region.kind == ABBE_REGION_GEODESIC ? TRIANGLES
                                                       : TEXELS;
}

/* The row of that kind with the least caustic_de that has no more bytes; s->count: none. */
static size_t find_best(const abbe_transport_study *s, kind which, double bytes) {
  size_t best = s->count;
  for (size_t i = 0; i < s->count; i++) {
    const double *n = s->row[i].number;
    if (kind_of(&s->row[i].contestant) != which ||
        !(n[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER] <= bytes))
      continue;
    if (best == s->count ||
        n[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER] < s->row[best].number[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER])
      best = i;
  }
  return best;
}

static void print_row(const abbe_transport_row *row, FILE *out) {
  static const abbe_transport_number shown[] = {
      ABBE_TRANSPORT_BYTES_MEMORY_NUMBER, ABBE_TRANSPORT_CAUSTIC_DE_NUMBER,
      ABBE_TRANSPORT_CAUSTIC_RMSE_NUMBER, ABBE_TRANSPORT_NODE_ERROR_NUMBER,
      ABBE_TRANSPORT_MID_ERROR_NUMBER};
  char text[ABBE_SWEEP_SHORT];
  print_name(row, out);
  for (size_t k = 0; k < sizeof shown / sizeof *shown; k++)
    fprintf(out, " | %s", abbe_sweep_number_short(row->number[shown[k]], text));
  fprintf(out, " |\n");
}

static void print_at_equal_bytes(const abbe_transport_study *s, FILE *out) {
  size_t printed = 0;
  while (printed < s->count && s->row[printed].contestant.fill.kind != ABBE_VOLUME_PRINTED)
    printed++;
  if (printed == s->count) return;
  const double bytes = s->row[printed].number[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER];
  abbe_number_write(out, "\n| at most %.3g bytes ", bytes);
  fprintf(out, "| bytes | CIEDE2000 | relative RMSE | at nodes | between |\n"
               "|---|---|---|---|---|---|\n");
  for (int k = NONE + 1; k < KINDS; k++) {
    const size_t best = find_best(s, (kind)k, bytes);
    if (best < s->count) print_row(&s->row[best], out);
  }
  print_row(&s->row[printed], out);
}

static void print_slopes(const abbe_transport_study *s, FILE *out) {
  for (size_t i = 0; i < s->count; i++) {
    const double slope = abbe_transport_study_slope(s, i);
    const abbe_render_desc *d = &s->row[i].contestant.render;
    const bool first =
        i == 0 || !abbe_transport_same_but_samples(d, &s->row[i - 1].contestant.render);
    if (first && isfinite(slope))
      abbe_number_write(out, "%s, footprint %s: slope %.2f\n", transport_of(d),
                        footprints[d->footprint], slope);
  }
}

void abbe_transport_table_print(const abbe_transport_study *s, FILE *out) {
  print_all(s, out);
  print_at_equal_bytes(s, out);
  print_slopes(s, out);
}
