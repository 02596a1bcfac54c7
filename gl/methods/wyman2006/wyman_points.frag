flat in vec4 light;
flat in vec3 direction;
layout(location = 0) out vec4 sum;
layout(location = 1) out vec4 directions;

void main() {
  sum = light;
  directions = vec4(direction, 0);
}
