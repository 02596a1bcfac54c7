in vec3 world;
layout(location = 0) out vec4 place;  // m; 1

void main() { place = vec4(world, 1); }
