#include "scenes/import/scene_reading.h"

#include "base/maths.h"
#include "base/text.h"
#include "scenes/import/scene_value.h"

#include <math.h>
#include <string.h>

static abbe_result read_size(abbe_yaml *yaml, abbe_yaml_node node, abbe_camera *out,
                             abbe_error *error) {
  double size[2] = {512, 512};
  ABBE_TRY(abbe_yaml_get_numbers(yaml, node, "size", 2, 1, ABBE_IMAGE_MAX_SIDE, size, error));
  out->width = (size_t)size[0];
  out->height = (size_t)size[1];
  if ((double)out->width != size[0] || (double)out->height != size[1])
    return abbe_yaml_fail(yaml, node, error, "'size' wants two whole numbers of pixels");
  return ABBE_OK;
}

/* From where 'frame' looks: the unit vector from its objects to the camera. */
static abbe_result read_side(abbe_yaml *yaml, abbe_yaml_node node, double out[3],
                             abbe_error *error) {
  double up = 60, around = -90;
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "elevation", -89.9, 89.9, &up, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "azimuth", -3600, 3600, &around, error));
  out[0] = cos(up * ABBE_DEGREE) * cos(around * ABBE_DEGREE);
  out[1] = cos(up * ABBE_DEGREE) * sin(around * ABBE_DEGREE);
  out[2] = sin(up * ABBE_DEGREE);
  return ABBE_OK;
}

static abbe_result read_frame(abbe_yaml *yaml, abbe_yaml_node node, abbe_error *error) {
  double fill = 0.7, side[3];
  const bool framed = abbe_yaml_get(yaml, node, "frame").id != 0;
  ABBE_TRY(read_side(yaml, node, side, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "fill", 0.01, 1, &fill, error));
  static const char *const own[] = {"elevation", "azimuth", "fill"};
  for (int i = 0; i < 3 && !framed; i++)
    if (abbe_yaml_get(yaml, node, own[i]).id != 0)
      return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, own[i]), error,
                            "'%s' goes with 'frame: [NAME, ...]', the objects that are to fill the "
                            "picture; a camera of an 'eye' and a 'target' has none",
                            own[i]);
  return ABBE_OK;
}

/* ---- the lens ---- */

#define FILM_M 0.024 /* high, as 35 mm film's */

static const char *const lenses[] = {"normal-50mm", "macro-60mm", "macro-100mm", "macro-180mm",
                                     NULL};

/* Its focal length, m; 0: there is none. */
static abbe_result read_lens(abbe_yaml *yaml, abbe_yaml_node node, double *focal,
                             abbe_error *error) {
  static const double lengths[] = {0.05, 0.06, 0.1, 0.18};
  const abbe_yaml_node lens = abbe_yaml_get(yaml, node, "lens");
  int which = 0;
  *focal = 0;
  if (lens.id == 0) return ABBE_OK;
  if (abbe_yaml_get(yaml, node, "fov").id != 0)
    return abbe_yaml_fail(yaml, lens, error,
                          "a 'lens' on 24 mm of film has its own angle: leave out the 'fov'");
  ABBE_TRY(abbe_yaml_get_choice(yaml, node, "lens", lenses, &which, error));
  *focal = lengths[which];
  return ABBE_OK;
}

/* A thin lens is sharp at that distance: the film is as far behind it as it is then. */
static double lens_angle(double focal, double distance) {
  return 2 * atan(0.5 * FILM_M * (distance - focal) / (focal * distance));
}

/* A pinhole has nothing to read but that 'focus' needs an aperture. */
static abbe_result read_aperture(abbe_yaml *yaml, abbe_yaml_node node, double *number,
                                 abbe_error *error) {
  const abbe_yaml_node focus = abbe_yaml_get(yaml, node, "focus");
  *number = 0;
  if (abbe_yaml_get(yaml, node, "aperture").id != 0)
    return abbe_yaml_get_number(yaml, node, "aperture", 0.5, 1000, number, error);
  return focus.id == 0
             ? ABBE_OK
             : abbe_yaml_fail(yaml, focus, error,
                              "'focus' goes with an 'aperture', an f-number such as 16; without "
                              "one all is sharp");
}

