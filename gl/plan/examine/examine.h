/* examine.h: what the plan finds out of a scene, part by part: what light may reach and from where
 * refractors are seen, by which models they are followed, what their materials require of the
 * wavelengths, how much light stays inside, and what is not modelled and so refused. Internal to
 * gl/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_EXAMINE_H
#define ABBE_GL_PLAN_EXAMINE_EXAMINE_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

/* What light, a view ray or another object may meet, to judge by bounds.
 *
 * Judged by the object's bounds, and never wrongly no: what stands in between is not looked at. */

/* False where the light is a spot whose cone misses the ball around the object's bounds. */
bool abbe_reach_light(const abbe_light *light, const abbe_object *object);

/* False where no part of the box around `behind` lies in the shadow of the object's ball: within
 * the square pyramid (a prism for a directional light) around it from the light, and no nearer than
 * the ball begins. Light that goes on nearly straight through the object then meets nothing there.
 */
bool abbe_reach_through(const abbe_light *light, const abbe_object *object,
                        const abbe_object *behind);

/* False where the box around the object is behind the camera or beside a picture of width x height
 * pixels and one pixel more all round. */
bool abbe_reach_eye(const abbe_camera *camera, size_t width, size_t height,
                    const abbe_object *object);

/* Whether two refractors may overlap. */
bool abbe_reach_overlap(const abbe_object *a, const abbe_object *b);

/* Whether a receiver may reach into a refractor; whether some of the scene's may. */
bool abbe_reach_into(const abbe_object *receiver, const abbe_object *refractor);
bool abbe_reach_is_entered(const abbe_scene *scene, const abbe_object *refractor);

/* Whether their bounds are nearer to one another than the refractor's are long. */
bool abbe_reach_is_near(const abbe_object *receiver, const abbe_object *refractor);

/* Signed distance of a point from the plane of a parallelogram (corner, edges u and v), m. */
double abbe_reach_side(const double parallelogram[9], const double at[3]);

/* From where refractors are seen: which lights and whether the camera meet them, in
 * how many views. */

/* Which lights and whether the camera may meet a refractor; what none of them meets takes no light
 * and costs nothing. */
void abbe_light_views_reach(const abbe_scene *scene, abbe_plan *plan);

/* A view of each light around all refractors or, where none holds them, views through the faces of
 * a cube; which receivers lie outside. ABBE_UNSUPPORTED where the thesis would need a cube, all
 * lights together more views than there are maps, or a seam would cut a mesh known by its layers.
 */
abbe_result abbe_light_views_choose(const abbe_scene *scene, abbe_plan *plan, abbe_error *error);

/* The view of the light around all refractors. False where it does not hold them all; `off`: the
 * first that it does not (may be NULL). */
bool abbe_light_views_fit(const abbe_scene *scene, const abbe_light *light, const abbe_plan *plan,
                          abbe_view *out, size_t *off);

/* The six square pyramids that share out the directions around a point among them.
 *
 * A point light whose refractors do not fit one view looks through some of these. Faces are
 * numbered +x, -x, +y, -y, +z, -z, along the world's axes. Every direction belongs to exactly one
 * (the shaders' cube_face in view.glsl is the same rule). This knows where objects lie; it knows
 * no GL. */

#define ABBE_LIGHT_CUBE_FACES 6
#define ABBE_LIGHT_CUBE_ALL 63u /* a bit a face */

/* That of the greatest of |x|, |y|, |z|; of equal ones, the first. */
int abbe_light_cube_face(const double direction[3]);

/* An empty view from origin along the face's axis. */
void abbe_light_cube_look(const double origin[3], int face, abbe_view *out);

/* Grows the window of a view made by abbe_light_cube_look around the part of the object that lies
 * in the face's pyramid; never beyond -1 to 1. False, and nothing done, where it has no part there.
 */
bool abbe_light_cube_fit(abbe_view *view, const abbe_object *object);

