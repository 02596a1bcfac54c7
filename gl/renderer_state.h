/* renderer_state.h: what the passes of one renderer share. Internal to gl/. */
#ifndef ABBE_GL_RENDERER_STATE_H
#define ABBE_GL_RENDERER_STATE_H

#include "gl/device/api.h"
#include "gl/plan/plan.h"
#include "gl/renderer.h"
#include "gl/scene/local_scene.h"
#include "gl/scene/receiver_charts.h"
#include "gl/scene/receiver_pages.h"
#include "spectral/wavelengths.h"

/* Shader storage bindings, as the shaders name them. */
enum {
  BINDING_LIGHTS,
  BINDING_REFRACTORS,
  BINDING_PLANES,
  BINDING_RECEIVERS,
  BINDING_SURFACES,
  BINDING_SPECTRA,
  BINDING_PHOTONS,
  BINDING_PHOTONS_IN,
  BINDING_SLOTS,
  BINDING_LANDINGS,
  BINDING_SIGNATURES,
  BINDING_SAMPLE_WEIGHTS,
  BINDING_LEDGER,
  BINDING_SHARED, /* paths, then map sums */
  BINDING_INTERVALS,
  BINDING_COUNT,
  BINDING_LIST = BINDING_COUNT /* pieces of light, pixels */
};

/* Texture units of the hierarchy's buffers and the pages', from the first; passes bind theirs
 * below. */
enum { HIERARCHY_UNIT = 7, PAGE_UNIT = 10 };

/* What the shaders know of pages: rows of each, where they are found, and of charts: to their
 * coordinates, and which side of one each face is. */
enum { PAGE_ROWS, PAGE_INDEX, CHART_ROWS, SIDE_OF_FACE, PAGE_TABLES };

enum {
  PHOTON_GROUP = 256,
  PHOTON_HEADER = 8 * 4,
  PHOTON_BYTES = 16,
  LANDING_BYTES = 32, /* place and flux, the wall that the light left, as exit_wall.glsl packs it */
  LEDGER_WORDS = 12,
  LEVELS = 3
};

/* Up to so many photons (cells times wavelengths) 32-bit sums round to well below 1e-4 of the light
 * without ever overflowing. */
enum { MAX_NARROW_PHOTONS = 1 << 20, WARP_STEPS = ABBE_MAP_LAYOUT_STEPS };

typedef struct mesh_buffers {
  GLuint array, vertices, indices;
  GLsizei index_count;
  GLuint layer_array, layer_indices; /* of fewer faces, where layers are drawn with them; else 0 */
  GLsizei layer_index_count;
} mesh_buffers;

typedef struct light_state {
  abbe_view near_view;
  abbe_map_layout map;
  size_t cells[2]; /* of the photon grid, across and up */
  size_t photon_count;
  double cell_flux;    /* most that one photon cell can carry, W */
  double white_peak;   /* largest of X, Y, Z of the light's white, by its Y */
  double reached_flux; /* that all cells together bring to refractors, weighted by ybar, W */
  abbe_receiver_pages pages;
  size_t page_layer; /* of the map, where it has pages */
} light_state;

/* OpenGL promises uniform blocks of 16 KiB; every desktop driver, llvmpipe too, has 64. */
enum { BLOCK_BYTES = 65536 };

/* Of the picture: samples of a receiver that light may reach. */
typedef struct lit_part {
  size_t receiver;
  int rect[4]; /* left, bottom, right, top; the ends excluded */
} lit_part;

typedef struct thesis_state thesis_state;

struct abbe_renderer {
  abbe_context *context;
  const abbe_gl *gl;
  abbe_local_scene local;
  const abbe_scene *scene; /* the local one: every place below is in its coordinates */
  abbe_map_layout given;   /* the request's layout there, where the scene is moved */
  abbe_plan plan;

  mesh_buffers *mesh; /* [scene->object_count] */
  double scene_min[3], scene_max[3], scene_size;
  double refractor_centre[3], refractor_radius;
  float rgb_from_xyz[9], xyz_from_rgb[9]; /* column-major, for uniforms */
  double *lambda_nm;                      /* [wavelengths] */

