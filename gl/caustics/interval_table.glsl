// What the band of wavelengths between two neighbouring nodes holds, step by step: interval i lies between
// nodes i and i - 1, and its row leads from node i over STEPS steps to node i - 1. Who includes this
// gives `nodes` and `table_first`.

// [table_first + (light * PART_SURFACES + refractor) * (nodes + 1) + i] * (STEPS + 1) + k,
// INTERVAL_TEXELS each: XYZ of the interval from node i up to step k, and how far along (0 to 1) that
// is; then those three times how far along their light is, and the index there; TINTS: then X, Y and Z times
// what the refractor takes of them by amount.
uniform samplerBuffer interval_sums;
#ifdef TINTS
const int INTERVAL_TEXELS = 3;
#else
const int INTERVAL_TEXELS = 2;
#endif

// Sums over an interval from its beginning on.
struct Sums {
  vec3 xyz, moment;
  float along, index;
};

Sums no_sums() { return Sums(vec3(0), vec3(0), 0.0, 0.0); }

Sums sums_at(int row, int step) {
  int at = row + INTERVAL_TEXELS * step;
  vec4 xyz_along = texelFetch(interval_sums, at), moment_index = texelFetch(interval_sums, at + 1);
  return Sums(xyz_along.xyz, moment_index.xyz, xyz_along.w, moment_index.w);
}

// The first row of the refractor that a path met first.
int rows_of(uint signature) {
  return table_first + (light * PART_SURFACES + int(signature & 255u)) * (nodes + 1);
}

int row_of(int rows, int interval) {
  return INTERVAL_TEXELS * ((rows + clamp(interval, 0, nodes)) * (STEPS + 1));
}
