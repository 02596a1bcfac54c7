// A program outside the house, in C++: handles as unique pointers, errors as exceptions.
#include "library/lib_comparison.h"
#include "library/lib_scene.h"

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

namespace {
using Scene = std::unique_ptr<abbe_lib_scene, decltype(&abbe_lib_scene_free)>;
using Picture = std::unique_ptr<abbe_lib_picture, decltype(&abbe_lib_picture_free)>;
using Comparison = std::unique_ptr<abbe_lib_comparison, decltype(&abbe_lib_comparison_free)>;

// call(function, arguments…): an abbe_result as an exception.
template <typename... Wanted, typename... Arguments>
void call(abbe_result (*function)(Wanted...), Arguments... arguments) {
  abbe_error error{};
  if (function(arguments..., &error) != ABBE_OK) throw std::runtime_error(error.text);
}

Picture render(const Scene &scene) {
  const std::vector<const char *> how{"width=32", "height=32", "photons=32", "map_size=64"};
  abbe_lib_picture *out = nullptr;
  call(abbe_lib_scene_render, scene.get(), how.data(), how.size(), &out);
  return {out, abbe_lib_picture_free};
}

double energy_ratio(const Picture &reference, const Picture &test) {
  abbe_lib_comparison *out = nullptr;
  double value, noise, limit;
  call(abbe_lib_comparison_make, reference.get(), test.get(), nullptr, nullptr, 0, &out);
  const Comparison comparison{out, abbe_lib_comparison_free};
  call(abbe_lib_comparison_value, comparison.get(), "energy_ratio", false, &value, &noise, &limit);
  return value;
}

void run(const char *path) {
  abbe_lib_scene *opened = nullptr;
  call(abbe_lib_scene_open, path, nullptr, nullptr, nullptr, 0, &opened);
  const Scene scene{opened, abbe_lib_scene_free};
  const Picture first = render(scene);
  double eye[3], target[3], up[3], fov;
  call(abbe_lib_scene_camera, scene.get(), eye, target, up, &fov);
  call(abbe_lib_scene_look, scene.get(), nullptr, nullptr, nullptr, 0.7 * fov);
  const Picture moved = render(scene);
  const std::vector<const char *> how{"width=32", "height=32", "photons=10000", "passes=2"};
  abbe_lib_picture *traced = nullptr;
  call(abbe_lib_scene_trace, scene.get(), how.data(), how.size(), nullptr, &traced, nullptr);
  const Picture truth{traced, abbe_lib_picture_free};
  const float *a = abbe_lib_picture_pixels(first.get()), *b = abbe_lib_picture_pixels(moved.get());
  const bool differs =
      std::vector<float>(a, a + 32 * 32 * 3) != std::vector<float>(b, b + 32 * 32 * 3);
  std::printf("outside in C++: done; camera %s, energy ratio %.1f\n", differs ? "moved" : "stuck",
              energy_ratio(truth, moved));
}
} // namespace

int main(int argc, char **argv) {
  try {
    run(argc > 1 ? argv[1] : "");
  } catch (const std::exception &error) {
    std::printf("outside in C++: %s\n", error.what());
    return 1;
  }
}
