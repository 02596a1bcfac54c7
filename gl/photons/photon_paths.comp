// Lists the paths that land at some wavelength: those of the first exits of all photons, then of the second
// and so on, for neighbours on the list are worked on together and should have as much to do.
layout(local_size_x = 256) in;
layout(std430, binding = BINDING_PATH_MARKS) readonly buffer PathMarks { uint path_mark[]; };
layout(std430, binding = BINDING_PATHS) buffer PathList {
  uint path_count, path_groups[3];
  uint path_list[];
};
uniform uint items;  // photons, or refined intervals

void main() {
  uint id = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
            gl_LocalInvocationID.x;
  if (id >= items * SLOTS) return;
  uint order = id / items, path = (id - order * items) * SLOTS + order;
  if (path_mark[path] != 0u) path_list[atomicAdd(path_count, 1u)] = path;
}
