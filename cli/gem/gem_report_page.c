/* The first page of a report: for who buys the stone. */
#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/command.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/plot/sheet.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_stretch.h"
#include "validation/measure/gem/gem_maps.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double MARGIN = 42;

/* ---- the same facets at better angles ---- */

void abbe_gem_report_page_free(abbe_gem_report_page *page) {
  abbe_gem_view_free(&page->own);
  abbe_gem_view_free(&page->ideal);
  abbe_image_free(&page->photo);
}

enum { WAVELENGTHS = 8, SEARCHED = 4, CROWNS = 7, PAVILIONS = 7, GLASS_SIDE = 320, SIDE = 128 };

/* Round brilliants of 57 facets, as scenes/designs has them: which one's index is nearer. */
static const struct ideal {
  double n, crown_deg, pavilion_deg;
  const char *name;
} ideals[] = {{2.417, 34.5, 40.75, "round brilliant for diamond"},
              {1.544, 42, 43, "round brilliant for quartz"}};

static const struct ideal *ideal_of(const abbe_gem_input *in) {
  const abbe_cut_measures *m = &in->measures;
  if (m->faces[ABBE_CUT_CROWN] != 33 || m->faces[ABBE_CUT_PAVILION] != 24 ||
      !(m->length < 1.02 * m->width))
    return NULL;
  return &ideals[in->n < sqrt(ideals[0].n * ideals[1].n)];
}

/* Its angles alone, at the stone's index. */
static void aim(const struct ideal *ideal, double n, abbe_gem_optimum_desc *d) {
  const double pavilion = abbe_cut_stretch_angle(ideal->pavilion_deg, ideal->n, n);
  const double factor = abbe_cut_stretch_factor(ideal->pavilion_deg, pavilion);
  d->crown_from_rad = d->crown_to_rad = atan(factor * tan(ideal->crown_deg * ABBE_DEGREE));
  d->pavilion_from_rad = d->pavilion_to_rad = pavilion * ABBE_DEGREE;
  d->crowns = d->pavilions = 1;
}

/* Where a design for another index would begin. */
static abbe_gem_optimum_desc describe(const abbe_gem_stone_input *in,
                                      const abbe_gem_view_desc *view) {
  const abbe_cut *cut = &in->in.cut;
  const double crown = abbe_cut_stretch_main_deg(cut, &in->in.stone, ABBE_CUT_CROWN);
  double pavilion = abbe_cut_stretch_main_deg(cut, &in->in.stone, ABBE_CUT_PAVILION);
  if (cut->refractive_index > 1 && pavilion > 0)
    pavilion = abbe_cut_stretch_angle(pavilion, cut->refractive_index, in->in.n);
  abbe_gem_optimum_desc d = {.crown_from_rad = fmax(crown - 6, 1) * ABBE_DEGREE,
                             .crown_to_rad = fmin(crown + 6, 89) * ABBE_DEGREE,
                             .pavilion_from_rad = fmax(pavilion - 3, 1) * ABBE_DEGREE,
                             .pavilion_to_rad = fmin(pavilion + 3, 89) * ABBE_DEGREE,
                             .crowns = CROWNS,
                             .pavilions = PAVILIONS,
                             .measure = ABBE_GEM_RETURN,
                             .width_m = in->width_m,
                             .axes = in->axes,
                             .view = *view};
  if (ideal_of(&in->in) != NULL) aim(ideal_of(&in->in), in->in.n, &d);
  d.view.side = 20;
  d.view.repeats = 4;
  return d;
}

typedef struct light {
  abbe_wavelengths wavelengths;
  abbe_weights weights;
} light;

static abbe_result make_light(const abbe_gem_stone_input *in, size_t most, light *out,
                              abbe_error *error) {
  const abbe_illuminant d65 = {0};
  const size_t count = in->count < most ? in->count : most;
  ABBE_TRY(abbe_wavelengths_make(count, in->from_nm, in->to_nm, &out->wavelengths, error));
  return abbe_weights_make(&out->wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &out->weights, error);
}

static void free_light(light *l) {
  abbe_weights_free(&l->weights);
  abbe_wavelengths_free(&l->wavelengths);
}

