#!/usr/bin/env bash
# Mesa's zink over lavapipe: two compute programs in turn, each with a uniform bool that decides a branch, and
# whether each dispatch acts by the value that was set for it.
set -euo pipefail
mesa=25.0.7-2+deb13u1
packages=({libegl-mesa0,mesa-libgallium,mesa-vulkan-drivers}="$mesa" libegl1 libegl-dev libgl1 libgl-dev libglvnd0 libglx0
  libvulkan1 libllvm19 libc6 libstdc++6 libgcc-s1 libgbm1 libdrm2 libdrm-amdgpu1 libdrm-intel1 libpciaccess0 libsensors5
  libelf1t64 libexpat1 libffi8 libedit2 libtinfo6 libbsd0 libmd0 libxml2 liblzma5 libz3-4 libzstd1 zlib1g
  libwayland-client0 libwayland-server0 libx11-6 libx11-xcb1 libxau6 libxdmcp6 libxcb1
  libxcb-{dri3-0,present0,randr0,shm0,sync1,xfixes0} libxshmfence1)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -n 1)
mkdir -p lists/partial cache/archives/partial
echo "deb $mirror trixie main" >sources.list
options=(-qq -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$work/lists"
  -o Dir::Cache="$work/cache" -o APT::Sandbox::User=root)
{ apt-get "${options[@]}" update && apt-get "${options[@]}" download "${packages[@]}"; } >log 2>&1 ||
  { cat log >&2; exit 2; }
for file in ./*.deb; do dpkg -x "$file" .; done
lib=$work/usr/lib/x86_64-linux-gnu
loader=$(find . -name 'ld-linux-x86-64.so.2' -type f | head -n 1)
cat >switch.c <<'END'
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <stdio.h>

static const char source[] =
    "#version 450\n"
    "layout(local_size_x = 1) in;\n"
    "uniform bool on;\n"
    "layout(std430, binding = 0) buffer Out { uint seen; };\n"
    "void main() { if (on) atomicAdd(seen, 1u); }\n";

static GLuint make(void) {
  const char *text = source;
  const GLuint program = glCreateProgram(), shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 1, &text, NULL);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glLinkProgram(program);
  return program;
}

static GLuint run(GLuint program, int on) {
  GLuint seen = 0;
  glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof seen, &seen, GL_DYNAMIC_COPY);
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "on"), on);
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof seen, &seen);
  return seen;
}

int main(void) {
  static const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  static const int steps[][2] = {{1, 0}, {0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 1}}; /* program, on */
  const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
  if (!eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API)) return 2;
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return 2;
  GLuint buffer;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
  const GLuint program[] = {make(), make()};
  printf("%s, %s\n ", (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
  for (int i = 0; i < 6; i++)
    printf(" %c on=%d did %u%s", "AB"[steps[i][0]], steps[i][1], run(program[steps[i][0]], steps[i][1]), i < 5 ? "," : "\n");
  return 0;
}
END
gcc -O1 -Iusr/include switch.c -o switch "$lib/libEGL.so.1" "$lib/libGL.so.1" -Wl,--allow-shlib-undefined
sed -i "s|/usr/lib/x86_64-linux-gnu|$lib|" usr/share/vulkan/icd.d/lvp_icd*.json
export LIBGL_ALWAYS_SOFTWARE=1 __EGL_VENDOR_LIBRARY_DIRS=$work/usr/share/glvnd/egl_vendor.d
export VK_DRIVER_FILES=$(echo "$work"/usr/share/vulkan/icd.d/lvp_icd*.json) MESA_SHADER_CACHE_DISABLE=true
echo "expected: what each does is its 'on', as by llvmpipe"
for driver in llvmpipe zink; do
  GALLIUM_DRIVER=$driver "$loader" --library-path "$lib" ./switch >"$driver" || exit 2
  echo "seen: $(cat $driver)"
done
if [ "$(tail -n 1 llvmpipe)" != '  B on=0 did 0, A on=0 did 0, B on=0 did 0, B on=1 did 1, A on=1 did 1, B on=1 did 1' ] ||
  [ "$(tail -n 1 zink)" != '  B on=0 did 0, A on=0 did 0, B on=0 did 0, B on=1 did 1, A on=1 did 1, B on=1 did 0' ]; then
  echo "this has changed" >&2
  exit 1
fi
echo "so a branch by a uniform alone can follow an earlier dispatch's value"
