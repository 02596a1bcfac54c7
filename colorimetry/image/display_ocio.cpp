#include "colorimetry/image/display_ocio.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <OpenColorIO/OpenColorIO.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
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
  bool adjusts; /* between the picture and the view: to_linear, adjustment, map, processor */
  OCIO::ConstCPUProcessorRcPtr to_linear;
  double adjustment[9]; /* exposure, and in XYZ the white */
  abbe_gamut_map map;
};

namespace {

/* More light overflows in some views, or before them. */
const float MOST_SHOWN = 0x1p60F, MOST_READ = 0x1p100F;

/* OpenColorIO reads the numbers of a configuration by the thread's locale. */
struct plain_numbers {
  const locale_t host = abbe_number_enter(); /* and so it is not assigned */
  plain_numbers() = default;
  plain_numbers(const plain_numbers &) = delete;
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
  const char *set = std::getenv("OCIO");
  return set != nullptr && set[0] != '\0' ? set : nullptr;
}

const char *config_name(const char *path) {
  return config_path(path) != nullptr ? config_path(path) : "the shipped colour configuration";
}

/* OpenColorIO would wait at a pipe that has no writer. Its built-in configurations are no files. */
void check_file(const char *path) {
  abbe_error error = {};
  std::FILE *file = nullptr;
  if (std::strncmp(path, "ocio://", 7) == 0) return;
  if (abbe_file_open(path, &file, nullptr, &error) != ABBE_OK) /* its words are behind "PATH: " */
    throw OCIO::Exception(error.text + strnlen(error.text, std::strlen(path) + 2));
  std::fclose(file);
}

/* The file's own word for its version; 0 where it has none. A built-in one's is in its name, and
 * the first are those of 2.2. */
void read_version(const char *path, bool built_in, int *major, int *minor) {
  char line[256];
  *major = *minor = 0;
  const char *named = built_in ? std::strstr(path, "ocio-v") : nullptr;
  if (named != nullptr) std::sscanf(named, "ocio-v%d.%d", major, minor);
  if (built_in && *major * 100 + *minor < 202) *major = *minor = 2;
  std::FILE *file = built_in ? nullptr : std::fopen(path, "r");
  while (file != nullptr && std::fgets(line, sizeof line, file) != nullptr)
    if (std::sscanf(line, "ocio_profile_version: %d.%d", major, minor) > 0) break;
  if (file != nullptr) std::fclose(file);
}

/* What a younger OpenColorIO could load is refused with what the one that is here knows. */
void check_version(const char *path) {
  const int here = OCIO::GetVersionHex(), major_here = here >> 24, minor_here = here >> 16 & 0xff;
  const bool built_in = std::strncmp(path, "ocio://", 7) == 0;
  int major, minor;
  char text[200];
  read_version(path, built_in, &major, &minor);
  if (major < major_here || (major == major_here && minor <= minor_here)) return;
  std::snprintf(text, sizeof text, "it %s %d.%d%s; the OpenColorIO here is %.20s",
                built_in ? "names a configuration that is built into OpenColorIO"
                         : "is a configuration of version",
                major, minor, built_in ? " and later" : "", OCIO::GetVersion());
  throw OCIO::Exception(text);
}

/* All names of a kind, "a, b, c". */
template <typename Name> std::string listed(int count, Name name) {
  std::string list;
  for (int i = 0; i < count; i++) list += std::string(i == 0 ? "" : ", ") + name(i);
  return list;
}

template <typename Name> bool has(const char *wanted, int count, Name name) {
  for (int i = 0; i < count; i++)
    if (std::strcmp(name(i), wanted) == 0) return true;
  return false;
}

/* OpenColorIO refuses a file whose active displays name one that is not there, as Filmic's do. */
OCIO::ConstConfigRcPtr without_unknown_displays(const OCIO::ConstConfigRcPtr &config) {
  OCIO::ConfigRcPtr known = config->createEditableCopy();
  std::istringstream active(config->getActiveDisplays());
  std::string list, name;
  while (std::getline(active >> std::ws, name, ','))
    if (has(name.c_str(), config->getNumDisplaysAll(),
            [&](int i) { return config->getDisplayAll(i); }))
      list += (list.empty() ? "" : ", ") + name;
  if (!list.empty()) known->setActiveDisplays(list.c_str());
  known->validate();
  return known;
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
  return without_unknown_displays(config);
}

abbe_result unknown(const char *config, const char *kind, const char *name,
                    const std::string &known, abbe_error *error) {
  return abbe_error_set(error, ABBE_COLOUR, "%s: it has no %s '%s'; it has: %s", config, kind, name,
                        known.c_str());
}

/* A linear, scene-referred space of a configuration and what its numbers are: the link between
 * Abbe's spaces and those of the configuration. */
struct anchor {
  std::string space; /* empty: none is known */
  double to_xyz[9];  /* row-major, to XYZ relative to D65 */
};

/* The roles that spaces are exchanged by, then names that state the primaries;
 * ABBE_RGB_SPACE_COUNT: AP0. */
const struct {
  const char *name;
  abbe_rgb_space space;
} known_anchors[] = {
    {"aces_interchange", ABBE_RGB_SPACE_COUNT}, {"cie_xyz_d65_interchange", ABBE_RGB_SPACE_XYZ},
    {"ACES2065-1", ABBE_RGB_SPACE_COUNT},       {"ACES - ACES2065-1", ABBE_RGB_SPACE_COUNT},
    {"ACEScg", ABBE_RGB_SPACE_ACESCG},          {"Linear Rec.709 (sRGB)", ABBE_RGB_SPACE_REC709},
    {"Linear Rec.709", ABBE_RGB_SPACE_REC709},  {"Linear BT.709", ABBE_RGB_SPACE_REC709},
    {"lin_rec709", ABBE_RGB_SPACE_REC709}};

bool is_scene_colour(const OCIO::ConstConfigRcPtr &config, const char *name) {
  OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
  return space && !space->isData() && space->getReferenceSpaceType() == OCIO::REFERENCE_SPACE_SCENE;
}

/* Whether the role scene_linear is linear Rec.709: sRGB, by that name, is then its curve alone (or
 * the power 2.2 that some write for it), a channel at a time. */
bool is_scene_linear_rec709(const OCIO::ConstConfigRcPtr &config) {
  const float light[12] = {0.5F, 0.2F, 0.2F, 0.2F, 0.5F, 0.2F, 0.2F, 0.2F, 0.5F, 0.7F, 0.7F, 0.7F};
  for (const char *texture : {"sRGB - Texture", "sRGB OETF", "sRGB"}) {
    if (!is_scene_colour(config, texture)) continue;
    float probe[12];
    bool same = is_scene_colour(config, OCIO::ROLE_SCENE_LINEAR);
    std::memcpy(probe, light, sizeof probe);
    OCIO::PackedImageDesc pixels(probe, 4, 1, 3);
    if (same)
      config->getProcessor(OCIO::ROLE_SCENE_LINEAR, texture)
          ->getDefaultCPUProcessor()
          ->apply(pixels);
    for (int i = 0; same && i < 12; i++) {
      const double x = light[i], curve = 1.055 * std::pow(x, 1 / 2.4) - 0.055;
      const double off =
          std::fmin(std::fabs(probe[i] - curve), std::fabs(probe[i] - std::pow(x, 1 / 2.2)));
      same = off < 2e-3;
    }
    return same;
  }
  return false;
}

anchor find_anchor(const OCIO::ConstConfigRcPtr &config) {
  static const double ap0_xy[8] = {0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767};
  anchor found = {};
  for (const auto &known : known_anchors) {
    if (!is_scene_colour(config, known.name)) continue;
    found.space = known.name;
    if (known.space == ABBE_RGB_SPACE_COUNT)
      abbe_rgb_space_chromaticities_to_xyz(ap0_xy, found.to_xyz, nullptr);
    else
      abbe_rgb_space_to_xyz(known.space, found.to_xyz);
    return found;
  }
  if (is_scene_linear_rec709(config)) found.space = OCIO::ROLE_SCENE_LINEAR;
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, found.to_xyz);
  return found;
}