/* That design at the angles of the stone's index. */
static abbe_result take_ideal(const abbe_gem_stone_input *in, const char *path,
                              const abbe_gem_view_desc *view, const light *l,
                              abbe_gem_report_page *page, abbe_error *error) {
  char place[2 * PATH_MAX];
  abbe_cut cut = {0};
  abbe_cut_polyhedron p = {0}, stretched = {0};
  abbe_gem_stone stone = {0};
  abbe_result result = abbe_cut_file_read_stone(abbe_shipped_find(path, place, sizeof place), 0,
                                                &cut, &p, NULL, error);
  const double main =
      result == ABBE_OK ? abbe_cut_stretch_main_deg(&cut, &p, ABBE_CUT_PAVILION) : 0;
  if (main > 0 && cut.refractive_index > 1) {
    const double factor =
        abbe_cut_stretch_factor(main, abbe_cut_stretch_angle(main, cut.refractive_index, in->in.n));
    result = abbe_cut_stretch_apply(&cut, &p, factor, factor, error);
  }
  if (result == ABBE_OK) result = abbe_cut_polyhedron_make(&cut, 0, &stretched, error);
  if (result == ABBE_OK)
    result = abbe_gem_stone_make(&cut, &stretched, in->in.material, &l->wavelengths, in->width_m,
                                 &stone, error);
  if (result == ABBE_OK && in->axis != NULL) result = abbe_gem_stone_turn(&stone, &in->axes, error);
  if (result == ABBE_OK)
    result = abbe_gem_view_make(&stone, &l->weights, view, &page->ideal, error);
  if (result == ABBE_OK) {
    page->crown_deg = abbe_cut_stretch_main_deg(&cut, &stretched, ABBE_CUT_CROWN);
    page->pavilion_deg = abbe_cut_stretch_main_deg(&cut, &stretched, ABBE_CUT_PAVILION);
    snprintf(page->name, sizeof page->name, "%s", cut.heading[0] != NULL ? cut.heading[0] : path);
  }
  abbe_gem_stone_free(&stone);
  abbe_cut_polyhedron_free(&stretched);
  abbe_cut_polyhedron_free(&p);
  abbe_cut_free(&cut);
  return result;
}

/* The angles that return most light; those that cannot be changed are no failure. */
static abbe_result search_ideal(const abbe_gem_stone_input *in, const abbe_gem_view_desc *view,
                                const light *l, abbe_gem_report_page *page, abbe_error *error) {
  const abbe_gem_optimum_desc desc = describe(in, view);
  const abbe_cut *cut = &in->in.cut;
  light few = {0};
  abbe_gem_optimum o = {0};
  abbe_gem_stone stone = {0};
  abbe_result result = make_light(in, SEARCHED, &few, error);
  if (result == ABBE_OK)
    result = abbe_gem_optimum_find(cut, &in->in.stone, in->in.material, &few.wavelengths,
                                   &few.weights, &desc, &o, error);
  if (result == ABBE_OK)
    result = abbe_gem_optimum_stone(cut, &in->in.stone, in->in.material, &l->wavelengths, &desc, &o,
                                    &stone, error);
  if (result == ABBE_OK)
    result = abbe_gem_view_make(&stone, &l->weights, view, &page->ideal, error);
  if (result == ABBE_OK) {
    if (ideal_of(&in->in) != NULL)
      snprintf(page->name, sizeof page->name, "the same facets as a %s", ideal_of(&in->in)->name);
    page->is_best = o.value[o.best].value <= o.design.value;
    page->crown_deg = o.crown_rad[o.best % o.crowns] / ABBE_DEGREE;
    page->pavilion_deg = o.pavilion_rad[o.best / o.crowns] / ABBE_DEGREE;
  }
  abbe_gem_stone_free(&stone);
  abbe_gem_optimum_free(&o);
  free_light(&few);
  return result == ABBE_GEOMETRY || result == ABBE_UNSUPPORTED || result == ABBE_OUT_OF_RANGE ||
                 result == ABBE_INVALID_ARGUMENT
             ? ABBE_OK
             : result;
}

abbe_result abbe_gem_report_page_make(const abbe_gem_stone_input *in,
                                      const abbe_gem_view_desc *view, const char *photo,
                                      const char *ideal, abbe_gem_report_page *out,
                                      abbe_error *error) {
  light l = {0};
  abbe_gem_stone stone = {0};
  abbe_gem_view_desc fine = *view;
  fine.side = abbe_media_is_crystal(&in->stone.media, 0) ? SIDE : GLASS_SIDE;
  fine.repeats = abbe_media_is_crystal(&in->stone.media, 0) ? 8 : 4;
  memset(out, 0, sizeof *out);
  abbe_result result =
      photo != NULL ? abbe_png_read_over_white(photo, &out->photo, error) : ABBE_OK;
  if (result == ABBE_OK) result = make_light(in, WAVELENGTHS, &l, error);
  if (result == ABBE_OK)
    result = abbe_gem_stone_make(&in->in.cut, &in->in.stone, in->in.material, &l.wavelengths,
                                 in->width_m, &stone, error);
  if (result == ABBE_OK && in->axis != NULL) result = abbe_gem_stone_turn(&stone, &in->axes, error);
  if (result == ABBE_OK) result = abbe_gem_view_make(&stone, &l.weights, &fine, &out->own, error);
  fine.side /= 2;
  if (result == ABBE_OK)
    result = ideal != NULL ? take_ideal(in, ideal, &fine, &l, out, error)
                           : search_ideal(in, &fine, &l, out, error);
  abbe_gem_stone_free(&stone);
  free_light(&l);
  if (result != ABBE_OK) abbe_gem_report_page_free(out);
  return result;
}

