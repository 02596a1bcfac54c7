#include "gl/plan/examine/examine.h"

#include "base/maths.h"

#include "scenes/geometry/digest.h"

#include <math.h>
#include <stdio.h>

enum { MAX_FOLLOWED = 32, MAX_REFRACTORS = 255, MAX_LISTED = 48 };

/* An index as near to air's as this bends no ray by more than that, a few grazing ones aside. */
static const double invisible = 2e-6;

static bool refractor_films_by_face(const abbe_object *object) {
  return object->coatings != NULL && object->coatings->face != NULL &&
         (object->exact.kind != ABBE_EXACT_CONVEX || !abbe_refractor_films(object, NULL));
}

/* Whether light goes through the object as through air: clear, of air's index, and no bubble; or a
 * cloud as through what is around it. */
static bool is_invisible(const abbe_scene *scene, const abbe_object *object,
                         const abbe_plan *plan) {
  abbe_material_range range;
  if (object->cloud) return !abbe_scene_is_hazy(scene);
  if (abbe_method_of(plan->desc.profile)->printed || object->medium != NULL ||
      object->coatings != NULL ||
      abbe_material_range_make(object->material, plan->desc.min_nm, plan->desc.max_nm, &range,
                               NULL) != ABBE_OK)
    return false;
  if (!(range.least_n >= 1 - invisible && range.most_n <= 1 + invisible) || range.most_per_m > 0)
    return false;
  for (size_t i = 0; i < scene->object_count; i++)
    if (&scene->object[i] != object &&
        abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR &&
        abbe_reach_overlap(&scene->object[i], object))
      return false;
  return true;
}

static bool is_convex(const abbe_mesh *mesh, abbe_plan_shape *known) {
  uint64_t of = abbe_digest_array(1, mesh->face, mesh->face_count, sizeof *mesh->face);
  of = abbe_digest_array(of, mesh->position, mesh->vertex_count, sizeof *mesh->position);
  if (known->of != of || of == 0) *known = (abbe_plan_shape){of, abbe_mesh_is_convex(mesh)};
  return known->convex;
}

/* Why light that has left a refractor may meet one again, or a receiver within; NULL: it cannot. */
static const char *why_in_turn(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *only = NULL;
  size_t refractors = 0, clouds = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (abbe_object_kind_of(o) != ABBE_OBJECT_REFRACTOR || is_invisible(scene, o, plan)) continue;
    only = o;
    refractors++;
    clouds += o->cloud;
  }
  if (abbe_method_of(plan->desc.profile)->own_passes) return NULL;
  if (abbe_scene_mirror(scene) != NULL) return "what a mirror sends on may meet a surface again";
  if (refractors == 0) return NULL;
  if (plan->desc.model == ABBE_MODEL_LAYERS || refractors > MAX_FOLLOWED) return NULL;
  if (plan->desc.model == ABBE_MODEL_BVH) return "as asked";
  if (refractors - clouds > 1) return "there is more than one refractor";
  if (clouds > 0) return "clouds in the refractor scatter otherwise than it does";
  if (scene->camera.inside && plan->around_eye != NULL) return "the eye is inside a refractor";
  if (refractor_films_by_face(only)) return "films are on some of the refractor's faces";
  const bool exact = only->exact.kind == ABBE_EXACT_SPHERE || only->exact.kind == ABBE_EXACT_CONVEX;
  if (!exact && plan->desc.transport == ABBE_TRANSPORT_PINHOLE)
    return "light of all around is followed from every receiver through a mesh";
  if (!exact && abbe_material_is_fluorescent(only->material))
    return "light that makes a mesh glow comes from all around";
  if (!exact && !is_convex(&only->mesh, &plan->shape)) return "the refractor is not convex";
  if (abbe_reach_is_entered(scene, only)) return "a receiver may reach into the refractor";
  if (only->medium != NULL) return "what is in the refractor scatters light";
  return NULL;
}

