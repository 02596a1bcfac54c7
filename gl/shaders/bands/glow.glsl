// What refractors emit by fluorescence, cell by cell of a grid in each (gl/eye/lighting.h). GLOW_RAYS: instead of that, what
// makes one glow is added to its cells, by wide_sum.glsl, where `glow_unit` is not 0.
uniform sampler2DArray glow_cells;       // layer after layer: the source times the share of the cell that is inside; that share
uniform vec4 glow_low[REFRACTORS];       // the grid's corner, m; 0: it does not glow
uniform vec3 glow_size[REFRACTORS];      // m
const int GLOW_STEPS = 8;                // of a path between two interfaces
#ifdef GLOW_RAYS
layout(std430, binding = BINDING_GLOW_SUMS) buffer GlowSums { uint glow_sum[]; };
uniform int glow_refractor;  // that is asked about
uniform float glow_unit;
float glow_arrives;   // units of what comes along the ray
float glow_shift;    // of a ray's steps, so that all rays together miss no cell
vec3 glow_emitted;  // XYZ of what the refractor sends back

void excite(vec3 at, float taken) {
  ivec3 cell = clamp(ivec3(at * float(GLOW_CELLS)), 0, GLOW_CELLS - 1);
  int word = 2 * ((cell.z * GLOW_CELLS + cell.y) * GLOW_CELLS + cell.x);
  WIDE_ADD(glow_sum, word, word + 1, uint(max(taken, 0.0) * glow_arrives + 0.5))
}
#endif

float glow_source(int r, vec3 at) {
  float cells = float(GLOW_CELLS), layer = clamp(at.z * cells - 0.5, 0.0, cells - 1.0), low = floor(layer);
  vec2 on = clamp(at.xy, vec2(0.5 / cells), vec2(1.0 - 0.5 / cells));
  vec2 layers = float(r) * cells + vec2(low, min(low + 1.0, cells - 1.0));
  vec2 there = mix(textureLod(glow_cells, vec3(on, layers.x), 0.0).rg, textureLod(glow_cells, vec3(on, layers.y), 0.0).rg, layer - low);
  return there.x / max(there.y, 1e-6);
}

// XYZ that refractor r of index n emits into the band that is taken, along d from p over so many metres inside, which
// begin at a depth and have the depth `along`; share: the path's.
vec3 glow_along(int r, float share, float n, vec3 p, vec3 d, float metres, Depth depth, Depth along) {
  vec3 sum = vec3(0), low = (p - glow_low[r].xyz) / max(glow_size[r], vec3(1e-30)), step_at = d * metres / max(glow_size[r], vec3(1e-30));
  float part = 1.0 / float(GLOW_STEPS);
#ifdef GLOW_RAYS
  if (r != glow_refractor) return sum;
  float white = share / max(dot(band_left(Depth(0.0)), vec3(1)), 1e-30), before = dot(band_left(depth), vec3(1));
#else
  if (glow_low[r].w <= 0.0) return sum;
#endif
  int at = counts.glow + 6 * (first_band(r) + band_at);
  Depth x = Depth(texelFetch(band_texels, at), texelFetch(band_texels, at + 1));
  Depth y = Depth(texelFetch(band_texels, at + 2), texelFetch(band_texels, at + 3));
  Depth z = Depth(texelFetch(band_texels, at + 4), texelFetch(band_texels, at + 5));
  for (int i = 0; i < GLOW_STEPS; i++) {
    float t = (float(i) + 0.5) * part;
    vec3 place = low + t * step_at;
#ifdef GLOW_RAYS
    if (glow_unit > 0.0) {
      float after = dot(band_left(depth + (t + 0.5 * part) * along), vec3(1));
      excite(low + (float(i) + glow_shift) * part * step_at, white * (before - after));
      before = after;
      continue;
    }
#endif
    Depth left = left_after(depth + t * along);
    sum += glow_source(r, place) * vec3(sum_of(x, left), sum_of(y, left), sum_of(z, left));
  }
  sum *= share * metres * part / (n * n);
#ifdef GLOW_RAYS
  glow_emitted += sum;
  return vec3(0);
#else
  return sum;
#endif
}