  light_state light[ABBE_SCENE_MAX_LIGHTS];
  abbe_view eye;

  GLuint buffer[BINDING_COUNT];
  GLuint hierarchy[3];    /* nodes, triangles, normals; 0: no model needs them */
  GLuint hierarchy_texture[3];
  size_t *refractor_root; /* [refractor_count] of its tree */
  size_t receiver_root;   /* of the tree of all receivers that are traversed */
  size_t hierarchy_depth;
  union {         /* as the shaders' block has them */
    int range[4]; /* first plane of each light and refractor, and how many */
    float plane[4];
  } *shadow_row;        /* all ranges, then all planes */
  size_t shadow_planes; /* 0: none, or more than a block holds: faces are asked one by one */
  GLuint table_bands, table_warps, table_shadows, texel_sizes, band_attenuation;
  size_t band_count, band_levels; /* of one refractor: samples, and samples joined by twos */
  GLuint ways;                    /* threads of a pixel as the eye sees it (refraction_ways.glsl) */
  GLuint path_marks, path_list, splat_list, map_sums;
  GLuint wants, pair_list; /* intervals that ask for all their wavelengths */
  GLuint fine_landings, fine_signatures, fine_marks, fine_paths;
  size_t nodes;      /* wavelengths that every photon takes; all of them where none are refined */
  size_t fine_nodes; /* of an interval between two of those, at the most, with both ends */
  size_t pair_room, pair_chunks;
  size_t splat_room, chunks; /* pieces of light that are listed at a time */
  GLuint list[LEVELS];       /* cells that may show a refractor, last level last */
  GLuint texture_surface;
  GLuint texels[6]; /* of buffers that are read as texels, one a unit */
  GLuint light_layers, light_owner, light_depth;
  GLuint map; /* XYZ flux over window area, one layer a light, in levels; then those of pages */
  size_t map_levels, map_texels, map_layers;
  abbe_receiver_charts charts; /* where the plan has pages */
  GLuint page_table[PAGE_TABLES], page_texture[PAGE_TABLES];
  bool pages;      /* shaders have PAGES: some light has any, or they are yet to be chosen */
  bool fits_pages; /* they are yet to be chosen */
  GLuint eye_receivers, eye_direct, eye_caustic, eye_depth, eye_refraction, eye_layers,
      eye_layers_depth, eye_picture, eye_floor;
  GLuint eye_owner, pixel_list, refine_list;
  lit_part *lit; /* where light may fall; all else is drawn unlit, where that is most */
  size_t lit_count;
  GLuint framebuffer, empty_array;
  size_t layer_side;          /* of the light's layers */
  size_t lanes;               /* wavelengths traced in one batch */
  size_t steps;               /* of an interval */
  size_t map_bands, map_band; /* bands of the range whose light the map sums, and the first of the
                                 three; 0: X, Y, Z */
  size_t device_bytes;
  char defines[2048];
  size_t page_defines; /* where in them those of pages start */

  GLuint place, cover, groups, list_groups, trace, paths, deposit, select, deposit_fine, splat,
      resolve, mip, layer, receivers, unlit, refraction, refraction_fine, refraction_list,
      eye_resolve;
  thesis_state *thesis;

  bool wide;                   /* the map's sums have 64 bits, else 32 */
  bool drawn;                  /* the last frame was, to its end */
  double untimed_ms;           /* of this frame, spent on its ledger */
  abbe_statistics *statistics; /* of the frame that runs, or NULL */
  double pass_start_ms;
};

double abbe_renderer_now_ms(void);
/* Flux of one unit of a light's map sums, W. */
double abbe_renderer_map_unit(const abbe_renderer *r, size_t light);
/* Window width (axis 0) or height (1) of the map's column or row `texel`. */
double abbe_renderer_texel_size(const abbe_renderer *r, size_t light, int axis, size_t texel);
/* Whether the request gives the layout of this light's map. */
bool abbe_renderer_map_is_given(const abbe_renderer *r, size_t light);
/* Whether the light looks through one face of a cube, and shares its power with the others. */
bool abbe_renderer_is_face(const abbe_renderer *r, size_t light);
/* Whether the light's map can be read as one picture: ABBE_UNSUPPORTED for a cube of maps that no
 * layout joins, ABBE_INVALID_ARGUMENT where the light has none. */
