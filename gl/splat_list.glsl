// Pieces of light on their way to the map: place of the middle in texels (x in 12.16 fixed point
// with the number of parts in the low four bits, y in 12.17 with the level in the low three; PAGES: y
// in 12.10, then the page's number from 1, 0 for the map, in seven), the way across all parts (two
// halves), XYZ of a part in map units, so that the list is what is summed, and the ways in texels from
// that place, which is Y's, to X's and to Z's (two halves each).
const uint SPLAT_WORDS = 8u;
layout(std430, binding = 15) buffer SplatList {
  uint splat_count, splat_groups_x, splat_groups_y, splat_groups_z;
  uint splat[];
};
