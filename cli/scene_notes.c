#include "cli/scene_notes.h"

#include <cjson/cJSON.h>
#include <stdio.h>

void abbe_scene_notes(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].mended != NULL)
      fprintf(stderr, "note: object '%s': %s\n", scene->object[i].name, scene->object[i].mended);
}

static const char *made_of(const abbe_object *o) {
  return o->material != NULL ? o->material->name : "receiver";
}

void abbe_scene_list(const abbe_scene *scene) {
  enum { MOST = 48 };
  printf("What is there, with its size and the middle of its bounds, m:\n");
  for (size_t i = 0; i < scene->object_count && i < MOST; i++) {
    const abbe_object *o = &scene->object[i];
    char size[64], middle[64];
    snprintf(size, sizeof size, "%.3g x %.3g x %.3g", o->max[0] - o->min[0], o->max[1] - o->min[1],
             o->max[2] - o->min[2]);
    snprintf(middle, sizeof middle, "(%.3g, %.3g, %.3g)", 0.5 * (o->min[0] + o->max[0]),
             0.5 * (o->min[1] + o->max[1]), 0.5 * (o->min[2] + o->max[2]));
    printf("  %-26.60s %-26s %-26s %s, %zu faces\n", o->name, size, middle, made_of(o),
           o->mesh.face_count);
  }
  if (scene->object_count > MOST) printf("  and %zu objects more\n", scene->object_count - MOST);
  printf("\n");
}

void abbe_scene_list_json(const abbe_scene *scene, cJSON *root) {
  cJSON *list = cJSON_AddArrayToObject(root, "objects");
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    cJSON *item = cJSON_CreateObject();
    cJSON_AddStringToObject(item, "name", o->name);
    if (o->material != NULL) cJSON_AddStringToObject(item, "material", o->material->name);
    cJSON_AddItemToObject(item, "min", cJSON_CreateDoubleArray(o->min, 3));
    cJSON_AddItemToObject(item, "max", cJSON_CreateDoubleArray(o->max, 3));
    cJSON_AddNumberToObject(item, "faces", (double)o->mesh.face_count);
    if (o->mended != NULL) cJSON_AddStringToObject(item, "note", o->mended);
    cJSON_AddItemToArray(list, item);
  }
}
