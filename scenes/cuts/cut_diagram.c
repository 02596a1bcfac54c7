#include "scenes/cuts/cut_file.h"

#include "base/file.h"
#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/plot/chart_panel.h"
#include "scenes/cuts/cut_stretch.h"

#include <assert.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Points, of 1/72 inch. */
static const double page_width = 595, page_height = 842, margin = 40;
static const double wheel = 104, reach = 92; /* radii of the wheel and of the stone within it */
static const double views_at = 236, profiles_at = 452, table_at = 560, title_end = 105;
static const double line = 11.5;

typedef struct sheet {
  cairo_t *cr;
  const abbe_cut *cut;
  const abbe_cut_polyhedron *p;
  abbe_cut_measures m;
  const char *note;
  double n;      /* index of the stone; 0: not known */
  double down;   /* how far a long heading moves everything below it */
  double *index; /* [facets] of the tier that is put */
  char *indices;
} sheet;

/* Where the stone's x, y, z is seen. */
typedef struct view {
  double x[3], y[3];   /* to the right and up on the sheet */
  double towards[3];   /* where from */
  double at[2], scale; /* place of the stone's origin; points a unit */
} view;

static void place(const view *v, const double at[3], double out[2]) {
  out[0] = v->at[0] + v->scale * abbe_vector_dot(v->x, at);
  out[1] = v->at[1] - v->scale * abbe_vector_dot(v->y, at);
}

static const double *corner(const sheet *s, const abbe_cut_face *face, size_t i) {
  return s->p->vertex[s->p->corner[face->first + i]];
}

/* ---- faces ---- */

static bool is_seen(const sheet *s, const view *v, const abbe_cut_face *face) {
  const double edge_on = 1e-3;
  return abbe_vector_dot(s->cut->facet[face->facet].n, v->towards) > edge_on;
}

static void trace_face(const sheet *s, const view *v, const abbe_cut_face *face) {
  double at[2];
  for (size_t i = 0; i < face->count; i++) {
    place(v, corner(s, face, i), at);
    if (i == 0) cairo_move_to(s->cr, at[0], at[1]);
    if (i > 0) cairo_line_to(s->cr, at[0], at[1]);
  }
  cairo_close_path(s->cr);
}

/* The middle on the sheet of a face that is seen, and how far from it the nearest edge is. */
static double find_middle(const sheet *s, const view *v, const abbe_cut_face *face, double out[2]) {
  double area = 0, sum[2] = {0, 0}, first[2], a[2], b[2];
  place(v, corner(s, face, 0), first);
  for (size_t i = 1; i + 1 < face->count; i++) {
    place(v, corner(s, face, i), a);
    place(v, corner(s, face, i + 1), b);
    const double part =
        (a[0] - first[0]) * (b[1] - first[1]) - (a[1] - first[1]) * (b[0] - first[0]);
    for (int k = 0; k < 2; k++) sum[k] += part * (first[k] + a[k] + b[k]) / 3;
    area += part;
  }
  for (int k = 0; k < 2; k++) out[k] = sum[k] / area;
  double nearest = INFINITY;
  for (size_t i = 0; i < face->count; i++) {
    place(v, corner(s, face, i), a);
    place(v, corner(s, face, (i + 1) % face->count), b);
    const double x = b[0] - a[0], y = b[1] - a[1], length = hypot(x, y);
    nearest = fmin(nearest, fabs(x * (out[1] - a[1]) - y * (out[0] - a[0])) / length);
  }
  return nearest;
}

static void name_face(const sheet *s, const view *v, const abbe_cut_face *face) {
  const double least = 3.2, most = 9;
  double at[2];
  const char *name = abbe_cut_facet_name(s->cut, face->facet);
  const double radius = find_middle(s, v, face, at);
  if (*name == '\0') return;
  abbe_chart_set_font(s->cr, 10, false);
  const double width = abbe_chart_text_width(s->cr, name) / 10;
  const double size = fmin(most, 1.2 * radius / hypot(0.5 * width, 0.4));
  if (size < least) return;
  abbe_chart_set_font(s->cr, size, false);
  abbe_chart_put_text(s->cr, name, at[0], at[1], 0.5, 0.5);
}

