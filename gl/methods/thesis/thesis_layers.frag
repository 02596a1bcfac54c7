in vec3 at;
in vec3 normal;
layout(location = 0) out vec4 layer;  // normal, distance

void main() { layer = vec4(normalize(normal), length(at)); }
