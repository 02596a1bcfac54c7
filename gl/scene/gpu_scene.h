/* gpu_scene.h: the scene on the device, as the plan needs it: meshes, tables, triangles to be
 * traversed, shadows' planes. Every pass reads it as const. Internal to gl/. */
#ifndef ABBE_GL_SCENE_GPU_SCENE_H
#define ABBE_GL_SCENE_GPU_SCENE_H

#include "base/error.h"
#include "colorimetry/rgb_space.h"
#include "gl/device/gpu.h"
#include "gl/plan/facts/render_desc.h"
#include "gl/plan/plan.h"
#include "gl/scene/spectra/spectral_tables.h"
#include "scenes/environment/radiance_map.h"
#include "scenes/mesh/bvh.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rays meeting the triangles of hierarchies on the processor's own threads, as
 * hierarchy.glsl does on the device: of the same triangles the same are met. */

enum { ABBE_RAY_CHILDREN = 8 };

/* Box and cone of normals of each child, and what it leads to: a node, or the complement of a
 * leaf's first triangle << 3 | count. A missing child's box is empty. */
typedef struct abbe_ray_node {
  float low[3][ABBE_RAY_CHILDREN], high[3][ABBE_RAY_CHILDREN];
  float axis[3][ABBE_RAY_CHILDREN], sine[ABBE_RAY_CHILDREN];
  int32_t child[ABBE_RAY_CHILDREN], count;
} abbe_ray_node;

typedef struct abbe_ray_trees {
  abbe_ray_node *node;
  size_t count, capacity;
} abbe_ray_trees;

/* Adds the tree at texel `root` of nodes as abbe_bvh_nodes_pack() makes them; *at: its node.
 * ABBE_NO_MEMORY. */
abbe_result abbe_ray_trees_add(abbe_ray_trees *trees, const uint32_t (*texel)[4], size_t root,
                               size_t *at, abbe_error *error);
void abbe_ray_trees_free(abbe_ray_trees *trees);

/* Rays that meet triangles together: nodes are read once for all of them, so neighbours cost least.
 * side 1: only triangles that the ray meets against their normal, -1: along it. t_min: from where
 * on. t, u, v, triangle: what it meets, as hierarchy.glsl has it; up to t. */
enum { ABBE_RAYS = 8 };

typedef struct abbe_rays {
  _Alignas(64) float o[3][ABBE_RAYS];
  float d[3][ABBE_RAYS], side[ABBE_RAYS], t_min[ABBE_RAYS];
  float t[ABBE_RAYS], u[ABBE_RAYS], v[ABBE_RAYS];
  int32_t triangle[ABBE_RAYS];
} abbe_rays;

/* The nearest triangle of the tree at node `root` with t_min < t on each ray of `mask`, which it is
 * given where it is nearer than t. triangle: a corner and two edges each. */
void abbe_ray_trees_meet(const abbe_ray_trees *trees, size_t root, const float (*triangle)[4],
                         unsigned mask, abbe_rays *rays);

/* The charts of a plan's receivers, numbered through.
 *
 * Parallelograms come first, as the shaders count them, then the charts of meshes
 * (scenes/mesh/mesh.h). It knows no light and no GL. */

typedef struct abbe_receiver_charts {
  size_t count;
  double (*parallelogram)[9]; /* [count] corner, U, V */
  size_t *object;             /* [count] the scene's */
  size_t face_count;
  size_t *face_first; /* [receiver_count + 1] of each receiver among all faces */
  int32_t *face_side; /* [face_count] 2 * chart, + 1 where the face's normal points against U x V */
} abbe_receiver_charts;

/* ABBE_NO_MEMORY, ABBE_UNSUPPORTED for more faces or charts than can be numbered. */
abbe_result abbe_receiver_charts_make(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_receiver_charts *out, abbe_error *error);
void abbe_receiver_charts_free(abbe_receiver_charts *charts);

/* What is around a scene, on the device: a texture by longitude and latitude, a cube with levels
 * for rays that stand for many directions, and irradiance by normal of what the scene's lights
 * leave of it. */

typedef struct abbe_gpu_environment {
  GLuint texture;    /* W/(m2 sr); 0: there is none */
  GLuint cube;       /* the same, texels about as wide, and means over wider ones */
  GLuint soft_light; /* W/m2, by the nodes of an abbe_irradiance_map */
} abbe_gpu_environment;

