#include "gl/plan/examine/examine.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

/* What reaches no further into a pyramid than a float resolves lies outside. */
static const double rounding = 1e-7;

static const double quarter = 0.78539816339744831; /* pi / 4 */

int abbe_light_cube_face(const double d[3]) {
  int axis = fabs(d[0]) >= fabs(d[1]) && fabs(d[0]) >= fabs(d[2]) ? 0
             : fabs(d[1]) >= fabs(d[2])                           ? 1
                                                                  : 2;
  return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

static void axis_of(int face, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = k == face / 2 ? (face % 2 != 0 ? -1 : 1) : 0;
}

void abbe_light_cube_look(const double origin[3], int face, abbe_view *out) {
  static const double up[3] = {0, 1, 0};
  double forward[3];
  axis_of(face, forward);
  abbe_view_look(origin, forward, up, false, out);
}

/* x to the right, y up, z forward. */
static void to_view(const abbe_view *view, const double p[3], double out[3]) {
  double d[3];
  abbe_vector_subtract(p, view->origin, d);
  out[0] = abbe_vector_dot(d, view->right);
  out[1] = abbe_vector_dot(d, view->up);
  out[2] = abbe_vector_dot(d, view->forward);
}

static void grow(abbe_view *view, int axis, double low, double high) {
  double *window = view->window + 2 * axis;
  window[0] = fmin(window[0], fmax(low, -1));
  window[1] = fmax(window[1], fmin(high, 1));
}

/* Distance of p from the pyramid |x|, |y| <= z: the nearest of its nearest places inside, on a
 * side, on an edge and at the apex, of those that there are. */
static double from_pyramid(const double p[3]) {
  const double x = fabs(p[0]), y = fabs(p[1]), z = p[2];
  if (x <= z && y <= z) return 0;
  double least = sqrt(x * x + y * y + z * z);
  const double across[2][2] = {{x, y}, {y, x}};
  for (int side = 0; side < 2; side++) {
    const double along = 0.5 * (across[side][0] + z);
    if (along >= 0 && across[side][1] <= along)
      least = fmin(least, fabs(across[side][0] - z) * sqrt(0.5));
  }
  const double edge = fmax((x + y + z) / 3, 0);
  return fmin(least, sqrt(pow(x - edge, 2) + pow(y - edge, 2) + pow(z - edge, 2)));
}

/* Each axis of the window around the sphere's shadow on the plane of that axis and forward. */
static bool fit_sphere(abbe_view *view, const abbe_exact *sphere) {
  double c[3];
  to_view(view, sphere->centre, c);
  if (!(from_pyramid(c) < sphere->radius * (1 - rounding))) return false;
  for (int axis = 0; axis < 2; axis++) {
    const double distance = hypot(c[axis], c[2]), middle = atan2(c[axis], c[2]);
    double low = -1, high = 1;
    if (distance > sphere->radius) {
      const double half = asin(sphere->radius / distance);
      for (int turn = -1; turn <= 1; turn++) {
        const double from = fmax(middle - half + 8 * turn * quarter, -quarter);
        const double to = fmin(middle + half + 8 * turn * quarter, quarter);
        if (from < to) low = tan(from), high = tan(to);
      }
    }
    grow(view, axis, low, high);
  }
  return true;
}

enum { MOST_CORNERS = 8 }; /* a triangle's, and one for each plane that cuts it */

/* The part of a polygon where scale z - side p[axis] >= 0. */
static int cut(const double (*from)[3], int count, int axis, double side, double (*to)[3]) {
  int kept = 0;
  for (int i = 0; i < count; i++) {
    const double *a = from[i], *b = from[(i + 1) % count];
    const double in_a = (1 - rounding) * a[2] - side * a[axis];
    const double in_b = (1 - rounding) * b[2] - side * b[axis];
    if (in_a >= 0 && kept < MOST_CORNERS) memcpy(to[kept++], a, sizeof *to);
    if ((in_a >= 0) == (in_b >= 0) || kept == MOST_CORNERS) continue;
    const double t = in_a / (in_a - in_b);
    for (int k = 0; k < 3; k++) to[kept][k] = a[k] + t * (b[k] - a[k]);
    kept++;
  }
  return kept;
}

static bool fit_triangle(abbe_view *view, const double corner[3][3]) {
  double polygon[2][MOST_CORNERS][3];
  int count = 3;
  bool any = false;
  memcpy(polygon[0], corner, 3 * sizeof *corner);
  for (int k = 0; k < 4 && count > 0; k++)
    count = cut((const double(*)[3])polygon[k % 2], count, k / 2, k % 2 != 0 ? -1 : 1,
                polygon[(k + 1) % 2]);
  for (int i = 0; i < count; i++) {
    const double *p = polygon[0][i];
    if (!(p[2] > 0)) continue;
    any = true;
    for (int axis = 0; axis < 2; axis++) grow(view, axis, p[axis] / p[2], p[axis] / p[2]);
  }
  return any;
}

static void read_triangle(const abbe_mesh *mesh, size_t face, double corner[3][3]) {
  for (int k = 0; k < 3; k++)
    memcpy(corner[k], mesh->position[mesh->face[face][k]], sizeof corner[k]);
}

bool abbe_light_cube_fit(abbe_view *view, const abbe_object *object) {
  const abbe_mesh *mesh = &object->mesh;
  bool any = false;
  if (object->exact.kind == ABBE_EXACT_SPHERE) return fit_sphere(view, &object->exact);
  for (size_t i = 0; i < mesh->face_count; i++) {
    double world[3][3], corner[3][3];
    read_triangle(mesh, i, world);
    for (int k = 0; k < 3; k++) to_view(view, world[k], corner[k]);
    any = fit_triangle(view, (const double(*)[3])corner) || any;
  }
  return any;
}

unsigned abbe_light_cube_reached(const abbe_light *light, const abbe_object *object) {
  static const double to_corner_rad = 0.95531661812450927; /* acos(1 / sqrt 3) */
  unsigned faces = 0;
  if (!abbe_reach_light(light, object)) return 0;
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    double axis[3];
    abbe_view view;
    axis_of(face, axis);
    if (light->kind == ABBE_LIGHT_SPOT) {
      const double c = fmin(fmax(abbe_vector_dot(axis, light->direction), -1), 1);
      if (acos(c) > light->cone_rad + to_corner_rad) continue;
    }
    abbe_light_cube_look(light->position, face, &view);
    if (abbe_light_cube_fit(&view, object)) faces |= 1u << face;
  }
  return faces;
}