/* What pictures say of it: ABBE_SCREEN_EXPOSURE. */
static abbe_result read_exposure(abbe_yaml *yaml, abbe_yaml_node node, abbe_camera *out,
                                 abbe_error *error) {
  const abbe_yaml_node at = abbe_yaml_get(yaml, node, "exposure");
  const char *text = abbe_yaml_text(yaml, at);
  out->exposed = text != NULL && strcmp(text, "auto") == 0;
  if (out->exposed) return ABBE_OK;
  if (text != NULL && strspn(text, "+-.0123456789") == 0)
    return abbe_yaml_fail(yaml, at, error, "'exposure' is 'auto' or stops such as 1.5, not '%.60s'",
                          text);
  return abbe_yaml_get_number(yaml, node, "exposure", -60, 60, &out->exposure, error);
}

abbe_result abbe_camera_read(abbe_yaml *yaml, abbe_yaml_node root, abbe_camera *out,
                             abbe_error *error) {
  abbe_yaml_node node;
  double fov = 45.0;
  static const char *const places[] = {"eye", "target"};
  double *place[] = {out->eye, out->target};
  memcpy(out->up, (const double[3]){0.0, 0.0, 1.0}, sizeof out->up);
  ABBE_TRY(abbe_yaml_require(yaml, root, "camera", &node, error));
  const bool framed = abbe_yaml_get(yaml, node, "frame").id != 0;
  for (int i = 0; i < 2; i++)
    if (!framed || abbe_yaml_get(yaml, node, places[i]).id != 0)
      ABBE_TRY(abbe_scene_value_point(yaml, node, places[i], place[i], error));
  ABBE_TRY(
      abbe_yaml_get_numbers(yaml, node, "up", 3, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out->up, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "fov", 0.1, 170, &fov, error));
  out->fov_y_rad = fov * ABBE_DEGREE;
  ABBE_TRY(read_size(yaml, node, out, error));
  ABBE_TRY(abbe_yaml_get_bool(yaml, node, "inside", &out->inside, error));
  double number;
  ABBE_TRY(read_frame(yaml, node, error));
  ABBE_TRY(read_lens(yaml, node, &number, error));
  ABBE_TRY(read_aperture(yaml, node, &number, error));
  ABBE_TRY(read_exposure(yaml, node, out, error));
  ABBE_TRY(abbe_scene_value_polariser(yaml, node, &out->polariser, error));
  return abbe_yaml_check_keys(yaml, node, "the camera", error);
}

/* ---- frame ---- */

/* Whether the object is the one of that name, or a part of it. */
static bool is_called(const abbe_object *object, const char *name) {
  const size_t length = strlen(name);
  return strncmp(object->name, name, length) == 0 &&
         (object->name[length] == '\0' || strncmp(object->name + length, " (part ", 7) == 0);
}

static abbe_result mark(const abbe_yaml *yaml, abbe_yaml_node node, const abbe_scene *scene,
                        const char *key, bool framed[ABBE_SCENE_MAX_OBJECTS], abbe_error *error) {
  const char *name = abbe_yaml_text(yaml, node), *names[ABBE_SCENE_MAX_OBJECTS];
  bool found = false;
  for (size_t i = 0; i < scene->object_count; i++) {
    names[i] = scene->object[i].name;
    if (name == NULL || !is_called(&scene->object[i], name)) continue;
    framed[i] = found = true;
  }
  if (found) return ABBE_OK;
  const char *near = name != NULL ? abbe_nearest_word(name, names, scene->object_count) : NULL;
  return abbe_yaml_fail(
      yaml, node, error, "'%s' wants names of objects, and none is called '%.60s'%s%.60s%s", key,
      name != NULL ? name : "", near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
}

static abbe_result mark_all(abbe_yaml *yaml, abbe_yaml_node frame, const abbe_scene *scene,
                            bool framed[ABBE_SCENE_MAX_OBJECTS], abbe_error *error) {
  if (!abbe_yaml_is_sequence(yaml, frame)) return mark(yaml, frame, scene, "frame", framed, error);
  ABBE_TRY(abbe_yaml_count(yaml, frame) > 0
               ? ABBE_OK
               : abbe_yaml_fail(yaml, frame, error, "'frame' names no object"));
  for (size_t i = 0; i < abbe_yaml_count(yaml, frame); i++)
    ABBE_TRY(mark(yaml, abbe_yaml_item(yaml, frame, i), scene, "frame", framed, error));
  return ABBE_OK;
}

/* The camera's directions: right, up, and back, towards the camera. */
typedef struct axes {
  double of[3][3];
} axes;

/* How far the camera must be for all to lie within the tangents; *aside: how far their middle, as
 * it is seen from there, lies to the right and up. */
static double distance(const abbe_scene *scene, const bool *framed, const double target[3],
                       const axes *a, const double tangent[2], double aside[2]) {
  double far = 0, least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < scene->object_count; i++)
      for (size_t v = 0; framed[i] && v < scene->object[i].mesh.vertex_count; v++) {
        double from[3], p[3];
        abbe_vector_subtract(scene->object[i].mesh.position[v], target, from);
        for (int k = 0; k < 3; k++) p[k] = abbe_vector_dot(from, a->of[k]);
        for (int k = 0; k < 2; k++) {
          if (pass == 0) far = fmax(far, p[2] + fabs(p[k]) / tangent[k]);
          if (pass == 0 || !(far > p[2])) continue;
          least[k] = fmin(least[k], p[k] / (far - p[2]));
          most[k] = fmax(most[k], p[k] / (far - p[2]));
        }
      }
  for (int k = 0; k < 2; k++) aside[k] = 0.5 * (least[k] + most[k]) * far;
  return far;
}

