// How the ray of a picture's sample differs from its neighbours' along the path [Igehy1999], to first order: what
// a sample stands for when it comes to what is around. Normals turn as a surface is bent: as a sphere's, not
// at all on facets, and as they are interpolated over a triangle.

struct Spread {
  vec3 place_x, place_y;  // of the neighbour to the right and of the one above, m from the ray's own place
  vec3 turn_x, turn_y;    // their directions, relative to its own
};

Spread no_spread() { return Spread(vec3(0), vec3(0), vec3(0), vec3(0)); }

// Least cosine that a ray is taken to meet a surface or to leave it by: along a surface there is no first order.
const float LEAST_COSINE = 0.02;

// Where neighbours meet the face of a unit normal to which a ray comes along d after t.
Spread spread_at(Spread s, vec3 d, float t, vec3 face_n) {
  float along = dot(d, face_n);
  along = along < 0.0 ? min(along, -LEAST_COSINE) : max(along, LEAST_COSINE);
  s.place_x += t * s.turn_x;
  s.place_y += t * s.turn_y;
  s.place_x -= d * (dot(s.place_x, face_n) / along);
  s.place_y -= d * (dot(s.place_y, face_n) / along);
  return s;
}

vec3 mirrored_turn(vec3 turn, vec3 d, vec3 n, vec3 n_turn) {
  return turn - 2.0 * ((dot(turn, n) + dot(d, n_turn)) * n + dot(d, n) * n_turn);
}

// bend: by how much the normal n turns for a step on the surface, 1/m.
Spread spread_mirrored(Spread s, vec3 d, vec3 n, mat3 bend) {
  s.turn_x = mirrored_turn(s.turn_x, d, n, bend * s.place_x);
  s.turn_y = mirrored_turn(s.turn_y, d, n, bend * s.place_y);
  return s;
}

// n on the side that d comes from; eta = n_i / n_t. A refracted direction is eta d + (eta c - t) n, with c and t
// the cosines before and behind.
Spread spread_refracted(Spread s, vec3 d, vec3 n, mat3 bend, float eta) {
  float c = -dot(d, n), t = max(sqrt(max(cos2_refracted(clamp(c, 0.0, 1.0), eta), 0.0)), LEAST_COSINE);
  float along = eta * c - t, by_cosine = eta - eta * eta * c / t;
  vec3 n_x = bend * s.place_x, n_y = bend * s.place_y;
  float c_x = -(dot(s.turn_x, n) + dot(d, n_x)), c_y = -(dot(s.turn_y, n) + dot(d, n_y));
  s.turn_x = eta * s.turn_x + along * n_x + by_cosine * c_x * n;
  s.turn_y = eta * s.turn_y + along * n_y + by_cosine * c_y * n;
  return s;
}

// On a facet, where the places do not count.
Spread spread_mirrored(Spread s, vec3 n) {
  s.turn_x = reflect(s.turn_x, n);
  s.turn_y = reflect(s.turn_y, n);
  return s;
}

Spread spread_refracted(Spread s, vec3 d, vec3 n, float eta) {
  float c = -dot(d, n), t = max(sqrt(max(cos2_refracted(clamp(c, 0.0, 1.0), eta), 0.0)), LEAST_COSINE);
  vec3 by_cosine = (eta - eta * eta * c / t) * n;
  s.turn_x = eta * s.turn_x - dot(s.turn_x, n) * by_cosine;
  s.turn_y = eta * s.turn_y - dot(s.turn_y, n) * by_cosine;
  return s;
}

// The bend of a triangle of edges e1, e2 from its first corner, whose normals there are n0, n1, n2;
// n: of the place, before it is made a unit vector.
mat3 triangle_bend(vec3 e1, vec3 e2, vec3 n0, vec3 n1, vec3 n2, vec3 n) {
  vec3 face = cross(e1, e2);
  float size = length(n), doubled = max(length(face), 1e-30);
  if (size <= 0.0) return mat3(0);
  face /= doubled;
  n /= size;
  vec3 by_u = n1 - n0, by_v = n2 - n0;
  by_u -= dot(by_u, n) * n;
  by_v -= dot(by_v, n) * n;
  return outerProduct(by_u / size, cross(e2, face) / doubled) + outerProduct(by_v / size, cross(face, e1) / doubled);
}
