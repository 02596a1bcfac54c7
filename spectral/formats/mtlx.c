#include "spectral/formats/material_import.h"

#include "base/number.h"
#include "base/xml.h"
#include "spectral/materials/absorption.h"
#include "spectral/materials/convert.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_NAME = 120, MOST_DEPTH = 64 };

/* What a shading model calls its numbers, and what they are where a file is silent. */
typedef struct model {
  const char *element, *weight, *ior, *dispersion, *scale, *colour, *depth;
  double default_weight, default_dispersion;
} model;

/* standard_surface's dispersion is the Abbe number itself, gltf_pbr's 20 / V_d. */
static const model models[] = {
    {"open_pbr_surface", "transmission_weight", "specular_ior",
     "transmission_dispersion_abbe_number", "transmission_dispersion_scale", "transmission_color",
     "transmission_depth", 0, 20},
    {"standard_surface", "transmission", "specular_IOR", "transmission_dispersion", NULL,
     "transmission_color", "transmission_depth", 0, 0},
    {"gltf_pbr", "transmission", "ior", "dispersion", NULL, "attenuation_color",
     "attenuation_distance", 0, 0}};

typedef struct reading {
  XML_Parser parser;
  const char *path;
  abbe_material_table *out;
  abbe_report *report;
  abbe_error *error;
  abbe_result result;
  const model *model; /* of the element that is open; NULL: none */
  size_t depth, found, line;
  bool connected; /* one of its numbers comes from another node */
  char name[MOST_NAME],
      material[MOST_NAME]; /* of the shader, of the surfacematerial that is open */
  struct link {
    char shader[MOST_NAME], material[MOST_NAME];
  } * link; /* [links], allocated in powers of two */
  size_t links;
  double weight, ior, dispersion, scale, colour[3], distance;
} reading;

static void stop(reading *r, abbe_result result) {
  if (r->result == ABBE_OK) r->result = result;
  XML_StopParser(r->parser, XML_FALSE);
}

static const char *attribute(const char **attributes, const char *name) {
  for (; *attributes != NULL; attributes += 2)
    if (strcmp(attributes[0], name) == 0) return attributes[1];
  return NULL;
}

/* So many numbers, and nothing else. */
static bool read_numbers(const char *text, double *out, size_t count) {
  for (size_t i = 0; i < count; i++) {
    text += strspn(text, " \t\n,");
    if (!abbe_number_read(text, &text, &out[i]) || !isfinite(out[i])) return false;
  }
  return text[strspn(text, " \t\n")] == '\0';
}

static void read_input(reading *r, const char **attributes) {
  const char *name = attribute(attributes, "name"), *value = attribute(attributes, "value");
  const model *m = r->model;
  if (name == NULL) return;
  const struct {
    const char *name;
    double *number;
    size_t count;
  } inputs[] = {{m->weight, &r->weight, 1},         {m->ior, &r->ior, 1},
                {m->dispersion, &r->dispersion, 1}, {m->scale, &r->scale, 1},
                {m->colour, r->colour, 3},          {m->depth, &r->distance, 1}};
  for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
    if (inputs[i].name == NULL || strcmp(inputs[i].name, name) != 0) continue;
    if (value == NULL)
      r->connected = true;
    else if (!read_numbers(value, inputs[i].number, inputs[i].count))
      stop(r, abbe_error_set(r->error, ABBE_PARSE, "%s:%zu: '%s' is '%.60s'; %s", r->path,
                             abbe_xml_line(r->parser), name, value,
                             inputs[i].count == 3 ? "three numbers such as 1, 0.5, 0.2 are right"
                                                  : "one number is right"));
  }
}

static void take_name(char out[MOST_NAME], const char *name) {
  snprintf(out, MOST_NAME, "%s", name + (strncmp(name, "SR_", 3) == 0 ? 3 : 0));
}

static void add_link(reading *r, const char *shader) {
  if ((r->links & (r->links - 1)) == 0) {
    struct link *more = realloc(r->link, (r->links ? 2 * r->links : 1) * sizeof *more);
    if (more == NULL) {
      stop(r, abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", r->path));
      return;
    }
    r->link = more;
  }
  take_name(r->link[r->links].shader, shader);
  take_name(r->link[r->links++].material, r->material);
}

/* The shader takes the name where a table could hold it; else it keeps its own. */
static void take_material_name(const reading *r, abbe_material *m, const char *name) {
  char *own = m->name, *other = strdup(name);
  abbe_error why = {0};
  if (other == NULL) return;
  for (size_t i = 0; i < r->out->count; i++)
    if (strcasecmp(r->out->material[i].name, other) == 0)
      snprintf(why.text, sizeof why.text, "another has that name");
  m->name = other;
  if (why.text[0] == '\0') abbe_material_check(m, &why);
  if (why.text[0] == '\0') {
    free(own);
    return;
  }
  m->name = own;
  free(other);
  abbe_report_add(r->report, ABBE_NOTE_CHANGED, m->line, own,
                  "its surfacematerial's name '%.60s' is not taken: %.200s", name, why.text);
}

/* People name the surfacematerial; what it shows is often named after its kind. */
static void rename_all(const reading *r) {
  for (size_t i = 0; i < r->out->count; i++)
    for (size_t k = 0; k < r->links; k++) {
      abbe_material *m = &r->out->material[i];
      if (strcmp(r->link[k].shader, m->name) != 0) continue;
      if (strcmp(r->link[k].material, m->name) != 0) take_material_name(r, m, r->link[k].material);
      break;
    }
}

static void begin(void *user, const char *element, const char **attributes) {
  reading *r = user;
  if (++r->depth > MOST_DEPTH) {
    stop(r, abbe_error_set(r->error, ABBE_PARSE, "%s: its elements are more than %d deep", r->path,
                           MOST_DEPTH));
    return;
  }
  if (r->model != NULL) {
    if (strcmp(element, "input") == 0) read_input(r, attributes);
    return;
  }
  const char *name = attribute(attributes, "name"), *node = attribute(attributes, "nodename");
  if (strcmp(element, "surfacematerial") == 0)
    snprintf(r->material, sizeof r->material, "%s", name != NULL ? name : "");
  if (r->material[0] != '\0' && strcmp(element, "input") == 0 && node != NULL) add_link(r, node);
  for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
    if (strcmp(models[i].element, element) != 0) continue;
    r->model = &models[i];
    r->line = abbe_xml_line(r->parser);
    r->connected = false;
    take_name(r->name, name != NULL ? name : element);
    r->weight = models[i].default_weight;
    r->ior = 1.5;
    r->dispersion = models[i].default_dispersion;
    r->scale = models[i].scale != NULL ? 0 : 1;
    r->colour[0] = r->colour[1] = r->colour[2] = 1;
    r->distance = 0;
  }
}

