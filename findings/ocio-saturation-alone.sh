#!/usr/bin/env bash
# OpenColorIO: a GradingPrimaryTransform whose saturation is 0, with and without a clamp at 100 that
# none of the values reaches.
set -euo pipefail
module=python3-pyopencolorio=2.1.2+dfsg1-4+b3 library=libopencolorio2.1=2.1.2+dfsg1-4+b3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
apt-get -qq download "$module" "$library" libyaml-cpp0.7 libpystring0 libimath-3-1-29 libexpat1 \
  2>"$work/log" || { cat "$work/log" >&2; exit 2; }
for package in ./*.deb; do dpkg -x "$package" .; done
export LD_LIBRARY_PATH=$PWD/usr/lib/x86_64-linux-gnu PYTHONPATH=$PWD/usr/lib/python3/dist-packages

/usr/bin/python3.11 - <<'END'
import sys
import PyOpenColorIO as ocio

colour = [0.8, 0.4, 0.2]
luma = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]


def graded(style, clamp):
    values = ocio.GradingPrimary(style)
    values.saturation = 0
    if clamp:
        values.clampWhite = 100
    transform = ocio.GradingPrimaryTransform(style=style)
    transform.setValue(values)
    transform.validate()
    processor = ocio.Config.CreateRaw().getProcessor(transform)
    return processor.getDefaultCPUProcessor().applyRGB(list(colour))


def near(a, b):
    return all(abs(x - y) < 1e-5 for x, y in zip(a, b))


print("OpenColorIO", ocio.GetVersion())
print("expected: without saturation a colour becomes its luma, %.4f" % luma)
same = True
for style in (ocio.GRADING_LIN, ocio.GRADING_LOG, ocio.GRADING_VIDEO):
    alone, clamped = graded(style, False), graded(style, True)
    print("seen, %s: alone %s; with a clamp at 100 %s" % (
        style.name, ["%.4f" % x for x in alone], ["%.4f" % x for x in clamped]))
    same = same and near(alone, colour) and near(clamped, [luma] * 3)
if not same:
    sys.exit("this has changed")
print("so saturation alone is ignored, until a control that changes nothing is set beside it")
END
