#include "gl/renderer_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The shaders' ON_A_PAGE. */
static const GLuint on_a_page = 0x40000000u;

static const char page_defines[] =
    "#define PAGES\n#define MOST_PAGES %zu\n#define PAGE_BLOCKS %zu\n#define CHART_SIDES %zu\n";

/* A page costs as much as a map: what lands beside the map is given up below so many times the
 * share below which paths end. */
static const double least_share = 1.5;

/* The texels of a block: rectangles of pages are of whole ones, in all levels. */
static size_t block_side(const abbe_renderer *r) {
  return (size_t)1 << (r->map_levels - 1);
}

static abbe_result upload(abbe_renderer *r, int table, GLenum format, size_t size, const void *data,
                          abbe_error *error) {
  GLint most = 0;
  r->gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (size / 4 > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the receivers' %zu faces and %zu flat parts are more than this OpenGL "
                          "reads in a buffer; use smaller meshes",
                          r->charts.face_count, r->charts.count);
  return abbe_renderer_make_texels(r, format, size, data, PAGE_UNIT + table, &r->page_table[table],
                                   &r->page_texture[table], error);
}

/* Of one light, as receiver_pages.glsl reads it: its layer, blocks of texels, sides of charts. */
static void write_index(const abbe_renderer *r, const light_state *state, size_t blocks,
                        GLint *index) {
  const size_t align = block_side(r), sides = 2 * r->charts.count;
  GLint *of_block = index + 1, *of_side = of_block + blocks * blocks;
  index[0] = (GLint)state->page_layer;
  for (size_t i = 0; i < blocks * blocks + sides; i++) of_block[i] = -1;
  for (size_t k = 0; k < state->pages.count; k++) {
    const abbe_receiver_page *page = &state->pages.page[k];
    of_side[page->chart_side] = (GLint)k;
    for (size_t y = page->rect[2] / align; y < page->rect[3] / align; y++)
      for (size_t x = page->rect[0] / align; x < page->rect[1] / align; x++)
        of_block[y * blocks + x] = (GLint)k;
  }
}

/* The shaders' tables, `most` pages a light, and what they are told of them. */
static abbe_result tell_shaders(abbe_renderer *r, size_t most, abbe_error *error) {
  const size_t lights = r->plan.light_view_count, sides = 2 * r->charts.count;
  const size_t blocks = r->plan.desc.map_size / block_side(r);
  const size_t words = 1 + blocks * blocks + sides;
  float(*row)[ABBE_PAGE_FLOATS] = calloc(lights * most, sizeof *row);
  GLint *index = calloc(lights * words, sizeof *index);
  abbe_result result = row != NULL && index != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  for (size_t i = 0; i < lights && result == ABBE_OK; i++) {
    const light_state *state = &r->light[i];
    for (size_t k = 0; k < state->pages.count; k++)
      abbe_receiver_page_pack(&state->pages.page[k],
                              r->charts.parallelogram[state->pages.page[k].chart_side / 2],
                              row[i * most + k]);
    write_index(r, state, blocks, index + i * words);
  }
  if (result == ABBE_OK)
    result = upload(r, PAGE_ROWS, GL_RGBA32F, lights * most * sizeof *row, row, error);
  if (result == ABBE_OK)
    result = upload(r, PAGE_INDEX, GL_R32I, lights * words * sizeof *index, index, error);
  free(row);
  free(index);
  r->page_defines = r->page_defines == 0 ? strlen(r->defines) : r->page_defines;
  snprintf(r->defines + r->page_defines, sizeof r->defines - r->page_defines, page_defines, most,
           blocks, sides);
  return result;
}

/* From a place to a chart's u, then v: a page of one texel of all of it. */
static abbe_result upload_charts(abbe_renderer *r, abbe_error *error) {
  static const abbe_receiver_page whole = {.window = {0, 1, 0, 1}, .rect = {0, 1, 0, 1}};
  float(*row)[8] = calloc(r->charts.count + 1, sizeof *row);
  if (row == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; i < r->charts.count; i++) {
    float packed[ABBE_PAGE_FLOATS];
    abbe_receiver_page_pack(&whole, r->charts.parallelogram[i], packed);
    memcpy(row[i], packed, sizeof row[i]);
  }
  abbe_result result = upload(r, CHART_ROWS, GL_RGBA32F, r->charts.count * sizeof *row, row, error);
  free(row);
  if (result != ABBE_OK) return result;
  return upload(r, SIDE_OF_FACE, GL_R32I, r->charts.face_count * sizeof *r->charts.face_side,
                r->charts.face_side, error);
}

abbe_result abbe_renderer_expect_pages(abbe_renderer *r, abbe_error *error) {
  r->pages = r->fits_pages = true;
  abbe_result result = upload_charts(r, error);
  return result == ABBE_OK ? tell_shaders(r, 1, error) : result;
}

