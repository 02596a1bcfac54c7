// Polygons of four neighbouring photons, or with TRIANGLES of three: the light of a beam, spread evenly. Corners
// are taken two triangles a cell. A cell with a corner that met nothing specular, or nothing behind it, has none.
// CORNERS: the light of the cells around each corner, by their polygons together. CULLED: polygons between
// surfaces have none. EVEN: all beams are alike.
#include "wyman_target.glsl"
#ifdef CULLED
#include "image_places.glsl"
#endif
uniform sampler2D photon_places, photon_directions;
uniform mat4 drawn_matrix;
uniform vec3 light_at;
uniform int grid;
uniform vec3 colour;
uniform float cell_area;     // area of a cell in the light's window
uniform float even_beam;     // sr
OF_POLYGON out vec3 ratio;  // ratio of the beam's solid angle to the polygon's
OF_POLYGON out vec3 direction;
out vec3 world;
const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));
const float MOST = 6e4;  // that 16 bits hold

struct Beam {
  float light, angle;  // sr, what it carries and what its polygon takes; 0: it has none
  vec3 along;          // sum of its photons' directions
};

// The solid angle of a triangle, projected on the unit sphere around the light.
float solid_angle(vec3 a, vec3 b, vec3 c) {
  a = normalize(a - light_at);
  return 0.5 * length(cross(normalize(b - light_at) - a, normalize(c - light_at) - a));
}

#ifdef CULLED
// How far a place is before or behind what the light sees there, by its distance.
float off_surface(vec3 at) {
  vec3 seen;
  float far = distance(at, light_at);
  return look_up(at, seen) ? abs(distance(seen, light_at) - far) / far : 0.0;
}

bool between(vec3 a, vec3 b) {
  return off_surface(0.5 * (a + b)) > HIDDEN && max(off_surface(a), off_surface(b)) < HIDDEN;
}
#endif

// half_of: of its two triangles the first or second, or with -1 all of it.
Beam beam_of(ivec2 at, int half_of) {
  vec4 p[4], sum = vec4(0);
  float least = 1.0, light = 0.0, angle = 0.0;
  int third = half_of == 0 ? 1 : 2;  // beside the diagonal's ends
  for (int i = 0; i < 4; i++) {
    ivec2 here = at + ivec2(i & 1, i >> 1);
    p[i] = texelFetch(photon_places, here, 0);
    least = min(least, p[i].w);
    vec4 incident = texelFetch(photon_directions, here, 0);
    if (half_of < 0 || i == 0 || i == 3 || i == third) {
      sum += vec4(incident.xyz, 1);
      light += p[i].w;
      angle += incident.w;
    }
  }
  Beam none = Beam(0.0, 0.0, vec3(0));
  if (least <= 0.0) return none;
#ifdef CULLED
  if (between(p[0].xyz, p[3].xyz)) return none;
  for (int i = 1; i < 3; i++)
    if ((half_of < 0 || i == third) && (between(p[0].xyz, p[i].xyz) || between(p[i].xyz, p[3].xyz))) return none;
#endif
#ifdef EVEN
  float cell = even_beam;
#else
  float cell = angle / sum.w * cell_area;
#endif
  float polygon = half_of == 1 ? 0.0 : solid_angle(p[0].xyz, p[1].xyz, p[3].xyz);
  if (half_of != 0) polygon += solid_angle(p[0].xyz, p[3].xyz, p[2].xyz);
  return Beam(light / sum.w * (half_of < 0 ? cell : 0.5 * cell), polygon, sum.xyz);
}

void main() {
  int corner = gl_VertexID % 6, cell = gl_VertexID / 6;
  ivec2 at = ivec2(cell % (grid - 1), cell / (grid - 1)), own = corners[corner];
#ifdef TRIANGLES
  Beam beam = beam_of(at, corner < 3 ? 0 : 1);
#else
  Beam beam = beam_of(at, -1);
#endif
  ratio = vec3(0);
  direction = vec3(0);
  world = vec3(0);
  gl_Position = vec4(2, 2, 2, 1);  // outside
  if (beam.angle <= 0.0 && beam.light <= 0.0) return;
#ifdef CORNERS
  beam = Beam(0.0, 0.0, vec3(0));
  for (int i = 0; i < 4; i++) {
    ivec2 there = at + own - ivec2(i & 1, i >> 1);
    if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, ivec2(grid - 1)))) continue;
    Beam other = beam_of(there, -1);
    beam.light += other.light;
    beam.angle += other.angle;
    beam.along += other.along;
  }
#endif
  float r = min(beam.light / max(beam.angle, 1e-30), MOST);
  ratio = r * colour;
  direction = r * normalize(beam.along);
  world = texelFetch(photon_places, at + own, 0).xyz;
  gl_Position = drawn_matrix * vec4(world, 1);
  gl_Position.z = 0.0;
}
