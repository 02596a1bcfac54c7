#!/usr/bin/env bash
# libvips: pixels of EXR pictures that have a value of 0.5 in all channels: spectral bands as [Fichet2021] names them,
# a layer's R, G and B, and X, Y and Z.
set -euo pipefail
package=libvips-tools=8.14.1-3+deb12u3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -s install --no-install-recommends --reinstall $package 2>log | awk '/^Inst/ {print $2}' |
  sed "s/^libvips-tools$/$package/" >needed
apt-get -qq download $(cat needed) 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
LD_LIBRARY_PATH=$(find "$PWD" -name '*.so*' -printf '%h\n' | sort -u | tr '\n' ':')
export LD_LIBRARY_PATH
# Uncompressed float scan lines of 4 x 4 pixels.
/usr/bin/python3 - <<'PYTHON'
import struct
def attribute(name, kind, data):
    return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(data)) + data
def write(path, names):
    box = struct.pack("<4i", 0, 0, 3, 3)
    channels = b"".join(name.encode() + struct.pack("<xi4xii", 2, 1, 1) for name in sorted(names)) + b"\0"
    head = struct.pack("<II", 20000630, 2) + attribute("channels", "chlist", channels)
    head += attribute("compression", "compression", b"\0") + attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = struct.pack("<f", 0.5) * 4 * len(names)
    with open(path, "wb") as file:
        file.write(head)
        for y in range(4):
            file.write(struct.pack("<Q", len(head) + 32 + y * (8 + len(line))))
        for y in range(4):
            file.write(struct.pack("<ii", y, len(line)) + line)
write("colours.exr", ["R", "G", "B"])
write("bands.exr", [f"S0.{nm},0nm" for nm in range(400, 701, 50)])
write("layer.exr", ["gem.R", "gem.G", "gem.B"])
write("xyz.exr", ["X", "Y", "Z"])
PYTHON
echo "${package/=/ }"
echo "expected: 0.5 0.5 0.5 for colours.exr, and a refusal, or the channels, for the others"
pixel() { usr/bin/vips getpoint "$1.exr" 2 2 2>&1 || echo refused; }
for file in colours bands layer xyz; do echo "seen in $file.exr: $(pixel $file)"; done
echo "bands and layers are black and opaque, X and Z are lost, and no word is said: choose R, G and B before"
if [ "$(pixel colours)" != "0.5 0.5 0.5 255 " ] || [ "$(pixel bands)" != "0 0 0 255 " ] ||
  [ "$(pixel layer)" != "0 0 0 255 " ] || [ "$(pixel xyz)" != "0.5 0.5 0.5 255 " ]; then
  echo "this has changed" >&2
  exit 1
fi