abbe_result abbe_renderer_check_map(const abbe_renderer *r, size_t light, abbe_error *error);
/* 32-bit words of a map texel's sums. */
size_t abbe_renderer_map_words(const abbe_renderer *r);

/* scene_buffers.c: geometry and tables on the device. */
abbe_result abbe_renderer_upload_scene(abbe_renderer *r, abbe_error *error);
/* Linear Rec.709, as scene files have it, to the space that the shaders work in. */
void abbe_renderer_to_working(const abbe_renderer *r, const double rgb[3], double out[3]);
void abbe_renderer_upload_lights(abbe_renderer *r);
/* intervals.c. The nodes that every photon takes, as a sampling of their own. */
abbe_result abbe_renderer_coarse_wavelengths(const abbe_renderer *r, const abbe_wavelengths *all,
                                             abbe_wavelengths *out, abbe_error *error);
/* intervals.c: between the coarse set's wavelengths, then where it is not all between all. */
abbe_result abbe_renderer_upload_intervals(abbe_renderer *r, const abbe_wavelengths *w,
                                           abbe_error *error);
/* What the map sums: bands first to first + 2 of so many, or with 0 bands X, Y, Z. */
abbe_result abbe_renderer_weigh_bands(abbe_renderer *r, size_t bands, size_t first,
                                      abbe_error *error);
void abbe_renderer_free_scene(abbe_renderer *r);
/* The attributes of surface.vert, in the bound array from the bound buffer. */
void abbe_renderer_point_to_vertices(const abbe_renderer *r);

/* layer_faces.c: the faces that layers are drawn with, once the views are known. */
abbe_result abbe_renderer_make_layer_faces(abbe_renderer *r, abbe_error *error);
size_t abbe_renderer_layer_faces(const abbe_renderer *r);
void abbe_renderer_draw_refractor(abbe_renderer *r, size_t refractor);

/* scene_hierarchy.c: the triangles of what is traversed, before the shaders are made. */
abbe_result abbe_renderer_make_hierarchy(abbe_renderer *r, abbe_error *error);

/* scene_shadows.c: the planes of convex refractors' shadows, before the shaders are made. */
abbe_result abbe_renderer_make_shadows(abbe_renderer *r, abbe_error *error);
abbe_result abbe_renderer_upload_shadows(abbe_renderer *r, abbe_error *error);

/* resources.c: buffers and textures, counted. */
abbe_result abbe_renderer_make_buffer(abbe_renderer *r, size_t size, const void *data, GLuint *out,
                                      abbe_error *error);
abbe_result abbe_renderer_make_texture(abbe_renderer *r, GLenum format, size_t width, size_t height,
                                       size_t layers, bool linear, GLuint *out, abbe_error *error);
abbe_result abbe_renderer_set_target(abbe_renderer *r, const GLuint *colour, const int *layer,
                                     size_t count, GLuint depth, size_t width, size_t height,
                                     abbe_error *error);
void abbe_renderer_bind_texture(abbe_renderer *r, GLuint program, const char *name, int unit,
                                GLuint texture);
void abbe_renderer_bind_texture_2d(abbe_renderer *r, GLuint program, const char *name, int unit,
                                   GLuint texture);
/* A buffer of `size` bytes that shaders read as texels of `format`, and its texture, at a unit of its
 * own; what *buffer was is deleted, *texture is made where it is 0. */
abbe_result abbe_renderer_make_texels(abbe_renderer *r, GLenum format, size_t size,
                                      const void *data, int unit, GLuint *buffer, GLuint *texture,
                                      abbe_error *error);
/* A buffer whose elements a shader reads as texels. */
void abbe_renderer_bind_texels(abbe_renderer *r, GLuint program, const char *name, int unit,
                               GLenum format, GLuint buffer);