OCIO::MatrixTransformRcPtr matrix_transform(const double matrix[9],
                                            OCIO::TransformDirection direction) {
  double wide[16] = {};
  for (int i = 0; i < 9; i++) wide[i / 3 * 4 + i % 3] = matrix[i];
  wide[15] = 1;
  OCIO::MatrixTransformRcPtr transform = OCIO::MatrixTransform::Create();
  transform->setMatrix(wide);
  transform->setDirection(direction);
  return transform;
}

OCIO::ColorSpaceTransformRcPtr space_transform(const char *from, const char *to) {
  OCIO::ColorSpaceTransformRcPtr transform = OCIO::ColorSpaceTransform::Create();
  transform->setSrc(from);
  transform->setDst(to);
  return transform;
}

/* Where pictures are: a space of the configuration, or one of Abbe's that it does not have. */
struct source_space {
  std::string name; /* in the configuration; empty: to_xyz */
  double to_xyz[9];
};

/* From the pictures to a space of the configuration, which is returned. */
const char *enter(const source_space &source, const anchor &door,
                  const OCIO::GroupTransformRcPtr &group) {
  if (!source.name.empty()) return source.name.c_str();
  group->appendTransform(matrix_transform(source.to_xyz, OCIO::TRANSFORM_DIR_FORWARD));
  group->appendTransform(matrix_transform(door.to_xyz, OCIO::TRANSFORM_DIR_INVERSE));
  return door.space.c_str();
}

