// A closed mesh as the front and back layers that a view sees of it.
// Layers are sampled at their nearest texel, not fetched by its number: for that a software rasteriser
// works out the sizes of the level for each lane. `drawn` is the part of the texture, across and up, that
// the view was drawn into.

// Normal of a layer at the point's projection, bilinear over texels on the same surface.
vec3 layer_normal(View v, sampler2DArray layers, vec2 drawn, float layer, vec3 p, vec3 fallback) {
  vec3 uvz;
  project(v, p, uvz);
  ivec2 size = textureSize(layers, 0).xy;
  vec2 at = uvz.xy * drawn * vec2(size) - 0.5;
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  vec3 sum = vec3(0);
  for (int k = 0; k < 4; k++) {
    ivec2 o = ivec2(k & 1, k >> 1);
    vec4 texel = textureLod(layers, vec3((vec2(base + o) + 0.5) / vec2(size), layer), 0.0);
    if (texel.w <= 0.0 || abs(texel.w - uvz.z) > 0.02 * uvz.z) continue;
    sum += texel.xyz * ((o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y));
  }
  return dot(sum, sum) > 1e-8 ? normalize(sum) : fallback;
}

#ifndef LAYER_STEPS
#define LAYER_STEPS 14
#endif
#ifndef LAYER_BISECTIONS
#define LAYER_BISECTIONS 3
#endif

// How deep x lies between front and back (layers front, front + 1), along the view's ray; negative
// outside, and behind the rim of what the view sees.
float layer_depth(View v, sampler2DArray layers, vec2 drawn, float front, vec3 x, out bool at_front) {
  vec3 uvz;
  at_front = false;
  if (!project(v, x, uvz) || !inside(uvz.xy)) return -1e9;
  float near = textureLod(layers, vec3(uvz.xy * drawn, front), 0.0).w;
  float far = textureLod(layers, vec3(uvz.xy * drawn, front + 1.0), 0.0).w;
  if (near <= 0.0 || far <= 0.0) return -1e9;
  at_front = uvz.z - near < far - uvz.z;
  return min(uvz.z - near, far - uvz.z);
}

// The next interface of a solid known by its front and back layers; `size` bounds the search. The ray
// starts on one, so a little outside counts as inside.
void layers_inner(View v, sampler2DArray layers, vec2 drawn, float front, float size, vec3 p, vec3 d,
                  out vec3 q, out vec3 n) {
  float slack = 2e-3 * size, low = 0.0, high = -1.0;
  float above = slack, below = -1e9;  // depths there, from -slack on
  bool at_front;
  for (int i = 1; i <= LAYER_STEPS && high < 0.0; i++) {
    // Short steps first: thin parts are crossed near the start.
    float t = size * float(i * i) / float(LAYER_STEPS * LAYER_STEPS);
    float depth = layer_depth(v, layers, drawn, front, p + t * d, at_front) + slack;
    bool out_now = depth < 0.0;
    high = out_now ? t : high;
    low = out_now ? low : t;
    below = out_now ? depth : below;
    above = out_now ? above : depth;
  }
  if (high < 0.0) high = size;
  for (int k = 0; k < LAYER_BISECTIONS; k++) {
    float m = 0.5 * (low + high);
    float depth = layer_depth(v, layers, drawn, front, p + m * d, at_front) + slack;
    bool out_now = depth < 0.0;
    high = out_now ? m : high;
    low = out_now ? low : m;
    below = out_now ? depth : below;
    above = out_now ? above : depth;
  }
  // The last step is along a line, unless the ray is lost behind the rim.
  low += below < -1e8 ? 0.0 : (high - low) * clamp(above / (above - below), 0.0, 1.0);
  q = p + low * d;
  layer_depth(v, layers, drawn, front, q, at_front);
  // Past the rim the ray leaves through the side.
  vec3 side = d - dot(d, v.forward.xyz) * v.forward.xyz;
  n = layer_normal(v, layers, drawn, at_front ? front : front + 1.0, q,
                   dot(side, side) > 1e-8 ? normalize(side) : d);
  float c = dot(n, d);
  if (c < 1e-3) n = normalize(n + (1e-3 - c) * d);
}
