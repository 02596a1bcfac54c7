#include "spectral/formats/material_import.h"

#include "base/number.h"
#include "base/text.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/absorption.h"
#include "spectral/materials/convert.h"

#include <ctype.h>
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
  r->result = result;
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
static abbe_result take_material_name(const reading *r, abbe_material *m, const char *name) {
  char *own = m->name, *other = strdup(name);
  abbe_error why = {0};
  if (other == NULL) return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", r->path);
  for (size_t i = 0; i < r->out->count; i++)
    if (strcasecmp(r->out->material[i].name, other) == 0)
      snprintf(why.text, sizeof why.text, "another has that name");
  m->name = other;
  if (why.text[0] == '\0') abbe_material_check(m, &why);
  if (why.text[0] == '\0') {
    free(own);
    return ABBE_OK;
  }
  m->name = own;
  free(other);
  abbe_report_add(r->report, ABBE_NOTE_CHANGED, m->line, own,
                  "its surfacematerial's name '%.60s' is not taken: %.200s", name, why.text);
  return ABBE_OK;
}

/* People name the surfacematerial; what it shows is often named after its kind. */
static abbe_result rename_all(const reading *r) {
  for (size_t i = 0; i < r->out->count; i++)
    for (size_t k = 0; k < r->links; k++) {
      abbe_material *m = &r->out->material[i];
      if (strcmp(r->link[k].shader, m->name) != 0) continue;
      if (strcmp(r->link[k].material, m->name) != 0)
        ABBE_TRY(take_material_name(r, m, r->link[k].material));
      break;
    }
  return ABBE_OK;
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

/* A material that cannot be made is skipped; the file is not, but where memory fails. */
static abbe_result skip(reading *r, abbe_result result, const abbe_error *why) {
  if (result == ABBE_NO_MEMORY)
    return abbe_error_set(r->error, result, "%s: %s", r->path, why->text);
  abbe_report_add(r->report, ABBE_NOTE_SKIPPED, r->line, r->name, "%s", why->text);
  return ABBE_OK;
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
  abbe_result result = abbe_convert_make(&given, ABBE_FIT_CAUCHY, &m.dispersion, &why);
  if (result != ABBE_OK) return skip(r, result, &why);
  snprintf(source, sizeof source, "%.200s, %s of MaterialX", r->path, r->model->element);
  m.name = strdup(r->name);
  m.source = strdup(source);
  if (m.name == NULL || m.source == NULL) {
    abbe_material_free(&m);
    return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", r->path);
  }
  result = absorb(r, &m, &why);
  if (result == ABBE_OK) result = abbe_material_check(&m, &why);
  result =
      result == ABBE_OK ? abbe_material_table_append(r->out, &m, r->error) : skip(r, result, &why);
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

/* Whatever has one may have entities and attributes without end. */
static void XMLCALL refuse_type(void *user, const XML_Char *name, const XML_Char *system,
                                const XML_Char *public, int internal) {
  reading *r = user;
  (void)name, (void)system, (void)public, (void)internal;
  stop(r, abbe_error_set(r->error, ABBE_PARSE, "%s:%zu: a MaterialX document has no <!DOCTYPE",
                         r->path, abbe_xml_line(r->parser)));
}

abbe_result abbe_mtlx_parse(const char *text, size_t size, const char *path,
                            abbe_material_table *out, abbe_report *report, abbe_error *error) {
  reading r = {
      .parser = XML_ParserCreate(NULL), .path = path, .out = out, .report = report, .error = error};
  if (r.parser == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
  XML_SetUserData(r.parser, &r);
  XML_SetElementHandler(r.parser, begin, end);
  XML_SetStartDoctypeDeclHandler(r.parser, refuse_type);
  if (XML_Parse(r.parser, text, (int)size, XML_TRUE) != XML_STATUS_OK && r.result == ABBE_OK) {
    const enum XML_Error code = XML_GetErrorCode(r.parser);
    r.result = abbe_error_set(error, code == XML_ERROR_NO_MEMORY ? ABBE_NO_MEMORY : ABBE_PARSE,
                              "%s:%zu: %s", path, abbe_xml_line(r.parser), XML_ErrorString(code));
  }
  XML_ParserFree(r.parser);
  if (r.result == ABBE_OK) r.result = rename_all(&r);
  free(r.link);
  if (r.result == ABBE_OK && r.found == 0)
    r.result =
        abbe_error_set(error, ABBE_SCHEMA,
                       "%s: holds none of open_pbr_surface, standard_surface and gltf_pbr", path);
  return r.result;
}

enum { MTLX_WRITE_MOST_NAME = 120 };

static void put(FILE *to, double value, const char *before) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "%s%s", before, abbe_number_text(abbe_number_tidy(value), text));
}

static void put_text(FILE *to, const char *text) {
  for (; *text != '\0'; text++)
    if (strchr("&<\"", *text) != NULL)
      fputs(*text == '&' ? "&amp;" : *text == '<' ? "&lt;" : "&quot;", to);
    else
      fputc((unsigned char)*text < 0x20 ? ' ' : *text, to);
}

typedef char made_name[MTLX_WRITE_MOST_NAME];

/* MaterialX's names are of letters, digits and '_', each only once: a number is added to the
 * second. */
static void make_name(const char *text, made_name *made, size_t count) {
  char *out = made[count];
  size_t length = 0;
  for (; *text != '\0' && length < MTLX_WRITE_MOST_NAME - 24; text++)
    out[length++] = isalnum((unsigned char)*text) && (unsigned char)*text < 0x80 ? *text : '_';
  out[length] = '\0';
  for (size_t i = 0, again = 2; i < count; i++)
    if (strcmp(made[i], out) == 0) {
      snprintf(out + length, 24, "_%zu", again++);
      i = (size_t)-1; /* from the start */
    }
}

/* The distance where the darkest of the three shares is 1 / e, m, and the shares; 0: clear. */
static double volume_colour(const abbe_material *m, double colour[3]) {
  double most = 0;
  if (m->attenuation == NULL) return 0;
  abbe_absorption_colour(m->attenuation, 1, colour);
  for (int i = 0; i < 3; i++) most = fmax(most, -log(fmax(colour[i], 1e-300)));
  if (!(most > 0)) return 0;
  abbe_absorption_colour(m->attenuation, 1 / most, colour);
  return 1 / most;
}

/* The greatest distance from 380 to 780 nm, within the record's range, between n and Cauchy's two
 * terms. */
static double cauchy_error(const abbe_material *m, double n_d, double v_d) {
  const double F = ABBE_LINE_F_NM, C = ABBE_LINE_C_NM, d = ABBE_LINE_D_NM;
  const double b = (n_d - 1) / v_d / (1 / (F * F) - 1 / (C * C));
  double most = 0;
  for (double l = fmax(m->min_nm, 380); l <= fmin(m->max_nm, 780); l++) {
    const double n = n_d + b * (1 / (l * l) - 1 / (d * d));
    most = fmax(most, fabs(n - abbe_dispersion_n(&m->dispersion, l)));
  }
  return most;
}

static void write_shader(FILE *to, const abbe_material *m, const abbe_dispersion_numbers *d,
                         const char *name) {
  double colour[3];
  const double distance = volume_colour(m, colour);
  fprintf(to, "  <open_pbr_surface name=\"SR_%s\" type=\"surfaceshader\" doc=\"", name);
  put_text(to, m->source);
  fputs("\">\n    <input name=\"specular_roughness\" type=\"float\" value=\"0\"/>\n"
        "    <input name=\"transmission_weight\" type=\"float\" value=\"1\"/>\n"
        "    <input name=\"transmission_dispersion_scale\" type=\"float\" value=\"1\"/>\n",
        to);
  put(to, d->n_d, "    <input name=\"specular_ior\" type=\"float\" value=\"");
  put(to, d->v_d,
      "\"/>\n    <input name=\"transmission_dispersion_abbe_number\" type=\"float\" value=\"");
  if (distance > 0) {
    put(to, distance, "\"/>\n    <input name=\"transmission_depth\" type=\"float\" value=\"");
    for (int i = 0; i < 3; i++)
      put(to, colour[i],
          i == 0 ? "\"/>\n    <input name=\"transmission_color\" type=\"color3\" "
                   "colorspace=\"lin_rec709\" value=\""
                 : ", ");
  }
  fprintf(to,
          "\"/>\n  </open_pbr_surface>\n  <surfacematerial name=\"%s\" type=\"material\">\n"
          "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"SR_%s\"/>\n"
          "  </surfacematerial>\n",
          name, name);
}

abbe_result abbe_mtlx_write(const abbe_material_table *table, FILE *to, abbe_report *report,
                            abbe_error *error) {
  made_name *made = calloc(table->count + 1, sizeof *made);
  size_t count = 0;
  if (made == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names");
  fputs("<?xml version=\"1.0\"?>\n<!-- Written by Abbe. Lengths in metres. -->\n"
        "<materialx version=\"1.39\">\n",
        to);
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    const abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
    const bool covered =
        m->extrapolate || (m->min_nm <= ABBE_LINE_F_NM && m->max_nm >= ABBE_LINE_C_NM);
    if (abbe_material_is_conductor(m) || !covered || !(d.n_d > 1 && d.v_d > 0 && isfinite(d.v_d))) {
      abbe_report_add(report, ABBE_NOTE_SKIPPED, m->line, m->name, "%s",
                      abbe_material_is_conductor(m) ? "it is a conductor"
                                                    : "it has no n_d and V_d in its range");
      continue;
    }
    if (abbe_material_is_crystal(m))
      abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                      "it is written with its %s index and its first absorption alone",
                      abbe_material_is_biaxial(m) ? "middle" : "ordinary");
    if (abbe_material_is_fluorescent(m))
      abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                      "it is written without its fluorescence and without what excites it");
    abbe_report_add(
        report, ABBE_NOTE_LOST, m->line, m->name,
        "n is Cauchy's two terms through n_d %.6g and V_d %.4g; from 380 to 780 nm it is "
        "off by up to %.2g%s",
        d.n_d, d.v_d, cauchy_error(m, d.n_d, d.v_d),
        m->attenuation != NULL ? "; absorption is three numbers" : "");
    make_name(m->name, made, count);
    write_shader(to, m, &d, made[count++]);
  }
  free(made);
  fputs("</materialx>\n", to);
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "the materials could not be written");
}