void append_display(const OCIO::GroupTransformRcPtr &group, const char *source, const char *display,
                    const char *view) {
  OCIO::DisplayViewTransformRcPtr show = OCIO::DisplayViewTransform::Create();
  show->setSrc(source);
  show->setDisplay(display);
  show->setView(view);
  group->appendTransform(show);
}

/* From the view's colour space to CIE XYZ, by the roles that OCIO has for it. */
OCIO::ConstProcessorRcPtr encoding_to_xyz(const OCIO::ConstConfigRcPtr &config,
                                          const OCIO::ConstColorSpaceRcPtr &space) {
  OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  const bool display = space->getReferenceSpaceType() == OCIO::REFERENCE_SPACE_DISPLAY;
  group->appendTransform(
      space_transform(space->getName(), display ? "cie_xyz_d65_interchange" : "aces_interchange"));
  if (!display) {
    OCIO::BuiltinTransformRcPtr to_xyz = OCIO::BuiltinTransform::Create();
    to_xyz->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
    group->appendTransform(to_xyz);
  }
  return config->getProcessor(group);
}

/* What the display's numbers mean; nothing where the configuration does not state it. */
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
  } catch (const OCIO::Exception &) { /* no such role, or a transform in one direction only */
  }
  const std::string plain = display.substr(0, display.find(" - Display"));
  if (plain == "sRGB") abbe_rgb_encoding_srgb(out->xy, out->curve);
  if (plain == "Display P3") abbe_rgb_encoding_display_p3(out->xy, out->curve);
}

