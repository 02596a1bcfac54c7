// Reads nothing, through as many samplers as a shader may have (abbe_gpu_forget_samplers).
layout(local_size_x = 1) in;
layout(std430, binding = BINDING_DISPATCH) buffer Sum { float sum; };
const int SAMPLERS = 16;
uniform sampler2D textures[SAMPLERS];  // all of unit 0
uniform bool never;

void main() {
  vec4 read = vec4(0);
  for (int i = 0; i < SAMPLERS; i++) read += textureLod(textures[i], vec2(0), 0.0);
  if (never) sum = dot(read, read);
}
