// Where photons start: rays from the light through its near view, to the refractor that each meets
// first. Who includes this gives `light`.

#ifdef FRONT_LAYER
uniform usampler2DArray layer_owner;  // refractor + 1 of the front layer, one layer a light

// What the light's view holds at uv, where that belongs to a refractor without an exact surface.
bool layers_front(vec2 uv, vec3 o, vec3 d, inout Hit h) {
  ivec2 at = ivec2(uv * vec2(textureSize(layer_owner, 0).xy));
  int owner = int(texelFetch(layer_owner, ivec3(at, light), 0).x) - 1;
  vec4 front = texelFetch(light_layers, ivec3(at, 2 * light), 0);
  if (owner < 0 || refractors[owner].info.x < MODEL_LAYERS || front.w <= 0.0 || front.w >= h.t)
    return false;
  h.t = front.w;
  h.p = o + h.t * d;
  h.n = normalize(front.xyz);
  // An interpolated normal at the rim may face away; the surface that the light sees does not.
  float c = dot(h.n, d);
  if (c > -1e-3) h.n = normalize(h.n - (c + 1e-3) * d);
  h.refractor = owner;
  h.facet = -1;
  return true;
}
#endif

// The ray at uv of the near view, the flux of a whole cell of such rays per unit power of the light,
// and what it meets. False
// where that is no refractor, or one that a receiver hides.
bool photon_start(vec2 uv, out vec3 o, out vec3 d, out Hit front, out float flux) {
  Light l = pass_light;
  view_ray(l.near_view, uv, o, d);
  flux = light_profile(l, d) * window_measure(l.near_view, d) / l.misc.z;
  front.t = 1e30;
  bool reached = exact_front(o, d, front);
#ifdef FRONT_LAYER
  if (layers_front(uv, o, d, front)) reached = true;
#endif
  // A parallel view begins close to the refractors, its light far beyond the scene.
  float from_light = int(l.position.w) == 2 ? 1e30 : front.t;
  return reached && flux > 0.0 && receiver_lit(light, front.p, front.n, d, from_light) &&
         area_lights_lit(light, front.p, d, from_light);
}