static abbe_result refuse_up(const abbe_yaml *yaml, abbe_yaml_node node, abbe_error *error) {
  return abbe_yaml_fail(yaml, node, error,
                        "the camera's 'up' points along its view (or is zero); any other "
                        "direction will do");
}

static abbe_result frame(abbe_yaml *yaml, abbe_yaml_node node, const abbe_scene *scene,
                         abbe_camera *out, abbe_error *error) {
  bool framed[ABBE_SCENE_MAX_OBJECTS] = {false};
  const bool targeted = abbe_yaml_get(yaml, node, "target").id != 0;
  double fill = 0.7, far = 0, aside[2], min[3], max[3];
  axes a;
  ABBE_TRY(mark_all(yaml, abbe_yaml_get(yaml, node, "frame"), scene, framed, error));
  (void)abbe_yaml_get_number(yaml, node, "fill", 0.01, 1, &fill, NULL); /* read_frame() did */
  (void)read_side(yaml, node, a.of[2], NULL);
  for (int k = 0; k < 3; k++) {
    min[k] = INFINITY, max[k] = -INFINITY;
    for (size_t i = 0; i < scene->object_count; i++)
      if (framed[i]) {
        min[k] = fmin(min[k], scene->object[i].min[k]);
        max[k] = fmax(max[k], scene->object[i].max[k]);
      }
    if (!targeted) out->target[k] = 0.5 * (min[k] + max[k]);
  }
  if (abbe_yaml_get(yaml, node, "eye").id != 0) return ABBE_OK;
  abbe_vector_cross(out->up, a.of[2], a.of[0]);
  if (!abbe_vector_normalise(a.of[0])) return refuse_up(yaml, node, error);
  abbe_vector_cross(a.of[2], a.of[0], a.of[1]);
  const double high = fill * tan(0.5 * out->fov_y_rad);
  const double tangent[2] = {high * (double)out->width / (double)out->height, high};
  for (int turn = 0; turn < 8; turn++) {
    far = distance(scene, framed, out->target, &a, tangent, aside);
    for (int k = 0; k < 3 && !targeted; k++)
      out->target[k] += aside[0] * a.of[0][k] + aside[1] * a.of[1][k];
  }
  for (int k = 0; k < 3; k++) out->eye[k] = out->target[k] + far * a.of[2][k];
  return ABBE_OK;
}

static double far_of(const abbe_camera *c) {
  double view[3];
  abbe_vector_subtract(c->target, c->eye, view);
  return abbe_vector_length(view);
}

/* The camera of a lens: framed, as far away as its angle there wants it. */
static abbe_result place(abbe_yaml *yaml, abbe_yaml_node node, double focal, abbe_scene *scene,
                         abbe_error *error) {
  abbe_camera *c = &scene->camera;
  const bool framed = abbe_yaml_get(yaml, node, "frame").id != 0;
  const bool stands = !framed || abbe_yaml_get(yaml, node, "eye").id != 0;
  double least = focal, most = ABBE_SCENE_FAR;
  if (framed) ABBE_TRY(frame(yaml, node, scene, c, error));
  if (focal <= 0) return ABBE_OK;
  if (stands && !(far_of(c) > focal))
    return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, "lens"), error,
                          "a lens is sharp beyond its focal length, and the camera's target is "
                          "%.3g mm away",
                          1e3 * far_of(c));
  if (stands) c->fov_y_rad = lens_angle(focal, far_of(c));
  for (int i = 0; i < 60 && !stands; i++) {
    const double distance = sqrt(least * most);
    c->fov_y_rad = lens_angle(focal, distance);
    (void)frame(yaml, node, scene, c, NULL); /* as before the lens */
    *(far_of(c) > distance ? &least : &most) = distance;
  }
  return ABBE_OK;
}

