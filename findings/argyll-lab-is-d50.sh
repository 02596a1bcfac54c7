#!/usr/bin/env bash
# ArgyllCMS: the Lab values that spec2cie computes for a perfect white from its spectrum, for three
# illuminants. Beside LAB it writes columns named after the illuminant where that is not D50, as ALAB.
set -euo pipefail
package=argyll=2.3.1+repack-1.1+b1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download "$package" 2>log || { cat log >&2; exit 2; }
dpkg -x ./*.deb .

{
  printf 'CTI3\n\nDESCRIPTOR "white"\nORIGINATOR "white"\nDEVICE_CLASS "OUTPUT"\nCOLOR_REP "RGB_LAB"\n'
  printf 'SPECTRAL_BANDS "36"\nSPECTRAL_START_NM "380"\nSPECTRAL_END_NM "730"\n\n'
  printf 'NUMBER_OF_FIELDS 40\nBEGIN_DATA_FORMAT\nSAMPLE_ID RGB_R RGB_G RGB_B'
  printf ' SPEC_%d' $(seq 380 10 730)
  printf '\nEND_DATA_FORMAT\n\nNUMBER_OF_SETS 1\nBEGIN_DATA\n1 100 100 100'
  printf ' 100.0%.0s' $(seq 36)
  printf '\nEND_DATA\n'
} >white.ti3

echo "${package/=/ }"
echo "expected: LAB 100 0 0 for a perfect white under the illuminant that was chosen"
changed=
for illuminant in D50 D65 A; do
  usr/bin/spec2cie -i $illuminant -n white.ti3 out.ti3 >log 2>&1 || { cat log >&2; exit 2; }
  awk -v illuminant=$illuminant '
    $1 == "SAMPLE_ID" { for (i = 1; i <= NF; i++) column[$i] = i }
    $1 == "1" && NF > 9 {
      printf "seen: %s: LAB %.1f %.1f %.1f", illuminant, $column["LAB_L"], $column["LAB_A"], $column["LAB_B"]
      own = illuminant "LAB_"
      if (own "L" in column)
        printf "; %s %.1f %.1f %.1f", own "*", $column[own "L"], $column[own "A"], $column[own "B"]
      print ""
    }' out.ti3 | sed 's/-0\.0/0.0/g' | tee line
  case $illuminant in
  D65) grep -q 'LAB 100.0 -2.4 -19.4; D65LAB_. 100.0 0.0 0.0' line || changed=1 ;;
  A) grep -q 'LAB 100.0 22.2 48.9; ALAB_. 100.0 0.0 0.0' line || changed=1 ;;
  esac
done
[ -z "$changed" ] || { echo "this has changed" >&2; exit 1; }
echo "so LAB is always against D50; compare D65LAB or ALAB with Lab values that have the illuminant's own white"
