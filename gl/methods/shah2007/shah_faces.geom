// A splat for each face of the cube around the light whose map it may reach.
#include "image_places.glsl"
layout(points) in;
layout(points, max_vertices = 6) out;
in vec3 landed[];
in vec4 landed_light[];
uniform float splat_size;  // texels
flat out vec2 centre;      // on the face's map, 0 to 1
flat out vec3 peak;

void main() {
  if (landed_light[0].w < 0.5) return;
  for (int face = 0; face < 6; face++) {
    vec3 uvz;
    if (project(places_face(face), landed[0], uvz) && inside(uvz.xy)) {
      gl_Layer = face;
      centre = uvz.xy;
      peak = landed_light[0].rgb;
      gl_PointSize = splat_size;
      gl_Position = vec4(2.0 * uvz.xy - 1.0, 0, 1);
      EmitVertex();
      EndPrimitive();
    }
  }
}