/* Whether a model that is asked for can serve the object. */
static abbe_result check_asked(const abbe_object *object, const abbe_plan *plan,
                               abbe_error *error) {
  abbe_model asked = plan->desc.model;
  char why[128];
  abbe_convex_reason(&object->exact.convex, why, sizeof why);
  if (asked == ABBE_MODEL_SPHERE && object->exact.kind != ABBE_EXACT_SPHERE)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the model 'sphere' cannot serve '%s', which is no sphere", object->name);
  if (asked == ABBE_MODEL_CONVEX && object->exact.kind != ABBE_EXACT_CONVEX)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the model 'convex' cannot serve '%s', which is no convex solid of at "
                          "most %d faces%s%s",
                          object->name, ABBE_SCENE_MAX_PLANES, why[0] != '\0' ? ": " : "", why);
  if (asked == ABBE_MODEL_BVH && !plan->multi_refractor_paths)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the model 'hierarchy' follows light through at most %d refractors; the "
                          "scene has more",
                          MAX_FOLLOWED);
  return ABBE_OK;
}

/* Whether nothing looks at a ball from inside: no light and no camera stands there. */
static bool is_seen_from_outside(const abbe_scene *scene, const abbe_object *ball) {
  bool outside = abbe_object_distance(ball, scene->camera.eye) > 0;
  for (size_t i = 0; i < scene->light_count; i++)
    if (scene->light[i].kind != ABBE_LIGHT_DIRECTIONAL)
      outside = outside && abbe_object_distance(ball, scene->light[i].position) > 0;
  return outside;
}

static abbe_refractor_model mirror_model(const abbe_scene *scene, const abbe_object *object,
                                         const abbe_plan *plan) {
  const bool ball = object->exact.kind == ABBE_EXACT_SPHERE;
  if (abbe_method_of(plan->desc.profile)->own_passes) return ABBE_REFRACTOR_LAYERS;
  return ball && plan->desc.model != ABBE_MODEL_BVH && is_seen_from_outside(scene, object)
             ? ABBE_REFRACTOR_SPHERE
             : ABBE_REFRACTOR_BVH;
}

static abbe_refractor_model model_of(const abbe_object *object, const abbe_plan *plan) {
  if (abbe_method_of(plan->desc.profile)->own_passes) return ABBE_REFRACTOR_LAYERS;
  /* Planes are followed as fast as layers, and a stone's few pixels do not show its facets. */
  if (plan->desc.model == ABBE_MODEL_LAYERS && object->exact.kind == ABBE_EXACT_CONVEX)
    return ABBE_REFRACTOR_CONVEX;
  if (plan->desc.model != ABBE_MODEL_AUTO)
    return (abbe_refractor_model)(plan->desc.model - ABBE_MODEL_SPHERE);
  if (plan->multi_refractor_paths && refractor_films_by_face(object)) return ABBE_REFRACTOR_BVH;
  if (object->exact.kind == ABBE_EXACT_SPHERE) return ABBE_REFRACTOR_SPHERE;
  if (object->exact.kind == ABBE_EXACT_CONVEX) return ABBE_REFRACTOR_CONVEX;
  return plan->multi_refractor_paths ? ABBE_REFRACTOR_BVH : ABBE_REFRACTOR_LAYERS;
}

