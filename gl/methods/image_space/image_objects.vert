// Refractors and mirrors, towards the geometry shader that sorts front from back.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 view_projection;
out vec3 place;
out vec3 place_normal;

void main() {
  place = position;
  place_normal = normal;
  gl_Position = view_projection * vec4(position, 1);
}
