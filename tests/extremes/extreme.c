#include "tests/extremes/extreme.h"

#include "base/file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ROOM = 8192 };

typedef struct text {
  char at[ROOM];
  size_t used;
} text;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
put(text *t, const char *format, ...) {
  va_list args;
  va_start(args, format);
  int count = vsnprintf(t->at + t->used, ROOM - t->used, format, args);
  va_end(args);
  t->used += count > 0 ? (size_t)count : 0;
  if (t->used < ROOM) return;
  fprintf(stderr, "an extreme scene is longer than %d bytes\n", ROOM);
  abort();
}

abbe_render_desc extreme_desc(const extreme *e) {
  abbe_render_desc d = e->desc;
  if (d.width == 0) d.width = 48;
  if (d.height == 0) d.height = 48;
  if (d.photons == 0) d.photons = 48;
  if (d.map_size == 0) d.map_size = 96;
  d.space = ABBE_RGB_SPACE_XYZ;
  return d;
}

static double unit_of(const extreme_scene *s) {
  return s->size != 0 ? s->size : 1;
}

static void put_point(text *t, const extreme_scene *s, const double p[3]) {
  double size = unit_of(s);
  put(t, "[%.17g, %.17g, %.17g]", s->at[0] + size * p[0], s->at[1] + size * p[1],
      s->at[2] + size * p[2]);
}

static void put_camera(text *t, const extreme_scene *s) {
  static const double eye[3] = {0, -1, 0.5}, target[3] = {0, 0, 0.05};
  bool given = memcmp(s->eye, s->target, sizeof s->eye) != 0;
  put(t, "camera: {eye: ");
  put_point(t, s, given ? s->eye : eye);
  put(t, ", target: ");
  put_point(t, s, given ? s->target : target);
  put(t, "}\n");
}

static void put_light(text *t, const extreme_scene *s, const extreme_light *l, int number) {
  double power = l->power != 0 ? l->power : 1, area = unit_of(s) * unit_of(s);
  bool sun = strcmp(l->kind, "directional") == 0, disk = strcmp(l->kind, "disk") == 0;
  put(t, "- {name: light%d, kind: %s, %s: %.17g", number, l->kind,
      sun    ? "irradiance"
      : disk ? "radiance"
             : "intensity",
      sun || disk ? power : power * area);
  if (!sun) {
    put(t, ", position: ");
    put_point(t, s, l->at);
  }
  if (l->way[0] != 0 || l->way[1] != 0 || l->way[2] != 0)
    put(t, ", direction: [%.17g, %.17g, %.17g]", l->way[0], l->way[1], l->way[2]);
  if (strcmp(l->kind, "spot") == 0) put(t, ", cone: 30, soft: 5");
  if (disk) put(t, ", radius: %.17g", 0.02 * unit_of(s));
  put(t, "}\n");
}

static void put_objects(text *t, const extreme_scene *s) {
  const char *from = s->objects != NULL ? s->objects : EXTREME_FLOOR EXTREME_BALL, *mark;
  for (; (mark = strstr(from, "PLACE")) != NULL; from = mark + 5)
    put(t, "%.*s{scale: %.17g}, {translate: [%.17g, %.17g, %.17g]}", (int)(mark - from), from,
        unit_of(s), s->at[0], s->at[1], s->at[2]);
  put(t, "%s", from);
}

static void put_scene(text *t, const extreme_scene *s) {
  static const extreme_light lamp = {.kind = "point", .at = {0.05, 0.03, 0.6}};
  put(t, "materials: glass.yaml\n");
  put_camera(t, s);
  put(t, "lights:\n");
  if (s->light[0].kind == NULL) put_light(t, s, &lamp, 1);
  for (int i = 0; i < 2; i++)
    if (s->light[i].kind != NULL) put_light(t, s, &s->light[i], i + 1);
  put(t, "objects:\n");
  put_objects(t, s);
}

static void put_materials(text *t, const extreme_scene *s) {
  put(t,
      "materials:\n- {name: glass, model: cauchy, coefficients: [%.17g, %.17g], range_nm: [300, "
      "2500], source: made up",
      s->n != 0 ? s->n : 1.5, s->b);
  if (s->attenuation_per_m > 0)
    put(t, ",\n   absorption: {attenuation_per_m: [[300, %.17g], [2500, %.17g]]}",
        s->attenuation_per_m, s->attenuation_per_m);
  put(t, "}\n- {name: air, model: constant, coefficients: [1], source: made up}\n");
}

abbe_result extreme_load(const extreme_scene *s, abbe_scene *out, abbe_error *error) {
  static const char *const names[] = {"glass.yaml", "scene.yaml", "solid.obj"};
  char folder[] = "/tmp/abbe-extreme-XXXXXX", path[3][64];
  text materials = {{0}, 0}, scene = {{0}, 0};
  put_materials(&materials, s);
  put_scene(&scene, s);
  if (mkdtemp(folder) == NULL) return abbe_error_set(error, ABBE_IO, "no folder in /tmp");
  const char *content[] = {materials.at, scene.at, s->mesh};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 3; i++) {
    snprintf(path[i], sizeof path[i], "%s/%s", folder, names[i]);
    if (content[i] != NULL && result == ABBE_OK)
      result = abbe_file_write(path[i], content[i], strlen(content[i]), error);
  }
  if (result == ABBE_OK) result = abbe_scene_load(path[1], NULL, out, error);
  for (int i = 0; i < 3; i++) unlink(path[i]);
  rmdir(folder);
  return result;
}

static void call_three(const extreme *e, extreme_call call, void *user) {
  static const struct {
    const char *name, *objects;
  } shape[] = {{"ball", EXTREME_FLOOR EXTREME_BALL},
               {"brick", EXTREME_FLOOR EXTREME_BRICK},
               {"ring", EXTREME_FLOOR EXTREME_RING}};
  for (int i = 0; i < 3; i++) {
    extreme one = *e;
    char name[128];
    snprintf(name, sizeof name, "%s, %s", e->name, shape[i].name);
    one.name = name;
    one.scene.objects = shape[i].objects;
    call(user, &one);
  }
}

void extreme_for_each(const extreme_report *report, extreme_call call, void *user) {
  for (size_t i = 0; i < extreme_count; i++) {
    const extreme *e = &extremes[i];
    if (!extreme_report_wants(report, e->group) || (e->heavy && !report->heavy)) continue;
    if (e->each)
      call_three(e, call, user);
    else
      call(user, e);
  }
}
