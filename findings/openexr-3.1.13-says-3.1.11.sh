#!/usr/bin/env bash
# OpenEXR as Debian 13 has it, package version 3.1.13: which version its headers, pkg-config and
# file names say. The headers are asked by the compiler, with a macro as a program would ask.
set -euo pipefail
package=libopenexr-dev=3.1.13-2 library=libopenexr-3-1-30=3.1.13-2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -n 1)
mkdir -p lists/partial cache/archives/partial
echo "deb $mirror trixie main" >sources.list
options=(-qq -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$work/lists"
  -o Dir::Cache="$work/cache" -o APT::Sandbox::User=root)
{ apt-get "${options[@]}" update && apt-get "${options[@]}" download "$package" "$library"; } >log 2>&1 ||
  { cat log >&2; exit 2; }
for file in ./*.deb; do dpkg -x "$file" .; done
echo 'OPENEXR_VERSION_STRING OPENEXR_VERSION_PATCH' |
  cpp -P -I usr/include/OpenEXR -I usr/include/Imath -include OpenEXRConfig.h | tail -n 1 >macros
config=$(sed -n 's/^Version: *//p' usr/lib/x86_64-linux-gnu/pkgconfig/OpenEXR.pc)
name=$(basename usr/lib/x86_64-linux-gnu/libOpenEXRCore-3_1.so.*.*)
echo "package 3.1.13-2"
echo "expected: 3.1.13 wherever a program can ask"
echo "seen: pkg-config $config; macros $(cat macros); library $name"
if [ "$config" != 3.1.11 ] || ! grep -q '"3\.1\.11" *11' macros; then
  echo "this has changed" >&2
  exit 1
fi
echo "so a check for 3.1.12 or 3.1.13 by version fails on a system that has 3.1.13"