/* Makes the environment of a scene with lights for it (environment_lights.h), over the request's
 * range, for its observer, in `space`; zeros where the scene has none. ABBE_GL, ABBE_NO_MEMORY,
 * errors of abbe_upsampling_make_by. */
abbe_result abbe_gpu_environment_make(abbe_gpu *gpu, const abbe_scene *scene, abbe_rgb_space space,
                                      const abbe_render_desc *desc, abbe_gpu_environment *out,
                                      abbe_error *error);
/* To `space` from the RGB of an environment, which is relative to its illuminant; row-major. Errors
 * of abbe_upsampling_make_by. */
abbe_result abbe_gpu_environment_colours(const abbe_illuminant *illuminant, abbe_rgb_space space,
                                         const abbe_render_desc *desc, double matrix[9],
                                         abbe_error *error);
/* A cube's levels with borders, by the matrix, as cube_mean.glsl looks them up. ABBE_GL,
 * ABBE_NO_MEMORY. */
abbe_result abbe_gpu_environment_cube(abbe_gpu *gpu, const abbe_radiance_cube *cube,
                                      const double matrix[9], GLuint *out, abbe_error *error);
void abbe_gpu_environment_free(abbe_gpu *gpu, abbe_gpu_environment *environment);

/* Into the program that is in use, where it reads it. `unit`: W in one of the scene's lights. */
void abbe_gpu_environment_set(abbe_gpu *gpu, const abbe_scene *scene,
                              const abbe_gpu_environment *environment, double unit, GLuint program);

/* OpenGL promises uniform blocks of 16 KiB; every desktop driver, llvmpipe too, has 64. */
enum { ABBE_GPU_BLOCK_BYTES = 65536 };

typedef struct abbe_gpu_mesh {
  GLuint array, vertices, indices;
  GLsizei index_count;
  size_t bytes;  /* of vertices and indices */
  GLuint coarse; /* indices of fewer triangles, once they were asked for; 0: there are none */
  GLsizei coarse_count;
  bool coarse_known;
} abbe_gpu_mesh;

/* A row of the shaders' block of shadows. */
typedef union abbe_gpu_shadow_row {
  int range[4]; /* first plane of each light and refractor, and how many */
  float plane[4];
} abbe_gpu_shadow_row;

typedef struct abbe_gpu_scene {
  abbe_gpu *gpu;
  const abbe_scene *local; /* whose coordinates all below are in */
  double unit;             /* its lights are in so many W; the environment is in W */
  const abbe_plan *plan;
  const abbe_map_layout *map_layout; /* the plan's, in these coordinates; NULL: none is given */
  abbe_receiver_charts charts;       /* where the plan has tiles, or pinhole tiles of meshes */

  double min[3], max[3], size; /* bounds of all objects, m, and their diagonal */
  double refractor_centre[3], refractor_radius;
  float rgb_from_xyz[9], xyz_from_rgb[9]; /* column-major, for uniforms */
  abbe_spectral_tables tables;

  abbe_gpu_mesh *mesh; /* [mesh_count], of each object */
  size_t mesh_count;
  size_t mesh_bytes; /* bytes of their vertices and faces */
  GLuint refractors, planes, receivers, surfaces, reflections, spectra, bands, shadows;
  GLuint surface_texture;
  GLuint band_texels, band_texels_texture; /* of camera_bands.h */
  GLuint film_texels, film_texels_texture; /* the same; 0: no films are drawn */
  GLuint band_reflections;                 /* 0: no dispersed light falls on receivers in colours */
  abbe_gpu_environment environment;
  size_t band_count, band_levels; /* for one refractor: samples, and samples joined by twos */

  GLuint bvh[3], bvh_texture[3]; /* nodes, triangles, corners; 0: no model needs them */
  size_t *refractor_root;        /* [refractor_count] of its tree */
  size_t receiver_root;          /* root of the tree of all receivers that are traversed */
  size_t bvh_depth;
  abbe_ray_trees trees;   /* of refractors, where a processor runs the shaders */
  size_t *refractor_tree; /* [refractor_count] */
  /* [(light views + 1) x bands]: rgb of each light of unit power, last of the scene's illuminant */
  float haze_white[(ABBE_SCENE_MAX_LIGHTS + 1) * ABBE_PLAN_HAZE_BANDS][3];

  /* All ranges, all planes, and with lights of some width that of each's penumbra. */
  abbe_gpu_shadow_row *shadow_row;
  size_t shadow_planes; /* 0: none, or more than a block holds: faces are asked one by one */
} abbe_gpu_scene;

