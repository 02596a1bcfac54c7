#include "gl/scene/shader_variant.h"

#include "colorimetry/reflectance/reflected_light.h"

#include <stdio.h>
#include <stdlib.h>

/* Along a camera path through the grid of a medium. */
enum { SHAFT_STEPS = 40 };

void abbe_shader_variant_make(const abbe_gpu_scene *scene, abbe_shader_variant *out) {
  const abbe_plan *p = scene->plan;
  *out = (abbe_shader_variant){.lights = p->light_view_count,
                               .area_lights = abbe_gpu_area_lights_count(scene),
                               .refractors = p->refractor_count,
                               .receivers = p->parallelogram_count,
                               .surfaces = p->receiver_count,
                               .reflections = abbe_gpu_surfaces_reflections(scene),
                               .bvh_stack = scene->bvh_depth + 1,
                               .shadow_planes = scene->shadow_planes,
                               .one_shadow = p->light_view_count * p->refractor_count == 1,
                               .tints = p->tints,
                               .part_surfaces = abbe_plan_surfaces(p),
                               .receiver_colours = p->receiver_colours,
                               .shafts = p->shaft_count,
                               .shaft_steps = SHAFT_STEPS,
                               .pixel_threads = !p->multi_refractor_paths ? 1
                                                : p->desc.wavelengths > 1 ? 8
                                                                          : 2,
#define FLAG_OF(field, define, value) .field = value,
#define COUNT_OF(field, value) .field = value,
                               ABBE_VARIANT_FLAGS(FLAG_OF) ABBE_VARIANT_COUNTS(COUNT_OF)
#undef FLAG_OF
#undef COUNT_OF
  };
  if (p->volume) {
    out->volume_kind = p->desc.volume->kind;
    out->volume_region = p->desc.volume->region.desc.kind;
    out->volume_pages = p->volume_pages;
  }
  for (size_t i = 0; i < p->refractor_count; i++)
    if (p->model[i] == ABBE_REFRACTOR_CONVEX)
      out->planes += scene->local->object[p->refractor_object[i]].exact.count;
}

static void print_count(FILE *to, const char *name, size_t count) {
  fprintf(to, "#define %s %zu\n", name, count);
}

/* A block of none has capacity for one. */
static void print_room(FILE *to, const char *name, size_t count) {
  print_count(to, name, count > 0 ? count : 1);
}

static void print_flag(FILE *to, const char *name, bool is) {
  if (is) fprintf(to, "#define %s\n", name);
}

static bool too_large(size_t count, size_t element) {
  return count * element > ABBE_GPU_BLOCK_BYTES;
}

static void print_tables(FILE *to, const abbe_shader_variant *v) {
  const size_t spectra = abbe_gpu_spectra_room((v->refractors + 1) * v->wavelengths);
  const size_t bands = abbe_gpu_spectra_room(v->refractors * ABBE_CAMERA_BAND_SETS * v->bands);
  const size_t reflections = abbe_gpu_spectra_room(v->reflections);
  print_count(to, "LIGHTS", v->lights);
  print_count(to, "REFRACTORS", v->refractors);
  print_count(to, "PART_SURFACES", v->part_surfaces);
  print_count(to, "RECEIVERS", v->receivers);
  print_flag(to, "MANY_EXITS", v->exits > 8);
  print_room(to, "LIGHT_ROOM", v->lights);
  print_room(to, "REFRACTOR_ROOM", v->refractors);
  print_room(to, "PLANE_ROOM", v->planes);
  print_room(to, "RECEIVER_ROOM", v->receivers);
  print_room(to, "SURFACE_ROOM", v->surfaces);
  print_count(to, "REFLECTION_ROOM", reflections);
  print_count(to, "SPECTRUM_ROOM", spectra);
  print_count(to, "BAND_ROOM", bands);
  print_count(to, "BAND_SETS", ABBE_CAMERA_BAND_SETS);
  print_flag(to, "BANDS_IN_STORAGE", too_large(bands, 32));
  print_flag(to, "PLANES_IN_STORAGE", too_large(v->planes, 16));
  print_flag(to, "SURFACES_IN_STORAGE", too_large(v->surfaces, 16));
  print_flag(to, "REFLECTIONS_IN_STORAGE", too_large(reflections, 16));
  print_flag(to, "SPECTRA_IN_STORAGE", too_large(spectra, 16));
  print_count(to, "HIERARCHY_STACK", (v->bvh_stack + 7) / 8 * 8);
  if (v->shadow_planes == 0) return;
  print_count(to, "SHADOW_PLANES", v->shadow_planes);
  print_flag(to, "ONE_SHADOW", v->one_shadow);
}

/* A loop that the shader has unrolled, up to so many turns; more are no longer worth their code. */
enum { MOST_COPIES = 256, MOST_COPIED_LIGHTS = 4, MOST_COPIED_RECEIVERS = 32 };

static void print_each(FILE *to, const char *name, size_t count, size_t most) {
  if (count == 0 || count > most) return;
  fprintf(to, "#define EACH_%s(DO)", name);
  for (size_t i = 0; i < count; i++) fprintf(to, " DO(%zu)", i);
  fprintf(to, "\n");
}

