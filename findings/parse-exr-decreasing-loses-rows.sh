#!/usr/bin/env bash
# parse-exr: two zipped EXR files of 20 lines, alike but for the order in which their blocks of 16 lines lie in the
# file. A line's values are its number; the package gives lines from the bottom up, in both cases.
set -euo pipefail
package=parse-exr@1.0.2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund "$package" >log 2>&1 || { cat log >&2; exit 2; }
echo "$package (npm)"
echo "expected: lines 19 to 0 of both files"
cat >lines.cjs <<'JS'
const zlib = require('zlib');
const module_ = require('parse-exr');
const parse = module_.default ?? module_;
const height = 20, block = 16, channels = ['B', 'G', 'R'];
const int = (...values) => Buffer.from(Int32Array.from(values).buffer);
const float = (...values) => Buffer.from(Float32Array.from(values).buffer);
const attribute = (name, type, value) =>
  Buffer.concat([Buffer.from(`${name}\0${type}\0`), int(value.length), value]);
const channel = (name) => Buffer.concat([Buffer.from(`${name}\0`), int(2, 0, 1, 1)]);
/* Even bytes before odd ones, differences, deflate. */
const pack = (raw) => {
  const half = (raw.length + 1) >> 1, out = Buffer.alloc(raw.length);
  raw.forEach((b, i) => { out[i % 2 ? half + (i >> 1) : i >> 1] = b; });
  for (let i = out.length - 1; i > 0; i--) out[i] = (out[i] - out[i - 1] + 384) & 255;
  return zlib.deflateSync(out);
};
const file = (decreasing) => {
  const box = int(0, 0, 0, height - 1);
  const header = Buffer.concat([int(20000630, 2),
    attribute('channels', 'chlist', Buffer.concat([...channels.map(channel), Buffer.from([0])])),
    attribute('compression', 'compression', Buffer.from([3])),
    attribute('dataWindow', 'box2i', box), attribute('displayWindow', 'box2i', box),
    attribute('lineOrder', 'lineOrder', Buffer.from([decreasing ? 1 : 0])),
    attribute('pixelAspectRatio', 'float', float(1)),
    attribute('screenWindowCenter', 'v2f', float(0, 0)),
    attribute('screenWindowWidth', 'float', float(1)), Buffer.from([0])]);
  const chunks = [];
  for (let y = 0; y < height; y += block) {
    const count = Math.min(block, height - y);
    const raw = Buffer.concat(Array.from({ length: count }, (_, i) => float(y + i, y + i, y + i)));
    const packed = pack(raw), data = packed.length < raw.length ? packed : raw;
    chunks.push(Buffer.concat([int(y, data.length), data]));
  }
  const order = chunks.map((_, i) => i);
  if (decreasing) order.reverse();
  const table = Buffer.alloc(8 * chunks.length);
  let at = header.length + table.length;
  for (const i of order) {
    table.writeBigUInt64LE(BigInt(at), 8 * i);
    at += chunks[i].length;
  }
  return Buffer.concat([header, table, ...order.map((i) => chunks[i])]);
};
const lines = (decreasing) => {
  const b = file(decreasing);
  if (process.argv[2]) require('fs').writeFileSync(`${process.argv[2]}/${+decreasing}.exr`, b);
  const r = parse(b.buffer.slice(b.byteOffset, b.byteOffset + b.length), 1015);
  return Array.from({ length: height }, (_, i) => r.data[4 * i]).join(' ');
};
const up = lines(false), down = lines(true);
console.log(`seen, increasing: ${up}\nseen, decreasing: ${down}`);
const from = (first) => Array.from({ length: first + 1 }, (_, i) => first - i).join(' ');
process.exit(up === from(19) && down === `${from(16)} 1 1 1` ? 0 : 1);
JS
node lines.cjs "${KEEP:-}" || { echo "this has changed" >&2; exit 1; }
echo "so the lowest lines of a picture whose blocks lie in decreasing order are lost (up to 15 of a ZIP file), the others"
echo "move down by as many, and ones fill the top: write increasing lines, or blocks of one line (ZIPS, RLE, none)"
