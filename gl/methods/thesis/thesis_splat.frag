// A Gaussian just under three pixels wide, in the wavelength's colour.
flat in vec2 centre;
flat in int wavelength;
flat in float strength;
uniform float resolution;
uniform float modifier;  // brightness for this many photons on this many texels
uniform vec3 colour[WAVELENGTHS];
uniform vec3 spot_colour;
layout(location = 0) out vec4 splat;

void main() {
  const float size2 = 2.5 * 2.5;
  vec2 d = gl_FragCoord.xy - (centre * 0.5 + 0.5) * resolution;
  float r2 = dot(d, d);
  float g = 0.918 + 0.918 * ((exp(-3.906 * r2 / size2) - 1.0) / 0.858152111);
  float inside = r2 / size2 < 0.25 ? 1.0 : 0.0;
#ifdef CIE
  splat = vec4(strength * modifier * inside * g * colour[wavelength], 1.0);
#else
  float adjustment = modifier * inside * g / (10.5 * size2 / 25.0);
  splat = vec4(spot_colour * strength * adjustment * colour[wavelength], 1.0);
#endif
}
