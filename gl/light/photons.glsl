// Photons: a list of them with its count. MAKES_PHOTONS: who includes this lists them.

// A cell's photon. It starts in the middle of the part of the cell that is lit and shows a refractor.
struct Photon {
  uint cell;    // x | y << 16
  float flux;   // that the lit part carries, of unit power of its light
  uint offset;  // from the cell's middle, in cells, packSnorm2x16
  uint extent;  // size of the lit part, in cells, packUnorm2x16
};

#ifndef MAKES_PHOTONS
readonly
#endif
layout(std430, binding = BINDING_PHOTONS) buffer Photons {
  uint photon_count, groups_x, groups_y, groups_z;
  uint draw[4];
  Photon photon_at[];
};
