#include "colorimetry/image/display_ocio.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <OpenColorIO/OpenColorIO.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <string>

namespace OCIO = OCIO_NAMESPACE;

extern "C" {
extern const unsigned char abbe_embedded_config_ocio[];
extern const size_t abbe_embedded_config_ocio_size;
}

struct abbe_display {
  OCIO::ConstCPUProcessorRcPtr processor;
  double xy[8], curve[5];
  int transfer;
  bool adjusts; /* by way of XYZ: to_xyz, white, map, processor */
  OCIO::ConstCPUProcessorRcPtr to_xyz;
  double white[9];
  abbe_gamut_map map;
};

namespace {

/* OpenColorIO reads the numbers of a configuration by the thread's locale. */
struct plain_numbers {
  locale_t host = abbe_number_enter();
  plain_numbers() = default;
  plain_numbers(const plain_numbers &) = delete;
  plain_numbers &operator=(const plain_numbers &) = delete;
  ~plain_numbers() { abbe_number_leave(host); }
};

/* Runs work and turns whatever it throws into a result: nothing leaves this file. */
template <typename Work> abbe_result guarded(const char *what, abbe_error *error, Work work) {
  const plain_numbers numbers;
  try {
    return work();
  } catch (const std::bad_alloc &) {
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for it", what);
  } catch (const std::exception &e) {
    return abbe_error_set(error, ABBE_COLOUR, "%s: %s", what, e.what());
  } catch (...) {
    return abbe_error_set(error, ABBE_COLOUR, "%s: it failed for an unknown reason", what);
  }
}

const char *config_path(const char *path) {
  if (path != nullptr) return path;
  const char *environment = std::getenv("OCIO");
  return environment != nullptr && environment[0] != '\0' ? environment : nullptr;
}

const char *config_name(const char *path) {
  return config_path(path) != nullptr ? config_path(path) : "the shipped colour configuration";
}

/* OpenColorIO would wait at a pipe that has no writer. Its built-in configurations are no files. */
void check_file(const char *path) {
  abbe_error error = {};
  std::FILE *file = nullptr;
  if (std::strncmp(path, "ocio://", 7) == 0) return;
  if (abbe_file_open(path, &file, nullptr, &error) != ABBE_OK)
    throw OCIO::Exception(error.text + std::strlen(path) + 2); /* after "PATH: " */
  std::fclose(file);
}

/* The file's own word for its version; 0 where it has none. */
void read_version(const char *path, int *major, int *minor) {
  char line[256];
  *major = *minor = 0;
  std::FILE *file = std::fopen(path, "r");
  while (file != nullptr && std::fgets(line, sizeof line, file) != nullptr)
    if (std::sscanf(line, "ocio_profile_version: %d.%d", major, minor) > 0) break;
  if (file != nullptr) std::fclose(file);
}

/* What a younger OpenColorIO could load is refused with what the one that is here knows. */
void check_version(const char *path) {
  const int here = OCIO::GetVersionHex(), major_here = here >> 24, minor_here = here >> 16 & 0xff;
  const std::string library = std::string("the OpenColorIO here is ") + OCIO::GetVersion();
  if (std::strncmp(path, "ocio://", 7) == 0) {
    if (major_here > 2 || (major_here == 2 && minor_here >= 2)) return;
    throw OCIO::Exception(
        ("it names a configuration that is built into OpenColorIO 2.2 and later; " + library)
            .c_str());
  }
  int major, minor;
  read_version(path, &major, &minor);
  if (major < major_here || (major == major_here && minor <= minor_here)) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "it is a configuration of version %d.%d; %.80s, which reads up to %d.%d", major,
                minor, library.c_str(), major_here, minor_here);
  throw OCIO::Exception(text);
}

OCIO::ConstConfigRcPtr load(const char *path) {
  OCIO::ConstConfigRcPtr config;
  if (config_path(path) != nullptr) {
    check_file(config_path(path));
    check_version(config_path(path));
    config = OCIO::Config::CreateFromFile(config_path(path));
  } else {
    std::istringstream text(std::string(reinterpret_cast<const char *>(abbe_embedded_config_ocio),
                                        abbe_embedded_config_ocio_size));
    config = OCIO::Config::CreateFromStream(text);
  }
  config->validate();
  return config;
}

