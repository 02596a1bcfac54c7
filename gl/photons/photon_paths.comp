// Lists the paths that land at some wavelength: those of the first exits of all photons, then of the second
// and so on, for neighbours on the list are worked on together and should have as much to do.
layout(local_size_x = 256) in;
#include "thread.glsl"
#define LISTS_PATHS
#include "path_list.glsl"
layout(std430, binding = BINDING_PATH_MARKS) readonly buffer PathMarks { uint path_mark[]; };
uniform uint items;  // photons, or refined intervals

void main() {
  uint id = thread_number();
  if (id >= items * counts.slots) return;
  uint order = id / items, path = (id - order * items) * counts.slots + order;
  if (path_mark[path] != 0u) path_list[atomicAdd(path_count, 1u)] = path;
}
