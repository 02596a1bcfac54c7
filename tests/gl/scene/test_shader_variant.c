#include "tests/check.h"

#include "gl/scene/shader_variant.h"
#include "gl/scene/spectra/camera_bands.h"

static bool has(const char *text, const char *line) {
  const size_t size = strlen(line);
  for (const char *at = text; (at = strstr(at, line)) != NULL; at += size)
    if ((at == text || at[-1] == '\n') && at[size] == '\n') return true;
  return false;
}

static char *text_of(const abbe_shader_variant *variant, const char *more) {
  char *text = abbe_shader_variant_text(variant, more);
  assert_non_null(text);
  return text;
}

TEST(counts_and_flags_are_told) {
  const abbe_shader_variant v =
      FIELDS(.lights = 2, .refractors = 3, .planes = 57, .wavelengths = 7, .bands = 14, .exits = 9,
             .convex = true, .wide = true, .aovs = true, .shadow_planes = 9, .one_shadow = true,
             .pixel_threads = 8);
  FREED char *text = text_of(&v, "#define MORE 1\n");
  assert_true(has(text, "#define LIGHTS 2"));
  assert_true(has(text, "#define SPECTRUM_ROOM 2048"));
  assert_true(has(text, "#define PLANE_ROOM 57"));
  assert_true(has(text, "#define CONVEX"));
  assert_true(has(text, "#define MANY_EXITS"));
  assert_true(has(text, "#define WIDE"));
  assert_true(has(text, "#define AOVS"));
  assert_true(has(text, "#define SHADOW_PLANES 9"));
  assert_true(has(text, "#define ONE_SHADOW"));
  assert_true(has(text, "#define PIXEL_THREADS 8"));
  assert_string_equal(text + strlen(text) - 15, "#define MORE 1\n");
}

/* A block may not be empty; what is not there is not told. */
TEST(nothing_has_room_for_one) {
  const abbe_shader_variant v = {.exits = 8};
  FREED char *text = text_of(&v, NULL);
  assert_true(has(text, "#define REFRACTORS 0"));
  assert_true(has(text, "#define REFRACTOR_ROOM 1"));
  static const char *const absent[] = {"SHADOW_PLANES", "ONE_SHADOW", "TILES",
                                       "STEPS",         "BRIDGE",     "MANY_EXITS",
                                       "WIDE",          "AOVS",       "IN_STORAGE"};
  for (size_t i = 0; i < sizeof absent / sizeof *absent; i++) assert_null(strstr(text, absent[i]));
}

/* Where tables are copied, so are those that are known by their numbers, up to a count that is
 * worth it. */
TEST(copies_are_told_where_they_are_made) {
  abbe_shader_variant v = {.lights = 1, .receivers = 3, .planes = 2, .one_convex = true};
  FREED char *text = text_of(&v, NULL);
  assert_null(strstr(text, "EACH_"));
  assert_null(strstr(text, "SOFTWARE"));
  free(text);
  v.copies = true;
  text = text_of(&v, NULL);
  assert_true(has(text, "#define SOFTWARE"));
  assert_true(has(text, "#define EACH_LIGHT(DO) DO(0)"));
  assert_true(has(text, "#define EACH_RECEIVER(DO) DO(0) DO(1) DO(2)"));
  assert_true(has(text, "#define EACH_PLANE(DO) DO(0) DO(1)"));
  assert_null(strstr(text, "EACH_SHADOW_PLANE"));
  free(text);
  v.receivers = 33;
  v.walk = true;
  text = text_of(&v, NULL);
  assert_null(strstr(text, "EACH_RECEIVER"));
  assert_null(strstr(text, "EACH_PLANE"));
}

/* A table of exactly a block is a block; one element more is storage. */
TEST(tables_beyond_a_block_are_storage) {
  abbe_shader_variant v = {.planes = ABBE_GPU_BLOCK_BYTES / 16, .refractors = 1};
  v.bands = ABBE_GPU_BLOCK_BYTES / 32 / ABBE_CAMERA_BAND_SETS;
  v.surfaces = ABBE_GPU_BLOCK_BYTES / 16;
  v.reflections = ABBE_GPU_BLOCK_BYTES / 16;
  v.wavelengths = ABBE_GPU_BLOCK_BYTES / 16 / 2; /* of the refractor, and of the air */
  FREED char *text = text_of(&v, NULL);
  assert_null(strstr(text, "IN_STORAGE"));
  free(text);
  v.planes++;
  v.bands++;
  v.surfaces++;
  v.reflections++;
  v.wavelengths++;
  text = text_of(&v, NULL);
  assert_true(has(text, "#define PLANES_IN_STORAGE"));
  assert_true(has(text, "#define BANDS_IN_STORAGE"));
  assert_true(has(text, "#define SURFACES_IN_STORAGE"));
  assert_true(has(text, "#define REFLECTIONS_IN_STORAGE"));
  assert_true(has(text, "#define SPECTRA_IN_STORAGE"));
}

TEST(photons_are_told_where_there_are_any) {
  abbe_shader_variant v = {.hit_stride = 7, .steps = 128, .bridge = true};
  FREED char *text = text_of(&v, NULL);
  assert_true(has(text, "#define STEPS 128") && has(text, "#define BRIDGE"));
  free(text);
  v.tiles = 3;
  text = text_of(&v, NULL);
  assert_true(has(text, "#define TILES") && has(text, "#define MOST_TILES 3"));
}

/* Other counts are other uniforms of the same program. */
TEST(other_counts_are_the_same_program) {
  abbe_shader_variant v =
      FIELDS(.refractors = 2, .wavelengths = 7, .bands = 14, .band_levels = 4, .exits = 4,
             .slots = 5, .bvh_stack = 18, .receiver_root = 3, .tiles = 3, .tile_blocks = 32,
             .chart_sides = 12, .hit_stride = 7, .steps = 128, .nodes = 7, .map_levels = 6);
  FREED char *text = text_of(&v, NULL);
  v.wavelengths = 12;
  v.bands = 24;
  v.band_levels = v.exits = v.slots = 8;
  v.bvh_stack = 24;
  v.receiver_root = 4;
  v.tile_blocks = v.chart_sides = v.map_levels = 9;
  v.hit_stride = v.nodes = 4;
  FREED char *other = text_of(&v, NULL);
  assert_string_equal(text, other);
}
