/* models.h: by which model light goes through refractors, through media that scatter, and to
 * receivers.
 *
 * What light does not notice is no refractor. Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_MODELS_H
#define ABBE_GL_PLAN_EXAMINE_MODELS_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* Lists the scene's refractors in the plan, each with its model, and what their materials require
 * of the wavelengths. ABBE_UNSUPPORTED, by the object's name, where a model that is requested
 * cannot serve it, or for more than 255 of them; ABBE_OUT_OF_RANGE for an index that is not known.
 */
abbe_result abbe_refractor_model_choose(const abbe_scene *scene, abbe_plan *plan,
                                        abbe_error *error);

/* The number of the film on each of a convex solid's planes, as coatings have it; film may be NULL.
 * False where a plane has faces of different films: then that of one. */
bool abbe_refractor_films(const abbe_object *object, uint8_t *film);

/* Whether the object's films are on some of its faces that no model but the BVH tells apart. */
bool abbe_refractor_films_by_face(const abbe_object *object);

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

#endif
