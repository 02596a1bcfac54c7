// Counts that size no array of a shader. They are uniforms, so that other counts compile nothing anew;
// gl/scene/shader_variant.h sets them, and defines those that do size one (LIGHTS, REFRACTORS, ...).
// COPIES_TABLES: they are read once by each thread, as copies.glsl says.

struct Counts {
  int wavelengths;
  int bands, band_levels;  // for a refractor: bands of all levels together, and levels (bands_wanted.glsl)
  int eye_bands;           // so many of these a pixel takes at the most
  int exits;               // interfaces that a path inside a refractor meets at the most
  int slots;               // capacity for a photon's hits at a wavelength
  int hit_stride;          // wavelengths for which a photon's hits have capacity
  int nodes;               // wavelengths that every photon takes (photon_nodes.glsl)
  int map_levels;          // levels of detail of the spectral map
  int tile_blocks;         // blocks of the layer of a light's tiles, a side (receiver_atlas.glsl)
  int chart_sides;         // sides of all charts, two each
  int crystals;            // the first texel of crystals' bands
  int glow;                // the first texel of what refractors emit
  int receiver_root;       // the first node of the receivers' hierarchy
};
uniform Counts counts;

#ifdef COPIES_TABLES
Counts own_counts;

int read_count(int x) { return max(x, x); }

void copy_counts() {
  own_counts = Counts(read_count(counts.wavelengths), read_count(counts.bands), read_count(counts.band_levels),
                      read_count(counts.eye_bands),
                      read_count(counts.exits), read_count(counts.slots), read_count(counts.hit_stride),
                      read_count(counts.nodes), read_count(counts.map_levels), read_count(counts.tile_blocks),
                      read_count(counts.chart_sides), read_count(counts.crystals), read_count(counts.glow), read_count(counts.receiver_root));
}

#define counts own_counts
#endif