std::string known_displays(const OCIO::ConstConfigRcPtr &config) {
  std::string list;
  for (int i = 0; i < config->getNumDisplays(); i++)
    list += std::string(i == 0 ? "" : ", ") + config->getDisplay(i);
  return list;
}

std::string known_views(const OCIO::ConstConfigRcPtr &config, const char *display) {
  std::string list;
  for (int i = 0; i < config->getNumViews(display); i++)
    list += std::string(i == 0 ? "" : ", ") + config->getView(display, i);
  return list;
}

std::string known_spaces(const OCIO::ConstConfigRcPtr &config) {
  std::string list;
  for (int i = 0; i < config->getNumColorSpaces(); i++)
    list += std::string(i == 0 ? "" : ", ") + config->getColorSpaceNameByIndex(i);
  return list;
}

bool has_display(const OCIO::ConstConfigRcPtr &config, const char *display) {
  for (int i = 0; i < config->getNumDisplays(); i++)
    if (std::strcmp(config->getDisplay(i), display) == 0) return true;
  return false;
}

bool has_view(const OCIO::ConstConfigRcPtr &config, const char *display, const char *view) {
  for (int i = 0; i < config->getNumViews(display); i++)
    if (std::strcmp(config->getView(display, i), view) == 0) return true;
  return false;
}

abbe_result unknown(const char *config, const char *kind, const char *name,
                    const std::string &known, abbe_error *error) {
  return abbe_error_set(error, ABBE_COLOUR, "%s: it has no %s '%s'; it has: %s", config, kind, name,
                        known.c_str());
}

/* Exposure scales scene-linear light; without it the picture goes to the display in one step. */
OCIO::GroupTransformRcPtr display_transform(const char *source, const char *display,
                                            const char *view, double exposure) {
  OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  if (exposure != 0) {
    OCIO::ColorSpaceTransformRcPtr linear = OCIO::ColorSpaceTransform::Create();
    linear->setSrc(source);
    linear->setDst(OCIO::ROLE_SCENE_LINEAR);
    group->appendTransform(linear);
    const double scale = std::exp2(exposure);
    const double diagonal[4] = {scale, scale, scale, 1};
    double matrix[16], offset[4];
    OCIO::MatrixTransform::Scale(matrix, offset, diagonal);
    OCIO::MatrixTransformRcPtr expose = OCIO::MatrixTransform::Create();
    expose->setMatrix(matrix);
    group->appendTransform(expose);
    source = OCIO::ROLE_SCENE_LINEAR;
  }
  OCIO::DisplayViewTransformRcPtr show = OCIO::DisplayViewTransform::Create();
  show->setSrc(source);
  show->setDisplay(display);
  show->setView(view);
  group->appendTransform(show);
  return group;
}

/* From the view's colour space to CIE XYZ, by the roles that OCIO has for it. */
OCIO::ConstProcessorRcPtr encoding_to_xyz(const OCIO::ConstConfigRcPtr &config,
                                          const OCIO::ConstColorSpaceRcPtr &space) {
  OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  OCIO::ColorSpaceTransformRcPtr decode = OCIO::ColorSpaceTransform::Create();
  const bool display = space->getReferenceSpaceType() == OCIO::REFERENCE_SPACE_DISPLAY;
  decode->setSrc(space->getName());
  decode->setDst(display ? "cie_xyz_d65_interchange" : "aces_interchange");
  group->appendTransform(decode);
  if (!display) {
    OCIO::BuiltinTransformRcPtr to_xyz = OCIO::BuiltinTransform::Create();
    to_xyz->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
    group->appendTransform(to_xyz);
  }
  return config->getProcessor(group);
}

bool named(const std::string &display, const char *name) {
  return display == name || display == std::string(name) + " - Display";
}