/* n_d and V_d of what the numbers say; glTF's word for it, 20 / V_d. */
static double dispersion_of(const reading *r) {
  const bool is_abbe_number = r->model != &models[2];
  if (r->dispersion == 0 || r->scale == 0) return 0;
  return is_abbe_number ? 20 * r->scale / r->dispersion : r->dispersion;
}

static abbe_result absorb(const reading *r, abbe_material *m, abbe_error *error) {
  double colour[3];
  bool clear = true;
  for (int i = 0; i < 3; i++) {
    colour[i] = fmin(fmax(r->colour[i], ABBE_ABSORPTION_LEAST_TRANSMITTANCE), 1);
    clear = clear && colour[i] == 1;
  }
  if (clear) return ABBE_OK;
  if (!(r->distance > 0)) {
    abbe_report_add(r->report, ABBE_NOTE_LOST, r->line, r->name,
                    "its colour is a tint of its surface, for the file states no distance");
    return ABBE_OK;
  }
  abbe_report_add(r->report, ABBE_NOTE_ASSUMED, r->line, r->name,
                  "the file's unit of length is a metre");
  return abbe_absorption_spectrum_of_colour(colour, r->distance, &m->attenuation, error);
}

static abbe_result take(reading *r) {
  const abbe_given given = {.kind = ABBE_GIVEN_GLTF, .first = r->ior, .second = dispersion_of(r)};
  abbe_material m = {.line = r->line, .min_nm = 380, .max_nm = 780, .temperature_c = NAN};
  abbe_error why = {0};
  char source[MOST_NAME + 300];
  if (r->connected || !(r->weight > 0)) {
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, r->line, r->name, "%s",
                    r->connected ? "its numbers come from another node"
                                 : "no light goes through it: its transmission is 0");
    return ABBE_OK;
  }
  if (abbe_convert_make(&given, ABBE_FIT_CAUCHY, &m.dispersion, &why) != ABBE_OK) {
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, r->line, r->name, "%s", why.text);
    return ABBE_OK;
  }
  snprintf(source, sizeof source, "%.200s, %s of MaterialX", r->path, r->model->element);
  m.name = strdup(r->name);
  m.source = strdup(source);
  if (m.name == NULL || m.source == NULL) {
    abbe_material_free(&m);
    return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", r->path);
  }
  abbe_result result = absorb(r, &m, &why);
  if (result == ABBE_OK) result = abbe_material_check(&m, &why);
  if (result == ABBE_OK) {
    result = abbe_material_table_append(r->out, &m, r->error);
  } else if (result != ABBE_NO_MEMORY) {
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, r->line, r->name, "%s", why.text);
    result = ABBE_OK;
  }
  abbe_material_free(&m);
  return result;
}

static void end(void *user, const char *element) {
  reading *r = user;
  r->depth--;
  if (strcmp(element, "surfacematerial") == 0) r->material[0] = '\0';
  if (r->model == NULL || strcmp(element, r->model->element) != 0) return;
  r->found++;
  const abbe_result result = take(r);
  r->model = NULL;
  if (result != ABBE_OK) stop(r, result);
}

abbe_result abbe_mtlx_parse(const char *text, size_t size, const char *path,
                            abbe_material_table *out, abbe_report *report, abbe_error *error) {
  reading r = {
      .parser = XML_ParserCreate(NULL), .path = path, .out = out, .report = report, .error = error};
  if (r.parser == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
  XML_SetUserData(r.parser, &r);
  XML_SetElementHandler(r.parser, begin, end);
  if (XML_Parse(r.parser, text, (int)size, XML_TRUE) != XML_STATUS_OK && r.result == ABBE_OK)
    r.result = abbe_error_set(error, ABBE_PARSE, "%s:%zu: %s", path, abbe_xml_line(r.parser),
                              XML_ErrorString(XML_GetErrorCode(r.parser)));
  XML_ParserFree(r.parser);
  if (r.result == ABBE_OK) rename_all(&r);
  free(r.link);
  if (r.result == ABBE_OK && r.found == 0)
    r.result =
        abbe_error_set(error, ABBE_SCHEMA,
                       "%s: holds none of open_pbr_surface, standard_surface and gltf_pbr", path);
  return r.result;
}
