// Paths through crystals from interface to interface: what walk.glsl does at their faces.

bool in_crystal(uint inside) { return inside != 0u && is_crystal(crystal_of(medium_of(inside))); }

// Light that comes to a crystal with a field becomes both of its waves, by their parts of the field: w goes on as one,
// as often as it has.
void enter_by_field(Crystal c, vec3 field, vec3 along, vec3 n, inout PathState w) {
  vec3 k, ray;
  bool first = wave_from(c, 0, along, -n, k, ray);
  vec3 d = displacement(c, 0, k);
  float a = dot(field, d), b = dot(field, cross(normalize(k), d));
  w.wave = first && wave_choice(w.interfaces + 7) * (a * a + b * b) < a * a ? 0 : 1;
  w.path += 977u * uint(w.wave);
}

// Both branches of w, which comes to a face of normal n on its side: the direction of what passes, and the share that
// does not. Light that enters a crystal becomes the path's wave, of two that are followed, and counts as of its field.
// A film between the crystal and air meets the wave's own index. False: there is no crystal on either side.
bool split_waves(uint after, vec3 n, Interface h, inout PathState w, inout PathState mirrored, inout vec3 through,
                 inout float reflected, inout float absorbed, inout bool passes) {
  bool from = in_crystal(mirrored.inside), into = in_crystal(after);
  if (!from && !into) return false;
  Crystal here = crystal_of(medium_of(max(mirrored.inside, 1u))), there = crystal_of(medium_of(max(after, 1u)));
  vec3 k = from ? w.k : medium_n(mirrored.inside) * w.d, along = k - dot(k, n) * n;
  float n_i = length(k), n_t = medium_n(after), left = n_t * n_t - dot(along, along);
  if (into && (from || w.wave > 1)) enter_by_field(there, from ? displacement(here, w.wave, k) : w.k, along, n, w);
  passes = into ? wave_from(there, w.wave, along, -n, w.k, through) : left > 0.0;
  if (into && passes) n_t = length(w.k);
  if (!into) through = normalize(along - sqrt(max(left, 0.0)) * n);
  vec3 reflects = passes || !into ? face_reflects(-dot(k, n) / n_i, n_i, n_t) : vec3(1);
  vec2 field = vec2(sqrt(0.5));
  if (from) field = field_parts(here, mirrored.wave, k, n);
  if (!from && passes) field = field_parts(there, w.wave, w.k, n);
  reflected = passes ? dot(reflects.xy, field * field) : 1.0;
#ifdef FILMS
  if (h.film != BARE) {
    vec2 shares = wave_film_shares(into ? there : here, h.hit.refractor, h.film, into, -dot(k, n) / n_i, into ? n_t : n_i);
    reflected = shares.x;
    absorbed = max(1.0 - shares.x - (passes ? shares.y : 0.0), 0.0);
    reflects = vec3(reflected);
  }
#endif
  if (!into) {
    vec3 d = displacement(here, w.wave, k);
    w.k = d - dot(d, through) * through;
    w.wave |= 2;
  }
  mirrored.d = reflect(mirrored.d, n);
  mirrored.k = from ? k : reflect(mirrored.k, n);
  if (from) turn_wave(here, reflects, -n, wave_choice(w.interfaces + 1), mirrored.wave, mirrored.k, mirrored.d);
  return true;
}