/* Parts of it, that may be made anew by themselves; a set of them is a sum of bits. */
enum {
  ABBE_SCENE_GEOMETRY = 1, /* meshes, planes, triangles to be traversed, receivers, charts */
  ABBE_SCENE_SURFACES = 2, /* reflectances and textures */
  ABBE_SCENE_SPECTRA = 4,  /* tables over wavelength */
  ABBE_SCENE_SHADOWS = 8,  /* planes of refractors' shadows: of geometry and lights */
  ABBE_SCENE_ALL = 15
};

/* Begins with this scene and plan: measures them, makes nothing. */
void abbe_gpu_scene_begin(abbe_gpu *gpu, const abbe_scene *local, double unit,
                          const abbe_plan *plan, const abbe_map_layout *map_layout,
                          abbe_gpu_scene *out);
/* Parts that are not there, or that were freed. Errors as of abbe_renderer_make. */
abbe_result abbe_gpu_scene_make(abbe_gpu_scene *scene, unsigned parts, abbe_error *error);
void abbe_gpu_scene_free(abbe_gpu_scene *scene, unsigned parts);

/* Every table where the shaders expect it. */
void abbe_gpu_scene_bind(const abbe_gpu_scene *scene);
/* The scene's uniforms and textures, into the program that is in use. */
void abbe_gpu_scene_set(const abbe_gpu_scene *scene, GLuint program);

/* gpu_environment.c: disks and rectangles, as rays meet them; of: the number from 1 of the one that
 * a light is a point of, 0: none. */
size_t abbe_gpu_area_lights_count(const abbe_gpu_scene *scene);
size_t abbe_gpu_area_lights_of(const abbe_gpu_scene *scene, size_t light);
void abbe_gpu_area_lights_set(const abbe_gpu_scene *scene, GLuint program);

/* gpu_meshes.c */
void abbe_gpu_meshes_draw(const abbe_gpu_scene *scene, size_t object);
/* By fewer triangles where that saves half of them (scenes/mesh/mesh.h). */
void abbe_gpu_meshes_draw_coarse(const abbe_gpu_scene *scene, size_t object);
abbe_result abbe_gpu_meshes_upload(abbe_gpu_scene *scene, abbe_error *error);
/* Uploads one mesh by itself. */
abbe_result abbe_gpu_mesh_upload(const abbe_gpu_scene *scene, const abbe_mesh *mesh,
                                 abbe_gpu_mesh *out, abbe_error *error);
void abbe_gpu_mesh_free(const abbe_gpu_scene *scene, abbe_gpu_mesh *mesh);
void abbe_gpu_meshes_free(abbe_gpu_scene *scene);

/* gpu_spectra.c: n, attenuation and bands of every refractor at all wavelengths, from the tables.
 * Capacity: elements of a buffer that holds so many, so that tables of like size share programs. */
size_t abbe_gpu_spectra_room(size_t count);
abbe_result abbe_gpu_spectra_upload(abbe_gpu_scene *scene, abbe_error *error);

/* gpu_haze.c: media by bands of the spectrum; make is a part of abbe_gpu_scene_begin. */
void abbe_gpu_haze_make(abbe_gpu_scene *scene);
void abbe_gpu_haze_set(const abbe_gpu_scene *scene, GLuint program);

/* gpu_surfaces.c: textures, what every receiver reflects of every light, and the environment.
 * reflections: rows of the table of these, three a matrix; the plan's facts decide it. */
size_t abbe_gpu_surfaces_reflections(const abbe_gpu_scene *scene);
abbe_result abbe_gpu_surfaces_upload(abbe_gpu_scene *scene, abbe_error *error);

/* One material, and a crystal's axes lie alike: else there is a face between them. */
bool abbe_gpu_scene_same_stuff(const abbe_object *a, const abbe_object *b);

