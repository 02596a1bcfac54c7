#include "validation/sweep/scaling_study.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/plot/chart.h"
#include "library/choice/sweep_setting.h"
#include "validation/sweep/sweep_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FACES = 2000000 };

#define ABBE_NAME_OF(code, name, text) name,
#define ABBE_TEXT_OF(code, name, text) text,
static const char *const names[] = {ABBE_SCALINGS(ABBE_NAME_OF)};
static const char *const texts[] = {ABBE_SCALINGS(ABBE_TEXT_OF)};

/* Meshes */

static void middle(const double a[3], const double b[3], bool unit, double out[3]) {
  double length = 0;
  for (int k = 0; k < 3; k++) {
    out[k] = 0.5 * (a[k] + b[k]);
    length += out[k] * out[k];
  }
  for (int k = 0; k < 3 && unit && length > 0; k++) out[k] /= sqrt(length);
}

/* Every face in four, flat: three corners and three middles of edges each. */
static abbe_result quarter(const abbe_mesh *from, abbe_mesh *out, abbe_error *error) {
  static const uint32_t part[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  size_t faces = from->face_count;
  abbe_result result = abbe_mesh_make(6 * faces, 4 * faces, from->uv != NULL, out, error);
  for (size_t i = 0; i < faces && result == ABBE_OK; i++) {
    const uint32_t *corner = from->face[i];
    for (size_t k = 0; k < 3; k++) {
      uint32_t a = corner[k], b = corner[(k + 1) % 3];
      memcpy(out->position[6 * i + k], from->position[a], sizeof *out->position);
      memcpy(out->normal[6 * i + k], from->normal[a], sizeof *out->normal);
      middle(from->position[a], from->position[b], false, out->position[6 * i + 3 + k]);
      middle(from->normal[a], from->normal[b], true, out->normal[6 * i + 3 + k]);
      for (int c = 0; c < 2 && from->uv != NULL; c++) {
        out->uv[6 * i + k][c] = from->uv[a][c];
        out->uv[6 * i + 3 + k][c] = 0.5 * (from->uv[a][c] + from->uv[b][c]);
      }
    }
    for (size_t p = 0; p < 4; p++)
      for (size_t k = 0; k < 3; k++) out->face[4 * i + p][k] = (uint32_t)(6 * i) + part[p][k];
  }
  return result;
}

static size_t count_faces(const abbe_scene *scene) {
  size_t faces = 0;
  for (size_t i = 0; i < scene->object_count; i++)
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR)
      faces += scene->object[i].mesh.face_count;
  return faces;
}

static abbe_result refine(abbe_scene *scene, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++) {
    abbe_mesh finer;
    if (abbe_object_kind_of(&scene->object[i]) != ABBE_OBJECT_REFRACTOR) continue;
    result = quarter(&scene->object[i].mesh, &finer, error);
    if (result != ABBE_OK) break;
    abbe_mesh_free(&scene->object[i].mesh);
    scene->object[i].mesh = finer;
  }
  return result;
}

/* Measuring */

typedef struct work {
  const abbe_sweep *sweep;
  abbe_scene *scene;
  abbe_sweep_setting base;
  size_t side;
  abbe_render_progress progress;
  void *user;
  abbe_scaling_study *out;
  abbe_error *error;
} work;

static abbe_result add(work *w, abbe_scaling_study_axis axis, double x,
                       const abbe_sweep_setting *setting, size_t side) {
  abbe_sweep_row row;
  abbe_scaling_study *g = w->out;
  if (g->count == ABBE_SCALING_MAX) return ABBE_OK;
  if (w->progress != NULL && !w->progress(w->user, (double)g->count / 24))
    return abbe_error_set(w->error, ABBE_CANCELLED, "stopped; nothing was written");
  abbe_sweep sweep = *w->sweep;
  sweep.scene = w->scene;
  abbe_result result = abbe_sweep_time(&sweep, setting, side, side, &row, w->error);
  if (result != ABBE_OK) return result;
  g->point[g->count++] = (abbe_scaling_study_point){axis,
                                                    x,
                                                    row.number[ABBE_SWEEP_FRAME_MS],
                                                    row.number[ABBE_SWEEP_LIGHT_MS],
                                                    row.number[ABBE_SWEEP_EYE_MS],
                                                    row.number[ABBE_SWEEP_BASELINE_MS]};
  return ABBE_OK;
}

