// The tree of pinholes (scenes/samples/surface_samples.h), as a texel goes down in it.
uniform samplerBuffer pinhole_nodes;  // rows as gl/methods/pinholes/pinhole_samples.h has them
uniform int node_count;
uniform float cluster_share;  // share of a hemisphere's light that a cluster may send at the most; 0: there are none
const float NEAR_AREAS = 6.0;  // samples nearer than the root of so many times their area are taken by parts
const int MOST_MET = 1024;     // nodes that are looked at before one is taken

struct Node {
  vec3 p, n;
  float area, radius, cone;
  int next, of;  // of: the sample
  bool cluster, leaf;
};

Node node_at(int i) {
  vec4 place = texelFetch(pinhole_nodes, 3 * i), normal = texelFetch(pinhole_nodes, 3 * i + 1);
  vec4 rest = texelFetch(pinhole_nodes, 3 * i + 2);
  return Node(place.xyz, normal.xyz, place.w, normal.w, rest.x, int(rest.y), int(rest.z), rest.w > 0.0,
              int(rest.y) == i + 1);
}

// Whether nothing below it sends p any light: all lies behind the receiver's plane, or faces away.
bool is_hidden(Node k, vec3 n, vec3 to, float far) {
  float sine = k.radius / max(far, 1e-20), cosine = sqrt(max(1.0 - sine * sine, 0.0));
  float turn = sqrt(max(1.0 - k.cone * k.cone, 0.0));
  float facing = -dot(k.n, to) / max(far, 1e-20);
  bool narrow = sine < 1.0 && k.cone * cosine - turn * sine > 0.0;
  return dot(n, to) + k.radius <= 0.0 || (narrow && facing < -(turn * cosine + k.cone * sine) - 1e-4);
}

// Whether p takes it for all that is below it.
bool is_enough(Node k, vec3 n, vec3 to, float far) {
  float gap = max(far - k.radius, 0.0), up = min(dot(n, to) + k.radius, gap);
  bool faint = gap > 0.0 && k.area * up <= PI * cluster_share * gap * gap * gap;
  return k.leaf || (k.cluster ? faint && cluster_share > 0.0 : far * far >= NEAR_AREAS * k.area);
}

// As a sample: it turns as its own does, and shows as much more or less as its area is.
Pinhole pinhole_of(Node k, vec3 from) {
  Pinhole s = pinhole_at(k.of, from);
  s.half_width *= sqrt(k.area / max(s.area, 1e-30));
  s.area = k.area;
  s.p = k.p;
  s.n = dot(k.n, s.n) < 0.0 ? -k.n : k.n;
  return s;
}

// The next node that p takes from `node` on, which then is the one after it; -1: none, or none so soon.
int next_taken(vec3 p, vec3 n, inout int node) {
  int taken = -1, met = 0;
  while (taken < 0 && node < node_count && met < MOST_MET) {
    Node k = node_at(node);
    vec3 to = k.p - p;
    float far = length(to);
    bool hidden = is_hidden(k, n, to, far), enough = !hidden && is_enough(k, n, to, far);
    taken = enough ? node : -1;
    node = hidden || enough ? k.next : node + 1;
    met++;
  }
  return taken;
}
