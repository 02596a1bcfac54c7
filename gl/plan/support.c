#include "gl/plan/examine/examine.h"

#include "base/maths.h"
#include "colorimetry/weights.h"

#include <math.h>

/* Light from all around, off mirrors, once. */
static abbe_result support_wand(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  if (scene->environment == NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the wand2003 profile's light is an environment; this scene has none");
  if (scene->light_count > 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the wand2003 profile knows no light but an environment; this scene has "
                          "'%s': make it a sun or a spot of the environment",
                          scene->light[0].name);
  for (size_t i = 0; i < plan->refractor_count; i++)
    if (!plan->mirror[i])
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the wand2003 profile follows light off mirrors; '%s' is a refractor",
                            scene->object[plan->refractor_object[i]].name);
  if (plan->refractor_count == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the wand2003 profile needs a mirror; this scene has none");
  return ABBE_OK;
}

abbe_result abbe_support_pinholes(const abbe_scene *scene, const abbe_plan *plan,
                                  abbe_error *error) {
  if (plan->desc.transport != ABBE_TRANSPORT_PINHOLE) return ABBE_OK;
  if (abbe_method_of(plan->desc.profile)->surroundings) return support_wand(scene, plan, error);
  if (scene->environment == NULL && !plan->rough)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the transport 'pinhole' carries an environment's light; this scene has "
                          "none: take the transport 'photons'");
  if (plan->refractor_count == 0 || plan->layers ||
      (plan->refractor_count > 1 && !plan->multi_refractor_paths))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the transport 'pinhole' follows light through at least one mirror or "
                          "refractor and at most 32, and not through the model 'layers'");
  return ABBE_OK;
}

abbe_result abbe_support_published(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error) {
  const char *profile = abbe_profile_name(plan->desc.profile);
  const abbe_method_facts *method = abbe_method_of(plan->desc.profile);
  if (!method->lamp) return ABBE_OK;
  if (scene->environment != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile knows no environment; this scene has one", profile);
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (!abbe_light_has_size(light)) continue;
    const double area = abbe_light_area(light);
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the light '%s' is a %s, and the %s profile's lights have no size; take the default "
        "profile, trace the scene, or make it a point or spot light of %.6g W/sr, which is what it "
        "sends along its normal",
        light->name, light->kind == ABBE_LIGHT_DISK ? "disk" : "rectangle", profile,
        light->points > 0 ? light->power * (double)light->points : light->power * area);
  }
  if (scene->light_count != 1)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile knows one light; this scene has %zu", profile,
                          scene->light_count);
  if (!method->directional && scene->light[0].kind == ABBE_LIGHT_DIRECTIONAL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile knows point and spot lights; '%s' is directional",
                          profile, scene->light[0].name);
  if (plan->desc.faces > 1 && scene->light[0].kind == ABBE_LIGHT_DIRECTIONAL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "a cube of views goes around a point or spot light; '%s' is directional, "
                          "and its one view holds everything",
                          scene->light[0].name);
  if (plan->refractor_count == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile needs a refractor; this scene has none", profile);
  for (size_t i = 1; !method->materials && i < plan->refractor_count; i++)
    if (scene->object[plan->refractor_object[i]].material !=
        scene->object[plan->refractor_object[0]].material)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the %s profile knows one material; this scene has several", profile);
  return ABBE_OK;
}

abbe_result abbe_support_haze(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  if (!abbe_scene_is_hazy(scene)) return ABBE_OK;
  if (abbe_method_of(plan->desc.profile)->own_passes)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the scene has a 'medium' that scatters light, of which the %s profile "
                          "knows nothing; leave it out, or take the default profile",
                          abbe_profile_name(plan->desc.profile));
  if (plan->desc.transport != ABBE_TRANSPORT_PHOTONS)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the scene has a 'medium' that scatters light, which photons carry "
                          "alone; take the transport 'photons'");
  return ABBE_OK;
}

