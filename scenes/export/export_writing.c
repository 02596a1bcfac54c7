#include "scenes/export/export_writing.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Quotes, brackets and blanks are the formats' own. */
static bool spellable(const char *name) {
  for (; *name != '\0'; name++)
    if ((unsigned char)*name <= ' ' || strchr("\"'\\<>&|#$", *name) != NULL) return false;
  return true;
}

abbe_result abbe_export_files_begin(abbe_export_files *files, const char *path, abbe_error *error) {
  const char *name = abbe_file_name(path), *dot = strrchr(name, '.');
  if (!spellable(name))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the name '%.200s' has a blank, a quote or another mark that exported "
                          "files cannot name; give it a plainer name",
                          name);
  const size_t length = dot != NULL && dot > name ? (size_t)(dot - path) : strlen(path);
  files->stem = strndup(path, length);
  if (files->stem == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  files->name = abbe_file_name(files->stem);
  return ABBE_OK;
}

void abbe_export_files_free(abbe_export_files *files) {
  for (size_t i = 0; i < files->count; i++) {
    free(files->file[i].path);
    abbe_image_free(&files->file[i].picture);
  }
  free(files->file);
  free(files->stem);
  memset(files, 0, sizeof *files);
}

/* The picture is taken, whatever the result. */
static abbe_result add_picture(abbe_export_files *files, const char *suffix, abbe_image *picture,
                               abbe_error *error) {
  abbe_export_file *all = realloc(files->file, (files->count + 1) * sizeof *all);
  const size_t size = strlen(files->stem) + strlen(suffix) + 1;
  char *path = malloc(size);
  if (all != NULL) files->file = all;
  if (all == NULL || path == NULL) {
    free(path);
    abbe_image_free(picture);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an exported file");
  }
  snprintf(path, size, "%s%s", files->stem, suffix);
  files->file[files->count++] =
      (abbe_export_file){.path = path, .picture = *picture, .fresh = access(path, F_OK) != 0};
  *picture = (abbe_image){0};
  return ABBE_OK;
}

abbe_result abbe_export_files_write(abbe_export_files *files, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < files->count && result == ABBE_OK; i++) {
    abbe_export_file *file = &files->file[i];
    result = abbe_exr_write(file->path, &file->picture, error);
    file->written = result == ABBE_OK;
  }
  if (result != ABBE_OK) abbe_export_files_undo(files);
  return result;
}

void abbe_export_files_undo(abbe_export_files *files) {
  for (size_t i = 0; i < files->count; i++)
    if (files->file[i].written && files->file[i].fresh) unlink(files->file[i].path);
}

const char *abbe_export_name(char out[ABBE_EXPORT_NAME_SIZE], const char *prefix, size_t number,
                             const char *name) {
  size_t at = (size_t)snprintf(out, ABBE_EXPORT_NAME_SIZE, "%.8s%zu_", prefix, number);
  for (int i = 0; name != NULL && name[i] != '\0' && i < 40; i++) {
    const char c = name[i];
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    out[at++] = plain ? c : '_';
  }
  out[at] = '\0';
  return out;
}

size_t abbe_export_glass_of(const abbe_export_writing *w, const abbe_material *material) {
  size_t i = 0;
  while (i + 1 < w->report->glass_count && w->report->glass[i].material != material) i++;
  return i;
}

/* One line, of which no "-->" or "--" is left. */
static void put_plain(FILE *file, const char *text) {
  for (char before = ' '; *text != '\0'; before = *text++) {
    const bool twice = *text == '-' && before == '-';
    fputc(iscntrl((unsigned char)*text) ? '?' : twice ? '_' : *text, file);
  }
}