void abbe_renderer_set_int(abbe_renderer *r, GLuint program, const char *name, int value);
void abbe_renderer_set_float(abbe_renderer *r, GLuint program, const char *name, double value);
void abbe_renderer_bind_tables(abbe_renderer *r);
void abbe_renderer_dispatch_2d(abbe_renderer *r, size_t width, size_t height);
void abbe_renderer_draw(abbe_renderer *r, size_t object);
void abbe_renderer_begin_pass(abbe_renderer *r);
void abbe_renderer_end_pass(abbe_renderer *r, abbe_pass pass);

/* light_pass.c: the light's views, their layers, and the photons. */
abbe_result abbe_renderer_make_light(abbe_renderer *r, abbe_error *error);
/* A light's map around all receivers, before it is fitted to the landings. */
void abbe_renderer_whole_map(const abbe_renderer *r, size_t light, abbe_map_layout *out);
abbe_result abbe_renderer_light_layers(abbe_renderer *r, abbe_error *error);
/* Moves the photon grid by the request's part of a cell; what is lit stays in the window. */
void abbe_renderer_shift_cells(abbe_renderer *r, size_t light);
void abbe_renderer_set_grid(abbe_renderer *r, GLuint program, size_t light);
abbe_result abbe_renderer_place_photons(abbe_renderer *r, size_t light, GLuint coverage,
                                        int coverage_layer, abbe_error *error);
/* A photon for each placed cell that is lit and shows a refractor, in some part. */
abbe_result abbe_renderer_start_photons(abbe_renderer *r, size_t light, abbe_error *error);

/* photon_pass.c: photons to the spectral map. */
abbe_result abbe_renderer_make_photons(abbe_renderer *r, abbe_error *error);
abbe_result abbe_renderer_photons(abbe_renderer *r, abbe_render_progress progress, void *user,
                                  abbe_error *error);
abbe_result abbe_renderer_read_ledger(abbe_renderer *r, size_t light, abbe_ledger *ledger,
                                      abbe_error *error);
/* The batch's landings, from wavelength `first` on, zero where there is none, and their paths (may
 * be NULL); malloc'd. */
abbe_result abbe_renderer_read_batch(abbe_renderer *r, size_t light, size_t first, float **data,
                                     GLuint **paths, abbe_error *error);
void abbe_renderer_trace_batch(abbe_renderer *r, size_t light, size_t first, size_t count,
                               size_t ledger_first);

/* map_fit.c: windows and warps of maps by where light lands, on FIT_BINS steps of x, then of y. */
enum { FIT_BINS = 1 << 15 };
/* Flux that landings are counted in whole parts of. */
double abbe_renderer_part_of(const float *landing, size_t count);
/* Adds landings in the map to the histogram; returns their flux, all in parts. */
double abbe_renderer_sort_landings(const abbe_renderer *r, size_t light, const float *landing,
                                   const GLuint *path, size_t count, double part,
                                   double *histogram);
void abbe_renderer_fit_axes(light_state *state, const double *histogram, double total);

/* receiver_pages_pass.c: which lights have maps on receivers, and where. */
/* Before the photons' shaders are made, where the plan asks for pages. */
abbe_result abbe_renderer_expect_pages(abbe_renderer *r, abbe_error *error);
/* Sorts one batch of landings in as long as the pages are yet to be chosen, fluxes in whole parts;
 * light: of both sides of each chart, made where it is NULL. */
abbe_result abbe_renderer_sort_pages(const abbe_renderer *r, const float *landing,
                                     const GLuint *path, size_t count, double part,
                                     abbe_page_light **light, abbe_error *error);
/* What landed on charts beside `held`, what landed in the map: sets the light's pages.
 * ABBE_UNSUPPORTED where they leave out more than --share allows, with the receiver's name. */
abbe_result abbe_renderer_choose_pages(abbe_renderer *r, size_t light,
                                       abbe_page_light *const *found, double held,
                                       abbe_error *error);
/* All lights' pages are chosen: their table, or shaders without. */
abbe_result abbe_renderer_keep_pages(abbe_renderer *r, abbe_error *error);
/* Of landings as the device keeps them, LANDING_BYTES each, places and fluxes side by side; those
 * on pages come to texels and the page's number. `words` of a signature. */
void abbe_renderer_place_landings(const abbe_renderer *r, size_t light, float *landing,
                                  const GLuint *signature, size_t words, size_t count);
