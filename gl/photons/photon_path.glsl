// The way of a photon's light of one wavelength: from the light through refractors to receivers.
// Every exit that still carries energy is followed, one landing each. Who includes this gives
// `light`, `share_limit` and keep_landing(photon, slot, lane, place, flux in W, signature, length, wall), the
// flux without what is absorbed where landings keep the length of their way inside.

#include "photon_absorption.glsl"

const int REACHED = 0, REFLECTED = 1, ABSORBED = 2, TRAPPED = 3, MISSED = 4;

const int NO_RECEIVER = 0, NOT_HELD = 1, LANDED = 2, LANDED_ON_PAGE = 3;

#ifdef PAGES
uniform bool fits_pages;  // they are yet to be chosen: coordinates of any chart will do
layout(binding = UNIT_CHART_ROWS) uniform samplerBuffer chart_rows;  // two a chart: from a place to its u, and v

// Where the light's map does not hold a place: the page of a chart's side on which it lies; false where
// there is none.
bool beside_map(int side, inout vec3 place, out int page) {
  vec3 at = place;
  page = page_of_side(light, side);
  if (fits_pages) {
    vec4 to_u = texelFetch(chart_rows, side >> 1 << 1), to_v = texelFetch(chart_rows, side | 1);
    place = vec3(dot(to_u.xyz, at) + to_u.w, dot(to_v.xyz, at) + to_v.w, side);
    return true;
  }
  return page >= 0 && is_within(page_rect(light, max(page, 0)), place_on_page(light, max(page, 0), at));
}
#endif

// The first receiver on the ray, and whether the light's map or a page can hold what lands there;
// place: what is kept of it.
int land(vec3 p, vec3 d, float t_min, float t_max, out vec3 at, out vec3 place, out int page,
         out uint receiver) {
  Light l = lights[light];
  vec3 uvz;
  float t;
  receiver = 1u;
  at = p;
  place = p;
  page = -1;
  int r = receiver_hit(p, d, t_min, t_max, t);
  if (r < 0) return NO_RECEIVER;
  at = p + t * d;
  place = at;
  receiver = uint(receiver_part(r)) + 1u;
  vec3 from;
  float distance_m;
  light_to(l, at, from, distance_m);
  bool held = project(l.map_view, at, uvz) && inside(uvz.xy) && receiver_lit(light, at, from, distance_m);
#ifdef PAGES
  int side = chart_side(r, d);
  if (!held && beside_map(side, place, page)) {
    receiver += 7919u * (uint(side) + 1u);  // parts of a mesh go on across its charts, places do not
    return LANDED_ON_PAGE;
  }
  page = -1;
#endif
  return held ? LANDED : NOT_HELD;
}

// A landing's signature; `path` counts the receiver too.
uint signature_of(uint path, int landed, uint owner) {
#ifdef PAGES
  return (path << 8 & ~ON_A_PAGE) | 0x80000000u | (landed == LANDED_ON_PAGE ? ON_A_PAGE : 0u) | owner;
#else
  return path << 8 | 0x80000000u | owner;
#endif
}

#ifdef WALK
#include "photon_walk.glsl"
#else

// Where light lands is looked for by all lanes of a software rasteriser, whether theirs leaves or not, so
// each goes on to its next wall that lets some out first. It pays in solids that keep light inside for long,
// which have more exits than others; not where there are few, or where walls cost more than that.
#ifdef LAYERS
const bool GO_ON = false;
#else
const bool GO_ON = EXITS > 8;
#endif

// A photon's light at wavelength i, from the refractor that it meets first. Each landing is handed
// on with its slot; `entry` takes the shares of the light that go elsewhere. Light that leaves a
// refractor meets none again. Loops have two ways out, as in refraction.comp.
void trace(uint photon, int lane, int i, float flux, vec3 o, vec3 d, Hit front, bool reached,
           out Shares entry[5]) {
  for (int k = 0; k < 5; k++) entry[k] = Shares(0.0);
  if (!reached) return;
  int r = front.refractor;
  vec2 spectrum = spectra[r * WAVELENGTHS + i].xy;
  float n = spectrum.x, cos_i = -dot(d, front.n);
  float reflected = fresnel(cos_i, 1.0 / n);
  entry[REACHED] = Shares(1.0);
  vec3 at, place;
  int page;
  uint receiver;
  uint path = uint(r) * 131u + uint(front.facet);
  if (reflected > 0.0) {
    // The mirror on the outside takes the slot behind the exits'; it is the same for all colours.
    int landed =
        land(front.p, reflect(d, front.n), -touch * refractor_bounds.w, 1e30, at, place, page, receiver);
    if (landed >= LANDED)
      keep_landing(photon, EXITS, lane, place, reflected * flux,
                   signature_of(path * 17u + receiver, landed, uint(r)), 0.0,
                   vec4(front.p, wall_word(front.n, false, page)));
    else
      entry[REFLECTED] = Shares(reflected);
  }
  float share = 1.0 - reflected;
  vec3 p = front.p, inner, wall_n;
  if (!refract_direction(d, front.n, 1.0 / n, inner)) return;
  int facet = front.facet;
  float way = 0.0;
#ifdef TINTING
  vec2 left = vec2(1);
#else
  const float left = 1.0;
#endif
  for (int order = 0; order < EXITS;) {
    vec3 wall = p, outer = inner;
    float out_share = 0.0;
    bool leaves = false, ends = false;
    while (order < EXITS) {
      int next;
      inner_hit(r, facet, p, inner,
#ifdef LAYERS
                lights[light].near_view, light_layers, 2.0 * float(light),
#endif
                wall, wall_n, next);
#ifdef TINTING
      vec2 before = left;
      way += distance(wall, p);
      left = left_after(way);
      entry[ABSORBED] += share * (before - left);
#elif defined(ABSORBING)
      float passed = exp(-spectrum.y * distance(wall, p));
      entry[ABSORBED] += share * (1.0 - passed);
      share *= passed;
#endif
      path = path * 31u + uint(next) + 1u;
      float kept = fresnel(dot(inner, wall_n), n);
      out_share = share * (1.0 - kept);
      leaves = out_share > 0.0 && refract_direction(inner, -wall_n, n, outer);
      share *= leaves ? kept : 1.0;
#ifdef TINTING
      ends = share * exp(-spectrum.y * way) < share_limit;
#else
      ends = share < share_limit;
#endif
      p = wall;
      facet = next;
      inner = reflect(inner, wall_n);
      order++;
      if (!GO_ON || leaves || ends) break;
    }
    if (leaves) {
      int landed = land(wall, outer, -touch * refractor_bounds.w, 1e30, at, place, page, receiver);
      if (landed >= LANDED) {
        keep_landing(photon, order - 1, lane, place, out_share * flux,
                     signature_of(path * 31u + receiver, landed, uint(r)), way,
                     vec4(wall, wall_word(wall_n, true, page)));
      } else {
        entry[MISSED] += out_share * left;
      }
    }
    if (ends) break;
  }
  entry[TRAPPED] += share * left;
}
#endif
