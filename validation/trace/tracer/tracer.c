#include "validation/trace/tracer/tracer.h"

#include "base/clock.h"
#include "spectral/wavelengths.h"
#include "validation/trace/tracer/light_pass.h"
#include "validation/trace/tracer/tracer_state.h"
#include "validation/trace/transport/lamp_place.h"
#include "validation/trace/walks/camera.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>
#ifdef __SSE__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

/* Radius and window shrink with this power of the pass: the squared bias then falls as fast as the
 * variance, in three dimensions (place and wavelength) [KnausZwicker2011]. */
static const double shrink = 1.0 / 7;
static const double first_window_nm = 25;
/* Rays of the camera to glass, of those of the photons in a pass, so that most of the time is
 * theirs.
 */
static const double eye_share = 0.12;

/* ---- the request ---- */

static abbe_result check_count(const char *what, size_t value, size_t most, abbe_error *error) {
  if (value <= most) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s %zu is too much: at most %zu", what,
                        value, most);
}

/* Pixels of the picture that photons are followed and gathered for. */
static size_t pixels_of(const abbe_trace_desc *d) {
  return d->whole_pixels > 0 ? d->whole_pixels : d->width * d->height;
}

static abbe_result resolve(const abbe_scene *scene, abbe_trace_desc *d, abbe_error *error) {
  if (d->width == 0) d->width = scene->camera.width;
  if (d->height == 0) d->height = scene->camera.height;
  if (d->map_width == 0) d->map_width = 512;
  if (d->map_height == 0) d->map_height = d->map_width;
  if (d->min_nm == 0) d->min_nm = ABBE_WAVELENGTH_MIN_NM;
  if (d->max_nm == 0) d->max_nm = ABBE_WAVELENGTH_MAX_NM;
  ABBE_TRY(check_count("width", d->width, ABBE_TRACER_MAX_SIDE, error));
  ABBE_TRY(check_count("height", d->height, ABBE_TRACER_MAX_SIDE, error));
  ABBE_TRY(check_count("map", d->map_width, ABBE_TRACER_MAX_SIDE, error));
  ABBE_TRY(check_count("map", d->map_height, ABBE_TRACER_MAX_SIDE, error));
  ABBE_TRY(check_count("photons", d->photons, ABBE_TRACER_MAX_PHOTONS, error));
  ABBE_TRY(check_count("threads", d->threads, ABBE_TRACER_MAX_THREADS, error));
  ABBE_TRY(check_count("whole picture", d->whole_pixels,
                       (size_t)ABBE_TRACER_MAX_SIDE * ABBE_TRACER_MAX_SIDE, error));
  ABBE_TRY(check_count("pixel", d->pixel_sides, ABBE_TRACER_MAX_SIDE, error));
  const bool empty = scene->object_count == 0;
  if (scene->environment == NULL && (scene->light_count == 0 || empty))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is nothing to trace: %s",
                          empty ? "the scene has no object and no environment"
                                : "the scene has no light and no environment");
  if (!d->no_map && scene->light_count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a map is of one light, and the scene has none but its environment: ask "
                          "for a picture alone");
  if (d->map_light >= scene->light_count && !d->no_map)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "there is no light %zu for the map: the scene has %zu", d->map_light,
                          scene->light_count);
  if ((int)d->observer < 0 || d->observer >= ABBE_OBSERVER_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no observer of number %d",
                          (int)d->observer);
  if (d->no_picture && d->no_map)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "neither a picture nor a map is asked for: leave one of the two in");
  d->guides = d->guides && !d->no_picture;
  if (d->layout != NULL) ABBE_TRY(abbe_map_layout_check(d->layout, error));
  if (d->photons == 0) {
    d->photons = 1u << 20;
    if (!d->no_picture && 4 * pixels_of(d) > d->photons) d->photons = 4 * pixels_of(d);
    if (d->photons > ABBE_TRACER_MAX_PHOTONS) d->photons = ABBE_TRACER_MAX_PHOTONS;
  }
  if (d->threads == 0) d->threads = (size_t)omp_get_num_procs();
  if (d->threads > ABBE_TRACER_MAX_THREADS) d->threads = ABBE_TRACER_MAX_THREADS;
  return ABBE_OK;
}