static void draw_faces(const sheet *s, const view *v, bool names) {
  cairo_set_line_join(s->cr, CAIRO_LINE_JOIN_ROUND);
  for (size_t f = 0; f < s->p->face_count; f++) {
    const abbe_cut_face *face = &s->p->face[f];
    if (!is_seen(s, v, face)) continue;
    /* lighter where it faces the reader */
    const double shade = 0.93 + 0.07 * abbe_vector_dot(s->cut->facet[face->facet].n, v->towards);
    trace_face(s, v, face);
    cairo_set_source_rgb(s->cr, shade, shade, fmin(1, shade + 0.015));
    cairo_fill_preserve(s->cr);
    cairo_set_source_rgb(s->cr, 0.1, 0.1, 0.15);
    cairo_set_line_width(s->cr, 0.7);
    cairo_stroke(s->cr);
  }
  abbe_chart_set_grey(s->cr, 0.25);
  for (size_t f = 0; names && f < s->p->face_count; f++)
    if (is_seen(s, v, &s->p->face[f])) name_face(s, v, &s->p->face[f]);
}

/* ---- the wheel of indices ---- */

static double full_turn(const abbe_cut *cut) {
  return (double)abs(cut->gear);
}

/* 1 to the gear's teeth. */
static double in_turn(const abbe_cut *cut, double index) {
  const double turn = full_turn(cut), at = fmod(index, turn);
  return at > 0 ? at : at + turn;
}

/* A tick, and a label where one is wanted. mirrored: as seen from below. */
static void draw_tick(const sheet *s, const double at[2], double index, bool mirrored, bool used) {
  const double turn = 2 * ABBE_PI * (index - s->cut->offset) / s->cut->gear;
  const double x = mirrored ? -sin(turn) : sin(turn), y = -cos(turn);
  const double to = wheel + (used ? 5 : 2.5);
  abbe_chart_set_grey(s->cr, used ? 0.1 : 0.6);
  cairo_set_line_width(s->cr, used ? 0.8 : 0.4);
  cairo_move_to(s->cr, at[0] + wheel * x, at[1] + wheel * y);
  cairo_line_to(s->cr, at[0] + to * x, at[1] + to * y);
  cairo_stroke(s->cr);
  if (!used) return;
  char text[ABBE_NUMBER_TEXT_SIZE];
  abbe_chart_set_font(s->cr, 6, false);
  abbe_chart_put_text(s->cr, abbe_number_text(abbe_number_tidy(in_turn(s->cut, index)), text),
                      at[0] + (wheel + 11) * x, at[1] + (wheel + 11) * y, 0.5, 0.5);
}

/* Labels of facets that are drawn, none twice and none on top of another. */
static void draw_wheel(const sheet *s, const double at[2], abbe_cut_side side) {
  const double turn = full_turn(s->cut), apart = turn * 8 / (2 * ABBE_PI * (wheel + 11));
  double shown[128]; /* for they are eight points apart */
  size_t count = 0;
  abbe_chart_set_grey(s->cr, 0.6);
  cairo_set_line_width(s->cr, 0.5);
  cairo_new_path(s->cr); /* text leaves a point behind, from which an arc would begin */
  cairo_arc(s->cr, at[0], at[1], wheel, 0, 2 * ABBE_PI);
  cairo_stroke(s->cr);
  for (int i = 1; turn <= 160 && i <= (int)turn; i++)
    draw_tick(s, at, i, side == ABBE_CUT_PAVILION, false);
  for (size_t f = 0; f < s->p->face_count; f++) {
    const abbe_cut_facet *facet = &s->cut->facet[s->p->face[f].facet];
    const abbe_cut_side own = abbe_cut_side_of(facet);
    if ((own != side && own != ABBE_CUT_GIRDLE) || fabs(facet->n[2]) > 1 - 1e-9) continue;
    const double index = in_turn(s->cut, facet->index);
    bool is_there = false;
    for (size_t i = 0; i < count; i++) {
      const double off = fmod(fabs(shown[i] - index), turn);
      is_there |= fmin(off, turn - off) < apart;
    }
    if (is_there) continue;
    assert(count < sizeof shown / sizeof *shown);
    shown[count++] = index;
    draw_tick(s, at, index, side == ABBE_CUT_PAVILION, true);
  }
}

