// Which thread this is among all of a dispatch, which may be run in parts (gl/device/gpu.h): of one in
// groups of a row after another; of one that has a thread a texel.
uniform uint first_group, first_row;

// What a dispatch is told that decides a branch, or how often a loop turns, and differs from one to the next. Mesa 25's zink
// may take an earlier one's value for a uniform that does so alone (findings/zink-keeps-a-uniform.sh). Adds 0.
int of_dispatch(int value) { return value + int(gl_WorkGroupID.z); }

uint group_number() {
  return first_group + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint thread_number() {
  return group_number() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

uvec2 texel_number() {
  return uvec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y + first_row);
}