/* ---- make ---- */

static abbe_result make_tables(abbe_tracer *t, abbe_error *error) {
  const abbe_trace_desc *d = &t->desc;
  const abbe_spectral_sampling_desc spectrum = {.observer = d->observer,
                                                .min_nm = d->min_nm,
                                                .max_nm = d->max_nm,
                                                .uniform = d->bands > 0 ? 0.5 : 0.15,
                                                .bands = d->bands};
  abbe_result result = abbe_geometry_make(t->scene, &t->geometry, error);
  if (result == ABBE_OK)
    result = abbe_spectral_sampling_make(t->scene, &spectrum, &t->sampling, error);
  if (result == ABBE_OK) t->brightest = abbe_spectral_sampling_brightest(&t->sampling);
  if (result == ABBE_OK)
    result =
        abbe_media_make(&t->geometry, t->sampling.lambda_nm, t->sampling.steps, &t->media, error);
  if (d->physics.matched) abbe_media_polish(&t->media);
  if (result == ABBE_OK && !d->physics.matched)
    result = abbe_glow_make(&t->geometry, &t->sampling, &t->media, &t->glow, error);
  t->media.haze.once = d->physics.matched || d->physics.once;
  if (result == ABBE_OK && !t->media.haze.once)
    result = abbe_haze_check(&t->media.haze, &t->geometry, error);
  if (result == ABBE_OK)
    result = abbe_mirrors_make(&t->geometry, t->sampling.lambda_nm, t->sampling.steps, &t->mirrors,
                               error);
  if (result == ABBE_OK) result = abbe_bands_make(&t->sampling, d->bands, &t->bands, error);
  if (result != ABBE_OK) return result;
  t->mixing = d->space == ABBE_RGB_SPACE_XYZ ? ABBE_RGB_SPACE_ACESCG : d->space;
  abbe_trace_camera_make(&t->geometry, d->width, d->height, &t->camera);
  result = abbe_environment_light_make(&t->geometry, &t->sampling, &t->bands, t->mixing,
                                       &t->environment, error);
  if (result == ABBE_OK)
    result = abbe_reflectance_make(&t->geometry, &t->sampling, &t->bands, &t->environment,
                                   t->mixing, &t->reflectance, error);
  if (result != ABBE_OK) return result;
  size_t lights = t->sampling.lights;
  t->colour = calloc(t->sampling.rows * t->sampling.steps, sizeof *t->colour);
  t->white = calloc(lights, sizeof *t->white);
  t->projection = calloc(lights, sizeof *t->projection);
  t->photons = calloc(lights, sizeof *t->photons);
  t->splits = calloc(lights, sizeof *t->splits);
  t->walk = calloc(d->threads, sizeof *t->walk);
  if (!t->colour || !t->white || !t->projection || !t->photons || !t->splits || !t->walk)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the lights' tables");
  abbe_spectral_sampling_colours(&t->sampling, t->mixing, t->colour);
  double matrix[9], white[3];
  abbe_rgb_space_to_xyz(t->mixing, matrix);
  for (int i = 0; i < 9; i++) t->to_xyz[i] = (float)matrix[i];
  abbe_rgb_space_from_xyz(t->mixing, matrix);
  for (size_t l = 0; l < lights; l++) {
    abbe_rgb_space_apply(matrix, t->sampling.white[l], white);
    for (int k = 0; k < 3; k++) t->white[l][k] = (float)white[k];
  }
  for (size_t i = 0; i < d->threads && result == ABBE_OK; i++)
    result = abbe_light_walk_make(&t->geometry, &t->media, &t->mirrors, &d->physics, d->seed,
                                  &t->walk[i], error);
  return result;
}

/* A request that cannot fit is refused before it is allocated: the system might grant it and fail
 * later. */