/* A layout belongs to where its light is. */
static bool looks_from(const abbe_view *view, const abbe_light *light) {
  const bool directional = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double apart[3];
  if (view->orthographic != directional) return false;
  abbe_vector_subtract(directional ? view->forward : view->origin,
                       directional ? light->direction : light->position, apart);
  return abbe_vector_length(apart) <= 1e-6 * (directional ? 1 : view->near);
}

abbe_result abbe_support_layout(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  const abbe_map_layout *layout = plan->desc.map_layout;
  const size_t index = plan->desc.map_layout_light;
  if (layout == NULL) return ABBE_OK;
  if (index >= scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the map layout is for light %zu; the scene has %zu", index + 1,
                          scene->light_count);
  if (abbe_method_of(plan->desc.profile)->own_passes)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the %s profile lays its map out by the light's cone; a given layout "
                          "goes with the default profile",
                          abbe_profile_name(plan->desc.profile));
  if (plan->refractor_count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no refractor, so there is no map to lay out");
  if (!looks_from(&layout->view, &scene->light[index]))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the map layout was made for a light in another place than '%s'; take "
                          "the map of that very light",
                          scene->light[index].name);
  return abbe_map_layout_check(layout, error);
}

abbe_result abbe_support_mirrors(const abbe_scene *scene, const abbe_plan *plan,
                                 abbe_error *error) {
  const abbe_object *mirror = abbe_scene_mirror(scene);
  const bool none = !abbe_method_of(plan->desc.profile)->mirrors;
  if (mirror == NULL || (!none && plan->desc.model != ABBE_MODEL_LAYERS)) return ABBE_OK;
  if (none)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the object '%s' (line %zu) is a mirror, and the %s profile follows no "
                          "light off mirrors; leave it out, or take the default profile",
                          mirror->name, mirror->line, abbe_profile_name(plan->desc.profile));
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the object '%s' (line %zu) is a mirror, and the model 'layers' follows no "
                        "light off mirrors; leave it out, or take the model 'hierarchy'",
                        mirror->name, mirror->line);
}

/* Whether some of the inner one's vertices lie in the outer one, a little off those that touch it.
 */
static bool holds_part(const abbe_object *outer, const abbe_object *inner) {
  enum { MOST = 64 };
  const abbe_mesh *mesh = &inner->mesh;
  const size_t step = mesh->vertex_count / MOST + 1;
  const double off = 1e-4;
  if (!abbe_reach_overlap(outer, inner)) return false;
  for (size_t i = 0; i < mesh->vertex_count; i += step) {
    double p[3];
    for (int k = 0; k < 3; k++)
      p[k] = (1 - off) * mesh->position[i][k] + off * 0.5 * (inner->min[k] + inner->max[k]);
    if (abbe_object_contains(outer, p)) return true;
  }
  return false;
}

abbe_result abbe_support_nesting(const abbe_scene *scene, const abbe_plan *plan,
                                 abbe_error *error) {
  if (plan->desc.model != ABBE_MODEL_LAYERS) return ABBE_OK;
  for (size_t i = 0; i < scene->object_count; i++)
    for (size_t k = 0; k < scene->object_count; k++) {
      const abbe_object *outer = &scene->object[i], *inner = &scene->object[k];
      if (i == k || (inner->cloud && !abbe_scene_is_hazy(scene)) ||
          abbe_object_kind_of(outer) != ABBE_OBJECT_REFRACTOR ||
          abbe_object_kind_of(inner) != ABBE_OBJECT_REFRACTOR || !holds_part(outer, inner))
        continue;
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "'%s' (line %zu) lies in '%s' (line %zu), and the model 'layers' takes "
                            "each refractor as if it stood in air alone; take the model "
                            "'hierarchy'",
                            inner->name, inner->line, outer->name, outer->line);
    }
  return ABBE_OK;
}

