#!/usr/bin/env bash
# LittleCMS: sRGB's white to XYZ by the absolute colorimetric intent, with an observer who is not at
# all, half, or fully adapted to the white of the profile connection space.
set -euo pipefail
tools=liblcms2-utils=2.14-2+deb12u1 library=liblcms2-2=2.14-2+deb12u1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download "$tools" "$library" 2>"$work/log" || { cat "$work/log" >&2; exit 2; }
for package in ./*.deb; do dpkg -x "$package" .; done
export LD_LIBRARY_PATH=$PWD/usr/lib/x86_64-linux-gnu

# white ADAPTATION: X, Y and Z in per cent.
white() {
  printf '255\n255\n255\n' | usr/bin/transicc -t3 "-d$1" '-i*sRGB' '-o*XYZ' 2>/dev/null |
    sed -n 's/^X=\([0-9.]*\) Y=\([0-9.]*\) Z=\([0-9.]*\).*/\1 \2 \3/p'
}
echo "liblcms2 ${library#*=}"
echo "expected: D65 at 0, D50 at 1, and at 0.5 a white between them: Y 100.00, Z half-way, at 95.70"
none=$(white 0) half=$(white 0.5) full=$(white 1)
printf 'seen at 0:   X %s Y %s Z %s\n' $none
printf 'seen at 0.5: X %s Y %s Z %s\n' $half
printf 'seen at 1:   X %s Y %s Z %s\n' $full
read -r _ y z <<<"$half"
awk -v none="${none#* }" -v full="${full#* }" -v y="$y" -v z="$z" 'BEGIN {
  split(none, a, " "); split(full, b, " ")
  ends = a[1] == 100 && b[1] == 100 && a[2] > 108.8 && b[2] < 82.6
  exit !(ends && y > 99.8 && y < 99.9 && z > 92.8 && z < 93.2) }' || {
  echo "this has changed" >&2
  exit 1
}
echo "so a white that is partly adapted to is no white of Y 100, and is nearer to D50 than half-way"