static abbe_result check_memory(const abbe_tracer *t, abbe_error *error) {
  const abbe_trace_desc *d = &t->desc;
  double values = 0, pages = (double)sysconf(_SC_PHYS_PAGES), page = (double)sysconf(_SC_PAGESIZE);
  if (!d->no_picture)
    values += (double)(d->width * d->height) * (double)(ABBE_TRACER_BANDS + t->bands.count);
  if (!d->no_map) values += (double)(d->map_width * d->map_height) * (double)(3 + t->bands.count);
  double needed = values * (16 * (double)d->threads + 3 * sizeof(abbe_whole_sum));
  if (d->guides)
    needed += (double)(d->width * d->height) * (sizeof(abbe_whole_sum) * ABBE_GUIDE_VALUES + 40);
  if (!(pages > 0) || !(page > 0) || needed < pages * page) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_NO_MEMORY,
      "the sums of %zu x %zu pixels, %zu bands and %zu threads need %.0f GiB, the "
      "machine has %.0f: ask for fewer",
      d->width, d->height, t->bands.count, d->threads, needed * 0x1p-30, pages * page * 0x1p-30);
}

static abbe_result make_sums(abbe_tracer *t, abbe_error *error) {
  const abbe_trace_desc *d = &t->desc;
  ABBE_TRY(check_memory(t, error));
  if (!d->no_picture) {
    abbe_light_range range;
    abbe_light_range_find(&t->geometry, &range);
    t->statistics.faintest = range.least / range.greatest;
    t->picture_channels = ABBE_TRACER_BANDS + t->bands.count;
    /* sums hold values 2^28 times the usual, to 2^-65 of it */
    ABBE_TRY(abbe_accumulator_make(d->width * d->height * t->picture_channels, d->threads,
                                   range.greatest * 0x1p28, &t->picture, error));
  }
  if (d->guides)
    ABBE_TRY(abbe_guide_sums_make(d->width * d->height, t->picture.unit, &t->guides, error));
  if (!d->no_map) {
    t->map_channels = 3 + t->bands.count;
    double reach = t->projection[d->map_light].reach;
    ABBE_TRY(abbe_accumulator_make(d->map_width * d->map_height * t->map_channels, d->threads,
                                   (reach > 0 ? reach : 1) * t->brightest * 0x1p14, &t->map,
                                   error));
  }
  return ABBE_OK;
}

/* Pixels a side of one of the picture that photons are gathered for. */
static float pixel_sides(const abbe_trace_desc *d) {
  return d->pixel_sides > 0 ? (float)d->pixel_sides : 1;
}

/* Four pixels of the receivers as far away as the refractors, or less where a pixel has more than
 * four photons: as many are in reach then. */
static float first_radius(const abbe_tracer *t) {
  float eye[3], far = 0;
  double pixels = (double)pixels_of(&t->desc);
  double sides = fmin(4, 8 * sqrt(pixels / (double)t->desc.photons));
  abbe_geometry_to_frame(&t->geometry, t->scene->camera.eye, eye);
  for (int k = 0; k < 3; k++) far += eye[k] * eye[k];
  return (float)sides * 2 * t->camera.half_height / (float)t->desc.height * pixel_sides(&t->desc) *
         sqrtf(far);
}

/* Four pixels as far away as the camera sees, or less where a pixel has many photons, which are
 * spread over a depth. Within a quarter of that distance photons are gathered even where they are
 * seen straight, by a quarter of the radius. */
static void choose_shafts(abbe_tracer *t) {
  if (!abbe_haze_is(&t->media.haze)) return;
  const double pixels = (double)pixels_of(&t->desc);
  const double sides = fmin(4, 6 * pow(pixels / (double)t->desc.photons, 0.25));
  const float depth = abbe_eye_samples_depth(&t->geometry, &t->camera);
  t->shaft_radius = (float)sides * 2 * t->camera.half_height / (float)t->desc.height *
                    pixel_sides(&t->desc) * depth;
  t->eye.shaft_near = 0.25f * depth;
}

