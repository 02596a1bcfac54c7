#include "colorimetry/screen/lut.h"

#include <OpenColorIO/OpenColorIO.h>

#include <exception>

namespace OCIO = OCIO_NAMESPACE;

abbe_result abbe_lut_apply(const char *path, abbe_image *image, abbe_error *error) {
  try {
    OCIO::FileTransformRcPtr file = OCIO::FileTransform::Create();
    file->setSrc(path);
    file->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
    OCIO::ClearAllCaches(); /* a file that was written anew is read anew */
    const ptrdiff_t pixel = static_cast<ptrdiff_t>(image->channels * sizeof(float));
    OCIO::PackedImageDesc pixels(image->data, static_cast<long>(image->width),
                                 static_cast<long>(image->height), 3, OCIO::BIT_DEPTH_F32,
                                 sizeof(float), pixel, pixel * static_cast<long>(image->width));
    OCIO::Config::CreateRaw()->getProcessor(file)->getDefaultCPUProcessor()->apply(pixels);
    return ABBE_OK;
  } catch (const std::exception &e) {
    return abbe_error_set(error, ABBE_COLOUR, "%s: OpenColorIO does not read it: %s", path,
                          e.what());
  }
}
