// Polygons of four neighbouring photons, or with TRIANGLES of three: the light of a beam, spread evenly. Corners
// are taken two triangles a cell. A cell with a corner that met nothing specular, or nothing behind it, has none.
#include "wyman_target.glsl"
uniform sampler2D photon_places, photon_directions;
uniform mat4 drawn_matrix;
uniform vec3 light_at;
uniform int grid;
uniform vec3 colour;
uniform float cell_area;  // of the light's window
flat out vec3 ratio;      // of the beam's solid angle to the polygon's
flat out vec3 direction;
out vec3 world;
const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));
const float MOST = 6e4;  // that 16 bits hold

// Of a triangle, projected on the unit sphere around the light.
float solid_angle(vec3 a, vec3 b, vec3 c) {
  a = normalize(a - light_at);
  return 0.5 * length(cross(normalize(b - light_at) - a, normalize(c - light_at) - a));
}

void main() {
  int corner = gl_VertexID % 6, cell = gl_VertexID / 6, first = corner < 3 ? 0 : 3;
  ivec2 at = ivec2(cell % (grid - 1), cell / (grid - 1));
  vec4 p[4], sum = vec4(0);
  float least = 1.0, light = 0.0, angle = 0.0;
  for (int i = 0; i < 4; i++) {
    ivec2 here = at + ivec2(i & 1, i >> 1);
    p[i] = texelFetch(photon_places, here, 0);
    least = min(least, p[i].w);
#ifdef TRIANGLES
    bool counts = i == 0 || i == 3 || i == (first == 0 ? 1 : 2);
#else
    bool counts = true;
#endif
    vec4 incident = texelFetch(photon_directions, here, 0);
    if (counts) {
      sum += vec4(incident.xyz, 1);
      light += p[i].w;
      angle += incident.w;
    }
  }
  ratio = vec3(0);
  direction = vec3(0);
  world = vec3(0);
  gl_Position = vec4(2, 2, 2, 1);  // outside
  if (least <= 0.0) return;
  float beam = light * angle / (sum.w * sum.w) * cell_area;
#ifdef TRIANGLES
  beam *= 0.5;
  float polygon = solid_angle(p[0].xyz, p[3].xyz, p[first == 0 ? 1 : 2].xyz);
#else
  float polygon = solid_angle(p[0].xyz, p[1].xyz, p[3].xyz) + solid_angle(p[0].xyz, p[3].xyz, p[2].xyz);
#endif
  float r = min(beam / max(polygon, 1e-30), MOST);
  ratio = r * colour;
  direction = r * normalize(sum.xyz);
  ivec2 own = corners[corner];
  world = p[own.x + 2 * own.y].xyz;
  gl_Position = drawn_matrix * vec4(world, 1);
  gl_Position.z = 0.0;
}