/* Faces through which the light may reach the object, a bit each; what stands in between is not
 * looked at. A spot's cone leaves faces out that lie beside it. */
unsigned abbe_light_cube_reached(const abbe_light *light, const abbe_object *object);

/* The part of the picture in which a light may fall on a receiver.
 *
 * A narrow light leaves most of a picture dark, and there no shader needs it. This bounds what a
 * view of the light holds of a parallelogram by a rectangle of the picture; what hides it from
 * either is not looked at. */

/* Widest cone that has a view of its own, radians off its axis. */
#define ABBE_LIT_WINDOW_MAX_CONE 1.2

/* A view around a spot's cone. False for a cone that is wider, and for another kind of light, which
 * may reach everything. Near and far are not set. */
bool abbe_lit_window_cone(const abbe_light *light, abbe_view *out);

/* The rectangle around those of width x height pixels of the camera's window that show something of
 * the parallelogram (corner, U, V) within the window of the light's view: left, bottom, right, top;
 * right and top excluded. Two pixels wider on every side. False where there are none. */
bool abbe_lit_window(const abbe_view *light, const abbe_view *eye, const double parallelogram[9],
                     size_t width, size_t height, int out[4]);

/* By which model light goes through refractors, through media that scatter, and to
 * receivers.
 *
 * What light does not notice is no refractor. */

/* Lists the scene's refractors in the plan, each with its model, and what their materials require
 * of the wavelengths. ABBE_UNSUPPORTED, by the object's name, where a model that is requested
 * cannot serve it, or for more than 255 of them; ABBE_OUT_OF_RANGE for an index that is not known.
 */
abbe_result abbe_refractor_model_choose(const abbe_scene *scene, abbe_plan *plan,
                                        abbe_error *error);

/* The number of the film on each of a convex solid's planes, as coatings have it; film may be NULL.
 * False where a plane has faces of different films: it is bare then. */
bool abbe_refractor_films(const abbe_object *object, uint8_t *film);

/* Notes what is left out where light is not followed from one to another. */
void abbe_refractor_model_note(const abbe_scene *scene, abbe_plan *plan);

/* What the renderer makes of media that scatter: one number each for all wavelengths in the air
 * and around the camera, and what it leaves out. */

/* Fills the plan's facts; of a scene without haze nothing. */
void abbe_haze_model_choose(const abbe_scene *scene, abbe_plan *plan);
/* Its entry and notes, when all other facts are known. */
void abbe_haze_model_note(const abbe_scene *scene, abbe_plan *plan);

/* How light and the camera meet receivers, and whether one may hide another. */

/* Parallelograms as they come, up to the capacity; triangles of all others. */
void abbe_receiver_model_choose(const abbe_scene *scene, abbe_plan *plan);

/* Receivers that bound a convex space with the lights inside cannot shadow one another. */
void abbe_receiver_model_shadows(const abbe_scene *scene, abbe_plan *plan);

/* Whether what it reflects varies over wavelength: that of a texture may. */
bool abbe_receiver_model_is_coloured(const abbe_object *object);

/* Whether light that refractors have spread may fall on a receiver in colours. */
bool abbe_receiver_model_disperses(const abbe_scene *scene, const abbe_plan *plan);

/* Whether single precision and the photon grid resolve a scene's refractors.
 *
 * Shaders compute in floats, and photons are the cells of a grid. A refractor that is lost in
 * either would be drawn wrong or by chance; it is refused with what would be right. Receivers are
 * not judged. */

/* ABBE_UNSUPPORTED, with a sentence, where some refractor of the plan is so far from a light that
 * its shape is lost (65536 of its radii), so thin that its front and back are one (2^-20 of that
 * distance), or, of the grid of four photons a side or more, less than half a cell wide; or where a
 * light with a cube of views is nearer to one than 1/4096 of half its diagonal. Default profile
 * only. */