/* ---- views ---- */

static double half_size(const sheet *s) {
  double most = 0;
  for (size_t v = 0; v < s->p->vertex_count; v++)
    most = fmax(most, hypot(s->p->vertex[v][0], s->p->vertex[v][1]));
  return most;
}

static void put_heading(const sheet *s, const char *text, double x, double y) {
  abbe_chart_set_grey(s->cr, 0.1);
  abbe_chart_set_font(s->cr, 9, true);
  abbe_chart_put_text(s->cr, text, x, y, 0.5, 1);
}

static void draw_views(const sheet *s) {
  const double x[] = {page_width / 2 - 132, page_width / 2 + 132};
  view crown = {
      .x = {1, 0, 0}, .y = {0, 1, 0}, .towards = {0, 0, 1}, .at = {x[0], s->down + views_at}};
  view pavilion = {
      .x = {-1, 0, 0}, .y = {0, 1, 0}, .towards = {0, 0, -1}, .at = {x[1], s->down + views_at}};
  crown.scale = pavilion.scale = reach / half_size(s);
  put_heading(s, "Crown", x[0], s->down + views_at - wheel - 20);
  put_heading(s, "Pavilion, from below", x[1], s->down + views_at - wheel - 20);
  draw_wheel(s, crown.at, ABBE_CUT_CROWN);
  draw_wheel(s, pavilion.at, ABBE_CUT_PAVILION);
  draw_faces(s, &crown, true);
  draw_faces(s, &pavilion, true);
}

/* A height of the stone beside a profile, as a share of its width. */
static void draw_height(const sheet *s, const view *v, double low, double high, double x) {
  const double tick = 3;
  char text[40];
  double a[2], b[2];
  if (!(high - low > 0.01 * s->m.width)) return;
  place(v, (double[3]){0, 0, low}, a);
  place(v, (double[3]){0, 0, high}, b);
  abbe_chart_set_grey(s->cr, 0.4);
  cairo_set_line_width(s->cr, 0.5);
  abbe_chart_draw_line(s->cr, x, a[1], x, b[1]);
  abbe_chart_draw_line(s->cr, x - tick, a[1], x + tick, a[1]);
  abbe_chart_draw_line(s->cr, x - tick, b[1], x + tick, b[1]);
  abbe_number_format(text, sizeof text, "%.3f", (high - low) / s->m.width);
  abbe_chart_set_font(s->cr, 6.5, false);
  abbe_chart_put_text(s->cr, text, x + 5, (a[1] + b[1]) / 2, 0, 0.5);
}

static void draw_profiles(const sheet *s) {
  const double x[] = {page_width / 2 - 132, page_width / 2 + 132};
  const double middle = (s->p->min[2] + s->p->max[2]) / 2;
  view front = {
      .x = {1, 0, 0}, .y = {0, 0, 1}, .towards = {0, -1, 0}, .at = {x[0], s->down + profiles_at}};
  view side = {
      .x = {0, 1, 0}, .y = {0, 0, 1}, .towards = {1, 0, 0}, .at = {x[1], s->down + profiles_at}};
  front.scale = fmin(reach / half_size(s), 120 / s->m.height);
  front.at[1] += front.scale * middle;
  side.scale = front.scale;
  side.at[1] = front.at[1];
  put_heading(s, "Front", x[0], s->down + profiles_at - 66);
  put_heading(s, "Right side", x[1], s->down + profiles_at - 66);
  draw_faces(s, &front, false);
  draw_faces(s, &side, false);
  const double beside = x[0] + front.scale * s->p->max[0] + 12;
  draw_height(s, &front, s->m.girdle_high, s->p->max[2], beside);
  draw_height(s, &front, s->m.girdle_low, s->m.girdle_high, beside);
  draw_height(s, &front, s->p->min[2], s->m.girdle_low, beside);
}