void abbe_export_comment(const abbe_export_writing *w, const char *before, const char *after) {
  char text[600];
  fputs(before, w->file);
  put_plain(w->file, "Abbe's scene ");
  put_plain(w->file, w->scene->path != NULL ? w->scene->path : "");
  fprintf(w->file, ", in metres%s", after);
  for (size_t i = 0; i < w->report->glass_count; i++) {
    const abbe_scene_export_glass *g = &w->report->glass[i];
    abbe_number_format(text, sizeof text,
                       "%s: n as '%s' is off by up to %.2g (at %g nm), RMS %.2g, 380 to 780 nm",
                       g->material->name, abbe_export_form_name(g->index.form), g->index.worst,
                       g->index.worst_nm, g->index.rms);
    fputs(before, w->file);
    put_plain(w->file, text);
    fputs(after, w->file);
  }
  for (size_t i = 0; i < w->report->notes.count; i++) {
    const abbe_note *note = &w->report->notes.note[i];
    snprintf(text, sizeof text, "%s: %s%s%s", abbe_note_kind_word(note->kind), note->name,
             note->name[0] != '\0' ? ": " : "", note->text);
    fputs(before, w->file);
    put_plain(w->file, text);
    fputs(after, w->file);
  }
}

static void export_numbers(FILE *file, const double *v, size_t count, const char *separator) {
  for (size_t i = 0; i < count; i++)
    abbe_number_write(file, "%s%.9g", i > 0 ? separator : "", v[i]);
}

void abbe_export_vector(FILE *file, const double v[3], const char *separator) {
  export_numbers(file, v, 3, separator);
}

void abbe_export_camera(const abbe_camera *camera, double right[3], double up[3],
                        double forward[3]) {
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_vector_normalise(forward);
  abbe_vector_cross(forward, camera->up, right);
  abbe_vector_normalise(right);
  abbe_vector_cross(right, forward, up);
}

void abbe_export_basis(const double direction[3], double a[3], double b[3]) {
  const int axis = fabs(direction[0]) < 0.6 ? 0 : 1;
  const double hint[3] = {axis == 0, axis == 1, 0};
  abbe_vector_cross(direction, hint, a);
  abbe_vector_normalise(a);
  abbe_vector_cross(direction, a, b);
}

void abbe_export_light_rgb(const abbe_illuminant *illuminant, double rgb[3]) {
  double white[3], matrix[9];
  abbe_weights_band_xyz(illuminant, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM,
                        ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, white);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, white, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = fmax(rgb[c], 0);
}

void abbe_export_light_spectrum(const abbe_illuminant *illuminant, double factor,
                                void (*put)(void *user, double lambda_nm, double value),
                                void *user) {
  double line[ABBE_ILLUMINANT_MOST_LINES];
  const size_t points = 3 * abbe_illuminant_lines(illuminant, line);
  for (size_t i = 0; i < points; i++) { /* its own points: nothing shines between them */
    const double nm = abbe_spectrum_lambda_nm(illuminant->spectrum)[i];
    put(user, nm, factor * abbe_spectrum_value(illuminant->spectrum)[i]);
  }
  if (points > 0) return;
  const bool dense =
      illuminant->kind == ABBE_ILLUMINANT_TABULATED || illuminant->kind == ABBE_ILLUMINANT_A;
  for (double nm = ABBE_WAVELENGTH_MIN_NM; nm <= ABBE_WAVELENGTH_MAX_NM; nm += dense ? 1 : 5)
    put(user, nm, factor * abbe_illuminant_power(illuminant, nm));
}

bool abbe_export_is_grey(const abbe_object *receiver) {
  const double *r = receiver->reflectance;
  return receiver->spectrum == NULL && r[0] == r[1] && r[1] == r[2];
}

/* A Rec.709 colour is lifted to what is linear between multiples of 5 nm, as a table's points are;
 * what is measured has its own points, or is curved between them. */