abbe_result abbe_precision_check(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* What index, attenuation and light over the wavelengths require of the plan.
 *
 * What varies, how many wavelengths that takes, and what is extrapolated or taken for one. */

/* A refractor's material over the range: whether its index varies, whether it attenuates, and that
 * by wavelength; ABBE_OUT_OF_RANGE where its index is not known, and a note where what is seen of
 * it is extrapolated. Before the material's first refractor is added. */
abbe_result abbe_spectral_needs_examine(const abbe_scene *scene, const abbe_material *material,
                                        abbe_plan *plan, abbe_error *error);

/* A mirror's reflectance over the range: whether it varies; what it reflects, as a sentence's part
 * into `text`. ABBE_OUT_OF_RANGE where its metal is not known over all of it. */
abbe_result abbe_spectral_needs_mirror(const abbe_object *mirror, abbe_plan *plan, char *text,
                                       size_t size, abbe_error *error);

/* How many wavelengths, where the request leaves it open, and why. */
void abbe_spectral_needs_count(const abbe_scene *scene, abbe_plan *plan);
enum { ABBE_PLAN_MOST_LINES = 32 };
/* Lines of the scene's lights from min_nm to max_nm, ascending; how many. 0 where a light, or the
 * surroundings, have others than lines, or there are too many. */
size_t abbe_spectral_needs_lines(const abbe_scene *scene, double min_nm, double max_nm,
                                 double lambda_nm[ABBE_PLAN_MOST_LINES]);

/* A note where lights of several spectra are taken for one. */
void abbe_spectral_needs_note(const abbe_scene *scene, abbe_plan *plan);

/* What refractors and mirrors take of light by wavelength, as photons' hits keep it: of each of
 * the first stuffs on a path how much it passed, which gives the rest at all wavelengths.
 *
 * An amount is a path inside, m, or of a mirror one for each reflection straight on; attenuation
 * is optical depth by amount. */

/* Stuffs whose amounts a hit keeps. */
enum { ABBE_MOST_TINTS = 3 };

/* Attenuation by surface s (abbe_plan_surfaces), by amount; at most what leaves nothing, so that
 * sums stay finite. */
double abbe_tint_attenuation(const abbe_scene *scene, const abbe_plan *plan, size_t s,
                             double lambda_nm);

/* The first of the plan's surfaces that is of the same stuff as s; -1: it absorbs all wavelengths
 * alike, or is a pleochroic refractor's mean. A metre of a pleochroic crystal is shared among its
 * axes (crystals.glsl). */
int abbe_tint_of(const abbe_scene *scene, const abbe_plan *plan, size_t s);
/* The number of all stuffs, ABBE_MOST_TINTS at the most. */
size_t abbe_tint_count(const abbe_scene *scene, const abbe_plan *plan);

/* Between what a material's index and attenuation lie over a range of wavelengths.
 *
 * Where the plan reads n(lambda) and attenuation, and nowhere else: whether something varies,
 * whether light notices it at all, and one value that stands for all of it. */

typedef struct abbe_material_range {
  double least_n, most_n;
  double least_per_m, most_per_m; /* attenuation */
  double middle_n, middle_per_m;  /* at the range's middle */
} abbe_material_range;

/* At 81 wavelengths from min_nm to max_nm, and at their mean. ABBE_OUT_OF_RANGE where the index is
 * not known. */
abbe_result abbe_material_range_make(const abbe_material *material, double min_nm, double max_nm,
                                     abbe_material_range *out, abbe_error *error);

/* Whether an attenuation, 1/m, loses anything over a hundred times what is there: less than that is
 * a share of 1 in the shaders' floats. */
bool abbe_absorption_shows(const abbe_scene *scene, double per_m);

/* How much light a convex faceted solid keeps inside, exit by exit.
 *
 * Rays of a grid over the solid, from a light or from the camera, followed in double precision at
 * one wavelength by Snell's and Fresnel's laws. No receivers, no colours, nothing random: the same
 * scene gives the same figures. The plan takes exits by them; no picture is made of them. */

/* The share of light, by which a plan chooses exits, that may stay inside, and its share that may
 * do so in paths that have become faint. */
#define ABBE_INNER_LIGHT_MOST 0.005
#define ABBE_INNER_LIGHT_MOST_FAINT 0.0025

/* Shares of the light that meets the solid, by exits, 1 to ABBE_RENDER_MAX_EXITS; [0]: what its
 * outside lets in, and 0. */
typedef struct abbe_inner_light {
  double kept[ABBE_RENDER_MAX_EXITS + 1];  /* inside after so many exits, in paths that go on */
  double faint[ABBE_RENDER_MAX_EXITS + 1]; /* in paths that have ended by then, below the share */
} abbe_inner_light;

/* The light through a view's window that meets the solid (ABBE_EXACT_CONVEX), of index n and an
 * attenuation in 1/m; a path ends where less than energy_share of its light is left. Light from
 * `light`, by its profile, or from all directions of the window alike (NULL). False, and all zero,
 * where no ray brings light. */
bool abbe_inner_light_follow(const abbe_exact *solid, const abbe_view *view,
                             const abbe_light *light, double n, double attenuation_per_m,
                             double energy_share, abbe_inner_light *out);

/* The fewest exits, from least to most, after which no more than ABBE_INNER_LIGHT_MOST is inside,
 * where what faint paths keep counts up to ABBE_INNER_LIGHT_MOST_FAINT; most, where none are
 * enough.
 */
size_t abbe_inner_light_exits(const abbe_inner_light *inside, size_t least, size_t most);

/* Exits and the share at which paths end, written into plan->desc, for the plan's one refractor, a
 * convex solid that light leaves for good; what was requested stays (NULL: nothing was). By the
 * light that keeps most inside or, where no light meets the solid, by the camera; at the middle of
 * the wavelengths. Returns the share of the light that is then still inside. */
double abbe_inner_light_plan(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan);

/* How far light is followed through refractors, from a light and from the camera. */

/* Exits at the most, the share of its light at which a path ends, both of the camera's rays, and
 * the capacity for hits of a photon. asked: the request as it came, or NULL. The wavelengths are
 * counted. */
void abbe_path_limits_choose(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan);

/* What the renderer does not model, refused by name.
 *
 * Of scenes whose refractors single precision does not resolve, see gl/plan/examine/models.h. */

/* ABBE_UNSUPPORTED for a rough mirror but by the transport of pinholes in the default profile. */
abbe_result abbe_support_roughness(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error);
/* ABBE_UNSUPPORTED for a mirror where the thesis's profiles or the model 'layers' is asked for. */
abbe_result abbe_support_mirrors(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);
/* ABBE_UNSUPPORTED for a refractor that lies in another, or partly, where the model 'layers' is
 * asked for: by some of their vertices, so that a thin overlap may be let through. */
abbe_result abbe_support_nesting(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* What the transport by pinholes follows, in wand2003 and in the default profile: an environment,
 * and mirrors or refractors. ABBE_UNSUPPORTED. */
abbe_result abbe_support_pinholes(const abbe_scene *scene, const abbe_plan *plan,
                                  abbe_error *error);
/* ABBE_UNSUPPORTED for what a published method does not know, where it is asked for. */
abbe_result abbe_support_published(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error);

/* ABBE_UNSUPPORTED for what a volume of caustics does not hold, where one is asked for: other
 * objects that bend light, another shape; but of printed ones also lights that are near, that meet
 * a part of the object, or are of another colour. */
abbe_result abbe_support_volume(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* ABBE_UNSUPPORTED for a medium that scatters in a published method, and where light is looked up.
 */
abbe_result abbe_support_haze(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* ABBE_INVALID_ARGUMENT for a given map layout that is not the layout of its light's map. */
abbe_result abbe_support_layout(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

#endif