/* White and gamut are matters of XYZ, between the picture's space and the view. */
abbe_result adjust(const OCIO::ConstConfigRcPtr &config, const abbe_display_desc *desc,
                   const source_space &source, const anchor &door, const char *display,
                   const char *view, abbe_display *out, abbe_error *error) {
  static const double d65[2] = {0.3127, 0.3290};
  const char *name = config_name(desc->config);
  const bool balanced = desc->white[0] != 0;
  const bool mapped = desc->gamut != ABBE_GAMUT_MAP_NONE;
  if (door.space.empty())
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: it has no role aces_interchange, nor another space that is known, "
                          "without which neither a white nor a gamut map can be applied",
                          name);
  if (mapped && out->xy[7] == 0)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: it does not tell the display's primaries, so no gamut map fits it",
                          name);
  OCIO::GroupTransformRcPtr before = OCIO::GroupTransform::Create();
  if (source.name.empty()) {
    before->appendTransform(matrix_transform(source.to_xyz, OCIO::TRANSFORM_DIR_FORWARD));
  } else {
    before->appendTransform(space_transform(source.name.c_str(), door.space.c_str()));
    before->appendTransform(matrix_transform(door.to_xyz, OCIO::TRANSFORM_DIR_FORWARD));
  }
  OCIO::GroupTransformRcPtr after = OCIO::GroupTransform::Create();
  after->appendTransform(matrix_transform(door.to_xyz, OCIO::TRANSFORM_DIR_INVERSE));
  append_display(after, door.space.c_str(), display, view);
  out->to_linear = config->getProcessor(before)->getDefaultCPUProcessor();
  out->processor = config->getProcessor(after)->getDefaultCPUProcessor();
  abbe_rgb_space_adapt(balanced ? desc->white : d65, d65, out->adjustment);
  return mapped ? abbe_gamut_map_make(desc->gamut, out->xy, &out->map, error) : ABBE_OK;
}

/* The picture goes to the display in one step, or by scene-linear light where that is exposed:
 * OpenColorIO takes the small numbers of a dark exposure's matrix for none. */
void show_plainly(const OCIO::ConstConfigRcPtr &config, const source_space &source,
                  const anchor &door, const char *display, const char *view, abbe_display *out) {
  OCIO::GroupTransformRcPtr before = OCIO::GroupTransform::Create();
  OCIO::GroupTransformRcPtr after = out->adjusts ? OCIO::GroupTransform::Create() : before;
  const char *from = enter(source, door, before);
  if (out->adjusts) {
    before->appendTransform(space_transform(from, OCIO::ROLE_SCENE_LINEAR));
    out->to_linear = config->getProcessor(before)->getDefaultCPUProcessor();
    from = OCIO::ROLE_SCENE_LINEAR;
  }
  append_display(after, from, display, view);
  out->processor = config->getProcessor(after)->getDefaultCPUProcessor();
  for (int i = 0; i < 9; i += 4) out->adjustment[i] = 1;
}

/* A name of the configuration goes before one of Abbe's, which the anchor reaches. */
abbe_result find_source(const OCIO::ConstConfigRcPtr &config, const abbe_display_desc *desc,
                        const anchor &door, source_space *out, abbe_error *error) {
  const char *name = desc->source_space != nullptr ? desc->source_space : OCIO::ROLE_SCENE_LINEAR;
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT && !config->getColorSpace(name); s++) {
    const abbe_rgb_space space = static_cast<abbe_rgb_space>(s);
    if (door.space.empty() || std::strcmp(name, abbe_rgb_space_ocio_name(space)) != 0) continue;
    abbe_rgb_space_to_xyz(space, out->to_xyz);
    return ABBE_OK;
  }
  out->name = name;
  if (config->getColorSpace(name)) return ABBE_OK;
  return unknown(config_name(desc->config), "colour space", name,
                 listed(config->getNumColorSpaces(),
                        [&](int i) { return config->getColorSpaceNameByIndex(i); }),
                 error);
}