/* Where few photons are followed the pass is the camera's. */
static abbe_result choose_samples(abbe_tracer *t, abbe_error *error) {
  const double photons = (double)t->desc.photons;
  const double rays = fmax(eye_share * t->photon_rays, photons - t->photon_rays);
  t->samples = malloc(t->desc.width * t->desc.height);
  if (t->samples == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu x %zu pixels", t->desc.width,
                          t->desc.height);
  abbe_eye_samples_share(&t->geometry, &t->camera, rays, t->desc.threads, t->samples);
  t->eye.samples = t->samples;
  t->radius = first_radius(t);
  choose_shafts(t);
  return ABBE_OK;
}

static abbe_media_set around_eye(const abbe_geometry *g) {
  abbe_media_set set = 0;
  for (size_t i = 0; i < g->refractor_count; i++)
    if (abbe_object_contains(&g->scene->object[g->refractor_object[i]], g->scene->camera.eye))
      set |= (abbe_media_set)1 << i;
  return set;
}

/* The camera needs photons around where some ray that met a refractor meets a receiver. */
static abbe_result prepare_eye(abbe_tracer *t, abbe_error *error) {
  const bool shows =
      !t->desc.no_picture && t->geometry.refractor_count + t->geometry.mirror_count > 0;
  t->eye_gathers = shows && t->reach > 0;
  t->eye = (abbe_eye_walk){.geometry = &t->geometry,
                           .media = &t->media,
                           .mirrors = &t->mirrors,
                           .sampling = &t->sampling,
                           .bands = &t->bands,
                           .camera = &t->camera,
                           .reflectance = &t->reflectance,
                           .environment = &t->environment,
                           .colour = (const float(*)[3])t->colour,
                           .white = (const float(*)[3])t->white,
                           .physics = t->desc.physics,
                           .seed = t->desc.seed,
                           .inside = around_eye(&t->geometry),
                           .least_branch = ABBE_EYE_LEAST_BRANCH};
  if (t->desc.physics.eye_orders > 0) {
    t->eye.physics.orders = t->desc.physics.eye_orders;
    t->eye.physics.energy_share = t->desc.physics.eye_share;
  }
  if (!shows) return ABBE_OK;
  abbe_eye_walk_prepare(&t->eye);
  for (size_t l = 0; l < t->sampling.lights; l++)
    t->landed_room += abbe_tracer_most_hits(t, l, t->photons[l]);
  t->landed = malloc((t->landed_room + 1) * sizeof *t->landed);
  if (t->landed == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu photons of a pass",
                          t->landed_room);
  return choose_samples(t, error);
}

abbe_result abbe_tracer_make(const abbe_scene *scene, const abbe_trace_desc *desc,
                             abbe_tracer **out, abbe_error *error) {
  *out = NULL;
  abbe_tracer *t = calloc(1, sizeof *t);
  if (t == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a tracer");
  t->scene = scene;
  t->step = 1;
  if (desc != NULL) t->desc = *desc;
  abbe_result result = resolve(scene, &t->desc, error);
  if (result == ABBE_OK && scene->camera.aperture > 0 && abbe_scene_is_hazy(scene))
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "a camera with an 'aperture' sees through clear air and stones alone: "
                            "leave it out, or the 'medium'");
  if (result == ABBE_OK) result = abbe_tracer_polarise(t, error);
  if (result == ABBE_OK) result = make_tables(t, error);
  if (result == ABBE_OK) result = abbe_tracer_check_wanted(t, error);
  if (result == ABBE_OK) result = abbe_tracer_share_photons(t, error);
  if (result == ABBE_OK) result = abbe_tracer_choose_splits(t, error);
  if (result == ABBE_OK && !t->desc.no_map) {
    if (t->desc.layout != NULL)
      t->layout = *t->desc.layout;
    else
      result = abbe_tracer_fit_layout(t, error);
  }
  if (result == ABBE_OK) result = make_sums(t, error);
  if (result == ABBE_OK) result = prepare_eye(t, error);
  if (result != ABBE_OK) {
    abbe_tracer_free(t);
    return result;
  }
  t->desc.layout = &t->layout;
  t->other_rays = abbe_tracer_walk_rays(t);
  *out = t;
  return ABBE_OK;
}