/* The object's model, why, and why it is no better one. */
static void write_reason(const abbe_object *object, const abbe_plan *plan, char *text,
                         size_t size) {
  const char *model = abbe_refractor_model_name(model_of(object, plan));
  const char *because, *joint = NULL; /* before what the mesh itself shows */
  char why[128], only[64];
  abbe_convex_reason(&object->exact.convex, why, sizeof why);
  if (abbe_method_of(plan->desc.profile)->own_passes) {
    snprintf(only, sizeof only, "the %s profile knows no other model",
             abbe_profile_name(plan->desc.profile));
    because = only;
  } else if (plan->desc.model != ABBE_MODEL_AUTO) {
    because = plan->desc.model == ABBE_MODEL_LAYERS && object->exact.kind == ABBE_EXACT_CONVEX
                  ? "the object is a convex faceted solid, whose planes say more than layers"
                  : "as asked";
  } else if (plan->multi_refractor_paths && refractor_films_by_face(object)) {
    because = "films are on some of its faces";
  } else if (object->exact.kind == ABBE_EXACT_SPHERE) {
    because = "the object is a sphere";
  } else if (object->exact.kind == ABBE_EXACT_CONVEX) {
    because = "the object is a convex faceted solid";
    joint = ": ";
  } else if (plan->multi_refractor_paths) {
    because = "the object is a general mesh, and light may meet it more than twice";
    joint = ": ";
  } else {
    because = "the object is a convex mesh and stands alone: a view sees all of it, front and back";
    joint = "; ";
  }
  const bool tells = joint != NULL && why[0] != '\0';
  snprintf(text, size, "%s: %s%s%s", model, because, tells ? joint : "", tells ? why : "");
}

/* Refractors beyond the plan's capacity are counted. */
static void list_model(abbe_plan *plan, size_t object, const char *name, const char *reason,
                       size_t *unlisted) {
  if (plan->entry_count < MAX_LISTED)
    abbe_plan_add_about(plan, ABBE_CHOICE_REFRACTOR_MODEL, object, name, "%s", reason);
  else
    ++*unlisted;
}

static void add(const abbe_scene *scene, abbe_plan *plan, size_t i, bool mirror,
                abbe_refractor_model model) {
  plan->refractor_object[plan->refractor_count] = i;
  plan->mirror[plan->refractor_count] = mirror;
  plan->model[plan->refractor_count++] = model;
  plan->spheres = plan->spheres || model == ABBE_REFRACTOR_SPHERE;
  plan->convex = plan->convex || model == ABBE_REFRACTOR_CONVEX;
  plan->layers = plan->layers || model == ABBE_REFRACTOR_LAYERS;
  plan->bvh = plan->bvh || model == ABBE_REFRACTOR_BVH;
  plan->facets = plan->facets || scene->object[i].exact.kind == ABBE_EXACT_CONVEX;
}

static abbe_result add_refractor(const abbe_scene *scene, size_t i, abbe_plan *plan,
                                 size_t *unlisted, abbe_error *error) {
  const abbe_object *object = &scene->object[i];
  char reason[288];
  abbe_result result = abbe_spectral_needs_examine(scene, object->material, plan, error);
  plan->filmed =
      plan->filmed || (object->coatings != NULL && !abbe_method_of(plan->desc.profile)->own_passes);
  plan->absorbing = plan->absorbing || object->medium != NULL;
  plan->tinting = plan->tinting ||
                  abbe_medium_is_coloured(object->medium, plan->desc.min_nm, plan->desc.max_nm);
  if (result == ABBE_OK) result = check_asked(object, plan, error);
  if (result != ABBE_OK) return result;
  const bool may = scene->camera.inside && plan->around_eye != NULL;
  if (may && plan->refractor_count < MAX_FOLLOWED &&
      (object == plan->around_eye || abbe_object_contains(object, scene->camera.eye)))
    plan->eye_inside |= 1u << plan->refractor_count;
  add(scene, plan, i, false, model_of(object, plan));
  write_reason(object, plan, reason, sizeof reason);
  list_model(plan, i, object->name, reason, unlisted);
  return ABBE_OK;
}