abbe_result make_on(const OCIO::ConstConfigRcPtr &config, const char *display,
                    const abbe_display_desc *desc, abbe_display **out, abbe_error *error) {
  const char *const name = config_name(desc->config);
  const auto display_name = [&](int i) { return config->getDisplay(i); };
  const int displays = config->getNumDisplays();
  if (!has(display, displays, display_name))
    return unknown(name, "display", display, listed(displays, display_name), error);
  const std::string view = desc->view != nullptr ? desc->view : config->getDefaultView(display);
  const auto view_name = [&](int i) { return config->getView(display, i); };
  const int views = config->getNumViews(display);
  if (!has(view.c_str(), views, view_name))
    return unknown(name, "view", view.c_str(), listed(views, view_name), error);
  const anchor door = find_anchor(config);
  source_space source;
  ABBE_TRY(find_source(config, desc, door, &source, error));
  abbe_display made = {};
  const bool by_xyz = desc->white[0] != 0 || desc->gamut != 0;
  made.adjusts = by_xyz || desc->exposure != 0;
  find_encoding(config, display, view.c_str(), &made);
  if (by_xyz)
    ABBE_TRY(adjust(config, desc, source, door, display, view.c_str(), &made, error));
  else
    show_plainly(config, source, door, display, view.c_str(), &made);
  for (double &number : made.adjustment) number *= std::exp2(desc->exposure);
  *out = new abbe_display(made);
  return ABBE_OK;
}

/* An ICC profile becomes a display as OpenColorIO has it, with the configuration's views for it. */
abbe_result make(const abbe_display_desc *desc, abbe_display **out, abbe_error *error) {
  const OCIO::ConstConfigRcPtr config = load(desc->config);
  const std::string name = desc->display != nullptr ? desc->display : config->getDefaultDisplay();
  const auto ending = std::filesystem::path(name).extension();
  if (ending != ".icc" && ending != ".icm") return make_on(config, name.c_str(), desc, out, error);
  const char *advice = " does not take this profile; --display sRGB needs none. Its reason";
  const std::string what = name + ": OpenColorIO " + OCIO::GetVersion() + advice;
  return guarded(what.c_str(), error, [=] {
    const OCIO::ConfigRcPtr made = config->createEditableCopy();
    const int at = made->instantiateDisplayFromICCProfile(std::filesystem::absolute(name).c_str());
    return make_on(made, made->getDisplay(at), desc, out, error);
  });
}

} // namespace

abbe_result abbe_display_make(const abbe_display_desc *desc, abbe_display **out,
                              abbe_error *error) {
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
  return guarded(config_name(desc->config), error, [=] { return make(desc, out, error); });
}

void abbe_display_free(abbe_display *display) {
  delete display;
}

/* Infinite light is the brightest that there is, and what is no number is none. */
static void hold_pixels(abbe_image *image, float most) {
  for (size_t i = 0; i < image->width * image->height; i++)
    for (size_t c = 0; c < 3; c++) {
      float *value = image->data + i * image->channels + c;
      *value = std::isnan(*value) ? 0 : std::fmin(std::fmax(*value, -most), most);
    }
}

static void adjust_pixels(const abbe_display *display, abbe_image *image) {
  for (size_t i = 0; i < image->width * image->height; i++) {
    float *pixel = image->data + i * image->channels;
    double v[3] = {pixel[0], pixel[1], pixel[2]};
    abbe_rgb_space_apply(display->adjustment, v, v);
    abbe_gamut_map_apply(&display->map, v);
    for (int c = 0; c < 3; c++) pixel[c] = static_cast<float>(v[c]);
  }
}

abbe_result abbe_display_apply(const abbe_display *display, abbe_image *image, abbe_error *error) {
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
      hold_pixels(image, MOST_READ);
      display->to_linear->apply(pixels);
      adjust_pixels(display, image);
    }
    hold_pixels(image, MOST_SHOWN);
    display->processor->apply(pixels);
    image->transfer = display->transfer;
    std::memcpy(image->xy, display->xy, sizeof image->xy);
    std::memcpy(image->curve, display->curve, sizeof image->curve);
    return ABBE_OK;
  });
}

abbe_result abbe_display_list(const char *config_file, char **out, abbe_error *error) {
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
