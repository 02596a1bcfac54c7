// Where a place of a parallelogram is on its tile: texels are even as wide as the refractors' bounds in
// front of it, and grow with the distance beyond.

// Along one axis: the bounds' middle, and their half width, in parts of the edge.
vec2 page_axis(vec4 dual, vec3 anchor) {
  float middle = dot(refractor_bounds.xyz - anchor, dual.xyz) + dual.w, wide = refractor_bounds.w * length(dual.xyz);
  return vec2(middle, max(wide, 1e-4));
}

// asinh, which loses what is small below 0 as it is often written.
float stretched(float x) { return sign(x) * log(abs(x) + sqrt(x * x + 1.0)); }

float to_page(vec2 axis, float x) {
  float low = stretched(-axis.x / axis.y), high = stretched((1.0 - axis.x) / axis.y);
  return (stretched((x - axis.x) / axis.y) - low) / (high - low);
}

float from_page(vec2 axis, float t) {
  float low = stretched(-axis.x / axis.y), high = stretched((1.0 - axis.x) / axis.y);
  return axis.x + axis.y * sinh(mix(low, high, t));
}
