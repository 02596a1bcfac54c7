// Which thread this is among all of a dispatch, which may be run in parts (gl/device/gpu.h): of one in
// groups of a row after another; of one that has a thread a texel.
uniform uint first_group, first_row;

uint group_number() {
  return first_group + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint thread_number() {
  return group_number() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

uvec2 texel_number() {
  return uvec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y + first_row);
}
