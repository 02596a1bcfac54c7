// Triangles in a hierarchy of boxes (scenes/mesh/bvh.h), several trees in one buffer: the nearest
// one on a ray. HIERARCHY_STACK: what the deepest tree stacks at the most. Loops end at their top
// alone: Mesa 22's llvmpipe clobbers what is loaded in a loop that lanes leave in its middle.

// Buffers as textures: llvmpipe fetches a texel of all lanes at once, and storage word by word.
layout(binding = UNIT_BVH_NODES) uniform usamplerBuffer hierarchy_nodes;  // as gpu_scene.h has them
layout(binding = UNIT_BVH_TRIANGLES) uniform samplerBuffer hierarchy_triangles;
layout(binding = UNIT_BVH_CORNERS) uniform samplerBuffer hierarchy_corners;

uvec4 hierarchy_node(int i) { return texelFetch(hierarchy_nodes, i); }
// A corner (w: smooth part of its mesh) and the two edges from there (w of the first: surface, of
// receivers), three a triangle.
vec4 hierarchy_triangle(int i) { return texelFetch(hierarchy_triangles, i); }
// Normals at the corners, w: u of the texture; v of the three in the fourth.
vec4 hierarchy_corner(int i) { return texelFetch(hierarchy_corners, i); }

struct TriangleHit {
  float t, u, v;  // barycentric, of the second and third corner
  int triangle;   // -1: none
};

// Where the ray enters the box, or 1e30; it passes grid point g at base + g * step. turn: by how many
// bits the side that it comes to stands in the box's words.
float hierarchy_enter(uvec3 box, uvec3 turn, vec3 base, vec3 step, float t_min, float t_max) {
  vec3 near = base + vec3(box >> turn & 0xffffu) * step;
  vec3 far = base + vec3(box >> (16u - turn) & 0xffffu) * step;
  float from = near.x > near.y ? near.x : near.y, to = far.x < far.y ? far.x : far.y;
  from = from > near.z ? from : near.z;
  to = to < far.z ? to : far.z;
  from = from > t_min ? from : t_min;
  to = to < t_max ? to : t_max;
  return from <= to ? from : 1e30;
}

// Whether all normals in a cone have `away`'s direction.
bool hierarchy_turned(uvec2 cone, vec3 away) {
  ivec4 word = ivec4(cone.x << 16, cone.x, cone.y << 16, cone.y) >> 16;
  return dot(vec3(word.xyz), away) > float(word.w);
}

// Makes the triangle the best so far if it is nearer. lean: those that the ray meets on the other side, as
// -side does, count from `skip` on.
void meet_triangle(int i, vec3 o, vec3 d, float side, float t_min, float lean, float skip,
                   inout TriangleHit best) {
  vec3 corner = hierarchy_triangle(3 * i).xyz;
  vec3 e1 = hierarchy_triangle(3 * i + 1).xyz, e2 = hierarchy_triangle(3 * i + 2).xyz;
  vec3 across = cross(d, e2), from = o - corner;
  float det = dot(e1, across);
  vec3 q = cross(from, e1);
  float scale = 1.0 / det;
  float u = dot(from, across) * scale, v = dot(d, q) * scale, t = dot(e2, q) * scale;
  bool hit = det != 0.0 && det * side >= 0.0 && min(u, v) >= -2e-6 && u + v <= 1.000002 &&
             t > (det * lean < 0.0 ? skip : t_min) && t < best.t;
  best.triangle = hit ? i : best.triangle;
  best.t = hit ? t : best.t;
  best.u = hit ? u : best.u;
  best.v = hit ? v : best.v;
}