static abbe_result add_mirror(const abbe_scene *scene, size_t i, abbe_plan *plan, size_t *unlisted,
                              abbe_error *error) {
  const abbe_object *object = &scene->object[i];
  const abbe_refractor_model model = mirror_model(scene, object, plan);
  char reason[288], reflects[128];
  ABBE_TRY(abbe_spectral_needs_mirror(object, plan, reflects, sizeof reflects, error));
  add(scene, plan, i, true, model);
  plan->mirror_count++;
  snprintf(reason, sizeof reason, "%s: the object is a mirror%s", abbe_refractor_model_name(model),
           model == ABBE_REFRACTOR_SPHERE ? " and a sphere" : ", on both sides of its faces");
  list_model(plan, i, object->name, reason, unlisted);
  if (plan->entry_count < MAX_LISTED)
    abbe_plan_add_about(plan, ABBE_CHOICE_MIRROR, i, object->name, "%s%s", reflects,
                        abbe_brushing_is_rough(&object->brushing)
                            ? "; rough, so its samples send on lamps' light, too, and photons end"
                            : "");
  return ABBE_OK;
}

static void list_in_turn(abbe_plan *plan, const char *why) {
  abbe_plan_add(plan, ABBE_CHOICE_MULTI_REFRACTOR_PATHS, "%s",
                plan->refractor_count == 0    ? "nothing refracts"
                : plan->multi_refractor_paths ? why
                : abbe_method_of(plan->desc.profile)->own_passes
                    ? "the published method follows two interfaces at the most"
                : plan->desc.model == ABBE_MODEL_LAYERS
                    ? "light goes through two layers and no further, as asked"
                : plan->refractor_count < 2 ? "light that leaves the refractor cannot meet it again"
                                            : "there are more refractors than are followed");
}

static abbe_result check_eye(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  const abbe_object *around = scene->camera.inside ? plan->around_eye : NULL;
  if (around == NULL || plan->multi_refractor_paths) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the eye is inside the refractor '%s' (line %zu), from where neither "
                        "published profiles nor the model 'layers' nor a scene of more than %d "
                        "refractors are seen; move it outside, or trace the scene",
                        around->name, around->line, MAX_FOLLOWED);
}

/* What is left out of the lists of refractors would not be met by a mirror's light, and a cloud
 * would have a surface. */
static abbe_result check_followed(const abbe_scene *scene, const abbe_plan *plan,
                                  abbe_error *error) {
  bool clouds = false;
  for (size_t i = 0; i < plan->refractor_count; i++)
    clouds = clouds || scene->object[plan->refractor_object[i]].cloud;
  if ((plan->mirror_count == 0 && !clouds) || plan->refractor_count <= MAX_FOLLOWED) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "light is followed %s among at most %d refractors, mirrors and clouds; the scene has %zu",
      clouds ? "through clouds" : "off mirrors", MAX_FOLLOWED, plan->refractor_count);
}

abbe_result abbe_refractor_model_choose(const abbe_scene *scene, abbe_plan *plan,
                                        abbe_error *error) {
  const char *in_turn = why_in_turn(scene, plan);
  size_t unlisted = 0;
  plan->multi_refractor_paths = in_turn != NULL;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    const bool mirror = abbe_object_kind_of(object) == ABBE_OBJECT_MIRROR;
    if (abbe_object_kind_of(object) == ABBE_OBJECT_RECEIVER) continue;
    if (plan->refractor_count == MAX_REFRACTORS)
      return abbe_error_set(error, ABBE_UNSUPPORTED, "the scene has more than %d refractors",
                            MAX_REFRACTORS);
    if (!mirror && is_invisible(scene, object, plan)) {
      list_model(plan, i, object->name,
                 object->cloud ? "as clear as what is around it: light does not notice it"
                               : "clear, and its index is that of air: light does not notice it",
                 &unlisted);
      continue;
    }
    abbe_result result = mirror ? add_mirror(scene, i, plan, &unlisted, error)
                                : add_refractor(scene, i, plan, &unlisted, error);
    if (result != ABBE_OK) return result;
  }
  abbe_result result = check_followed(scene, plan, error);
  if (result == ABBE_OK) result = check_eye(scene, plan, error);
  if (result != ABBE_OK) return result;
  if (unlisted > 0)
    abbe_plan_add(plan, ABBE_CHOICE_MORE_REFRACTORS, "and %zu refractors more", unlisted);
  list_in_turn(plan, in_turn);
  return ABBE_OK;
}