void abbe_tracer_free(abbe_tracer *t) {
  if (t == NULL) return;
  for (size_t i = 0; t->walk != NULL && i < t->desc.threads; i++) abbe_light_walk_free(t->walk[i]);
  for (size_t l = 0; t->projection != NULL && l < t->sampling.lights; l++)
    abbe_projection_map_free(&t->projection[l]);
  abbe_accumulator_free(&t->picture);
  abbe_guide_sums_free(&t->guides);
  abbe_accumulator_free(&t->map);
  abbe_photon_grid_free(&t->grid);
  abbe_haze_grid_free(&t->shafts);
  free(t->shaft);
  abbe_bands_free(&t->bands);
  abbe_reflectance_free(&t->reflectance);
  abbe_environment_light_free(&t->environment);
  abbe_media_free(&t->media);
  abbe_glow_free(&t->glow);
  abbe_mirrors_free(&t->mirrors);
  abbe_spectral_sampling_free(&t->sampling);
  abbe_geometry_free(&t->geometry);
  free(t->landed);
  free(t->samples);
  free(t->colour);
  free(t->white);
  free(t->projection);
  free(t->photons);
  free(t->splits);
  free(t->walk);
  free(t->dimmed.light);
  free(t);
}

/* ---- passes ---- */

static void add_sample(abbe_tracer *t, size_t thread, size_t pixel, const abbe_eye_sample *s) {
  size_t at = pixel * t->picture_channels;
  float rgb[3], caustic[3];
  abbe_tracer_finish(t, s->rgb, rgb);
  abbe_tracer_finish(t, s->caustic, caustic);
  for (size_t k = 0; k < 3; k++) {
    abbe_accumulator_add(&t->picture, thread, at + ABBE_TRACER_RGB + k, rgb[k]);
    if (caustic[k] != 0)
      abbe_accumulator_add(&t->picture, thread, at + ABBE_TRACER_CAUSTIC + k, caustic[k]);
  }
  for (size_t i = 0; i < t->bands.count; i++)
    abbe_accumulator_add(&t->picture, thread, at + ABBE_TRACER_BANDS + i, t->passes * s->band[i]);
  if (t->desc.guides) abbe_guide_sums_set(&t->guides, pixel, rgb, s);
}

static double shrunk_by(size_t pass) {
  return pow((double)pass + 1, -shrink);
}

/* Photons that haze scattered in this pass. */
static abbe_result fill_shafts(abbe_tracer *t, abbe_error *error) {
  t->eye.shafts = NULL;
  if (!abbe_haze_is(&t->media.haze)) return ABBE_OK;
  t->eye.shafts = &t->shafts;
  return abbe_haze_grid_fill(&t->shafts, t->shaft, t->shaft_count, t->eye.shaft_radius, error);
}

static abbe_result eye_pass(abbe_tracer *t, size_t landed, const volatile int *stop,
                            abbe_error *error) {
  t->eye.grid = NULL;
  if (t->eye_gathers) {
    const double factor = shrunk_by(t->pass);
    t->eye.radius = (float)((double)t->radius * factor);
    t->eye.window_nm = fmin(first_window_nm, 0.5 * (t->desc.max_nm - t->desc.min_nm)) * factor;
    abbe_result result =
        abbe_photon_grid_fill(&t->grid, t->landed, landed, t->eye.radius, t->desc.threads, error);
    if (result != ABBE_OK) return result;
    t->eye.grid = &t->grid;
    result = fill_shafts(t, error);
    if (result != ABBE_OK) return result;
  }
  uint64_t rays = 0;
#pragma omp parallel for schedule(dynamic) num_threads((int)t->desc.threads) reduction(+ : rays)
  for (size_t row = 0; row < t->desc.height; row++) {
    abbe_eye_sample s;
    for (size_t column = 0; column < t->desc.width && (stop == NULL || !*stop); column++) {
      size_t pixel = row * t->desc.width + column;
      abbe_eye_walk_pixel(&t->eye, pixel, (uint32_t)t->pass, &s);
      add_sample(t, (size_t)omp_get_thread_num(), pixel, &s);
      rays += s.rays;
    }
  }
  t->statistics.eye_rays += rays;
  return stop != NULL && *stop ? abbe_error_set(error, ABBE_CANCELLED, "stopped") : ABBE_OK;
}