/* ---- the drawing ---- */

typedef struct drawing {
  abbe_sheet *sheet;
  const abbe_gem_input *in;
  double mm;          /* in a unit */
  double x, y, scale; /* of the middle of the stone's bounds; points a unit */
} drawing;

/* Faces that look along `towards`, with the axes h and v to the right and up. */
static void draw(const drawing *d, int h, int v, const double towards[3]) {
  const abbe_cut_polyhedron *p = &d->in->stone;
  for (size_t f = 0; f < p->face_count; f++) {
    const abbe_cut_face *face = &p->face[f];
    if (!(abbe_vector_dot(d->in->cut.facet[face->facet].n, towards) > 1e-3)) continue;
    for (size_t i = 0; i < face->count; i++) {
      double at[2][2];
      for (size_t end = 0; end < 2; end++) {
        const double *q = p->vertex[p->corner[face->first + (i + end) % face->count]];
        at[end][0] = d->x + d->scale * (q[h] - 0.5 * (p->min[h] + p->max[h]));
        at[end][1] = d->y - d->scale * (q[v] - 0.5 * (p->min[v] + p->max[v]));
      }
      abbe_sheet_line(d->sheet, at[0][0], at[0][1], at[1][0], at[1][1], 0.25);
    }
  }
}

/* A length in millimetres between two ticks. */
static void put_length(const drawing *d, double x, double y, double units, bool upright) {
  const double half = 0.5 * d->scale * units, tick = 3;
  char text[40];
  snprintf(text, sizeof text, "%.2f mm", d->mm * units);
  if (upright) {
    abbe_sheet_line(d->sheet, x, y - half, x, y + half, 0.5);
    abbe_sheet_line(d->sheet, x - tick, y - half, x + tick, y - half, 0.5);
    abbe_sheet_line(d->sheet, x - tick, y + half, x + tick, y + half, 0.5);
    abbe_sheet_text(d->sheet, x + 5, y + 3, 8, false, false, 0.2, text);
    return;
  }
  abbe_sheet_line(d->sheet, x - half, y, x + half, y, 0.5);
  abbe_sheet_line(d->sheet, x - half, y - tick, x - half, y + tick, 0.5);
  abbe_sheet_line(d->sheet, x + half, y - tick, x + half, y + tick, 0.5);
  abbe_sheet_text(d->sheet, x + 20, y + 11, 8, false, true, 0.2, text);
}

static void put_drawing(abbe_sheet *s, const abbe_gem_stone_input *stone, double x, double y) {
  const abbe_gem_input *in = &stone->in;
  const abbe_cut_polyhedron *p = &in->stone;
  const abbe_cut_measures *m = &in->measures;
  const double wide = p->max[0] - p->min[0], deep = p->max[1] - p->min[1];
  drawing d = {.sheet = s,
               .in = in,
               .mm = 1e3 * stone->width_m / m->width,
               .x = x,
               .y = y,
               .scale = 140 / fmax(fmax(wide, deep), m->height)};
  const double below = y + 0.5 * d.scale * deep;
  draw(&d, 0, 1, (double[3]){0, 0, 1});
  put_length(&d, x, below + 12, wide, false);
  put_length(&d, x + 0.5 * d.scale * wide + 12, y, deep, true);
  d.y = below + 44 + 0.5 * d.scale * m->height;
  draw(&d, 0, 2, (double[3]){0, -1, 0});
  put_length(&d, x + 0.5 * d.scale * wide + 12, d.y, m->height, true);
}

/* ---- words ---- */

