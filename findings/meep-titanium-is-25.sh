#!/usr/bin/env bash
# Meep: refractive indices at 587.6 nm of the media in its library of materials, beside the library's other fits of
# the same metal.
set -euo pipefail
package=python3-meep=1.25.0-2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
needed="$package libmeep30 libctl7 libfftw3-double3 libgdsii0 libgsl27 libgslcblas0 libharminv3 libhdf5-103-1 libsz2 libaec0
  guile-3.0-libs libgc1 libcurl4 python3-numpy python3-scipy python3-decorator libblas3 liblapack3 libgfortran5 libquadmath0"
apt-get -qq download $needed 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
lib=$PWD/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$lib:$PWD/usr/lib:$lib/blas:$lib/lapack PYTHONPATH=$PWD/usr/lib/python3/dist-packages
echo "${package/=/ }"
echo "expected: Ti_visible is titanium, near Ti (1.9 + 3.1i), and Au_JC_visible, a fit to Johnson and Christy, near 0.3 + 2.9i"
/usr/bin/python3 - <<'PYTHON' | grep -v Elapsed || { echo "this has changed" >&2; exit 1; }
import sys
from cmath import sqrt
from meep import materials
n = {}
for name in ("BK7", "Al2O3_aniso", "Ti", "Ti_visible", "Au", "Au_visible", "Au_JC_visible"):
    n[name] = sqrt(getattr(materials, name).epsilon(1 / 0.5876)[0][0])
    reflectance = abs((n[name] - 1) / (n[name] + 1)) ** 2
    print(f"seen: {name} {n[name]:.4f}, reflectance {reflectance:.3f}")
print("glass and sapphire are right to four digits; Ti_visible has an index of 25.6 and reflects half as much again as Ti,")
print("Au_JC_visible reflects half of the light, where the other two golds reflect five sixths; neither says so")
right = abs(n["BK7"] - 1.5168) < 1e-4 and abs(n["Al2O3_aniso"] - 1.7682) < 1e-4 and abs(n["Ti"] - (1.91 + 3.07j)) < 0.02
sys.exit(not (right and abs(n["Ti_visible"] - (25.55 + 0.36j)) < 0.02 and abs(n["Au_JC_visible"] - (1.49 + 2.456j)) < 0.01))
PYTHON