abbe_result abbe_support_roughness(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error) {
  const abbe_render_desc *d = &plan->desc;
  const abbe_object *rough = NULL;
  for (size_t i = 0; i < scene->object_count && rough == NULL; i++)
    if (abbe_brushing_is_rough(&scene->object[i].brushing)) rough = &scene->object[i];
  if (rough == NULL) return ABBE_OK;
  if (abbe_method_of(d->profile)->own_passes)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the object '%s' (line %zu) is a rough mirror, and the %s profile knows "
        "smooth ones alone; leave its 'roughness' out, or take the default profile",
        rough->name, rough->line, abbe_profile_name(d->profile));
  if (d->transport == ABBE_TRANSPORT_PINHOLE) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the object '%s' (line %zu) is a rough mirror, and the renderer sends light "
      "on from one by the transport 'pinhole' alone, not by '%s'; leave its "
      "'roughness' out, or trace the scene",
      rough->name, rough->line, abbe_transport_name(d->transport));
}

/* Lights that are nearer, in the object's radii, shift a ball's focus by more than a tenth of its
 * distance. */
static const double volume_least_radii = 10;

/* Whether all of the ball around the object is where the light has its full strength. */
static bool holds_all(const abbe_light *light, const double to[3], double distance, double radius) {
  if (light->kind != ABBE_LIGHT_SPOT) return true;
  const double off = acos(fmin(abbe_vector_dot(light->direction, to) / distance, 1));
  return off + asin(radius / distance) <= light->cone_rad - light->soft_rad;
}

static abbe_result check_volume_light(const abbe_light *light, const abbe_render_desc *d,
                                      const double centre[3], abbe_error *error) {
  const abbe_caustic_volume *v = d->volume;
  double white[3], to[3], distance = INFINITY;
  abbe_weights_band_xyz(&light->illuminant, d->min_nm, d->max_nm, d->min_nm, d->max_nm, white);
  abbe_vector_subtract(centre, light->position, to);
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) distance = abbe_vector_length(to);
  if (distance < volume_least_radii * v->body.radius)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the light '%s' is %.3g m from '%s', and the volume is of light from far "
        "away: %.3g m and more, ten times the object's radius; move it there, make "
        "it directional, or take the transport 'photons'",
        light->name, distance, v->body.name, volume_least_radii * v->body.radius);
  if (!holds_all(light, to, distance, v->body.radius))
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the light '%s' meets a part of '%s' alone, and the volume is of light on "
        "all of it; widen its cone, or take the transport 'photons'",
        light->name, v->body.name);
  for (int k = 0; k < 3; k++)
    if (!(fabs(white[k] - v->white[k]) <= 0.005))
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the light '%s' has a white of X %.3f, Z %.3f for Y 1, and the volume "
                            "was made for X %.3f, Z %.3f: make one for it (abbe volume --light)",
                            light->name, white[0], white[2], v->white[0], v->white[2]);
  return ABBE_OK;
}

/* Exits have wavelengths, which any light and observer may weigh, as far as they go. */
static abbe_result check_exits_range(const abbe_render_desc *d, abbe_error *error) {
  const abbe_caustic_volume *v = d->volume;
  if (d->min_nm >= v->min_nm - 1e-6 && d->max_nm <= v->max_nm + 1e-6) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the volume's exits are of %g to %g nm, and the picture's light of %g to %g "
      "nm: make one for it (abbe volume --range)",
      v->min_nm, v->max_nm, d->min_nm, d->max_nm);
}

abbe_result abbe_support_volume(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  const abbe_render_desc *d = &plan->desc;
  abbe_volume_place place;
  if (d->transport != ABBE_TRANSPORT_VOLUME) return ABBE_OK;
  if (plan->refractor_count != 1)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "a volume holds the caustics of one object alone, '%s'; this scene has "
                          "%zu that bend light",
                          d->volume->body.name, plan->refractor_count);
  ABBE_TRY(abbe_volume_body_find(&d->volume->body, &scene->object[plan->refractor_object[0]],
                                 &place, error));
  for (size_t i = 0; i < scene->light_count; i++)
    if (d->volume->kind == ABBE_VOLUME_VECTOR)
      ABBE_TRY(check_volume_light(&scene->light[i], d, place.centre, error));
  if (d->volume->kind == ABBE_VOLUME_EXITS) ABBE_TRY(check_exits_range(d, error));
  return ABBE_OK;
}
