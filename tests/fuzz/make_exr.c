/* make_exr.c: small OpenEXR files of every kind that another program may write, for the corpus.
 * usage: make_exr FOLDER (tests/fuzz/make_corpus compiles and runs it)
 */
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>

enum { W = 9, H = 7, TILE = 4 };

static void must(exr_result_t rv, const char *path) {
  if (rv == EXR_ERR_SUCCESS) return;
  fprintf(stderr, "%s: %s\n", path, exr_get_default_error_message(rv));
  exit(1);
}

static void describe(exr_context_t f, const char *path, exr_storage_t storage,
                     exr_compression_t compression, exr_pixel_type_t type) {
  int part = 0;
  const exr_attr_box2i_t window = {.min = {.x = -2, .y = 3}, .max = {.x = W - 3, .y = H + 2}};
  const exr_attr_v2f_t center = {.x = 0, .y = 0};
  const exr_attr_chromaticities_t c = {0.713f, 0.293f, 0.165f,   0.83f,
                                       0.128f, 0.044f, 0.32168f, 0.33767f};
  must(exr_add_part(f, "", storage, &part), path);
  must(exr_initialize_required_attr(f, 0, &window, &window, 1, &center, 1,
                                    EXR_LINEORDER_INCREASING_Y, compression),
       path);
  must(exr_add_channel(f, 0, "B", type, EXR_PERCEPTUALLY_LINEAR, 1, 1), path);
  must(exr_add_channel(f, 0, "G", type, EXR_PERCEPTUALLY_LINEAR, 1, 1), path);
  must(exr_attr_set_chromaticities(f, 0, "chromaticities", &c), path);
  must(exr_attr_set_string(f, 0, "note", "small"), path);
  if (type == EXR_PIXEL_HALF) must(exr_attr_set_string(f, 0, "abbe:stored_unit", "4"), path);
  if (storage == EXR_STORAGE_TILED)
    must(exr_set_tile_descriptor(f, 0, TILE, TILE, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN), path);
  must(exr_write_header(f), path);
}

static void encode(exr_context_t f, const char *path, exr_encode_pipeline_t *pipe, int x, int y,
                   int tiled, int size) {
  static const uint8_t samples[W * H * 4] = {0, 60, 0,   64, 0, 56, 1, 60,
                                             0, 0,  128, 63, 0, 0,  0, 64};
  exr_chunk_info_t chunk = {0};
  const int first = x == 0 && y == 0;
  must(tiled ? exr_write_tile_chunk_info(f, 0, x / TILE, y / TILE, 0, 0, &chunk)
             : exr_write_scanline_chunk_info(f, 0, y + 3, &chunk),
       path);
  must(first ? exr_encoding_initialize(f, 0, &chunk, pipe)
             : exr_encoding_update(f, 0, &chunk, pipe),
       path);
  for (int c = 0; c < 2; c++) {
    pipe->channels[c].encode_from_ptr = samples + (y * W + x) * size;
    pipe->channels[c].user_pixel_stride = size;
    pipe->channels[c].user_line_stride = size * W;
  }
  if (first) must(exr_encoding_choose_default_routines(f, 0, pipe), path);
  must(exr_encoding_run(f, 0, pipe), path);
}

static void make(const char *path, exr_storage_t storage, exr_compression_t compression,
                 exr_pixel_type_t type) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
  exr_context_t f = NULL;
  const int tiled = storage == EXR_STORAGE_TILED, size = type == EXR_PIXEL_HALF ? 2 : 4;
  int32_t lines = TILE;
  must(exr_start_write(&f, path, EXR_WRITE_FILE_DIRECTLY, &setup), path);
  describe(f, path, storage, compression, type);
  if (!tiled) must(exr_get_scanlines_per_chunk(f, 0, &lines), path);
  for (int y = 0; y < H; y += lines)
    for (int x = 0; x < W; x += tiled ? TILE : W) encode(f, path, &pipe, x, y, tiled, size);
  exr_encoding_destroy(f, &pipe);
  must(exr_finish(&f), path);
}

int main(int argc, char **argv) {
  static const struct {
    const char *name;
    exr_compression_t code;
  } codecs[] = {{"none", EXR_COMPRESSION_NONE}, {"rle", EXR_COMPRESSION_RLE},
                {"zips", EXR_COMPRESSION_ZIPS}, {"zip", EXR_COMPRESSION_ZIP},
                {"piz", EXR_COMPRESSION_PIZ},   {"pxr24", EXR_COMPRESSION_PXR24},
                {"b44", EXR_COMPRESSION_B44},   {"b44a", EXR_COMPRESSION_B44A}};
  static const char *const types[] = {"uint", "half", "float"};
  if (argc != 2) return 2;
  for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
    for (int tiled = 0; tiled < (i < 6 ? 2 : 1); tiled++) { /* its B44 tiles are not its own */
      const exr_pixel_type_t type = i >= 6 || (i + (size_t)tiled) % 2 ? EXR_PIXEL_HALF
                                    : i == 2                          ? EXR_PIXEL_UINT
                                                                      : EXR_PIXEL_FLOAT;
      char path[1024];
      snprintf(path, sizeof path, "%s/%s_%s_%s.exr", argv[1], codecs[i].name, types[type],
               tiled ? "tiles" : "lines");
      make(path, tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, codecs[i].code, type);
    }
  return 0;
}
