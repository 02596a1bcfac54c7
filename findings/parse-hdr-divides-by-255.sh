#!/usr/bin/env bash
# parse-hdr: two pixels of a Radiance picture whose values are powers of two, and the exposure of its header. Radiance
# stores value = mantissa / 256 * 2^(exponent - 128), times the product of all EXPOSURE lines, which readers divide by.
set -euo pipefail
package=parse-hdr@1.0.0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm pack --silent "$package" >log 2>&1 || { cat log >&2; exit 2; }
tar -xzf ./*.tgz
echo "$package (npm)"
echo "expected: 1 1 1 and 1 2 0.5; exposures of 2, 2, and 8, or values divided by them"
cat >pixels.cjs <<'JS'
const parse = require('./package');
const pixels = Buffer.from([128, 128, 128, 129, 64, 128, 32, 130]);
const read = (lines) => parse(Buffer.concat([
  Buffer.from(`#?RADIANCE\n${lines}FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n`), pixels]));
const values = (picture) => Array.from(picture.data, (v) => v.toFixed(4)).join(' ');
const plain = values(read(''));
const pictures = ['EXPOSURE=2\n', 'EXPOSURE=2.0\n', 'EXPOSURE=2.0\nEXPOSURE=4.0\n'].map(read);
const exposures = pictures.map((p) => p.exposure).join(', ');
const same = pictures.every((p) => values(p) === plain);
console.log(`seen: ${plain}; exposures ${exposures}, values ${same ? 'not divided' : 'divided'}`);
process.exit(same && exposures === '1, 2, 4' &&
  plain === '1.0039 1.0039 1.0039 1.0000 1.0039 2.0078 0.5020 1.0000' ? 0 : 1);
JS
node pixels.cjs || { echo "this has changed" >&2; exit 1; }
echo "so an HDRI is 0.39 % too bright (a mantissa is divided by 255), an exposure without a point is lost, and of"
echo "several exposures the last is given: divide by the product of the header's own lines, and multiply by 255/256"