void abbe_light_views_reach(const abbe_scene *scene, abbe_plan *plan) {
  bool thesis = abbe_method_of(plan->desc.profile)->own_passes;
  const bool lands = plan->receiver_count > 0 || abbe_scene_is_hazy(scene);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_object *object = &scene->object[plan->refractor_object[k]];
    for (size_t i = 0; i < scene->light_count && lands; i++)
      if (thesis || abbe_reach_light(&scene->light[i], object))
        plan->caustics = plan->reaches[i] = true;
    if (thesis || abbe_reach_eye(&scene->camera, plan->desc.width, plan->desc.height, object))
      plan->camera_sees_refractor = true;
  }
  for (size_t i = 0; i < scene->light_count && !plan->forward_transmission; i++)
    for (size_t k = 0; k < plan->refractor_count && plan->reaches[i] && !plan->forward_transmission;
         k++)
      for (size_t j = 0; j < plan->receiver_count && !plan->forward_transmission; j++)
        plan->forward_transmission =
            abbe_reach_through(&scene->light[i], &scene->object[plan->refractor_object[k]],
                               &scene->object[plan->receiver_object[j]]);
  if (plan->caustics || plan->camera_sees_refractor) return;
  plan->dispersive = plan->absorbing = plan->tinting = plan->colouring = false;
  plan->filmed = plan->crystals = plan->pleochroic = false;
}

/* Receivers outside the view have tiles. */
static void find_aside(const abbe_scene *scene, abbe_plan *plan, abbe_view *view) {
  for (size_t k = 0; k < plan->receiver_count; k++) {
    const abbe_mesh *mesh = &scene->object[plan->receiver_object[k]].mesh;
    if (!abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count))
      plan->outside_map_view = true;
  }
}

/* What a mesh is inside is read from its layers, which no seam may cut. */
static abbe_result check_layers(const abbe_scene *scene, const abbe_plan *plan,
                                const abbe_light *light, int face, size_t refractor,
                                abbe_error *error) {
  const abbe_object *object = &scene->object[plan->refractor_object[refractor]];
  abbe_view view;
  if (plan->model[refractor] != ABBE_REFRACTOR_LAYERS) return ABBE_OK;
  abbe_light_cube_look(light->position, face, &view);
  if (abbe_view_fit(&view, (const double(*)[3])object->mesh.position, object->mesh.vertex_count))
    return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the light '%s' is so near to the refractor '%s' that no view holds its "
      "layers, 76 degrees to each side; ask for the model 'hierarchy', or move it "
      "away",
      light->name, object->name);
}

/* One view for each face of the cube through which light may reach a refractor; the first stands
 * in the light's own place. */
