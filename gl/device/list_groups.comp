// Turns the count at the head of a list into the dispatch that consumes it.
layout(local_size_x = 1) in;
layout(std430, binding = BINDING_DISPATCH) buffer List { uint count, groups_x, groups_y, groups_z; };
uniform uint group_size;
uniform uint first;    // element that is looked at
uniform uint most;     // at most so many of them
uniform uint threads;  // an element

void main() {
  // No dimension may have more than 65535 groups.
  uint groups = (min(max(count, first) - first, most) * threads + group_size - 1u) / group_size;
  groups_y = (groups + 65534u) / 65535u;
  groups_x = groups_y > 0u ? (groups + groups_y - 1u) / groups_y : 0u;
  groups_z = 1u;
}
