#!/usr/bin/env bash
# Spectral Python (SPy): an ENVI cube of whole numbers with `reflectance scale factor = 10000` is read, and written
# again with its own metadata; and a spectrum whose wavelengths descend is resampled to two bands.
set -euo pipefail
package=python3-spectral=0.22.4-1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
needed="$package python3-numpy libblas3 liblapack3 libgfortran5 libquadmath0"
apt-get -qq download $needed 2>log || { cat log >&2; exit 2; }
for deb in ./*.deb; do dpkg -x "$deb" .; done
lib=$PWD/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack PYTHONPATH=$PWD/usr/lib/python3/dist-packages
echo "${package/=/ }"
echo "expected: the copy's reflectance is the first cube's, 0.5; descending wavelengths give 1.5 and 4.5 as ascending ones do"
/usr/bin/python3 - <<'PYTHON' || { echo "this has changed" >&2; exit 1; }
import sys
import numpy
from spectral import BandResampler
from spectral.io import envi
envi.save_image("cube.hdr", numpy.full((2, 2, 3), 5000, "int16"), metadata={"reflectance scale factor": 10000})
cube = envi.open("cube.hdr")
first, array = cube[0, 0, 0], cube.asarray()[0, 0, 0]
envi.save_image("copy.hdr", cube.load(), metadata=cube.metadata)
copy = envi.open("copy.hdr")[0, 0, 0]
envi.save_image("open.hdr", cube)
whole = envi.open("open.hdr")[0, 0, 0]
print(f"seen: {first:g} read, {array:g} by asarray(), {copy:g} in a copy of load(), {whole:g} in one of the file object")
up, down = [400, 450, 500, 550, 600], [600, 550, 500, 450, 400]
ascending = BandResampler(up, [425, 575], [50] * 5, [50] * 2)([1, 2, 3, 4, 5])
descending = BandResampler(down, [425, 575], [50] * 5, [50] * 2)([5, 4, 3, 2, 1])
print(f"seen: ascending {ascending}, descending {descending}")
print("load() divides by the factor, and its metadata still has it: each such copy is ten thousand times darker;")
print("the resampler stops at the first band beyond its own: where wavelengths descend, bands below the longest are not found")
right = first == 0.5 and whole == 0.5 and numpy.allclose(ascending, [1.5, 4.5])
sys.exit(not (right and array == 5000 and abs(copy - 5e-5) < 1e-9 and numpy.isnan(descending[0])))
PYTHON
