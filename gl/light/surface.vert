// Triangles of the scene, seen from the camera or from a light.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
uniform mat4 view_projection;
out vec3 world;
out vec3 world_normal;
out vec2 surface_uv;
invariant gl_Position;  // programs draw over each other where their depths are equal

void main() {
  world = position;
  world_normal = normal;
  surface_uv = uv;
  gl_Position = view_projection * vec4(position, 1);
}