/* What the display's numbers mean; nothing where the configuration does not tell. */
void find_encoding(const OCIO::ConstConfigRcPtr &config, const std::string &display,
                   const char *view, abbe_display *out) {
  const std::string word = config->getDisplayViewColorSpaceName(display.c_str(), view);
  const std::string name = word == OCIO::OCIO_VIEW_USE_DISPLAY_NAME ? display : word;
  OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name.c_str());
  if (!space || space->isData()) return;
  float probes[ABBE_RGB_ENCODING_PROBES][3];
  abbe_rgb_encoding_probes(probes);
  try {
    OCIO::PackedImageDesc pixels(probes, ABBE_RGB_ENCODING_PROBES, 1, 3);
    encoding_to_xyz(config, space)->getDefaultCPUProcessor()->apply(pixels);
    if (abbe_rgb_encoding_of_probes(probes, out->xy, out->curve)) return;
    if (abbe_rgb_encoding_of_hdr_probes(probes, out->xy, &out->transfer)) return;
  } catch (const OCIO::Exception &) { /* no such role, or a transform of one way only */
  }
  if (named(display, "sRGB")) abbe_rgb_encoding_srgb(out->xy, out->curve);
  if (named(display, "Display P3")) abbe_rgb_encoding_display_p3(out->xy, out->curve);
}

/* To XYZ relative to D65, or back, from the role that the ACES spaces are exchanged by. */
OCIO::BuiltinTransformRcPtr aces_to_xyz(OCIO::TransformDirection direction) {
  OCIO::BuiltinTransformRcPtr transform = OCIO::BuiltinTransform::Create();
  transform->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
  transform->setDirection(direction);
  return transform;
}

/* White and gamut are matters of XYZ, between the picture's space and the view. */
abbe_result adjust(const OCIO::ConstConfigRcPtr &config, const abbe_display_desc *desc,
                   const char *source, const OCIO::GroupTransformRcPtr &show, abbe_display *out,
                   abbe_error *error) {
  static const double d65[2] = {0.3127, 0.3290};
  const char *name = config_name(desc->config);
  const bool balanced = desc->white[0] != 0 || desc->white[1] != 0;
  const bool mapped = desc->gamut != ABBE_GAMUT_MAP_NONE;
  if (!config->hasRole("aces_interchange"))
    return abbe_error_set(
        error, ABBE_COLOUR,
        "%s: it has no role aces_interchange, without which neither a white nor a "
        "gamut map can be applied",
        name);
  if (mapped && out->xy[7] == 0)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: it does not tell the display's primaries, so no gamut map fits it",
                          name);
  OCIO::GroupTransformRcPtr before = OCIO::GroupTransform::Create();
  OCIO::ColorSpaceTransformRcPtr to_aces = OCIO::ColorSpaceTransform::Create();
  to_aces->setSrc(source);
  to_aces->setDst("aces_interchange");
  before->appendTransform(to_aces);
  before->appendTransform(aces_to_xyz(OCIO::TRANSFORM_DIR_FORWARD));
  OCIO::GroupTransformRcPtr after = OCIO::GroupTransform::Create();
  after->appendTransform(aces_to_xyz(OCIO::TRANSFORM_DIR_INVERSE));
  after->appendTransform(show);
  out->to_xyz = config->getProcessor(before)->getDefaultCPUProcessor();
  out->processor = config->getProcessor(after)->getDefaultCPUProcessor();
  out->adjusts = true;
  abbe_rgb_space_adapt(balanced ? desc->white : d65, d65, out->white);
  return mapped ? abbe_gamut_map_make(desc->gamut, out->xy, &out->map, error) : ABBE_OK;
}

abbe_result make(const abbe_display_desc *desc, abbe_display **out, abbe_error *error) {
  const char *name = config_name(desc->config);
  OCIO::ConstConfigRcPtr config = load(desc->config);
  const std::string display =
      desc->display != nullptr ? desc->display : config->getDefaultDisplay();
  if (!has_display(config, display.c_str()))
    return unknown(name, "display", display.c_str(), known_displays(config), error);
  const std::string view =
      desc->view != nullptr ? desc->view : config->getDefaultView(display.c_str());
  if (!has_view(config, display.c_str(), view.c_str()))
    return unknown(name, "view", view.c_str(), known_views(config, display.c_str()), error);
  const char *source = desc->source_space != nullptr ? desc->source_space : OCIO::ROLE_SCENE_LINEAR;
  if (config->getColorSpace(source) == nullptr)
    return unknown(name, "colour space", source, known_spaces(config), error);
  const bool adjusts = desc->white[0] != 0 || desc->white[1] != 0 || desc->gamut != 0;
  OCIO::GroupTransformRcPtr show = display_transform(adjusts ? "aces_interchange" : source,
                                                     display.c_str(), view.c_str(), desc->exposure);
  abbe_display made = {};
  find_encoding(config, display, view.c_str(), &made);
  if (adjusts) {
    const abbe_result result = adjust(config, desc, source, show, &made, error);
    if (result != ABBE_OK) return result;
  } else {
    made.processor = config->getProcessor(show)->getDefaultCPUProcessor();
  }
  *out = new abbe_display(made);
  return ABBE_OK;
}

} // namespace

