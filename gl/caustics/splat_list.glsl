// Splats of light for the map: the place of the middle in texels (12.15 fixed point; below x the
// high five bits of the tile's number from 1, 0 for the map; below y the low two, then the level in three),
// from edge to edge across the footprint (two halves), XYZ in map units, so that the list is what is
// summed, and from that place to where X, Y and Z lie in the mean; the shift from one
// colour to the next, and by how much more the footprint's second half is than its first; its width
// beside that across, and how far it is to the next coarser level, 0 to 1 (two halves each, texels).
const uint SPLAT_WORDS = 12u;
layout(std430, binding = BINDING_SPLATS) buffer SplatList {
  uint splat_count, splat_groups_x, splat_groups_y, splat_groups_z;
  uint splat[];
};
