#!/usr/bin/env bash
# OpenEXR: the levels of a ripmap, written by its C++ library, read by it and by the C library OpenEXRCore. Each level
# holds one number, 10 times its level in x and its level in y.
set -euo pipefail
package=libopenexr-3-1-30=3.1.5-5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download "$package" libopenexr-dev=3.1.5-5 libimath-3-1-29 libimath-dev 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
lib=$PWD/usr/lib/x86_64-linux-gnu
cat >levels.cpp <<'C'
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTiledInputFile.h>
#include <ImfTiledOutputFile.h>
#include <openexr.h>
#include <cstdio>
#include <vector>

using namespace OPENEXR_IMF_NAMESPACE;

static FrameBuffer buffer_of(std::vector<float> &pixel, int width)
{
  FrameBuffer f;
  f.insert("Y", Slice(OPENEXR_IMF_NAMESPACE::FLOAT, (char *)pixel.data(), 4, 4 * width));
  return f;
}

static void write(const char *path)
{
  Header h(16, 8);
  h.channels().insert("Y", Channel(OPENEXR_IMF_NAMESPACE::FLOAT));
  h.setTileDescription(TileDescription(8, 8, RIPMAP_LEVELS, ROUND_DOWN));
  h.compression() = NO_COMPRESSION;
  TiledOutputFile o(path, h);
  for (int y = 0; y < o.numYLevels(); y++)
    for (int x = 0; x < o.numXLevels(); x++) {
      std::vector<float> pixel(16 * 8, 10 * x + y);
      o.setFrameBuffer(buffer_of(pixel, o.levelWidth(x)));
      o.writeTiles(0, o.numXTiles(x) - 1, 0, o.numYTiles(y) - 1, x, y);
    }
}

static void by_class(const char *path)
{
  TiledInputFile in(path);
  for (int y = 0; y < in.numYLevels(); y++, puts(""))
    for (int x = 0; x < in.numXLevels(); x++) {
      std::vector<float> pixel(16 * 8, -1);
      in.setFrameBuffer(buffer_of(pixel, in.levelWidth(x)));
      in.readTiles(0, in.numXTiles(x) - 1, 0, in.numYTiles(y) - 1, x, y);
      printf(" %g", pixel[0]);
    }
}

static void quiet(exr_const_context_t, exr_result_t, const char *) {}

static void by_core(const char *path)
{
  exr_context_t c;
  exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
  how.error_handler_fn = quiet;
  int32_t across, down;
  exr_start_read(&c, path, &how);
  exr_get_tile_levels(c, 0, &across, &down);
  for (int y = 0; y < down; y++, puts(""))
    for (int x = 0; x < across; x++) {
      exr_chunk_info_t chunk;
      std::vector<float> pixel(16 * 8, -1);
      exr_result_t rv = exr_read_tile_chunk_info(c, 0, 0, 0, x, y, &chunk);
      if (rv == EXR_ERR_SUCCESS) rv = exr_read_chunk(c, 0, &chunk, pixel.data());
      if (rv == EXR_ERR_SUCCESS) printf(" %g", pixel[0]);
      else printf(" %s", exr_get_error_code_as_string(rv));
    }
  exr_finish(&c);
}

int main()
{
  write("a.exr");
  puts("seen: by the C++ library, a line for each level in y:");
  by_class("a.exr");
  puts("seen: by OpenEXRCore:");
  by_core("a.exr");
}
C
g++ -w -Iusr/include/OpenEXR -Iusr/include/Imath levels.cpp -o levels -L"$lib" \
  -lOpenEXR-3_1 -lOpenEXRCore-3_1 -lIex-3_1 -lImath-3_1 -Wl,-rpath,"$lib",-rpath-link,"$lib"
echo "${package/=/ }"
echo "expected: both the same, 0 10 20 30 40 and so on"
./levels | tee seen
bad=EXR_ERR_BAD_CHUNK_LEADER
cat >known <<T
seen: by the C++ library, a line for each level in y:
 0 10 20 30 40
 1 11 21 31 41
 2 12 22 32 42
 3 13 23 33 43
seen: by OpenEXRCore:
 0 10 20 30 40
 $bad $bad $bad $bad $bad
 $bad $bad $bad $bad $bad
 $bad $bad $bad $bad $bad
T
cmp -s seen known || { echo "this has changed" >&2; exit 1; }
echo "so a sound ripmap is called corrupt by programs that read it by OpenEXRCore; level (0, 0) is right"