// Nearest triangle of the tree at `root` with t_min < t < h.t. side 1: only those that the ray meets
// against their normal, -1: along it, 0: all. any: the first that is found will do.
// lean and skip: as meet_triangle() has them.
bool hierarchy_hit(int root, vec3 o, vec3 d, float side, float t_min, float lean, float skip, bool any,
                   inout TriangleHit h) {
  // What waits: the last four, for llvmpipe writes arrays lane by lane, and below them the others.
  ivec4 top = ivec4(0);
  int deep[HIERARCHY_STACK];
  vec3 least = vec3(1e-20);
  vec3 inverse = 1.0 / mix(d, mix(-least, least, greaterThanEqual(d, vec3(0))),
                           lessThan(abs(d), least));
  uvec4 low = hierarchy_node(root);
  vec3 cell = uintBitsToFloat(hierarchy_node(root + 1).xyz);
  vec3 base = (uintBitsToFloat(low.xyz) - o) * inverse, step = cell * inverse;
  vec3 far_base = base + 65535.0 * step;
  vec3 first = min(base, far_base), last = max(base, far_base);
  float start = max(max(first.x, first.y), max(first.z, t_min));
  bool meets = start <= min(min(last.x, last.y), min(last.z, h.t)) * 1.0000005;
  // From where the tree begins, however far that is: its boxes are known to its size.
  start = meets ? max(start, 0.0) : 0.0;
  o += start * d;
  base = (uintBitsToFloat(low.xyz) - o) * inverse;
  t_min -= start;
  skip -= start;
  TriangleHit best = TriangleHit(h.t - start, 0.0, 0.0, -1);
  vec3 away = side * d;
  uvec3 turn = mix(uvec3(16), uvec3(0), greaterThanEqual(d, vec3(0)));
  int code = meets ? int(low.w) : -1;
  int waiting = 0, leaf = ~code;
  int node = code, next = code < 0 ? leaf >> 3 : 0, end = next + (code < 0 ? leaf & 7 : 0);
  while (node >= 0 || next < end) {
    while (node >= 0) {
      uvec4 first_child = hierarchy_node(node), second_child = hierarchy_node(node + 1);
      uvec4 cones = hierarchy_node(node + 2);
      float a = hierarchy_enter(first_child.xyz, turn, base, step, t_min, best.t);
      float b = hierarchy_enter(second_child.xyz, turn, base, step, t_min, best.t);
      int code_a = a < 1e30 && !hierarchy_turned(cones.xy, away) ? int(first_child.w) : -1;
      int code_b = b < 1e30 && !hierarchy_turned(cones.zw, away) ? int(second_child.w) : -1;
      bool both = code_a != -1 && code_b != -1;
      int far = b < a ? code_a : code_b;
      code = both ? (b < a ? code_b : code_a) : code_a != -1 ? code_a : code_b;
      bool pop = code == -1 && waiting > 0;
      code = pop ? top.x : code;
      if (both && waiting >= 4) deep[waiting - 4] = top.w;
      ivec4 popped = ivec4(top.yzw, 0);
      if (pop && waiting > 4) popped.w = deep[waiting - 5];
      top = mix(mix(top, popped, bvec4(pop)), ivec4(far, top.xyz), bvec4(both));
      waiting += both ? 1 : pop ? -1 : 0;
      node = code;
    }
    leaf = ~code;
    next = leaf >> 3;
    end = next + (leaf & 7);
    while (next < end) {
      meet_triangle(next, o, d, side, t_min, lean, skip, best);
      next++;
    }
    bool pop = waiting > 0 && !(any && best.triangle >= 0);
    code = pop ? top.x : -1;
    ivec4 popped = ivec4(top.yzw, 0);
    if (pop && waiting > 4) popped.w = deep[waiting - 5];
    top = mix(top, popped, bvec4(pop));
    waiting -= pop ? 1 : 0;
    leaf = ~code;
    node = code;
    next = code < 0 ? leaf >> 3 : 0;
    end = code < 0 ? next + (leaf & 7) : 0;
  }
  h = best;
  h.t = best.t + start;
  return best.triangle >= 0;
}

bool hierarchy_hit(int root, vec3 o, vec3 d, float side, float t_min, bool any, inout TriangleHit h) {
  return hierarchy_hit(root, o, d, side, t_min, 0.0, t_min, any, h);
}
