#include "tests/colorimetry/image/exr_library.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

using Imath::Box2i;
using Imath::V2i;

namespace {

template <typename Work> bool guarded(char *why, size_t size, Work work) {
  try {
    Imf::setGlobalThreadCount(0); /* the files are small */
    work();
    return true;
  } catch (const std::exception &e) {
    std::snprintf(why, size, "%s", e.what());
  } catch (...) {
    std::snprintf(why, size, "an unknown reason");
  }
  return false;
}

Box2i box(const int window[4]) {
  return Box2i(V2i(window[0], window[1]), V2i(window[2], window[3]));
}

void unbox(const Box2i &b, int window[4]) {
  const int corner[4] = {b.min.x, b.min.y, b.max.x, b.max.y};
  std::memcpy(window, corner, sizeof corner);
}

/* A gradient with steps, so that lossy codecs have something to do, and no two channels alike; of
 * channel -1 the same everywhere. */
double value(int channel, int x, int y) {
  if (channel < 0) return 0.5;
  return (channel + 1) * 0.75 + x * 0.013 - y * 0.029 + ((x / 5 + y / 3 + channel) % 4) * 2.5;
}

struct plane {
  std::vector<char> bytes;
  int width, bytes_per_element;
};

plane fill(int type, int channel, int sampling, const Box2i &window) {
  plane p;
  p.bytes_per_element = type == Imf::HALF ? 2 : 4;
  p.width = window.max.x / sampling - window.min.x / sampling + 1;
  const int height = window.max.y / sampling - window.min.y / sampling + 1;
  p.bytes.resize(size_t(p.width) * size_t(height) * size_t(p.bytes_per_element));
  char *at = p.bytes.data();
  for (int y = 0; y < height; y++)
    for (int x = 0; x < p.width; x++, at += p.bytes_per_element) {
      const double v = value(channel, x, y);
      const half h = half(float(v));
      const float f = float(v);
      const unsigned u = unsigned(1000 * (v + 100)) * 4001u;
      std::memcpy(at,
                  type == Imf::HALF    ? (const void *)&h
                  : type == Imf::FLOAT ? (const void *)&f
                                       : &u,
                  size_t(p.bytes_per_element));
    }
  return p;
}

/* A slice's base is where the pixel (0, 0) would be. */
Imf::Slice slice(Imf::PixelType type, char *first, int width, int bytes, int sampling,
                 const Box2i &window) {
  const ptrdiff_t origin =
      ptrdiff_t(window.min.y / sampling) * width + ptrdiff_t(window.min.x / sampling);
  return Imf::Slice(type, first - origin * bytes, size_t(bytes), size_t(bytes) * size_t(width),
                    sampling, sampling);
}

/* What a file or part of one needs before it is written. */
struct content {
  Imf::Header header;
  std::vector<plane> planes;
  Imf::FrameBuffer frame;

  explicit content(const exr_library_file &f) : header(box(f.display_window), box(f.data_window)) {
    const Box2i window = box(f.data_window);
    header.compression() = Imf::Compression(f.codec);
    header.lineOrder() = Imf::LineOrder(f.line_order);
    if (f.tile[0] > 0)
      header.setTileDescription(
          Imf::TileDescription(unsigned(f.tile[0]), unsigned(f.tile[1]), Imf::LevelMode(f.levels)));
    if (f.part != nullptr) {
      header.setName(f.part);
      header.setType(f.tile[0] > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    }
    if (f.id != nullptr) header.insert("colorInteropID", Imf::StringAttribute(f.id));
    for (int c = 0; c < f.channels; c++) {
      const std::string name = std::string(f.name[c]) + ".wavelength";
      if (f.metres[c] != 0 && c % 2 == 0) header.insert(name, Imf::FloatAttribute(f.metres[c]));
      if (f.metres[c] != 0 && c % 2 == 1)
        header.insert(name, Imf::DoubleAttribute(double(f.metres[c])));
      const int sampling = f.sampling > 1 && c == f.channels - 1 ? f.sampling : 1;
      header.channels().insert(
          f.name[c], Imf::Channel(Imf::PixelType(f.type[c]), sampling, sampling, c % 2 == 1));
      planes.push_back(fill(f.type[c], f.flat ? -1 : c, sampling, window));
      plane &p = planes.back();
      frame.insert(f.name[c], slice(Imf::PixelType(f.type[c]), p.bytes.data(), p.width,
                                    p.bytes_per_element, sampling, window));
    }
  }
};

template <typename File> void write_lines(File &file, const content &c) {
  file.setFrameBuffer(c.frame);
  file.writePixels(c.header.dataWindow().max.y - c.header.dataWindow().min.y + 1);
}

/* Each lesser level shows the corner of the full one: no matter. */
template <typename File> void write_tiles(File &file, const content &c) {
  file.setFrameBuffer(c.frame);
  for (int x = 0; x < file.numXLevels(); x++)
    for (int y = 0; y < file.numYLevels(); y++)
      if (file.isValidLevel(x, y))
        file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
}

void write(const char *path, const exr_library_file *f, int parts) {
  std::vector<content> contents;
  std::vector<Imf::Header> headers;
  for (int i = 0; i < parts; i++) contents.emplace_back(f[i]);
  for (const content &c : contents) headers.push_back(c.header);
  if (parts == 1 && f->tile[0] == 0) {
    Imf::OutputFile file(path, headers[0]);
    write_lines(file, contents[0]);
  } else if (parts == 1) {
    Imf::TiledOutputFile file(path, headers[0]);
    write_tiles(file, contents[0]);
  } else {
    Imf::MultiPartOutputFile file(path, headers.data(), parts);
    for (int i = 0; i < parts; i++)
      if (f[i].tile[0] == 0) {
        Imf::OutputPart part(file, i);
        write_lines(part, contents[size_t(i)]);
      } else {
        Imf::TiledOutputPart part(file, i);
        write_tiles(part, contents[size_t(i)]);
      }
  }
}

} // namespace

bool exr_library_write(const char *path, const exr_library_file *f, char *why, size_t size) {
  return guarded(why, size, [=] { write(path, f, 1); });
}

bool exr_library_write_parts(const char *path, const exr_library_file *f, int parts, char *why,
                             size_t size) {
  return guarded(why, size, [=] { write(path, f, parts); });
}

bool exr_library_read(const char *path, int part, const char *const *name, int count,
                      int data_window[4], int display_window[4], float **out, char *why,
                      size_t size) {
  *out = nullptr;
  return guarded(why, size, [=] {
    Imf::MultiPartInputFile parts(path);
    Imf::InputPart file(parts, part);
    const Box2i window = file.header().dataWindow();
    unbox(window, data_window);
    unbox(file.header().displayWindow(), display_window);
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    const size_t plane = size_t(width) * size_t(height);
    *out = static_cast<float *>(std::calloc(plane * size_t(count), sizeof **out));
    if (*out == nullptr) throw std::bad_alloc();
    Imf::FrameBuffer frame;
    for (int c = 0; c < count; c++) {
      if (file.header().channels().findChannel(name[c]) == nullptr)
        throw std::runtime_error(std::string("there is no channel ") + name[c]);
      frame.insert(name[c], slice(Imf::FLOAT, reinterpret_cast<char *>(*out + plane * size_t(c)),
                                  width, sizeof **out, 1, window));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
  });
}
