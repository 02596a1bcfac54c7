// A beam of light in the picture: a segment, and how wide it lies across it at both ends.

// Texels of a beam: its ends in pixels; their depths, and the widths at both ends of a cell along
// one axis of the grid, along the other, and of its part of the spectrum, in pixels; the ends in
// the world, each with red or green of what is scattered at the end, W/m; by how much that grows a
// metre back, 1/m, and blue.
const int BEAM_TEXELS = 6;

// Light lies evenly over each of its widths and over a pixel: together they are taken for two, which have
// the same spread, and of which the wider tiles as cells do. The wider and the narrower.
vec2 beam_kernel(vec3 widths) {
  vec3 w = abs(widths);
  float most = max(w.x, max(w.y, w.z)), rest = sqrt(max(dot(w, w) - most * most, 0.0) + 1.0);
  return vec2(max(max(most, rest), 1.0), max(min(most, rest), 1.0));
}

// Pixels from its middle to where it ends.
float beam_reach(vec3 widths) {
  vec2 kernel = beam_kernel(widths);
  return 0.5 * (kernel.x + kernel.y);
}

// Share of the light per pixel across a beam, at x from the middle: 1 together.
float beam_share(vec3 widths, float x) {
  vec2 kernel = beam_kernel(widths);
  return clamp((0.5 * (kernel.x + kernel.y) - abs(x)) / kernel.y, 0.0, 1.0) / kernel.x;
}
