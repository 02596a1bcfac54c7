// What a light or the camera looks through; the float version of scenes/view/view.h.

// A frustum from one point (perspective: origin.w = 1) or along one direction (0). window is
// left, right, bottom, top: tangents on the plane at distance 1, or metres. range is near, far.
struct View {
  vec4 origin, right, up, forward, window, range;
};

// Where a point falls on the view's window, [0, 1]^2 inside; z: distance along the ray
// (perspective) or along forward. False behind the origin.
bool project(View v, vec3 p, out vec3 uvz) {
  vec3 d = p - v.origin.xyz;
  float z = dot(d, v.forward.xyz);
  vec2 xy = vec2(dot(d, v.right.xyz), dot(d, v.up.xyz));
  bool perspective = v.origin.w > 0.5;
  if (perspective) xy /= z;
  uvz = vec3((xy - v.window.xz) / (v.window.yw - v.window.xz), perspective ? length(d) : z);
  return !perspective || z > 0.0;
}

bool inside(vec2 uv) { return all(greaterThanEqual(uv, vec2(0))) && all(lessThan(uv, vec2(1))); }

void view_ray(View v, vec2 uv, out vec3 origin, out vec3 direction) {
  vec2 xy = mix(v.window.xz, v.window.yw, uv);
  vec3 side = v.right.xyz * xy.x + v.up.xyz * xy.y;
  bool perspective = v.origin.w > 0.5;
  origin = perspective ? v.origin.xyz : v.origin.xyz + side;
  direction = perspective ? normalize(v.forward.xyz + side) : v.forward.xyz;
}

// The face of a cube around a point to which a direction belongs: the same rule as abbe_light_cube_face.
int cube_face(vec3 d) {
  vec3 a = abs(d);
  bool x = a.x >= a.y && a.x >= a.z, y = !x && a.y >= a.z;
  float along = x ? d.x : y ? d.y : d.z;
  return (x ? 0 : y ? 2 : 4) + (along < 0.0 ? 1 : 0);
}

// Window area (tangent plane, or m2) to solid angle (or m2 across the beam) along direction.
float window_measure(View v, vec3 direction) {
  float c = dot(direction, v.forward.xyz);
  return v.origin.w > 0.5 ? c * c * c : 1.0;
}

// atan(y, x) within 5e-7 rad. GLSL promises nothing of its own: Mesa's acos is off by 1.6e-4 rad, a tenth of a texel of
// a map of 4096. The polynomial is that of atan(t) / t in t^2 by Chebyshev's nodes, off by 1e-8.
float angle_of(float y, float x) {
  float a = abs(x), b = abs(y), t = min(a, b) / max(max(a, b), 1e-37), s = t * t;
  float r = 0.0421376236 + s * (-0.0157312491 + s * 0.0027662835);
  r = -0.1419779779 + s * (0.1061837064 + s * (-0.0745685483 + s * r));
  r = t * (0.9999999818 + s * (-0.3333303671 + s * (0.1999187203 + s * r)));
  r = b > a ? 1.5707963268 - r : r;
  r = x < 0.0 ? 3.1415926536 - r : r;
  return y < 0.0 ? -r : r;
}

// The angles of a direction: longitude, and from +z on.
vec2 sphere_angles(vec3 d) { return vec2(angle_of(d.y, d.x), angle_of(length(d.xy), d.z)); }