static void put_heading(abbe_sheet *s, const abbe_gem_report_facts *f) {
  const abbe_gem_input *in = &f->input->in;
  const abbe_cut_measures *m = &in->measures;
  const double mm = 1e3 * f->input->width_m / m->width, density = abbe_gem_input_density(in);
  char text[400];
  abbe_sheet_text(s, MARGIN, MARGIN + 14, 20, true, false, 0, abbe_gem_input_title(in));
  int used = snprintf(text, sizeof text, "%s, %.2f x %.2f x %.2f mm", in->material->name,
                      mm * m->length, mm * m->width, mm * m->height);
  if (density > 0)
    snprintf(text + used, sizeof text - (size_t)used, ", %.2f carats",
             abbe_cut_measures_carats(m, f->input->width_m, density));
  abbe_sheet_text(s, MARGIN, MARGIN + 32, 12, false, false, 0.2, text);
}

/* Tiers that leak, or that there is none. */
static void put_flat(abbe_sheet *s, const abbe_gem_input *in, double y) {
  double low, high;
  char text[400];
  abbe_cut_stretch_window(in->n, &low, &high);
  int used =
      snprintf(text, sizeof text,
               "Pavilion facets below the critical angle, %.1f\u00b0, where light leaks:", low);
  const int first = used;
  for (size_t t = 0; t < in->cut.tier_count && used < 360; t++)
    if (in->cut.tier[t].count > 0 && abbe_cut_stretch_is_flat(&in->cut.tier[t], in->n))
      used += snprintf(
          text + used, sizeof text - (size_t)used, "%s %.8s at %.1f\u00b0", used > first ? "," : "",
          abbe_cut_facet_name(&in->cut, in->cut.tier[t].first), -in->cut.tier[t].angle_deg);
  if (used == first) snprintf(text + used, sizeof text - (size_t)used, " none.");
  abbe_sheet_text(s, MARGIN, y, 9, false, false, used == first ? 0.2 : 0, text);
}

/* What a customer wants to know, each with a sentence. */
static const struct {
  const char *name, *title, *text;
} told[] = {
    {"return", "Light return",
     "Of the light from above this much comes back, your head's shadow left out."},
    {"iso", "Brightness", "The same, with light from where your head is, too."},
    {"absorbed", "Kept by its colour",
     "Share of the light that the stone takes: the deeper its colour, the more."},
    {"area_window", "Windows", "Share of the face through which you look at what lies below."},
    {"area_extinct", "Dark areas", "Share of the face that mostly shows your head's shadow."},
    {"contrast", "Contrast",
     "How strongly bright and dark alternate: a stone without any looks flat."},
    {"fire", "Fire", "Share of the face in colour under small lamps, while the stone rocks."},
    {"scintillation", "Sparkle",
     "Share of the face that lights up or goes out at a small step of rocking."},
    {"tilt_iso", "Brightness, rocked", "Brightness in the mean over all tilts."},
};
enum { TOLD = sizeof told / sizeof *told };

/* The ideal's numbers, as far as they are known without rocking it. */
static bool find_number(const abbe_gem_view *v, const char *name, abbe_gem_number *out) {
  abbe_gem_areas areas;
  if (v->side == 0 || abbe_gem_view_areas(v, &areas, NULL) != ABBE_OK) return false;
  if (strcmp(name, "return") == 0)
    *out = abbe_gem_view_amount(v, ABBE_GEM_RETURN);
  else if (strcmp(name, "iso") == 0)
    *out = abbe_gem_view_amount(v, ABBE_GEM_ISO);
  else if (strcmp(name, "absorbed") == 0)
    *out = abbe_gem_view_amount(v, ABBE_GEM_ABSORBED);
  else if (strcmp(name, "area_window") == 0)
    *out = areas.window;
  else if (strcmp(name, "area_extinct") == 0)
    *out = areas.extinct;
  else if (strcmp(name, "contrast") == 0)
    *out = abbe_gem_view_contrast(v);
  else
    return false;
  return true;
}

static void put_value(abbe_sheet *s, double x, double y, bool bold,
                      const abbe_gem_judgement_row *row) {
  char value[32], error[32], text[80];
  abbe_gem_report_number(row, value, error);
  snprintf(text, sizeof text, "%s \u00b1 %s", value, error);
  abbe_sheet_text(s, x, y, 10, bold, true, bold ? 0 : 0.35, text);
}

