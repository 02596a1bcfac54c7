#!/usr/bin/env bash
# Mesa's llvmpipe: what a shader finds in a seamless cube map, while the threads beside it look at a
# face's middle, or at a corner of the cube.
set -euo pipefail
mesa=22.3.6-1+deb12u2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download libosmesa6=$mesa libosmesa6-dev=$mesa libglapi-mesa=$mesa libllvm15=1:15.0.6-4+b1 \
  libgl-dev libegl-dev libffi8 libedit2 libz3-4 libtinfo6 libxml2 libbsd0 libicu72 libmd0 \
  2>"$work/log" || { cat "$work/log" >&2; exit 2; }
for package in ./*.deb; do dpkg -x "$package" .; done
libraries=$PWD/usr/lib/x86_64-linux-gnu
cat >cube.c <<'END'
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
#include <GL/glext.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOOKS = 4096, SIDE = 8 };

static const char source[] =
    "#version 450\n"
    "layout(local_size_x = 64) in;\n"
    "layout(binding = 0) uniform samplerCube cube;\n"
    "layout(std430, binding = 0) readonly buffer In { vec4 d[]; };\n"
    "layout(std430, binding = 1) buffer Out { vec4 seen[]; };\n"
    "void main() { uint i = gl_GlobalInvocationID.x; seen[i] = textureLod(cube, d[i].xyz, 0.0); }\n";

int main(void) {
  const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION, 4, OSMESA_CONTEXT_MINOR_VERSION, 5, 0};
  static unsigned char screen[4 * 16 * 16];
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, NULL);
  if (context == NULL || !OSMesaMakeCurrent(context, screen, GL_UNSIGNED_BYTE, 16, 16)) return 2;

  GLuint texture, buffer[2];
  static float texel[SIDE * SIDE * 4];
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_CUBE_MAP, texture);
  srand(1);
  for (int face = 0; face < 6; face++) {
    for (int i = 0; i < SIDE * SIDE * 4; i++) texel[i] = (float)rand() / (float)RAND_MAX;
    glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA32F, SIDE, SIDE, 0, GL_RGBA, GL_FLOAT, texel);
  }
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  const char *text = source;
  GLuint shader = glCreateShader(GL_COMPUTE_SHADER), program = glCreateProgram();
  glShaderSource(shader, 1, &text, NULL);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glLinkProgram(program);
  glUseProgram(program);
  glGenBuffers(2, buffer);

  printf("%s, %s\n", (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
  static float in[LOOKS][4], seen[2][LOOKS][4];
  int changed[2] = {0, 0};
  for (int seamless = 0; seamless < 2; seamless++) {
    (seamless ? glEnable : glDisable)(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    for (int pass = 0; pass < 2; pass++) {
      for (int i = 0; i < LOOKS; i++) { /* the odd ones: to a face's middle, then to a corner */
        const double turn = 2.399963 * i, z = 1 - (2 * i + 1.0) / LOOKS;
        const double ring = sqrt(1 - z * z);
        float even[4] = {(float)(ring * cos(turn)), (float)(ring * sin(turn)), (float)z, 0};
        float odd[4] = {1, (float)pass, (float)pass, 0};
        memcpy(in[i], i % 2 ? odd : even, sizeof even);
      }
      for (int k = 0; k < 2; k++) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k, buffer[k]);
        glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof in, k ? NULL : in, GL_STATIC_DRAW);
      }
      glDispatchCompute(LOOKS / 64, 1, 1);
      glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
      glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof seen[0], seen[pass]);
    }
    for (int i = 0; i < LOOKS; i += 2)
      changed[seamless] += memcmp(seen[0][i], seen[1][i], sizeof seen[0][i]) != 0;
  }
  double most = 0;
  for (int i = 0; i < LOOKS; i += 2)
    for (int k = 0; k < 4; k++)
      most = fmax(most, fabs((double)seen[0][i][k] - (double)seen[1][i][k]));
  printf("expected: what a look-up finds does not hang on those beside it: 0 of %d change\n", LOOKS / 2);
  printf("seen: seamless off, %d change; on, %d change, by %.1e at the most\n", changed[0], changed[1], most);
  return changed[0] == 0 && changed[1] > 0 && most < 1e-6 ? 0 : 1;
}
END
gcc -O1 -Iusr/include cube.c -o cube "$libraries/libOSMesa.so.8" -Wl,-rpath-link,"$libraries" -lm
export LD_LIBRARY_PATH=$libraries:$PWD/lib/x86_64-linux-gnu
if ! ./cube; then
  echo "this has changed" >&2
  exit 1
fi
echo "so bits of a picture hang on which pixels share a vector, and that on how threads list them"