static abbe_result make_cube(const abbe_scene *scene, size_t light, abbe_plan *plan,
                             abbe_error *error) {
  const abbe_light *from = &scene->light[light];
  unsigned all = 0;
  bool first = true;
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const unsigned faces = abbe_light_cube_reached(from, &scene->object[plan->refractor_object[k]]);
    for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
      ABBE_TRY(faces >> face & 1 ? check_layers(scene, plan, from, face, k, error) : ABBE_OK);
    }
    all |= faces;
  }
  plan->reaches[light] = all != 0;
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    abbe_view view;
    if ((all >> face & 1) == 0) continue;
    if (!first && plan->light_view_count == ABBE_SCENE_MAX_LIGHTS)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the refractors around the light '%s' need a cube of maps, and all "
                            "lights together more than %d maps; move it away from them, or leave "
                            "lights out",
                            from->name, ABBE_SCENE_MAX_LIGHTS);
    const size_t at = first ? light : plan->light_view_count++;
    const unsigned rest = first ? ABBE_LIGHT_CUBE_ALL & ~all : 0;
    plan->light_view[at] = (abbe_light_view){light, face, 1u << face | rest};
    plan->reaches[at] = plan->cubes = true;
    first = false;
    abbe_light_cube_look(from->position, face, &view);
    find_aside(scene, plan, &view);
  }
  return ABBE_OK;
}

bool abbe_light_views_fit(const abbe_scene *scene, const abbe_light *light, const abbe_plan *plan,
                          abbe_view *out, size_t *off) {
  static const double up[3] = {0, 1, 0};
  const bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL;
  bool all = true;
  double min[3], max[3], forward[3];
  abbe_scene_bounds(scene, true, false, min, max);
  for (int k = 0; k < 3; k++) forward[k] = 0.5 * (min[k] + max[k]) - light->position[k];
  if (forward[0] == 0 && forward[1] == 0 && forward[2] == 0) forward[2] = -1;
  abbe_view_look(sun ? min : light->position, sun ? light->direction : forward, up, sun, out);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_mesh *mesh = &scene->object[plan->refractor_object[k]].mesh;
    if (abbe_view_fit(out, (const double(*)[3])mesh->position, mesh->vertex_count) || sun) continue;
    if (all && off != NULL) *off = plan->refractor_object[k];
    all = false;
  }
  return all;
}

/* Where one view of the light holds all refractors, it has that; else a cube of them. */
static abbe_result examine_view(const abbe_scene *scene, size_t light, abbe_plan *plan,
                                abbe_error *error) {
  const bool thesis = abbe_method_of(plan->desc.profile)->own_passes;
  const abbe_light *from = &scene->light[light];
  abbe_view view;
  const bool cube = abbe_method_of(plan->desc.profile)->estimates && plan->desc.faces == 0 &&
                    !abbe_render_desc_in_light(&plan->desc);
  if (thesis && from->kind == ABBE_LIGHT_SPOT) return ABBE_OK; /* its view is its cone */
  const bool fits = abbe_light_views_fit(scene, from, plan, &view, &plan->off_view[light]);
  if (fits) find_aside(scene, plan, &view);
  if (cube && (!fits || plan->outside_map_view)) plan->desc.faces = ABBE_LIGHT_CUBE_FACES;
  if (fits || plan->desc.faces > 1) return ABBE_OK;
  if (!thesis) return make_cube(scene, light, plan, error);
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the %s profile looks through one view, and the light '%s' sees the "
                        "refractor '%s' more than 76 degrees off the middle of all; move it away, "
                        "or take the default profile%s",
                        abbe_profile_name(plan->desc.profile), from->name,
                        scene->object[plan->off_view[light]].name,
                        abbe_method_of(plan->desc.profile)->estimates
                            ? ", or six views (--faces 6; of wyman2006, with photons in the "
                              "camera's image)"
                            : "");
}

abbe_result abbe_light_views_choose(const abbe_scene *scene, abbe_plan *plan, abbe_error *error) {
  plan->light_view_count = scene->light_count;
  for (size_t i = 0; i < scene->light_count; i++)
    plan->light_view[i] = (abbe_light_view){i, -1, ABBE_LIGHT_CUBE_ALL};
  if (plan->refractor_count == 0) return ABBE_OK;
  for (size_t i = 0; i < scene->light_count; i++) {
    if (scene->light[i].kind == ABBE_LIGHT_DIRECTIONAL || !plan->reaches[i]) continue;
    ABBE_TRY(examine_view(scene, i, plan, error));
  }
  plan->caustics = false;
  for (size_t i = 0; i < plan->light_view_count; i++)
    plan->caustics = plan->caustics || plan->reaches[i];
  return ABBE_OK;
}