/* ---- words ---- */

static const char *or_else(const char *text, const char *instead) {
  return text != NULL && *text != '\0' ? text : instead;
}

/* Words of a text, as many to a line as fit; returns the y after them. Nothing is drawn without
 * `draw`. */
static double put_words(const sheet *s, const char *text, double x, double y, double width,
                        bool draw) {
  char row[1024] = "";
  for (const char *at = text; *at != '\0';) {
    const size_t gap = strspn(at, " "), length = gap + strcspn(at + gap, " ");
    char more[1024];
    snprintf(more, sizeof more, "%s%.*s", row, (int)length, at);
    if (row[0] != '\0' && abbe_chart_text_width(s->cr, more) > width) {
      if (draw) abbe_chart_put_text(s->cr, row, x, y, 0, 1);
      y += line;
      snprintf(row, sizeof row, "%.*s", (int)(length - gap), at + gap);
    } else {
      snprintf(row, sizeof row, "%s", more);
    }
    at += length;
  }
  if (draw) abbe_chart_put_text(s->cr, row, x, y, 0, 1);
  return y + line;
}

/* Returns the y after its last line. */
static double put_title(const sheet *s, bool draw) {
  const abbe_cut_measures *m = &s->m;
  const abbe_cut *cut = s->cut;
  char text[400], folds[60] = "", index[60] = "";
  double y = margin + 16;
  abbe_chart_set_grey(s->cr, 0);
  abbe_chart_set_font(s->cr, 17, true);
  const double width = page_width - 2 * margin;
  y = put_words(s, or_else(cut->heading[0], "A design without a name"), margin, y, width, draw);
  y += 3;
  abbe_chart_set_font(s->cr, 8.5, false);
  abbe_chart_set_grey(s->cr, 0.3);
  for (int i = 1; i < ABBE_CUT_LINES; i++)
    if (cut->heading[i] != NULL) y = put_words(s, cut->heading[i], margin, y, width, draw);
  if (cut->folds > 0)
    snprintf(folds, sizeof folds, ", %d-fold%s", cut->folds,
             cut->mirror ? ", mirrored" : ", not mirrored");
  if (cut->refractive_index > 0)
    abbe_number_format(index, sizeof index, ", for an index of %.3f", cut->refractive_index);
  snprintf(text, sizeof text, "%zu + %zu girdle facets, gear %d%s%s",
           m->faces[ABBE_CUT_CROWN] + m->faces[ABBE_CUT_PAVILION], m->faces[ABBE_CUT_GIRDLE],
           cut->gear, folds, index);
  y = put_words(s, text, margin, y, width, draw);
  abbe_number_format(
      text, sizeof text, "L/W %.3f   T/W %.3f   C/W %.3f   P/W %.3f   H/W %.3f   Vol/W³ %.3f",
      m->length / m->width, m->table / m->width, m->side[ABBE_CUT_CROWN] / m->width,
      m->side[ABBE_CUT_PAVILION] / m->width, m->height / m->width, m->volume / pow(m->width, 3));
  y = put_words(s, text, margin, y, width, draw);
  return s->note != NULL ? put_words(s, s->note, margin, y, width, draw) : y;
}