/* As exit_wall.glsl packs it. */
static size_t page_of_wall(float word) {
  GLuint bits = 0;
  memcpy(&bits, &word, sizeof bits);
  const GLuint exponent = bits >> 23 & 255u;
  return exponent > 0 ? (exponent - 1) % 80 - 1 : SIZE_MAX;
}

void abbe_renderer_place_landings(const abbe_renderer *r, size_t light, float *landing,
                                  const GLuint *signature, size_t words, size_t count) {
  const abbe_receiver_pages *pages = &r->light[light].pages;
  for (size_t i = 0; i < count; i++) {
    const float *from = landing + LANDING_BYTES / sizeof *landing * i;
    float at[4] = {from[0], from[1], from[2], from[3]}, packed[ABBE_PAGE_FLOATS];
    const size_t k = page_of_wall(from[7]);
    if (!r->fits_pages && abbe_renderer_is_on_page(r, signature[words * i]) && k < pages->count) {
      const abbe_receiver_page *page = &pages->page[k];
      abbe_receiver_page_pack(page, r->charts.parallelogram[page->chart_side / 2], packed);
      for (int axis = 0; axis < 2; axis++) {
        const float *to = packed + 4 * axis;
        at[axis] = to[0] * from[0] + to[1] * from[1] + to[2] * from[2] + to[3];
      }
      at[2] = (float)k;
    }
    memcpy(landing + 4 * i, at, sizeof at);
  }
}

bool abbe_renderer_is_on_page(const abbe_renderer *r, GLuint path) {
  return r->pages && (path & on_a_page) != 0;
}

abbe_result abbe_renderer_sort_pages(const abbe_renderer *r, const float *landing,
                                     const GLuint *path, size_t count, double part,
                                     abbe_page_light **light, abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    const float *at = landing + 4 * i;
    if (!(at[3] > 0) || !abbe_renderer_is_on_page(r, path[i])) continue;
    const size_t side = (size_t)fmax(at[2], 0);
    if (side >= 2 * r->charts.count) continue;
    if (light[side] == NULL) light[side] = calloc(1, sizeof **light);
    if (light[side] == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fit pages");
    abbe_page_light_add(light[side], at[0], at[1], rint((double)at[3] / part));
  }
  return ABBE_OK;
}

static bool has_page(const abbe_receiver_pages *pages, size_t side) {
  for (size_t k = 0; k < pages->count; k++)
    if (pages->page[k].chart_side == side) return true;
  return false;
}

abbe_result abbe_renderer_choose_pages(abbe_renderer *r, size_t light,
                                       abbe_page_light *const *found, double held,
                                       abbe_error *error) {
  const size_t sides = 2 * r->charts.count;
  abbe_receiver_pages *pages = &r->light[light].pages;
  double beside = 0, left = 0, most = 0;
  size_t worst = 0;
  if (!r->pages) return ABBE_OK;
  for (size_t i = 0; i < sides; i++) beside += found[i] != NULL ? found[i]->flux : 0;
  const double total = held + beside, enough = least_share * r->plan.desc.energy_share * total;
  if (!(beside > 0) || beside < enough) return ABBE_OK;
  abbe_receiver_pages_lay_out(found, (const double(*)[9])r->charts.parallelogram, sides, total,
                              r->plan.desc.map_size, block_side(r), pages);
  for (size_t i = 0; i < sides; i++) {
    if (found[i] == NULL || has_page(pages, i)) continue;
    left += found[i]->flux;
    if (found[i]->flux > most) worst = i;
    most = fmax(most, found[i]->flux);
  }
  if (left < enough || left < 1e-3 * total) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "%.2g %% of the light that '%.40s' sends through refractors falls where it does not shine "
      "itself, on more parts of receivers than the %zu that maps are kept for, most of it on "
      "'%.40s'; give that a smoother mesh, ask for a larger --map, or allow a larger --share",
      100 * left / total, r->scene->light[r->plan.light_view[light].light].name, pages->count,
      r->scene->object[r->charts.object[worst / 2]].name);
}

abbe_result abbe_renderer_keep_pages(abbe_renderer *r, abbe_error *error) {
  size_t layer = r->plan.light_view_count, most = 0;
  for (size_t i = 0; i < r->plan.light_view_count; i++) {
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
  abbe_receiver_page_place(page, r->charts.parallelogram[page->chart_side / 2], landing[0],
                           landing[1], out);
}

void abbe_renderer_free_pages(abbe_renderer *r) {
  r->gl->DeleteTextures(PAGE_TABLES, r->page_texture);
  r->gl->DeleteBuffers(PAGE_TABLES, r->page_table);
  abbe_receiver_charts_free(&r->charts);
}
