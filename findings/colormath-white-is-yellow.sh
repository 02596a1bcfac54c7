#!/usr/bin/env bash
# python-colormath: a perfect white, a reflectance of 1 at all its wavelengths, under the illuminants that it knows,
# as L*a*b* relative to the same illuminant's white.
set -euo pipefail
package=python3-colormath=3.0.0-4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
needed="$package python3-networkx python3-decorator python3-numpy libblas3 liblapack3 libgfortran5 libquadmath0"
apt-get -qq download $needed 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
lib=$PWD/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack PYTHONPATH=$PWD/usr/lib/python3/dist-packages
echo "${package/=/ }"
echo "expected: 100, 0, 0 under each illuminant, to 0.1"
/usr/bin/python3 - <<'PYTHON' || { echo "this has changed" >&2; exit 1; }
import sys
from colormath.color_objects import LabColor, SpectralColor
from colormath.color_conversions import convert_color
bands = {f"spec_{nm}nm": 1.0 for nm in range(340, 840, 10)}
off = {}
for light in ("a", "c", "d50", "d65", "e", "f2", "f7", "f11"):
    lab = convert_color(SpectralColor(observer="2", illuminant=light, **bands), LabColor)
    off[light] = (lab.lab_l, lab.lab_a, lab.lab_b)
    print(f"seen under {light}: %.1f %.1f %.1f" % off[light])
print("its lamps have every second of the CIE's 5 nm values: f2, f7, f11 lose the mercury line at 436 nm, all whites turn yellow")
smooth = all(abs(off[light][i]) < 0.1 for light in ("a", "c", "d50", "d65", "e") for i in (1, 2))
lines = 12 < off["f2"][2] < 12.4 and 7.2 < off["f7"][2] < 7.6 and 14 < off["f11"][2] < 14.6
sys.exit(not (smooth and lines))
PYTHON