static void print_copies(FILE *to, const abbe_shader_variant *v) {
  if (!v->copies) return;
  print_flag(to, "SOFTWARE", true);
  print_each(to, "LIGHT", v->lights, MOST_COPIED_LIGHTS);
  print_each(to, "RECEIVER", v->receivers, MOST_COPIED_RECEIVERS);
  print_each(to, "PLANE", v->one_convex && !v->walk ? v->planes : 0, MOST_COPIES);
  print_each(to, "SHADOW_PLANE", v->one_shadow ? v->shadow_planes : 0, MOST_COPIES);
}

static void print_facts(FILE *to, const abbe_shader_variant *v) {
#define PRINT_FLAG(field, define, value) print_flag(to, #define, v->field);
  ABBE_VARIANT_FLAGS(PRINT_FLAG)
#undef PRINT_FLAG
  print_flag(to, "FRONT_LAYER", v->layers || v->hierarchy);
  if (v->tints > 0) print_count(to, "TINTS", v->tints);
  if (v->films) print_count(to, "FILM_ANGLES", ABBE_FILM_ANGLES);
  if (v->glows) print_count(to, "GLOW_CELLS", ABBE_PLAN_GLOW_CELLS);
  if (v->receiver_colours) {
    print_count(to, "RECEIVER_COLOURS", 1);
    print_count(to, "BAND_TURNS", ABBE_BAND_REFLECTION_TURNS);
    print_count(to, "BAND_RINGS", ABBE_BAND_REFLECTION_RINGS);
  }
  if (v->area_lights > 0) print_count(to, "AREA_LIGHTS", v->area_lights);
  if (v->environment) {
    print_count(to, "SOFT_ROWS", ABBE_IRRADIANCE_MAP_ROWS);
    print_count(to, "SOFT_COLUMNS", ABBE_IRRADIANCE_MAP_COLUMNS);
  }
  if (v->volume && v->volume_pages > 0) print_count(to, "VOLUME_PAGES", v->volume_pages);
  print_flag(to, "VOLUME_PRINTED", v->volume && v->volume_kind == ABBE_VOLUME_PRINTED);
  print_flag(to, "VOLUME_GRID", v->volume && v->volume_region == ABBE_REGION_GRID);
  print_flag(to, "VOLUME_GEODESIC", v->volume && v->volume_region == ABBE_REGION_GEODESIC);
  print_flag(to, "VOLUME_OCTAHEDRAL", v->volume && v->volume_region == ABBE_REGION_OCTAHEDRAL);
  print_count(to, "HAZE_BANDS", ABBE_PLAN_HAZE_BANDS);
  if (v->shafts > 0) print_count(to, "SHAFTS", v->shafts);
  if (v->shafts > 0) print_count(to, "SHAFT_STEPS", v->shaft_steps);
  print_flag(to, "CHART_SIDES", v->page_charts || v->tiles > 0);
  print_count(to, "PIXEL_THREADS", v->pixel_threads);
}

static void print_photons(FILE *to, const abbe_shader_variant *v) {
  if (v->tiles > 0) {
    print_flag(to, "TILES", true);
    print_count(to, "MOST_TILES", v->tiles);
  }
  if (v->hit_stride == 0) return;
  print_count(to, "STEPS", v->steps);
  print_flag(to, "BRIDGE", v->bridge);
  print_flag(to, "DOUBTS_BRIDGES", v->doubts_bridges);
}

const char *abbe_shader_variant_waves(const abbe_plan *plan) {
  static const char *const text[2][2] = {
      {"#define CRYSTALS\n#define UNIAXIAL\n",
       "#define CRYSTALS\n#define UNIAXIAL\n#define PLEOCHROIC\n"},
      {"#define CRYSTALS\n", "#define CRYSTALS\n#define PLEOCHROIC\n"}};
  return plan->crystals ? text[plan->biaxial][plan->pleochroic] : "";
}

char *abbe_shader_variant_text(const abbe_shader_variant *variant, const char *more) {
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  if (to == NULL) return NULL;
  print_tables(to, variant);
  print_copies(to, variant);
  print_facts(to, variant);
  print_photons(to, variant);
  if (more != NULL) fputs(more, to);
  const bool failed = ferror(to) != 0;
  if (fclose(to) == 0 && !failed) return text;
  free(text);
  return NULL;
}

/* The shaders' Counts (counts.glsl); a program has those that it reads. */
static void set_counts(const abbe_shader_variant *v, const abbe_gl *gl, GLuint program) {
  const struct {
    const char *name;
    size_t value;
  } counts[] = {
#define COUNT(field, value) {"counts." #field, v->field},
      ABBE_VARIANT_COUNTS(COUNT)
#undef COUNT
  };
  gl->UseProgram(program);
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    gl->Uniform1i(gl->GetUniformLocation(program, counts[i].name), (GLint)counts[i].value);
}

abbe_result abbe_shader_variant_program(const abbe_shader_variant *variant, abbe_gpu *gpu,
                                        const abbe_program_stage *stages, size_t count,
                                        const char *more, GLuint *out, abbe_error *error) {
  char *text = abbe_shader_variant_text(variant, more);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a shader");
  const abbe_result result = abbe_gpu_program(gpu, stages, count, text, out, error);
  free(text);
  if (result == ABBE_OK) set_counts(variant, gpu->gl, *out);
  return result;
}

abbe_result abbe_shader_variant_compute(const abbe_shader_variant *variant, abbe_gpu *gpu,
                                        const char *file, const char *more, GLuint *out,
                                        abbe_error *error) {
  const abbe_program_stage stage = {GL_COMPUTE_SHADER, file};
  return abbe_shader_variant_program(variant, gpu, &stage, 1, more, out, error);
}
