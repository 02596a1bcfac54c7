// How many there are of what a scene and its settings ask for. They are uniforms, so that other counts
// compile nothing anew; who makes the program sets them (gl/scene/shader_variant.h). COPIES_TABLES: read
// once, as copies.glsl says.

struct Counts {
  int wavelengths;
  int bands, band_levels;  // of a refractor: those of all levels, and the levels (bands_wanted.glsl)
  int exits;               // interfaces that a path inside a refractor meets at the most
  int slots;               // hits that a photon has room for at a wavelength
  int hit_stride, nodes;   // samples of a photon: with room for them, and of the coarse set
  int map_levels;
  int tile_blocks, chart_sides;  // of a light's tiles: blocks a side, and sides of charts (receiver_atlas.glsl)
  int receiver_root;             // of the receivers' hierarchy
};
uniform Counts counts;

#ifdef COPIES_TABLES
Counts own_counts;

int read_count(int x) { return max(x, x); }

void copy_counts() {
  own_counts = Counts(read_count(counts.wavelengths), read_count(counts.bands), read_count(counts.band_levels),
                      read_count(counts.exits), read_count(counts.slots), read_count(counts.hit_stride),
                      read_count(counts.nodes), read_count(counts.map_levels), read_count(counts.tile_blocks),
                      read_count(counts.chart_sides), read_count(counts.receiver_root));
}

#define counts own_counts
#endif