/* gpu_bvh.c: the triangles of what is traversed. */
abbe_result abbe_gpu_bvh_make(abbe_gpu_scene *scene, abbe_error *error);

/* gpu_shadows.c: the planes of convex refractors' shadows. */
abbe_result abbe_gpu_shadows_make(abbe_gpu_scene *scene, abbe_error *error);
void abbe_gpu_shadows_free(abbe_gpu_scene *scene);
/* Of the part of a light that a point stands for, as a disk, m; of a directional light the tangent
 * of the angle. 0 of lights without a size. */
double abbe_gpu_shadows_radius(const abbe_light *light);
/* Whether that of some light of the scene is above 0. */
bool abbe_gpu_shadows_soft(const abbe_gpu_scene *scene);

/* Linear Rec.709, as scene files have it, to the space that the shaders work in. */
void abbe_gpu_scene_to_working(const abbe_gpu_scene *scene, const double rgb[3], double out[3]);
abbe_rgb_space abbe_gpu_scene_working_space(const abbe_gpu_scene *scene);

/* A hierarchy over triangles as the shaders traverse it (hierarchy.glsl).
 *
 * Boxes stand on a grid of 16 bits over the tree, rounded outwards, and each with a cone that
 * holds the normals below it: a ray that looks for faces of one side alone leaves out what shows
 * it the other, and so what it starts from. It knows nothing of GL. */

/* Texels of four words: two for the tree, then three for each inner node. */
size_t abbe_bvh_nodes_count(const abbe_bvh *bvh);

/* triangle: as the hierarchy was made from. The texels are the first_texel'th and following of
 * the buffer that the shaders read, the triangles, in the hierarchy's order, the first_triangle'th
 * and following; those end below 2^28, texels below 2^31. The root is first_texel.
 *
 * Tree: lowest grid point in x, y, z and, as bits, what the root leads to; width of a grid cell in
 * x, y, z. Inner node: for each of two children, its box (low | high << 16 a word, in x, y, z) and
 * what it leads to; then its cone twice, axis and sine of the half angle, snorm16: x | y << 16, z |
 * sine << 16; a sine of one leaves nothing out. Leads to: an inner node's first texel, or the
 * complement of a leaf's first triangle << 3 | count. ABBE_NO_MEMORY, ABBE_CANCELLED by the
 * thread's watch. */
abbe_result abbe_bvh_nodes_pack(const abbe_bvh *hierarchy, const double (*triangle)[9],
                                size_t first_texel, size_t first_triangle, uint32_t (*out)[4],
                                abbe_error *error);

/* The shadow of a convex solid in a light without size, as planes.
 *
 * What lies in shadow is itself convex: it lies behind every face that the light is in front of,
 * and within the planes through the light and the outline that the light sees. So a place is asked
 * a few products instead of where its ray to the light meets each face. Places in the solid count
 * as in shadow; what else stands in the light is not looked at. */

/* The solid n . x < d of `count` planes, unit n, with a place strictly inside. A place x is in the
 * light's shadow where n . x' < d for all planes of `out`, n of length 1; x' is x from the light's
 * position, or for a directional one x itself. There are the planes of the outline and, if `faces`,
 * those of the lit faces: without them places between the solid and the light count as in shadow
 * too. One plane that holds for no place where the light is in front of no face, as for a light
 * inside. edge . (x', 1), where x lies on a plane of the outline: how far behind the solid's edge
 * x is along its ray, over that edge's distance from the light, or in metres for a directional one;
 * of other planes `edge` is 0. Capacity of out and edge: twice `count`, and one. ABBE_NO_MEMORY;
 * what is found is *found. */
abbe_result abbe_shadow_planes_make(const double (*plane)[4], size_t count, const double inside[3],
                                    const abbe_light *light, bool faces, double (*out)[4],
                                    double (*edge)[4], size_t *found, abbe_error *error);

/* Whether some part of the object may lie between a convex object and the light: false only where a
 * plane, the object's own or across an axis, has the object on one side and those two on the other,
 * up to 1e-6 of the convex object's size. */
bool abbe_shadow_planes_in_front(const abbe_object *convex, const abbe_light *light,
                                 const abbe_object *object);

#endif
