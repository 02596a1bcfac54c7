// A layer of what a view sees: normal, and distance along the view's ray.
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
uniform vec4 view_origin;   // w: 1 perspective, 0 orthographic
uniform vec3 view_forward;
uniform uint owner;         // refractor + 1
layout(location = 0) out vec4 layer;
layout(location = 1) out uint layer_owner;

void main() {
  vec3 d = world - view_origin.xyz;
  layer = vec4(normalize(world_normal), view_origin.w > 0.5 ? length(d) : dot(d, view_forward));
  layer_owner = owner;
}
