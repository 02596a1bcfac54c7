#!/usr/bin/env bash
# OpenEXR as Debian testing has it: exrmultipart -combine puts two pictures into one file. What stands
# in that file's tables of chunk offsets, which say where each row of a part lies.
set -euo pipefail
packages=(openexr=3.4.16+ds-1 libopenexr-3-4-33=3.4.16+ds-1 libimath-3-2-30 libdeflate0 libopenjph0.32
  libc6 libstdc++6 libgcc-s1)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -n 1)
mkdir -p lists/partial cache/archives/partial
echo "deb $mirror forky main" >sources.list
options=(-qq -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$work/lists"
  -o Dir::Cache="$work/cache" -o APT::Sandbox::User=root)
{ apt-get "${options[@]}" update && apt-get "${options[@]}" download "${packages[@]}"; } >log 2>&1 ||
  { cat log >&2; exit 2; }
for file in ./*.deb; do dpkg -x "$file" .; done
lib=$(find . -name 'ld-linux-x86-64.so.2' -type f | head -n 1)
# tool NAME ARGUMENT...: with the libraries that it was built for.
tool() {
  local name=$1
  shift
  "$lib" --library-path "$(dirname "$lib"):$work/usr/lib/x86_64-linux-gnu" "usr/bin/$name" "$@"
}
python3 - <<'PYTHON'
import struct

def attribute(name, kind, data):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

for path, names in (("depth.exr", (b"Z",)), ("colours.exr", (b"B", b"G", b"R"))):
    channels = b"".join(n + b"\0" + struct.pack("<4i", 2, 0, 1, 1) for n in names) + b"\0"
    window = struct.pack("<4i", 0, 0, 3, 3)
    head = b"\x76\x2f\x31\x01\x02\0\0\0" + attribute(b"channels", b"chlist", channels)
    head += attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", window)
    head += attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", bytes(8))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 16 * len(names)
    head += struct.pack("<4Q", *(len(head) + 32 + line * y for y in range(4)))
    for y in range(4):
        head += struct.pack(f"<ii{4 * len(names)}f", y, 16 * len(names), *[1.0] * (4 * len(names)))
    open(path, "wb").write(head)
PYTHON
tool exrmultipart -combine -i depth.exr colours.exr -o parts.exr >log 2>&1 || { cat log >&2; exit 2; }
echo "${packages[0]/=/ }"
echo "expected: 'Combine Success', and 8 offsets, 4 of each part, none of them 0"
success=$(tail -n 1 log)
tool exrinfo parts.exr >info 2>&1 && info=0 || info=$?
python3 - "$success" "$info" <<'PYTHON'
import struct, sys
data = open("parts.exr", "rb").read()
# The tables stand before the chunks: 4 rows of 28 bytes of one part and 4 of 60 of the other.
tables = data[len(data) - 4 * (12 + 16) - 4 * (12 + 48) - 64:][:64]
offsets = struct.unpack("<8Q", tables)
print(f"seen: '{sys.argv[1]}', exrinfo ends with {sys.argv[2]}, offsets {' '.join(map(str, offsets))}")
sys.exit(0 if not any(offsets) and sys.argv[2] == "0" else "this has changed")
PYTHON
echo "so readers that do not rebuild a table by walking the chunks find an unfinished file; -separate does rebuild it"
