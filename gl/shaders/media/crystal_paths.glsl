// Paths through crystals from interface to interface: what walk.glsl does at their faces.

bool in_crystal(uint inside) { return inside != 0u && is_crystal(crystal_of(medium_of(inside))); }

// Both branches of w, which comes to a face of normal n on its side: the direction of what passes, and the share that
// does not. Light that enters a crystal becomes the path's wave, of two that are followed, and counts as of its field.
// bare: else a film has said the share. False: there is no crystal on either side.
bool split_waves(uint after, vec3 n, bool bare, inout PathState w, inout PathState mirrored, inout vec3 through,
                 inout float reflected, inout bool passes) {
  bool from = in_crystal(mirrored.inside), into = in_crystal(after);
  if (!from && !into) return false;
  Crystal here = crystal_of(medium_of(max(mirrored.inside, 1u))), there = crystal_of(medium_of(max(after, 1u)));
  vec3 k = from ? w.k : medium_n(mirrored.inside) * w.d, along = k - dot(k, n) * n;
  float n_i = length(k), n_t = medium_n(after), left = n_t * n_t - dot(along, along);
  passes = into ? wave_from(there, w.wave, along, -n, w.k, through) : left > 0.0;
  if (into && passes) n_t = length(w.k);
  if (!into) through = normalize(along - sqrt(max(left, 0.0)) * n);
  vec3 reflects = passes || !into ? face_reflects(-dot(k, n) / n_i, n_i, n_t) : vec3(1);
  vec2 field = vec2(sqrt(0.5));
  if (from) field = field_parts(here, mirrored.wave, k, n);
  if (!from && passes) field = field_parts(there, w.wave, w.k, n);
  if (bare) reflected = passes ? dot(reflects.xy, field * field) : 1.0;
  mirrored.d = reflect(mirrored.d, n);
  mirrored.k = k;
  if (from) turn_wave(here, reflects, -n, wave_choice(w.interfaces + 1), mirrored.wave, mirrored.k, mirrored.d);
  return true;
}
