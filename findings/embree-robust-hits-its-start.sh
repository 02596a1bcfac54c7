#!/usr/bin/env bash
# Embree: a ray that starts on a primitive, and one whose tnear is the distance of its hit, in scenes with and without
# RTC_SCENE_FLAG_ROBUST. All numbers are powers of two or lie in the primitive's plane, so nothing is rounded.
set -euo pipefail
package=libembree3-3=3.13.5+dfsg-2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download "$package" libembree-dev=3.13.5+dfsg-2 libtbb12 libtbbmalloc2 libtbbbind-2-5 2>log ||
  { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
lib=$PWD/usr/lib/x86_64-linux-gnu
cat >start.c <<'C'
#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static RTCScene one(RTCDevice device, int kind, enum RTCSceneFlags flags)
{
  static const enum RTCGeometryType types[] = {RTC_GEOMETRY_TYPE_TRIANGLE, RTC_GEOMETRY_TYPE_QUAD,
                                               RTC_GEOMETRY_TYPE_SPHERE_POINT};
  static const float corners[] = {-4, -4, 1, 4, -4, 1, 4, 4, 1, -4, 4, 1}, ball[] = {0, 0, 2, 1};
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, flags);
  RTCGeometry g = rtcNewGeometry(device, types[kind]);
  if (kind == 2)
    memcpy(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, 1), ball, sizeof ball);
  else {
    memcpy(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4), corners, sizeof corners);
    unsigned *index = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0,
                                              kind ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, kind ? 16 : 12, 1);
    for (unsigned i = 0; i < (kind ? 4u : 3u); i++) index[i] = i;
  }
  rtcCommitGeometry(g);
  rtcAttachGeometry(scene, g);
  rtcReleaseGeometry(g);
  rtcCommitScene(scene);
  return scene;
}

static int hits(RTCScene scene, float x, float z, float direction, float near)
{
  struct RTCRayHit ray = {.ray = {.org_x = x, .org_z = z, .dir_z = direction, .tnear = near, .tfar = INFINITY,
                                  .mask = ~0u},
                          .hit.geomID = RTC_INVALID_GEOMETRY_ID};
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

int main(void)
{
  static const char *const kinds[] = {"triangle", "quad", "sphere"};
  RTCDevice device = rtcNewDevice("");
  for (int kind = 0; kind < 3; kind++) {
    const float x = kind == 2 ? 0 : 2;
    printf("seen: %s:", kinds[kind]);
    for (int robust = 0; robust < 2; robust++) {
      RTCScene scene = one(device, kind, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
      printf("%s start %s, tnear at the hit %s", robust ? "; robust:" : "", hits(scene, x, 1, -1, 0) ? "hit" : "missed",
             hits(scene, x, 0, 1, 1) ? "hit" : "missed");
    }
    puts("");
  }
  return 0;
}
C
gcc -Iusr/include start.c -o start -L"$lib" -lembree3 -Wl,-rpath,"$lib",-rpath-link,"$lib"
echo "${package/=/ }"
echo "expected: the same for all; a hit at tnear, the end of the interval, whatever the flag"
./start | tee seen
cat >known <<'T'
seen: triangle: start missed, tnear at the hit missed; robust: start hit, tnear at the hit hit
seen: quad: start missed, tnear at the hit missed; robust: start hit, tnear at the hit hit
seen: sphere: start hit, tnear at the hit hit; robust: start hit, tnear at the hit hit
T
cmp -s seen known || { echo "this has changed" >&2; exit 1; }
echo "so a shadow ray with tnear 0 from a point on a floor at z = 1 is free, and blocked by the floor itself once"
echo "RTC_SCENE_FLAG_ROBUST is set, and on spheres always: move the start, or tnear, off the surface in any case"
