#!/usr/bin/env bash
# OpenEXR's exrenvmap: a latitude-longitude map of 512 by 256 texels that is black but for one texel, as a
# sun of an HDRI is, made four times smaller. What is left of that texel's light, by solid angle.
set -euo pipefail
tools=openexr=3.1.5-5 library=libopenexr-3-1-30=3.1.5-5 maths=libimath-3-1-29=3.1.6-1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download $tools $library $maths 2>log || { cat log >&2; exit 2; }
for package in ./*.deb; do dpkg -x "$package" .; done
export LD_LIBRARY_PATH=$PWD/usr/lib/x86_64-linux-gnu
echo "${tools/=/ }"
echo "expected: 1.0 of the light, wherever the sun stands, within some per cent"
python3 - <<'PYTHON'
import math, struct, subprocess, sys

width, height, small = 512, 256, 128

def solid_angle(row, wide, high):
    return 2 * math.pi / wide * (math.cos(math.pi * row / high) - math.cos(math.pi * (row + 1) / high))

def attribute(name, kind, data):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

def write_sun(column, row):
    """A float EXR without compression whose sun has a light of 0.1."""
    channels = b"".join(c + b"\0" + struct.pack("<4i", 2, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = b"\x76\x2f\x31\x01\x02\0\0\0" + attribute(b"channels", b"chlist", channels)
    head += attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", window)
    head += attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", bytes(8))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 12 * width
    head += struct.pack(f"<{height}Q", *(len(head) + 8 * height + line * y for y in range(height)))
    for y in range(height):
        values = [0.0] * width
        if y == row:
            values[column] = 0.1 / solid_angle(row, width, height)
        head += struct.pack(f"<ii{3 * width}f", y, 12 * width, *(values * 3))
    open("sun.exr", "wb").write(head)

def light_left(*options):
    high = small // 2
    subprocess.run(["usr/bin/exrenvmap", "-li", "-l", "-z", "none", "-w", str(small), "-t", str(small), str(high),
                    *options, "sun.exr", "small.exr"], check=True)
    pixels = open("small.exr", "rb").read()[-6 * small * high:]
    green = lambda y: struct.unpack_from(f"<{small}e", pixels, 6 * small * y + 2 * small)
    return sum(solid_angle(y, small, high) * sum(green(y)) for y in range(high)) / 0.1

changed = False
for place, seen in (((203, 67), 0.07), ((200, 128), 0.41), ((201, 128), 0.80), ((202, 129), 1.82), ((201, 65), 2.19)):
    write_sun(*place)
    usual, wide = light_left(), light_left("-f", "2", "20")
    print(f"seen: sun at texel {place}: {usual:.2f} by default, {wide:.2f} with -f 2 20")
    changed = changed or abs(usual - seen) > 0.01 or abs(wide - 1) > 0.06
sys.exit("this has changed" if changed else 0)
PYTHON
echo "so make an HDRI with a sun smaller with -f 2 20; the default leaves 0.07 to 2.2 of its light"