static abbe_result grow_setting(work *w, abbe_scaling_study_axis axis) {
  static const size_t eighths[] = {1, 2, 4, 8, 16}, wavelengths[] = {1, 3, 7, 14, 28, 56};
  bool of_photons = axis == ABBE_SCALING_PHOTONS;
  size_t count =
      of_photons ? sizeof eighths / sizeof *eighths : sizeof wavelengths / sizeof *wavelengths;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    abbe_sweep_setting s = w->base;
    if (of_photons)
      s.photons = w->side * eighths[i] / 8;
    else
      s.wavelengths = wavelengths[i];
    result = add(w, axis, of_photons ? (double)(s.photons * s.photons) : (double)s.wavelengths, &s,
                 w->side);
  }
  return result;
}

static abbe_result grow_pixels(work *w) {
  abbe_result result = ABBE_OK;
  for (size_t side = w->side / 4; side <= 2 * w->side && result == ABBE_OK; side *= 2)
    result = add(w, ABBE_SCALING_PIXELS, (double)(side * side), &w->base, side);
  return result;
}

static abbe_result grow_share(work *w) {
  static const double share[] = {1 / 16.0, 1 / 4.0, 1, 2};
  const double fov = w->scene->camera.fov_y_rad;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof share / sizeof *share && result == ABBE_OK; i++) {
    w->scene->camera.fov_y_rad = 2 * atan(tan(0.5 * fov) / sqrt(share[i]));
    result = add(w, ABBE_SCALING_SHARE, share[i], &w->base, w->side);
  }
  w->scene->camera.fov_y_rad = fov;
  return result;
}

/* On copies of the refractors' meshes. */
static abbe_result grow_faces(work *w) {
  abbe_mesh *kept = calloc(w->scene->object_count + 1, sizeof *kept);
  if (kept == NULL) return abbe_error_set(w->error, ABBE_NO_MEMORY, "no memory for meshes");
  abbe_result result = add(w, ABBE_SCALING_FACES, (double)count_faces(w->scene), &w->base, w->side);
  for (size_t i = 0; i < w->scene->object_count && result == ABBE_OK; i++) {
    if (abbe_object_kind_of(&w->scene->object[i]) != ABBE_OBJECT_REFRACTOR) continue;
    kept[i] = w->scene->object[i].mesh;
    w->scene->object[i].mesh = (abbe_mesh){0};
    result = quarter(&kept[i], &w->scene->object[i].mesh, w->error);
  }
  for (int i = 0; i < 3 && result == ABBE_OK && count_faces(w->scene) <= MAX_FACES; i++) {
    if (i > 0) result = refine(w->scene, w->error);
    if (result == ABBE_OK)
      result = add(w, ABBE_SCALING_FACES, (double)count_faces(w->scene), &w->base, w->side);
  }
  for (size_t i = 0; i < w->scene->object_count; i++) {
    if (kept[i].face_count == 0) continue;
    abbe_mesh_free(&w->scene->object[i].mesh);
    w->scene->object[i].mesh = kept[i];
  }
  free(kept);
  return result;
}

abbe_result abbe_scaling_study_measure(const abbe_sweep *sweep, abbe_scene *scene, size_t side,
                                       abbe_render_progress progress, void *user,
                                       abbe_scaling_study *out, abbe_error *error) {
  work w = {sweep, scene, {.wavelengths = 0}, side, progress, user, out, error};
  abbe_sweep_setting *list = NULL;
  size_t count, refused;
  const abbe_sweep_grid grid = {.wavelengths = {1, {7}},
                                .photons = {1, {side / 2}},
                                .map = {1, {2 * side}},
                                .samples = {1, {1}}};
  *out = (abbe_scaling_study){.count = 0};
  if (side < 16 || side % 8 != 0 || 2 * side > ABBE_RENDER_MAX_MAP)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the base picture has %zu pixels a side; it may have 16 to %d, in eights",
                          side, ABBE_RENDER_MAX_MAP / 2);
  abbe_result result =
      abbe_sweep_grid_expand(scene, &grid, 1, &list, &count, &refused, NULL, error);
  if (result != ABBE_OK) return result;
  w.base = list[0];
  free(list);
  snprintf(out->scene, sizeof out->scene, "%.255s", scene->path);
  abbe_sweep_setting_describe(&w.base, out->base, sizeof out->base);
  const double base_x[] = {(double)(w.base.photons * w.base.photons), (double)w.base.wavelengths,
                           (double)(side * side), (double)count_faces(scene), 1};
  memcpy(out->base_x, base_x, sizeof out->base_x);
  result = grow_setting(&w, ABBE_SCALING_PHOTONS);
  if (result == ABBE_OK) result = grow_setting(&w, ABBE_SCALING_WAVELENGTHS);
  if (result == ABBE_OK) result = grow_pixels(&w);
  if (result == ABBE_OK) result = grow_faces(&w);
  return result == ABBE_OK ? grow_share(&w) : result;
}

/* Numbers */

