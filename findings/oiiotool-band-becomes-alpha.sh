#!/usr/bin/env bash
# OpenImageIO's oiiotool: a picture with R, G, B and spectral bands, in the layout of [Fichet2021], is written as
# a PNG. What the PNG's channels hold.
set -euo pipefail
tools=openimageio-tools=2.4.7.1+dfsg-2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
# The libraries that this system lacks come beside the tools, 400 MB.
apt-get -s install --no-install-recommends --reinstall $tools 2>log | awk '/^Inst/ {print $2}' |
  sed "s/^openimageio-tools$/$tools/" >needed
apt-get -qq download $(cat needed) 2>log || { cat log >&2; exit 2; }
for package in ./*.deb; do dpkg -x "$package" .; done
LD_LIBRARY_PATH=$(find "$PWD" -name '*.so*' -printf '%h\n' | sort -u | grep -v python | tr '\n' ':')
export LD_LIBRARY_PATH
oiiotool=usr/bin/oiiotool
echo "${tools/=/ }"
echo "expected: the colours 51, 102, 153 of 255 in the PNG, without the bands"
$oiiotool --pattern constant:color=0.2,0.4,0.6,0.5,0.25 8x8 5 --chnames R,G,B,S0.430nm,S0.530nm -d float -o bands.exr
means() { $oiiotool --no-autopremult --stats "$1" | sed -n 's/.*Avg: \([0-9. ]*[0-9]\) (.*/\1/p'; }
$oiiotool bands.exr -o bands.png 2>warning
seen=$(means bands.png)
$oiiotool bands.exr --ch R,G,B -o colours.png
chosen=$(means colours.png)
echo "seen: $seen; it says: $(head -n 1 warning)"
echo "seen with --ch R,G,B: $chosen"
echo "the first band is the PNG's alpha, and the colours are divided by it and clipped: name the channels"
if [ "$seen" != "101.00 203.00 255.00 128.00" ] || [ "$chosen" != "51.00 102.00 153.00" ]; then
  echo "this has changed" >&2
  exit 1
fi
