// Pieces of light on their way to the map: place in texels (x in 12.20 fixed point; y in 12.17 with
// the level in the low three bits) and XYZ in map units, so that the list is what is summed.
const uint SPLAT_WORDS = 5u;
layout(std430, binding = 15) buffer SplatList {
  uint splat_count, splat_groups_x, splat_groups_y, splat_groups_z;
  uint splat[];
};