static void put_numbers(abbe_sheet *s, const abbe_gem_report_facts *f, double y) {
  abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS];
  const size_t count = abbe_gem_judgement_rows(f->judgement, row);
  const double right = ABBE_SHEET_A4_WIDTH - MARGIN, own = right - 100;
  abbe_sheet_text(s, own, y, 8, false, true, 0.35, "this stone");
  if (f->page->ideal.side > 0)
    abbe_sheet_text(s, right, y, 8, false, true, 0.35,
                    f->page->name[0] != '\0' ? "ideal cut" : "best angles");
  y += 5;
  for (int t = 0; t < TOLD; t++)
    for (size_t i = 0; i < count; i++) {
      if (strcmp(told[t].name, row[i].name) != 0) continue;
      abbe_sheet_line(s, MARGIN, y, right, y, 0.85);
      abbe_sheet_text(s, MARGIN, y + 12, 10, true, false, 0.1, told[t].title);
      abbe_sheet_text(s, MARGIN, y + 22, 8, false, false, 0.35, told[t].text);
      put_value(s, own, y + 15, true, &row[i]);
      abbe_gem_judgement_row ideal = row[i];
      if (find_number(&f->page->ideal, row[i].name, &ideal.number))
        put_value(s, right, y + 15, false, &ideal);
      y += 24;
    }
  abbe_sheet_line(s, MARGIN, y, right, y, 0.85);
}

/* ---- pictures ---- */

static abbe_result put_map(abbe_sheet *s, const abbe_gem_view *view, abbe_gem_map map, double x,
                           double y, double size, const char *text, abbe_error *error) {
  abbe_image image = {0};
  abbe_result result = abbe_gem_map_paint(view, map, &image, error);
  if (result == ABBE_OK) result = abbe_sheet_picture(s, x, y, size, size, &image, error);
  abbe_sheet_text(s, x, y - 3, 8, false, false, 0.3, text);
  abbe_image_free(&image);
  return result;
}

static abbe_result put_picture(abbe_sheet *s, const abbe_gem_report_page *page, double x, double y,
                               double size, abbe_error *error) {
  const abbe_image *photo = &page->photo;
  if (photo->data == NULL)
    return put_map(s, &page->own, ABBE_GEM_MAP_COLOUR, x, y, size, "", error);
  const double scale = size / (double)(photo->width > photo->height ? photo->width : photo->height);
  return abbe_sheet_picture(s, x, y, scale * (double)photo->width, scale * (double)photo->height,
                            photo, error);
}

static abbe_result put_maps(abbe_sheet *s, const abbe_gem_report_page *page, double y,
                            abbe_error *error) {
  static const struct {
    abbe_gem_map map;
    bool ideal;
    const char *text;
  } shown[] = {{ABBE_GEM_MAP_ASET, false, "ASET, this stone"},
               {ABBE_GEM_MAP_ASET, true, "ASET, beside it"},
               {ABBE_GEM_MAP_ISO, false, "brightness, this stone"},
               {ABBE_GEM_MAP_ISO, true, "brightness, beside it"}};
  const double each = (ABBE_SHEET_A4_WIDTH - 2 * MARGIN) / 4;
  for (int i = 0; i < 4; i++) {
    const abbe_gem_view *view = shown[i].ideal ? &page->ideal : &page->own;
    if (view->side > 0)
      ABBE_TRY(
          put_map(s, view, shown[i].map, MARGIN + each * i, y, each - 8, shown[i].text, error));
  }
  return ABBE_OK;
}

abbe_result abbe_gem_report_page_put(abbe_sheet *s, const abbe_gem_report_facts *f,
                                     abbe_error *error) {
  const abbe_gem_report_page *page = f->page;
  char text[200];
  put_heading(s, f);
  abbe_result result = put_picture(s, page, MARGIN, 92, 268, error);
  put_drawing(s, f->input, 430, 168);
  if (result == ABBE_OK) result = put_maps(s, page, 392, error);
  put_numbers(s, f, 532);
  put_flat(s, &f->input->in, 766);
  if (page->name[0] != '\0')
    snprintf(text, sizeof text,
             "Ideal cut: %.100s, with a crown of %.2f\u00b0 and a pavilion of %.2f\u00b0",
             page->name, page->crown_deg, page->pavilion_deg);
  else if (page->ideal.side > 0)
    snprintf(text, sizeof text,
             "Best angles: of %d pairs, crown %.2f\u00b0 and pavilion %.2f\u00b0 return the most "
             "light%s",
             CROWNS * PAVILIONS, page->crown_deg, page->pavilion_deg,
             page->is_best ? ", but no more than this stone" : "");
  else
    snprintf(text, sizeof text, "Nothing stands beside it: its angles cannot be changed");
  abbe_sheet_text(s, MARGIN, 780, 9, false, false, 0.2, text);
  abbe_sheet_text(s, MARGIN, 800, 7, false, false, 0.5,
                  "\u00b1: one standard deviation. Stone level, seen from above, in daylight. "
                  "Definitions: docs/gem-measures.md of Abbe");
  return result;
}