/* Along the view to the middle of those objects together. */
static double distance_to(const abbe_scene *scene, const bool *named) {
  const abbe_camera *c = &scene->camera;
  double view[3], to[3];
  abbe_vector_subtract(c->target, c->eye, view);
  abbe_vector_normalise(view);
  for (int k = 0; k < 3; k++) {
    double min = INFINITY, max = -INFINITY;
    for (size_t i = 0; i < scene->object_count; i++) {
      if (!named[i]) continue;
      min = fmin(min, scene->object[i].min[k]);
      max = fmax(max, scene->object[i].max[k]);
    }
    to[k] = 0.5 * (min + max) - c->eye[k];
  }
  return abbe_vector_dot(to, view);
}

/* 'focus' is a distance along the view, or the middle of an object; without it the target. */
static abbe_result focus(abbe_yaml *yaml, abbe_yaml_node node, double focal, abbe_scene *scene,
                         abbe_error *error) {
  abbe_camera *c = &scene->camera;
  bool named[ABBE_SCENE_MAX_OBJECTS] = {false};
  double number;
  const abbe_yaml_node at = abbe_yaml_get(yaml, node, "focus");
  const char *text = abbe_yaml_text(yaml, at);
  (void)read_aperture(yaml, node, &number, NULL); /* abbe_camera_read() did */
  if (number <= 0) return ABBE_OK;
  const double lens = focal; /* without one the film is there for the f-number alone */
  if (focal <= 0) focal = 0.5 * FILM_M / tan(0.5 * c->fov_y_rad);
  c->aperture = focal / number;
  c->focus = far_of(c);
  if (at.id == 0) return ABBE_OK;
  if (text != NULL && strchr("0123456789.-+", text[0]) != NULL) {
    ABBE_TRY(abbe_yaml_get_length(yaml, node, "focus", 1e-6, ABBE_SCENE_FAR, &c->focus, error));
  } else {
    ABBE_TRY(mark(yaml, at, scene, "focus", named, error));
    c->focus = distance_to(scene, named);
    if (!(c->focus > 0)) return abbe_yaml_fail(yaml, at, error, "'%s' is behind the camera", text);
  }
  if (c->focus > lens) return ABBE_OK;
  return abbe_yaml_fail(yaml, at, error,
                        "a lens is sharp beyond its focal length, %.3g mm, and 'focus' is %.3g mm "
                        "away",
                        1e3 * lens, 1e3 * c->focus);
}

/* The pupil is in air. */
static abbe_result check_pupil(abbe_yaml *yaml, abbe_yaml_node node, const abbe_scene *scene,
                               abbe_error *error) {
  const abbe_camera *c = &scene->camera;
  const double radius = 0.5 * c->aperture;
  for (size_t i = 0; i < scene->object_count && radius > 0; i++) {
    const double near = fabs(abbe_object_distance_within(&scene->object[i], c->eye, radius));
    if (near < radius)
      return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, "aperture"), error,
                            "the pupil is %.3g mm wide, and object '%.60s' is %.3g mm from its "
                            "middle: take a greater f-number",
                            2e3 * radius, scene->object[i].name, 1e3 * near);
  }
  return ABBE_OK;
}

abbe_result abbe_camera_frame(abbe_yaml *yaml, abbe_yaml_node root, abbe_scene *scene,
                              abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(yaml, root, "camera");
  abbe_camera *c = &scene->camera;
  double view[3], side[3], focal;
  (void)read_lens(yaml, node, &focal, NULL); /* abbe_camera_read() did */
  ABBE_TRY(place(yaml, node, focal, scene, error));
  abbe_vector_subtract(c->target, c->eye, view);
  if (!(abbe_vector_length(view) > 0.0))
    return abbe_yaml_fail(yaml, node, error, "the camera's 'eye' and 'target' are the same point");
  abbe_vector_cross(view, c->up, side);
  if (!(abbe_vector_length(side) > 1e-9 * abbe_vector_length(view) * abbe_vector_length(c->up)))
    return refuse_up(yaml, node, error);
  ABBE_TRY(focus(yaml, node, focal, scene, error));
  return check_pupil(yaml, node, scene, error);
}
