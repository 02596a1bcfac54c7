in vec3 world;
in vec3 world_normal;
uniform int object;
layout(location = 0) out vec4 place;   // m; 1
layout(location = 1) out vec4 normal;  // unit; refractor's number, from 1

void main() {
  place = vec4(world, 1);
  normal = vec4(normalize(world_normal), float(object + 1));
}
