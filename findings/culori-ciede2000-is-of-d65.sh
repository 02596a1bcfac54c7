#!/usr/bin/env bash
# culori: the CIEDE2000 of Lab values, for four pairs whose differences are published [Sharma2005, table 1]. The
# formula knows no illuminant: it is a function of six numbers.
set -euo pipefail
package=culori@4.0.2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm pack --silent "$package" >log 2>&1 || { cat log >&2; exit 2; }
tar -xzf ./*.tgz
echo "$package (npm)"
echo "expected: CIEDE2000 of the Lab values that it is given, 2.0425, 7.1792, 7.2195, 27.1492"
cat >pairs.mjs <<'JS'
import { differenceCiede2000 } from './package/bundled/culori.mjs';
const difference = differenceCiede2000();
const pairs = [
  [50, 2.6772, -79.7751, 50, 0, -82.7485],
  [50, 2.49, -0.001, 50, -2.49, 0.001],
  [50, 2.49, -0.001, 50, -2.49, 0.0011],
  [50, 2.5, 0, 73, 25, -18],
];
const all = (mode) => pairs.map((p) => difference(
  { mode, l: p[0], a: p[1], b: p[2] }, { mode, l: p[3], a: p[4], b: p[5] }).toFixed(4)).join(', ');
const lab = all('lab'), lab65 = all('lab65');
console.log(`seen: mode 'lab': ${lab}; mode 'lab65': ${lab65}`);
process.exit(lab === '1.8566, 7.1502, 7.1502, 27.4986' && lab65 === '2.0425, 7.1792, 7.2195, 27.1492' ? 0 : 1);
JS
node pairs.mjs || { echo "this has changed" >&2; exit 1; }
echo "so Lab values against D50, as instruments and profiles give them, are adapted to D65 first, which takes 9 % of"
echo "the first difference: hand them over as 'lab65', whatever their white is"
