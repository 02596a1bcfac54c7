#include "gl/renderer_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The shaders' ON_A_PAGE. */
static const GLuint on_a_page = 0x40000000u;

static const char page_defines[] = "#define PAGES\n#define MOST_PAGES %zu\n";

/* A page costs as much as a map: what lands beside the map is given up below so many times the share
 * below which paths end. */
static const double least_share = 1.5;

/* How far off its plane a place on a receiver may be found, in parts of the scene. */
static const double thickness = 4e-6;

/* The shaders' table, `most` pages a light, and what they are told of it. */
static abbe_result tell_shaders(abbe_renderer *r, size_t most, abbe_error *error) {
  const size_t count = r->plan.light_count * most;
  float(*table)[ABBE_PAGE_FLOATS] = calloc(count, sizeof *table);
  if (table == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pages", count);
  for (size_t i = 0; i < count; i++) {
    const light_state *state = &r->light[i / most];
    const abbe_receiver_page *page = &state->pages.page[i % most];
    table[i][16] = -1; /* of no parallelogram */
    if (i % most < state->pages.count)
      abbe_receiver_page_pack(page, r->parallelogram[page->parallelogram], state->page_layer,
                              thickness * r->scene_size, table[i]);
  }
  r->gl->DeleteBuffers(1, &r->table_pages);
  r->table_pages = 0;
  abbe_result result =
      abbe_renderer_make_buffer(r, count * sizeof *table, table, &r->table_pages, error);
  free(table);
  r->page_defines = r->page_defines == 0 ? strlen(r->defines) : r->page_defines;
  snprintf(r->defines + r->page_defines, sizeof r->defines - r->page_defines, page_defines, most);
  return result;
}

abbe_result abbe_renderer_expect_pages(abbe_renderer *r, abbe_error *error) {
  const size_t count = r->plan.parallelogram_count;
  size_t next = 0;
  r->parallelogram = calloc(count + 1, sizeof *r->parallelogram);
  if (r->parallelogram == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu parallelograms", count);
  for (size_t i = 0; i < r->plan.receiver_count; i++) {
    const abbe_exact *exact = &r->scene->object[r->plan.receiver_object[i]].exact;
    if (r->plan.receiver_model[i] != ABBE_RECEIVER_EXACT) continue;
    for (size_t k = 0; k < exact->count && next < count; k++)
      memcpy(r->parallelogram[next++], exact->parallelogram[k], sizeof *r->parallelogram);
  }
  r->pages = r->fits_pages = true;
  return tell_shaders(r, 1, error);
}

bool abbe_renderer_is_on_page(const abbe_renderer *r, GLuint path) {
  return r->pages && (path & on_a_page) != 0;
}

void abbe_renderer_sort_pages(const abbe_renderer *r, const float *landing, const GLuint *path,
                              size_t count, double part, abbe_page_light *light) {
  for (size_t i = 0; i < count; i++) {
    const float *at = landing + 4 * i;
    if (!(at[3] > 0) || !abbe_renderer_is_on_page(r, path[i])) continue;
    const size_t parallelogram = (size_t)fmax(at[2], 0);
    if (parallelogram < r->plan.parallelogram_count)
      abbe_page_light_add(&light[parallelogram], at[0], at[1], rint((double)at[3] / part));
  }
}

void abbe_renderer_choose_pages(abbe_renderer *r, size_t light, const abbe_page_light *found,
                                double total) {
  const size_t side = r->plan.desc.map_size, align = (size_t)1 << (r->map_levels - 1);
  double beside = 0;
  if (!r->pages) return;
  for (size_t i = 0; i < r->plan.parallelogram_count; i++) beside += found[i].flux;
  total += beside;
  if (beside < least_share * r->plan.desc.energy_share * total) return;
  abbe_receiver_pages_lay_out(found, (const double(*)[9])r->parallelogram,
                              r->plan.parallelogram_count, total, side, align,
                              &r->light[light].pages);
}

abbe_result abbe_renderer_keep_pages(abbe_renderer *r, abbe_error *error) {
  size_t layer = r->plan.light_count, most = 0;
  for (size_t i = 0; i < r->plan.light_count; i++) {
    light_state *state = &r->light[i];
    if (state->pages.count > most) most = state->pages.count;
    if (state->pages.count > 0) state->page_layer = layer++;
  }
  r->fits_pages = false;
  r->pages = most > 0;
  if (r->pages) return tell_shaders(r, most, error);
  r->defines[r->page_defines] = '\0';
  return ABBE_OK;
}

void abbe_renderer_page_place(const abbe_renderer *r, size_t light, const float *landing,
                              double out[3]) {
  const abbe_receiver_pages *pages = &r->light[light].pages;
  const size_t k = (size_t)fmin(fmax(landing[2], 0), ABBE_RECEIVER_PAGES - 1);
  const abbe_receiver_page *page = &pages->page[k];
  abbe_receiver_page_place(page, r->parallelogram[page->parallelogram], landing[0], landing[1],
                           out);
}