abbe_result abbe_display_make(const abbe_display_desc *desc, abbe_display **out,
                              abbe_error *error) {
  ABBE_REQUIRE(desc && out, error);
  *out = nullptr;
  if (!std::isfinite(desc->exposure) || std::fabs(desc->exposure) > ABBE_DISPLAY_MAX_EXPOSURE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an exposure of %g stops is outside -%g to %g", desc->exposure,
                          ABBE_DISPLAY_MAX_EXPOSURE, ABBE_DISPLAY_MAX_EXPOSURE);
  const double *white = desc->white;
  if ((white[0] != 0 || white[1] != 0) &&
      !(white[0] > 0 && white[1] > 0.01 && white[0] + white[1] < 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the white x, y = %g, %g is none; such as 0.3127, 0.3290 is", white[0],
                          white[1]);
  if (static_cast<unsigned>(desc->gamut) >= ABBE_GAMUT_MAP_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no gamut map number %d",
                          static_cast<int>(desc->gamut));
  return guarded(config_name(desc->config), error, [=] { return make(desc, out, error); });
}

void abbe_display_free(abbe_display *display) {
  delete display;
}

static void adjust_pixels(const abbe_display *display, abbe_image *image) {
  for (size_t i = 0; i < image->width * image->height; i++) {
    float *pixel = image->data + i * image->channels;
    double xyz[3] = {pixel[0], pixel[1], pixel[2]};
    abbe_rgb_space_apply(display->white, xyz, xyz);
    abbe_gamut_map_apply(&display->map, xyz);
    for (int c = 0; c < 3; c++) pixel[c] = static_cast<float>(xyz[c]);
  }
}

abbe_result abbe_display_apply(const abbe_display *display, abbe_image *image, abbe_error *error) {
  ABBE_REQUIRE(display && image, error);
  if (image->data == nullptr || image->channels < 3)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an image of %zu channels cannot be displayed; three are needed",
                          image->channels);
  return guarded("the display transform", error, [=] {
    const ptrdiff_t pixel = static_cast<ptrdiff_t>(image->channels * sizeof(float));
    OCIO::PackedImageDesc pixels(image->data, static_cast<long>(image->width),
                                 static_cast<long>(image->height), 3, OCIO::BIT_DEPTH_F32,
                                 sizeof(float), pixel, pixel * static_cast<long>(image->width));
    if (display->adjusts) {
      display->to_xyz->apply(pixels);
      adjust_pixels(display, image);
    }
    display->processor->apply(pixels);
    image->transfer = display->transfer;
    std::memcpy(image->xy, display->xy, sizeof image->xy);
    std::memcpy(image->curve, display->curve, sizeof image->curve);
    return ABBE_OK;
  });
}

abbe_result abbe_display_list(const char *config_file, char **out, abbe_error *error) {
  ABBE_REQUIRE(out, error);
  *out = nullptr;
  return guarded(config_name(config_file), error, [=] {
    OCIO::ConstConfigRcPtr config = load(config_file);
    std::string text;
    for (int d = 0; d < config->getNumDisplays(); d++) {
      const char *display = config->getDisplay(d);
      for (int v = 0; v < config->getNumViews(display); v++)
        text += std::string(display) + " / " + config->getView(display, v) + "\n";
    }
    *out = strdup(text.c_str());
    if (*out == nullptr) throw std::bad_alloc();
    return ABBE_OK;
  });
}

void abbe_display_set_log(void (*log)(const char *message)) {
  OCIO::SetLoggingFunction(log);
}
