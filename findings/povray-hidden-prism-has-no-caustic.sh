#!/usr/bin/env bash
# POV-Ray: a prism throws its photons on a plane. What is left of the caustic and of the shadow when the prism has
# no_image or no_reflection, which the manual describes as hiding it from the camera's or from mirrors' rays.
set -euo pipefail
package=povray=1:3.7.0.10-2+b2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -s install --no-install-recommends --reinstall $package 2>log | awk '/^Inst/ {print $2}' |
  sed "s/^povray$/$package/" >needed
apt-get -qq download $(cat needed) 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
LD_LIBRARY_PATH=$(find "$PWD" -name '*.so*' -printf '%h\n' | sort -u | tr '\n' ':')
export LD_LIBRARY_PATH
cat >scene <<'E'
#version 3.7;
global_settings { assumed_gamma 1 photons { count 100000 } }
light_source { <0, 10, 0> rgb 0.6 photons { refraction on reflection off } }
camera { orthographic location <0, 0.5, 0> right 12*x up 12*z direction -y look_at 0 sky z }
plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0.5 } photons { collect on } }
prism {
  -1, 1, 4, <-1, -1>, <1.2, -0.8>, <0, 1.2>, <-1, -1> rotate x*90 translate y*3
  pigment { rgbf 1 } finish { ambient 0 diffuse 0 } interior { ior 1.5 }
  photons { target refraction on reflection off collect off }
  HIDDEN
}
E
# draw NAME: the photons stored, and the pixel behind the prism (255 at a value of 1).
draw() {
  sed "s/HIDDEN/$1/" scene >prism.pov
  usr/bin/povray +Iprism.pov +Oprism.ppm +FP +W65 +H65 -D File_Gamma=1.0 +Lusr/share/povray-3.7/include >/dev/null 2>log
  stored=$(sed -n 's/^Surface photons stored: *//p' log)
  echo "${stored:-0} $(tail -c $((65 * 65 * 3)) prism.ppm |
    od -An -tu1 -j $(((32 * 65 + 32) * 3)) -N 1 | tr -d ' ')"
}
echo "${package/=/ }"
echo "expected: the same photons with no_image, for a camera below the prism does not see it anyway"
bare=$(draw "")
hidden=$(draw no_image)
mirrors=$(draw no_reflection)
echo "seen, photons stored and light behind the prism: bare $bare, no_image $hidden, no_reflection $mirrors"
echo "no_image takes the caustic away and lets the light pass straight on: put the camera below, or clip the prism"
if [ "${bare%% *}" -lt 100000 ] || [ "$bare" != "$mirrors" ] || [ "${hidden%% *}" -ne 0 ] ||
  [ "${bare##* }" -ne 0 ] || [ "${hidden##* }" -lt 70 ]; then
  echo "this has changed" >&2
  exit 1
fi
