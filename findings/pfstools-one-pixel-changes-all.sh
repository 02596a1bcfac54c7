#!/usr/bin/env bash
# pfstools: a float picture is written as OpenEXR and as Radiance RGBE. What one pixel of a sun does to the others,
# and what becomes of a colour outside of the gamut, whose red is below 0.
set -euo pipefail
package=pfstools=2.2.0-5+b1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -s install --no-install-recommends --reinstall $package 2>log | awk '/^Inst/ {print $2}' |
  sed "s/^pfstools$/$package/" >needed
apt-get -qq download $(cat needed) openexr 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
LD_LIBRARY_PATH=$(find "$PWD" -name '*.so*' -printf '%h\n' | sort -u | tr '\n' ':')
PATH=$PWD/usr/bin:$PATH
export LD_LIBRARY_PATH PATH
# Two pixels: 0.5, 0.5, 0.5, and a sun of 100000, above half floats' greatest number 65504.
{ printf 'PF\n2 1\n-1.0\n'; printf '\0\0\0?\0\0\0?\0\0\0?\0P\303G\0P\303G\0P\303G'; } >sun.pfm
# One pixel: -0.125, 0.5, 0.5.
{ printf 'PF\n1 1\n-1.0\n'; printf '\0\0\0\276\0\0\0?\0\0\0?'; } >cyan.pfm
red() { od -An -tf4 -j "$(($(head -n 3 "$1" | wc -c)))" -N 4 "$1" | tr -d ' '; }
echo "${package/=/ }"
echo "expected: 0.5 stays 0.5 in the EXR and the sun is clamped; the red below 0 is 0 in the RGBE file"
pfsinpfm sun.pfm | pfsoutexr sun.exr
white=$(exrheader sun.exr | sed -n 's/^whiteLuminance.*: //p')
pfsinpfm sun.pfm | pfsoutexr --float32 float.exr
float=$(exrheader float.exr | sed -n 's/^whiteLuminance.*: //p')
pfsinpfm cyan.pfm | pfsoutrgbe cyan.hdr
pfsinrgbe cyan.hdr | pfsoutpfm back.pfm
back=$(red back.pfm)
echo "seen: all pixels of the EXR are divided by $white, its whiteLuminance, which other readers do not apply"
echo "seen with --float32: no whiteLuminance (${float:-none})"
echo "seen in the RGBE file: the red is $back, brighter than green and blue"
awk -v w="$white" -v f="$float" -v b="$back" 'BEGIN {exit !(w > 1.526 && w < 1.527 && f == "" && b > 0.8)}' || {
  echo "this has changed" >&2
  exit 1
}