static double next_point(const abbe_spectrum *measured, double nm) {
  if (measured == NULL) return nm + ABBE_EXPORT_TABLE_STEP_NM;
  if (abbe_spectrum_interpolation(measured) != ABBE_INTERPOLATION_LINEAR) return nm + 1;
  const double *at = abbe_spectrum_lambda_nm(measured);
  const size_t count = abbe_spectrum_count(measured);
  size_t i = 0;
  while (i < count && at[i] <= nm) i++;
  return i < count ? at[i] : INFINITY;
}

void abbe_export_reflectance(const abbe_object *receiver,
                             void (*put)(void *user, double lambda_nm, double value), void *user) {
  const double last =
      ABBE_EXPORT_TABLE_FIRST_NM + ABBE_EXPORT_TABLE_STEP_NM * (ABBE_EXPORT_TABLE_COUNT - 1);
  for (double nm = ABBE_EXPORT_TABLE_FIRST_NM;;
       nm = fmin(next_point(receiver->spectrum, nm), last)) {
    double channel[3], sum = 0;
    abbe_reflectance_channels(receiver->spectrum, nm, channel);
    for (int c = 0; c < 3; c++)
      sum += (receiver->spectrum != NULL ? 1 : receiver->reflectance[c]) * channel[c];
    put(user, nm, sum);
    if (nm >= last) return;
  }
}

static void put_corner(abbe_mesh *mesh, size_t i, const abbe_light *light, const double a[3],
                       double x, const double b[3], double y) {
  for (int k = 0; k < 3; k++) {
    mesh->position[i][k] = light->position[k] + x * a[k] + y * b[k];
    mesh->normal[i][k] = light->direction[k];
  }
}

abbe_result abbe_export_light_mesh(const abbe_light *light, abbe_mesh *out, abbe_error *error) {
  const size_t sides = light->kind == ABBE_LIGHT_DISK ? ABBE_EXPORT_DISK_SIDES : 4;
  ABBE_TRY(abbe_mesh_make(sides, sides - 2, false, out, error));
  if (light->kind == ABBE_LIGHT_DISK) {
    const double step = 2 * ABBE_PI / (double)sides;
    const double radius = light->radius * sqrt(step / sin(step));
    double a[3], b[3];
    abbe_export_basis(light->direction, a, b);
    for (size_t i = 0; i < sides; i++)
      put_corner(out, i, light, a, radius * cos(step * (double)i), b,
                 radius * sin(step * (double)i));
  } else {
    static const double x[4] = {-1, 1, 1, -1}, y[4] = {-1, -1, 1, 1};
    double normal[3];
    abbe_vector_cross(light->edge[0], light->edge[1], normal);
    const int turned = abbe_vector_dot(normal, light->direction) < 0;
    for (size_t i = 0; i < 4; i++)
      put_corner(out, i, light, light->edge[turned], x[i], light->edge[!turned], y[i]);
  }
  for (size_t f = 0; f + 2 < sides; f++) {
    out->face[f][0] = 0;
    out->face[f][1] = (uint32_t)f + 1;
    out->face[f][2] = (uint32_t)f + 2;
  }
  return ABBE_OK;
}

void abbe_export_attenuation_rgb(const abbe_material *material, double per_m[3]) {
  static const double nm[3] = {611.4, 549.1, 464.2};
  for (int c = 0; c < 3; c++) per_m[c] = abbe_material_attenuation(material, nm[c]);
}

static void export_nk(const abbe_material *conductor, double lambda_nm, double *n, double *k) {
  const double at = fmin(fmax(lambda_nm, conductor->min_nm), conductor->max_nm);
  if (abbe_material_nk(conductor, at, n, k, NULL) != ABBE_OK) *n = *k = 1;
}

double abbe_export_conductor_n(const abbe_material *conductor, double lambda_nm) {
  double n, k;
  export_nk(conductor, lambda_nm, &n, &k);
  return n;
}

double abbe_export_conductor_k(const abbe_material *conductor, double lambda_nm) {
  double n, k;
  export_nk(conductor, lambda_nm, &n, &k);
  return k;
}