static int by_turn(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A tier's indices with a face, "96 12 24 …", ascending from the gear's own. */
static void list_indices(const sheet *s, size_t t) {
  const abbe_cut_tier *tier = &s->cut->tier[t];
  char one[ABBE_NUMBER_TEXT_SIZE];
  size_t count = 0, used = 0;
  for (size_t i = 0; i < tier->count; i++)
    if (s->p->fate[tier->first + i] == ABBE_CUT_FACE)
      s->index[count++] =
          fmod(in_turn(s->cut, s->cut->facet[tier->first + i].index), full_turn(s->cut));
  s->indices[0] = '\0';
  qsort(s->index, count, sizeof *s->index, by_turn);
  for (size_t i = 0; i < count; i++)
    used += (size_t)sprintf(s->indices + used, "%s%s", i > 0 ? " " : "",
                            abbe_number_text(abbe_number_tidy(in_turn(s->cut, s->index[i])), one));
}

/* Its names, one after another, none twice running. */
static void list_names(const sheet *s, size_t t, char *out, size_t size) {
  const abbe_cut_tier *tier = &s->cut->tier[t];
  size_t used = 0;
  const char *last = "";
  *out = '\0';
  for (size_t i = tier->first; i < tier->first + tier->count && used < size; i++) {
    const char *name = abbe_cut_facet_name(s->cut, i);
    if (strcmp(name, last) == 0) continue;
    used += (size_t)snprintf(out + used, size - used, "%s%s", used > 0 ? ", " : "", name);
    last = name;
  }
}

static abbe_cut_side side_of_tier(const sheet *s, size_t t) {
  return abbe_cut_side_of(&s->cut->facet[s->cut->tier[t].first]);
}

static const double columns[] = {40, 92, 140, 400}; /* names, angle, indices, instruction */

static double put_tier(const sheet *s, size_t t, double y, bool draw) {
  const abbe_cut_tier *tier = &s->cut->tier[t];
  char names[120], angle[40];
  list_indices(s, t);
  list_names(s, t, names, sizeof names);
  abbe_number_format(angle, sizeof angle, "%.2f°", fabs(tier->angle_deg));
  abbe_chart_set_font(s->cr, 8, false);
  abbe_chart_set_grey(s->cr, 0.1);
  double end = put_words(s, names, columns[0], y, columns[1] - columns[0] - 6, draw);
  if (draw) abbe_chart_put_text(s->cr, angle, columns[2] - 14, y, 1, 1);
  end = fmax(end, put_words(s, s->indices, columns[2], y, columns[3] - columns[2] - 12, draw));
  if (tier->instruction != NULL)
    end = fmax(end, put_words(s, tier->instruction, columns[3], y, page_width - margin - columns[3],
                              draw));
  if (abbe_cut_stretch_is_flat(tier, s->n)) {
    cairo_set_source_rgb(s->cr, 0.75, 0.1, 0.1);
    end = fmax(end, put_words(s, "below the critical angle: light leaks", columns[3],
                              tier->instruction != NULL ? end : y, page_width - margin - columns[3],
                              draw));
  }
  return end;
}

/* Returns where the sheet ends. */
static double put_table(const sheet *s, bool draw) {
  static const abbe_cut_side order[] = {ABBE_CUT_GIRDLE, ABBE_CUT_PAVILION, ABBE_CUT_CROWN};
  static const char *const titles[] = {"Girdle", "Pavilion", "Crown"};
  double y = s->down + table_at;
  for (int k = 0; k < 3; k++) {
    bool any = false;
    for (size_t t = 0; t < s->cut->tier_count; t++) {
      if (s->cut->tier[t].count == 0 || side_of_tier(s, t) != order[k]) continue;
      if (!any) {
        abbe_chart_set_font(s->cr, 9, true);
        abbe_chart_set_grey(s->cr, 0.1);
        if (draw) abbe_chart_put_text(s->cr, titles[k], columns[0], y, 0, 1);
        if (draw) {
          abbe_chart_set_grey(s->cr, 0.7);
          cairo_set_line_width(s->cr, 0.5);
          abbe_chart_draw_line(s->cr, columns[0], y + 3, page_width - margin, y + 3);
        }
        y += line + 3;
        any = true;
      }
      y = put_tier(s, t, y, draw);
    }
    if (any) y += line / 2;
  }
  abbe_chart_set_font(s->cr, 8, false);
  abbe_chart_set_grey(s->cr, 0.3);
  for (int i = 0; i < ABBE_CUT_LINES; i++)
    if (s->cut->footnote[i] != NULL)
      y = put_words(s, s->cut->footnote[i], columns[0], y, page_width - 2 * margin, draw);
  return y + margin - line;
}

/* ---- the sheet ---- */

/* The height of the page; sets down. */
static double measure(sheet *s) {
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  sheet own = *s;
  own.cr = cairo_create(surface);
  own.down = s->down = fmax(put_title(&own, false) - title_end, 0);
  const double end = put_table(&own, false);
  cairo_destroy(own.cr);
  cairo_surface_destroy(surface);
  return ceil(fmax(page_height, end));
}

static void draw(const sheet *s) {
  cairo_set_source_rgb(s->cr, 1, 1, 1);
  cairo_paint(s->cr);
  put_title(s, true);
  draw_views(s);
  draw_profiles(s);
  put_table(s, true);
}

static bool ends_with(const char *path, const char *ending) {
  const size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

/* What does not reach the file shows in ferror when it is committed, with the reason. */
static cairo_status_t write_bytes(void *closure, const unsigned char *data, unsigned int length) {
  fwrite(data, 1, length, closure);
  return CAIRO_STATUS_SUCCESS;
}

static cairo_surface_t *make_surface(const char *path, double height, FILE *to) {
  const int pixels = ABBE_CUT_DIAGRAM_PIXELS;
  if (ends_with(path, ".pdf"))
    return cairo_pdf_surface_create_for_stream(write_bytes, to, page_width, height);
  if (ends_with(path, ".svg"))
    return cairo_svg_surface_create_for_stream(write_bytes, to, page_width, height);
  cairo_surface_t *surface = cairo_image_surface_create(
      CAIRO_FORMAT_RGB24, pixels * (int)page_width, pixels * (int)height);
  cairo_surface_set_device_scale(surface, pixels, pixels);
  return surface;
}

static abbe_result write_sheet(sheet *s, const char *path, FILE *to, abbe_error *error) {
  cairo_surface_t *surface = make_surface(path, measure(s), to);
  s->cr = cairo_create(surface);
  draw(s);
  cairo_status_t status = cairo_status(s->cr);
  cairo_destroy(s->cr);
  if (status == CAIRO_STATUS_SUCCESS && ends_with(path, ".png"))
    status = cairo_surface_write_to_png_stream(surface, write_bytes, to);
  cairo_surface_finish(surface);
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (status == CAIRO_STATUS_SUCCESS) return ABBE_OK;
  return abbe_error_set(error, status == CAIRO_STATUS_NO_MEMORY ? ABBE_NO_MEMORY : ABBE_IO,
                        "%s: the diagram could not be drawn: %s", path,
                        cairo_status_to_string(status));
}

abbe_result abbe_cut_diagram_write(const char *path, const abbe_cut *cut,
                                   const abbe_cut_polyhedron *polyhedron, const char *note,
                                   double n, abbe_error *error) {
  abbe_file_writer writer;
  sheet s = {.cut = cut, .p = polyhedron, .note = note, .n = n};
  if (!ends_with(path, ".pdf") && !ends_with(path, ".svg") && !ends_with(path, ".png"))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a diagram wants a name that ends with .pdf, .svg or .png", path);
  abbe_cut_measures_make(cut, polyhedron, &s.m);
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  s.index = malloc(cut->facet_count * sizeof *s.index);
  s.indices = malloc(cut->facet_count * ABBE_NUMBER_TEXT_SIZE);
  abbe_result result = ABBE_OK;
  if (s.index == NULL || s.indices == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for a diagram", path);
  if (result == ABBE_OK) result = write_sheet(&s, path, writer.stream, error);
  free(s.index);
  free(s.indices);
  return abbe_file_writer_end(&writer, result, error);
}