double abbe_scaling_study_slope(const abbe_scaling_study *g, abbe_scaling_study_axis axis) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (size_t i = 0; i < g->count; i++) {
    if (g->point[i].axis != axis) continue;
    double a = log(g->point[i].x), b = log(g->point[i].frame_ms);
    n++;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  double spread = n * xx - x * x;
  return n >= 2 && spread > 0 ? (n * xy - x * y) / spread : NAN;
}

abbe_result abbe_scaling_study_save(const abbe_scaling_study *g, const char *path,
                                    abbe_error *error) {
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  fprintf(writer.stream, "# scene: %s\n# base: %s\naxis,x,frame_ms,light_ms,eye_ms,baseline_ms\n",
          g->scene, g->base);
  for (size_t i = 0; i < g->count; i++) {
    const abbe_scaling_study_point *p = &g->point[i];
    const double value[] = {p->x, p->frame_ms, p->light_ms, p->eye_ms, p->baseline_ms};
    fprintf(writer.stream, "%s", names[p->axis]);
    for (int k = 0; k < 5; k++) {
      char text[ABBE_NUMBER_TEXT_SIZE];
      fprintf(writer.stream, ",%s", abbe_number_text(value[k], text));
    }
    fprintf(writer.stream, "\n");
  }
  return abbe_file_writer_commit(&writer, error);
}

void abbe_scaling_study_print(const abbe_scaling_study *g, FILE *out) {
  fprintf(out,
          "%s; %s\n\n| what grows | | frame, ms | light's passes | eye's passes | baseline |\n"
          "|---|---|---|---|---|---|\n",
          g->scene, g->base);
  for (size_t i = 0; i < g->count; i++) {
    const abbe_scaling_study_point *p = &g->point[i];
    bool first = i == 0 || p[-1].axis != p->axis;
    fprintf(out, "| %s", first ? texts[p->axis] : "");
    if (first) abbe_number_write(out, " (slope %.2f)", abbe_scaling_study_slope(g, p->axis));
    abbe_number_write(out, " | %.4g | %.1f | %.1f | %.1f | %.1f |\n", p->x, p->frame_ms,
                      p->light_ms, p->eye_ms, p->baseline_ms);
  }
}

/* The chart */

abbe_result abbe_scaling_study_plot(const abbe_scaling_study *g, const char *path,
                                    abbe_error *error) {
  double x[ABBE_SCALING_MAX], y[ABBE_SCALING_MAX], line_x[2] = {1, 1}, line_y[2];
  char label[ABBE_SCALING_COUNT][96], title[320];
  abbe_chart_series series[ABBE_SCALING_COUNT + 1];
  size_t used = 0;
  double base_ms = NAN;
  for (size_t i = 0; i < g->count; i++) {
    const abbe_scaling_study_point *p = &g->point[i];
    x[i] = p->x / g->base_x[p->axis];
    y[i] = p->frame_ms;
    line_x[0] = fmin(line_x[0], x[i]);
    line_x[1] = fmax(line_x[1], x[i]);
    if (p->axis == ABBE_SCALING_PIXELS && x[i] == 1) base_ms = y[i];
    if (i == 0 || p[-1].axis != p->axis) {
      abbe_number_format(label[used], sizeof label[used], "%s (slope %.2f)", texts[p->axis],
                         abbe_scaling_study_slope(g, p->axis));
      series[used] = (abbe_chart_series){
          .label = label[used], .style = ABBE_CHART_JOINED_POINTS, .x = &x[i], .y = &y[i]};
      used++;
    }
    series[used - 1].count++;
  }
  if (used == 0) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no times to draw");
  /* As far as the times go, so that the guide does not lengthen the axis. */
  double least = y[0], most = y[0];
  for (size_t i = 0; i < g->count; i++) {
    least = fmin(least, y[i]);
    most = fmax(most, y[i]);
  }
  line_x[0] = fmax(line_x[0], least / base_ms);
  line_x[1] = fmin(line_x[1], most / base_ms);
  for (int i = 0; i < 2; i++) line_y[i] = base_ms * line_x[i];
  series[used++] = (abbe_chart_series){.label = "proportional",
                                       .style = ABBE_CHART_DASHED,
                                       .count = 2,
                                       .x = line_x,
                                       .y = line_y,
                                       .colour = 7};
  const char *slash = strrchr(g->scene, '/');
  snprintf(title, sizeof title, "%s: how a frame's time grows",
           slash != NULL ? slash + 1 : g->scene);
  const abbe_chart chart = {.title = title,
                            .x = {.label = "times the base setting's", .log = true},
                            .y = {.label = "frame, ms (median)", .log = true},
                            .series_count = used,
                            .series = series};
  return abbe_chart_write(path, &chart, 1, 960, 560, error);
}