double abbe_export_roughness(const abbe_object *mirror) {
  return sqrt(mirror->brushing.facets.x * mirror->brushing.facets.y);
}

void abbe_export_mirror_rgb(const abbe_object *mirror, double rgb[3]) {
  const abbe_illuminant d65 = {0};
  double xyz[3] = {0}, matrix[9];
  for (int c = 0; c < 3; c++) rgb[c] = mirror->mirror_reflectance;
  if (mirror->conductor == NULL) return;
  abbe_weights_range range;
  abbe_weights_range_make(&d65, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, &range);
  for (double nm = ABBE_WAVELENGTH_MIN_NM; nm < ABBE_WAVELENGTH_MAX_NM; nm += 5) {
    double n, k, band[3];
    export_nk(mirror->conductor, nm + 2.5, &n, &k);
    const double reflected = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    abbe_weights_range_xyz(&range, nm, nm + 5, band);
    for (int c = 0; c < 3; c++) xyz[c] += reflected * band[c];
  }
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = fmin(fmax(rgb[c], 0), 1);
}

static abbe_result make_picture(size_t width, size_t height, abbe_image *out, abbe_error *error) {
  static const char *const channels[] = {"R", "G", "B"};
  ABBE_TRY(abbe_image_make(width, height, 3, channels, out, error));
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, out->xy);
  return ABBE_OK;
}

abbe_result abbe_export_environment(const abbe_export_writing *w, size_t width, size_t height,
                                    void (*direction)(double u, double v, double out[3]),
                                    abbe_error *error) {
  enum { FINE = 4 }; /* places across a texel */
  const abbe_environment *e = w->scene->environment;
  double white[3];
  abbe_image picture;
  ABBE_TRY(make_picture(width, height, &picture, error));
  abbe_export_light_rgb(&e->illuminant, white);
  for (size_t i = 0; i < width * height; i++) {
    double sum[3] = {0};
    for (int s = 0; s < FINE * FINE; s++) {
      double way[3], rgb[3];
      direction(((double)(i % width) + (s % FINE + 0.5) / FINE) / (double)width,
                ((double)(i / width) + (s / FINE + 0.5) / FINE) / (double)height, way);
      abbe_environment_radiance(e, way, rgb);
      for (int c = 0; c < 3; c++) sum[c] += rgb[c];
    }
    for (int c = 0; c < 3; c++)
      picture.data[3 * i + (size_t)c] = (float)(white[c] * sum[c] / (FINE * FINE));
  }
  return add_picture(w->files, "-environment.exr", &picture, error);
}

abbe_result abbe_export_texture(const abbe_export_writing *w, const abbe_object *object,
                                const char *name, abbe_error *error) {
  const abbe_image *from = &object->texture;
  char suffix[ABBE_EXPORT_NAME_SIZE + 8];
  abbe_image picture;
  ABBE_TRY(make_picture(from->width, from->height, &picture, error));
  for (size_t i = 0; i < from->width * from->height; i++)
    for (size_t c = 0; c < 3; c++)
      picture.data[3 * i + c] =
          (float)(object->reflectance[c] * (double)from->data[from->channels * i + c]);
  snprintf(suffix, sizeof suffix, "-%s.exr", name);
  return add_picture(w->files, suffix, &picture, error);
}

bool abbe_export_is_faceted(const abbe_mesh *mesh) {
  for (size_t f = 0; f < mesh->face_count; f++) {
    double n[3];
    const uint32_t *corner = mesh->face[f];
    abbe_vector_triangle(mesh->position[corner[0]], mesh->position[corner[1]],
                         mesh->position[corner[2]], n);
    if (!abbe_vector_normalise(n)) continue;
    for (int k = 0; k < 3; k++)
      if (abbe_vector_dot(n, mesh->normal[corner[k]]) < 1 - 1e-9) return false;
  }
  return true;
}
