// Triangles into the six views of a cube, a layer each.
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;
in vec3 place[];
in vec3 place_normal[];
uniform mat4 face_matrix[6];
out vec3 world;
out vec3 world_normal;

void main() {
  vec4 clip[3];
  for (int i = 0; i < 3; i++) clip[i] = face_matrix[gl_InvocationID] * vec4(place[i], 1);
  // beside the view, all three of them
  bvec4 outside = bvec4(true);
  for (int i = 0; i < 3; i++) {
    vec4 c = clip[i];
    outside = bvec4(outside.x && c.x < -c.w, outside.y && c.x > c.w, outside.z && c.y < -c.w, outside.w && c.y > c.w);
  }
  if (any(outside)) return;
  for (int i = 0; i < 3; i++) {
    gl_Layer = gl_InvocationID;
    world = place[i];
    world_normal = place_normal[i];
    gl_Position = clip[i];
    EmitVertex();
  }
  EndPrimitive();
}
