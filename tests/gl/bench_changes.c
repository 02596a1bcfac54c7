/* Times what follows a change of a renderer, for script/bench-changes and script/bench-gpu: no
 * test. */
#include "base/clock.h"
#include "gl/renderer.h"
#include "scenes/geometry/transform.h"
#include "scenes/import/scene_file.h"
#include "scenes/object_motion.h"
#include "scenes/volume/caustic_volume.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_REPEATS = 5, SUN_FRAMES = 13 };

typedef struct bench {
  abbe_context *context;
  abbe_scene scene;
  abbe_render_desc desc;
  abbe_renderer *renderer;
  int repeats; /* odd */
} bench;

static void must(abbe_result result, const abbe_error *error) {
  if (result == ABBE_OK) return;
  fprintf(stderr, "bench_changes: %s\n", error->text);
  exit(1);
}

static double now_ms(void) {
  return 1e3 * abbe_clock_seconds();
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void change_camera(bench *b, int k) {
  b->scene.camera.eye[0] += k % 2 == 0 ? 0.01 : -0.01;
}

static void change_power(bench *b, int k) {
  b->scene.light[0].power *= k % 2 == 0 ? 0.5 : 2;
}

static void change_light(bench *b, int k) {
  double *d = b->scene.light[0].direction;
  b->scene.light[0].position[0] += k % 2 == 0 ? 0.002 : -0.002;
  if (b->scene.light[0].kind != ABBE_LIGHT_DIRECTIONAL) return;
  d[0] += k % 2 == 0 ? 0.002 : -0.002;
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (int i = 0; i < 3; i++) d[i] /= length;
}

static void change_object(bench *b, int k) {
  const double offset[3] = {k % 2 == 0 ? 0.002 : -0.002, 0, 0};
  double matrix[16];
  abbe_error error;
  abbe_transform_translate(offset, matrix);
  for (size_t i = 0; i < b->scene.object_count; i++) {
    if (b->scene.object[i].material == NULL) continue;
    must(abbe_object_move(&b->scene.object[i], matrix, &error), &error);
    return;
  }
}

static void change_material(bench *b, int k) {
  for (size_t i = 0; i < b->scene.table.count; i++)
    b->scene.table.material[i].dispersion.c[0] += k % 2 == 0 ? 1e-3 : -1e-3;
}

static void draw(abbe_renderer *renderer) {
  abbe_error error;
  must(abbe_renderer_frame(renderer, NULL, NULL, NULL, &error), &error);
}

/* The median of what the change and its frame take. */
static double time_change(bench *b, void (*change)(bench *, int)) {
  double ms[MAX_REPEATS];
  abbe_error error;
  for (int k = -2; k < b->repeats; k++) { /* the first two compile what is new */
    change(b, k + 2);
    const double start = now_ms();
    must(abbe_renderer_change(b->renderer, &b->scene, &b->desc, &error), &error);
    draw(b->renderer);
    if (k >= 0) ms[k] = now_ms() - start;
  }
  qsort(ms, (size_t)b->repeats, sizeof *ms, ascending);
  return ms[b->repeats / 2];
}

static double time_anew(bench *b) {
  abbe_renderer *anew = NULL;
  abbe_error error;
  const double start = now_ms();
  must(abbe_renderer_make(b->context, &b->scene, &b->desc, &anew, &error), &error);
  draw(anew);
  const double ms = now_ms() - start;
  abbe_renderer_free(anew);
  return ms;
}

/* When somebody who watches was asked, and the longest time between. */
typedef struct asked {
  double last_ms, longest_ms;
  int calls, stop_at;
  double stopped_ms;
} asked;

static bool ask(void *user, double done) {
  asked *a = user;
  const double at = now_ms();
  (void)done;
  if (a->calls++ > 0 && at - a->last_ms > a->longest_ms) a->longest_ms = at - a->last_ms;
  a->last_ms = at;
  if (a->calls != a->stop_at) return true;
  a->stopped_ms = at;
  return false;
}

/* The longest time between two questions in a whole watched frame, and after a no to its end. */
static void time_cancel(bench *b, double *between_ms, double *after_ms) {
  asked a = {.stop_at = -1};
  abbe_error error;
  abbe_renderer_redraw(b->renderer);
  must(abbe_renderer_frame(b->renderer, ask, &a, NULL, &error), &error);
  *between_ms = a.longest_ms;
  *after_ms = 0;
  for (int part = 1; part < 8; part++) {
    asked no = {.stop_at = 1 + a.calls * part / 8};
    abbe_renderer_redraw(b->renderer);
    if (abbe_renderer_frame(b->renderer, ask, &no, NULL, &error) != ABBE_CANCELLED) continue;
    const double ms = now_ms() - no.stopped_ms;
    if (ms > *after_ms) *after_ms = ms;
  }
}

static double median(double *ms, size_t count) {
  qsort(ms, count, sizeof *ms, ascending);
  return ms[count / 2];
}

/* Frames of a sun that goes from where it stands to another direction, by a volume: the change and
 * its frame, and the change alone, by the clock; and what processors spend on them. */
static void time_sun(bench *b, const char *name, const double to[3]) {
  double ms[SUN_FRAMES], change_ms[SUN_FRAMES], processor_ms[SUN_FRAMES],
      processor_change_ms[SUN_FRAMES], from[3];
  abbe_error error;
  memcpy(from, b->scene.light[0].direction, sizeof from);
  for (int k = -2; k < SUN_FRAMES; k++) { /* the first two compile what is new */
    const double part = (double)(k + 2) / (SUN_FRAMES + 1);
    double *d = b->scene.light[0].direction, square = 0;
    for (int i = 0; i < 3; i++) d[i] = from[i] + part * (to[i] - from[i]);
    for (int i = 0; i < 3; i++) square += d[i] * d[i];
    for (int i = 0; i < 3; i++) d[i] /= sqrt(square);
    const double start = now_ms(), spent = (double)clock();
    must(abbe_renderer_change(b->renderer, &b->scene, &b->desc, &error), &error);
    const double changed = now_ms(), spent_there = (double)clock();
    must(abbe_renderer_frame(b->renderer, NULL, NULL, NULL, &error), &error);
    if (k < 0) continue;
    ms[k] = now_ms() - start;
    change_ms[k] = changed - start;
    processor_ms[k] = 1e3 * ((double)clock() - spent) / CLOCKS_PER_SEC;
    processor_change_ms[k] = 1e3 * (spent_there - spent) / CLOCKS_PER_SEC;
  }
  printf("| %s | %.1f | %.1f | %.1f | %.1f |\n", name, median(ms, SUN_FRAMES),
         median(change_ms, SUN_FRAMES), median(processor_ms, SUN_FRAMES),
         median(processor_change_ms, SUN_FRAMES));
}

/* Of a scene of one sun, by a volume. */
static int bench_sun(bench *b, char **argument) {
  static const double to[3] = {-0.25, 0.4, -1};
  abbe_caustic_volume volume;
  abbe_error error;
  must(abbe_volume_file_read(argument[0], &volume, &error), &error);
  must(abbe_context_make(ABBE_CONTEXT_CPU, &b->context, &error), &error);
  must(abbe_scene_load(argument[2], NULL, &b->scene, &error), &error);
  b->desc.width = b->desc.height = (size_t)strtoul(argument[1], NULL, 10);
  b->desc.volume = &volume;
  if (volume.kind == ABBE_VOLUME_PRINTED) b->desc.profile = ABBE_PROFILE_WYMAN2003;
  must(abbe_renderer_make(b->context, &b->scene, &b->desc, &b->renderer, &error), &error);
  must(abbe_renderer_frame(b->renderer, NULL, NULL, NULL, &error), &error);
  time_sun(b, argument[3], to);
  abbe_renderer_free(b->renderer);
  abbe_scene_free(&b->scene);
  abbe_context_free(b->context);
  abbe_caustic_volume_free(&volume);
  return 0;
}

/* The camera's and the light's frames and those made anew, ms, a line a scene; -: no light. */
static void time_frames(bench *b, const char *name) {
  printf("%s\t%.4g", name, time_change(b, change_camera));
  if (b->scene.light_count > 0)
    printf("\t%.4g", time_change(b, change_light));
  else
    printf("\t-");
  printf("\t%.4g\n", time_anew(b));
}

static void time_all(bench *b, const char *name) {
  void (*const changes[])(bench *, int) = {change_camera, change_power, change_light, change_object,
                                           change_material};
  double between, after;
  printf("| %s", name);
  for (size_t k = 0; k < sizeof changes / sizeof *changes; k++)
    printf(" | %.0f", time_change(b, changes[k]));
  time_cancel(b, &between, &after);
  printf(" | %.0f | %.0f | %.0f |\n", time_anew(b), between, after);
}

/* frames: those alone. WIDTHxHEIGHT pixels; a single number is both. */
static void time_scenes(bench *b, bool frames, const char *size, char **names, int count) {
  abbe_error error;
  char *end = NULL;
  b->desc.width = b->desc.height = (size_t)strtoul(size, &end, 10);
  if (*end == 'x') b->desc.height = (size_t)strtoul(end + 1, NULL, 10);
  b->desc.supersample = 1;
  if (!frames)
    printf("%zu x %zu, one sample a pixel, %s; ms\n\n"
           "| scene | camera | power | light | object | material | made anew | between questions | "
           "after a no |\n|---|---|---|---|---|---|---|---|---|\n",
           b->desc.width, b->desc.height, abbe_context_description(b->context));
  for (int i = 0; i < count; i++) {
    char path[4096];
    snprintf(path, sizeof path, "%s.yaml", names[i]);
    must(abbe_scene_load(path, NULL, &b->scene, &error), &error);
    must(abbe_renderer_make(b->context, &b->scene, &b->desc, &b->renderer, &error), &error);
    draw(b->renderer);
    (frames ? time_frames : time_all)(b, names[i]);
    fflush(stdout);
    abbe_renderer_free(b->renderer);
    abbe_scene_free(&b->scene);
  }
}

int main(int argc, char **argv) {
  bench b = {.repeats = MAX_REPEATS};
  abbe_context_backend backend = ABBE_CONTEXT_CPU;
  bool frames = false;
  abbe_error error;
  if (argc == 6 && strcmp(argv[1], "--sun") == 0) return bench_sun(&b, argv + 2);
  for (; argc > 1 && strncmp(argv[1], "--", 2) == 0; argc--, argv++) {
    if (strcmp(argv[1], "--quick") == 0) { /* few photons, once: to see that it works */
      b.repeats = 1;
      b.desc.photons = 16;
      b.desc.map_size = 64;
    }
    if (strcmp(argv[1], "--frames") == 0) frames = true;
    if (strcmp(argv[1], "--gpu") == 0) backend = ABBE_CONTEXT_GPU;
    if (strncmp(argv[1], "--photons=", 10) == 0)
      b.desc.photons = (size_t)strtoul(argv[1] + 10, NULL, 10);
  }
  if (argc < 3) {
    fprintf(stderr, "Usage: bench_changes [--quick] [--frames] [--gpu] [--photons=N] "
                    "SIZE|WIDTHxHEIGHT SCENE…\n"
                    "       bench_changes --sun VOLUME SIZE SCENE.yaml NAME\n");
    return 2;
  }
  must(abbe_context_make(backend, &b.context, &error), &error);
  time_scenes(&b, frames, argv[1], argv + 2, argc - 2);
  abbe_context_free(b.context);
  return 0;
}