/* Whether a landing of that path lies on a page. */
bool abbe_renderer_is_on_page(const abbe_renderer *r, GLuint path);
/* Of a mesh, on the rectangle that bounds its chart. */
void abbe_renderer_page_place(const abbe_renderer *r, size_t light, const float *landing,
                              double out[3]);
void abbe_renderer_free_pages(abbe_renderer *r);

/* renderer.c: the map's texture, with a layer for each light that has pages. */
abbe_result abbe_renderer_make_map(abbe_renderer *r, abbe_error *error);

/* band_attenuation.c: what is left of light in parts of its band, where landings keep lengths. */
/* Of the coarse set and of all wavelengths, where it is not all of them. */
abbe_result abbe_renderer_upload_attenuation(abbe_renderer *r, const abbe_wavelengths *coarse,
                                             const abbe_wavelengths *all, abbe_error *error);
/* Of a landing's signature, with the length of its way where it is kept. */
size_t abbe_renderer_signature_bytes(const abbe_renderer *r);
/* A batch's landings from wavelength `first` on, as read: takes off what is absorbed at their
 * nodes, and leaves paths alone in `signature`. */
void abbe_renderer_attenuate(const abbe_renderer *r, size_t first, size_t count, float *landing,
                             GLuint *signature);

/* photon_refine.c: which photons take which wavelengths. */
typedef enum trace_set { TRACE_ALL, TRACE_COARSE, TRACE_REFINED } trace_set;
/* Index among all wavelengths of node k of so many. */
size_t abbe_renderer_coarse_node(size_t wavelengths, size_t nodes, size_t k);
bool abbe_renderer_refines(const abbe_renderer *r);
/* What a refined interval's landings need; after the landings' own buffers. */
abbe_result abbe_renderer_make_refinement(abbe_renderer *r, size_t most_photons, abbe_error *error);
abbe_result abbe_renderer_make_refining_programs(abbe_renderer *r, const char *defines,
                                                 abbe_error *error);
void abbe_renderer_trace_coarse(abbe_renderer *r, size_t light);
/* How many intervals ask, of those photons in one chunk. The coarse set is traced by then. */
size_t abbe_renderer_count_pairs(abbe_renderer *r, size_t light);
/* Lists and traces one chunk's refined intervals. */
void abbe_renderer_trace_refined(abbe_renderer *r, size_t light, size_t chunk);
void abbe_renderer_free_refinement(abbe_renderer *r);

/* Sets the trace up, and clears what it lists. */
void abbe_renderer_begin_trace(abbe_renderer *r, size_t light, trace_set set, size_t count);
/* Lists the paths of so many photons or refined intervals that the trace between the two has
 * marked. */
void abbe_renderer_end_trace(abbe_renderer *r, trace_set set, size_t items);
void abbe_renderer_dispatch_list(abbe_renderer *r, GLuint program, GLuint list, size_t most,
                                 size_t threads);
void abbe_renderer_clear_buffer(abbe_renderer *r, GLuint buffer);

/* cell_fit.c: photon grids no finer than the maps can tell. */
abbe_result abbe_renderer_fit_cells(abbe_renderer *r, size_t light, abbe_error *error);

/* eye_pass.c: the picture. */
void abbe_renderer_fit_eye(abbe_renderer *r);
/* Of the picture, across or up; they cover it, and less than one of them more. */
size_t abbe_renderer_samples(const abbe_renderer *r, int axis);
abbe_result abbe_renderer_make_eye(abbe_renderer *r, abbe_error *error);
abbe_result abbe_renderer_eye(abbe_renderer *r, abbe_render_progress progress, void *user,
                              abbe_error *error);
void abbe_renderer_set_lighting(abbe_renderer *r, GLuint program);

/* thesis.c: the thesis profile's own passes. */
abbe_result abbe_renderer_make_thesis(abbe_renderer *r, abbe_error *error);
abbe_result abbe_renderer_thesis_frame(abbe_renderer *r, abbe_error *error);
GLuint abbe_renderer_thesis_map(const abbe_renderer *r, bool filled);
void abbe_renderer_free_thesis(abbe_renderer *r);

#endif