/* Embree's advice: numbers too small for single precision count as zero, on every thread. */
static unsigned flush_tiny_numbers(const abbe_tracer *t) {
#ifdef __SSE__
  unsigned mode = _mm_getcsr();
#pragma omp parallel num_threads((int)t->desc.threads)
  {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  return mode;
#else
  (void)t;
  return 0;
#endif
}

/* On every thread: they do other work after this, and whose part is done by whom is chance. */
static void restore_mode(const abbe_tracer *t, unsigned mode) {
#ifdef __SSE__
#pragma omp parallel num_threads((int)t->desc.threads)
  _mm_setcsr(mode);
#else
  (void)t;
  (void)mode;
#endif
}

static void end_ledger(abbe_tracer *t) {
  const double per_unit = 1 / abbe_tracer_ledger_unit(t), *part = &t->statistics.ledger.reached;
  for (size_t i = 0; i < ABBE_TRACER_LEDGER; i++)
    t->ledger[i] += abbe_whole_sum_quantise(part[i], per_unit, 0x1p60 / per_unit);
}

static void drop_pass(abbe_tracer *t) {
  if (!t->desc.no_picture) abbe_accumulator_drop_pass(&t->picture);
  if (!t->desc.no_map) abbe_accumulator_drop_pass(&t->map);
  t->stopped = false;
}

abbe_result abbe_tracer_pass(abbe_tracer *t, const volatile int *stop, abbe_error *error) {
  if (t->pass >= ABBE_WHOLE_SUM_MOST_PASSES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there are no more than %u passes",
                          ABBE_WHOLE_SUM_MOST_PASSES);
  unsigned mode = flush_tiny_numbers(t);
  if (t->stopped) drop_pass(t);
  t->statistics.ledger = (abbe_light_ledger){0};
  abbe_trace_statistics before = t->statistics;
  size_t landed = 0;
  double start = abbe_clock_seconds();
  t->eye.shaft_radius = (float)((double)t->shaft_radius * shrunk_by(t->pass));
  abbe_result result = abbe_tracer_light_pass(t, stop, &landed, error);
  double middle = abbe_clock_seconds();
  if (result == ABBE_OK && !t->desc.no_picture) result = eye_pass(t, landed, stop, error);
  double end = abbe_clock_seconds();
  restore_mode(t, mode);
  if (result != ABBE_OK) {
    t->statistics = before;
    t->stopped = true; /* whoever stops it is not to wait for its sums to be cleared */
    return result;
  }
  t->statistics.light_seconds += middle - start;
  t->statistics.eye_seconds += end - middle;
  if (t->desc.guides) abbe_guide_sums_end_pass(&t->guides, &t->picture, t->picture_channels);
  if (!t->desc.no_picture) abbe_accumulator_end_pass(&t->picture);
  if (!t->desc.no_map) abbe_accumulator_end_pass(&t->map);
  end_ledger(t);
  t->pass += t->step;
  return ABBE_OK;
}

size_t abbe_tracer_passes(const abbe_tracer *t) {
  return (t->pass - t->first) / t->step;
}

void abbe_tracer_statistics(const abbe_tracer *t, abbe_trace_statistics *out) {
  *out = t->statistics;
  const size_t passes = out->passes = abbe_tracer_passes(t);
  out->radius =
      t->eye_gathers && passes > 0
          ? (double)((float)((double)t->radius * shrunk_by(t->pass - t->step))) * t->geometry.unit
          : 0;
  out->light_rays += abbe_tracer_walk_rays(t) - t->other_rays;
  if (!t->desc.no_picture) out->cuts += abbe_accumulator_cuts(&t->picture);
  if (!t->desc.no_map) out->cuts += abbe_accumulator_cuts(&t->map);
  const double scale = passes > 0 ? abbe_tracer_ledger_unit(t) / (double)passes : 0;
  double *part = &out->ledger.reached;
  for (size_t i = 0; i < ABBE_TRACER_LEDGER; i++) part[i] = scale * (double)t->ledger[i];
}
