// Front faces to layer 0, back faces to layer 1, in one pass.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
in vec3 view_position[];
in vec3 view_normal[];
out vec3 at;
out vec3 normal;

void main() {
  vec3 face = cross(view_position[1] - view_position[0], view_position[2] - view_position[0]);
  int layer = dot(face, view_position[0]) < 0.0 ? 0 : 1;
  for (int i = 0; i < 3; i++) {
    gl_Layer = layer;
    at = view_position[i];
    normal = view_normal[i];
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
  EndPrimitive();
}
