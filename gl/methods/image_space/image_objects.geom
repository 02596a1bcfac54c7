// Faces that are seen from their front, and all of mirrors, to layer 0; others to layer 1.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
in vec3 place[];
in vec3 place_normal[];
uniform vec4 seen_along;  // w 1: from this point; 0: along this direction
uniform int mirror;
uniform int first_layer;  // first layer of this view
uniform int only;  // this layer; -1: both
out vec3 world;
out vec3 world_normal;

void main() {
  vec3 face = cross(place[1] - place[0], place[2] - place[0]);
  vec3 along = seen_along.w > 0.5 ? place[0] - seen_along.xyz : seen_along.xyz;
  int layer = mirror == 1 || dot(face, along) < 0.0 ? 0 : 1;
  if (only >= 0 && layer != only) return;
  for (int i = 0; i < 3; i++) {
    gl_Layer = first_layer + layer;
    world = place[i];
    world_normal = place_normal[i];
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
  EndPrimitive();
}