/* Whether light of lights may come to a rough mirror by another surface: off rough ones samples and
 * the camera follow it. */
static bool smooth_besides_rough(const abbe_scene *scene, const abbe_plan *plan) {
  size_t rough = 0;
  for (size_t i = 0; i < plan->refractor_count; i++)
    rough += abbe_brushing_is_rough(&scene->object[plan->refractor_object[i]].brushing) ? 1 : 0;
  return scene->light_count > 0 && rough > 0 && rough < plan->refractor_count;
}

/* The scene's rule, that the later object wins, is not the renderer's. */
/* The first refractor that light leaves after many inner reflections, for it is totally reflected
 * beyond 30 degrees; NULL: none. */
static const abbe_object *find_keeper(const abbe_scene *scene, const abbe_plan *plan) {
  const double high = 2;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i]];
    abbe_material_range range;
    if (!plan->mirror[i] && plan->model[i] == ABBE_REFRACTOR_LAYERS &&
        abbe_material_range_make(object->material, plan->desc.min_nm, plan->desc.max_nm, &range,
                                 NULL) == ABBE_OK &&
        range.most_n > high)
      return object;
  }
  return NULL;
}

static void note_layers(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *keeper =
      plan->desc.model == ABBE_MODEL_LAYERS ? find_keeper(scene, plan) : NULL;
  if (keeper != NULL)
    abbe_plan_note(plan,
                   "'%.50s' keeps light for many inner reflections, and layers show few of them: "
                   "the object is too dark; any other model follows them",
                   keeper->name);
}

static void note_lost_glow(const abbe_scene *scene, abbe_plan *plan) {
  for (size_t r = 0; r < plan->refractor_count && !plan->glowing; r++) {
    const abbe_object *o = &scene->object[plan->refractor_object[r]];
    if (plan->mirror[r] || !abbe_material_is_fluorescent(o->material)) continue;
    abbe_plan_note(plan,
                   "%s: drawn without its glow, which takes the default profile, no --model layers "
                   "and at most %d refractors; 'abbe trace' has it",
                   o->name, ABBE_PLAN_MOST_GLOWING);
  }
}

void abbe_refractor_model_note(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *first[2] = {NULL, NULL};
  size_t pairs = 0;
  if (smooth_besides_rough(scene, plan))
    abbe_plan_note(plan,
                   "light of lamps that comes to a rough mirror through glass or off a smooth "
                   "mirror is left out, on receivers and as the camera sees it");
  note_layers(scene, plan);
  note_lost_glow(scene, plan);
  if (plan->multi_refractor_paths) return;
  if (plan->refractor_count > 1)
    abbe_plan_note(plan, "light that leaves one refractor and meets another goes on unrefracted");
  for (size_t i = 0; i < plan->refractor_count; i++)
    for (size_t k = i + 1; k < plan->refractor_count; k++) {
      const abbe_object *a = &scene->object[plan->refractor_object[i]];
      const abbe_object *b = &scene->object[plan->refractor_object[k]];
      if (!abbe_reach_overlap(a, b)) continue;
      if (pairs++ > 0) continue;
      first[0] = a;
      first[1] = b;
    }
  if (pairs == 0) return;
  char more[48] = "";
  if (pairs > 1)
    snprintf(more, sizeof more, " (and %zu pair%s more)", pairs - 1, pairs > 2 ? "s" : "");
  abbe_plan_note(
      plan,
      "the refractors '%.50s' and '%.50s'%s overlap, to judge by their bounds; each is taken as if "
      "it stood in air alone",
      first[0]->name, first[1]->name, more);
}
