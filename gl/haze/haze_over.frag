// What haze scatters, over what it leaves of the picture: blended by alpha.
uniform sampler2D scattered;
layout(location = 0) out vec4 over;

void main() { over = texelFetch(scattered, ivec2(gl_FragCoord.xy), 0); }
