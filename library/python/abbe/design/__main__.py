"""`abbe design`."""
import argparse
import contextlib
import json
import math
import os
import re
import sys

import numpy as np

import abbe

from .._arguments import Parser, count, near, target
from . import pane, prism, solid

VERBS = ("pane", "prism", "achromat")
USAGE = """\
usage: abbe design pane TARGET.png -o pane.obj [OPTION...]
       abbe design prism --deviation DEG | --spread DEG [OPTION...]
       abbe design achromat --deviation DEG | --focal LENGTH [OPTION...]

Designs what throws the light that is wanted: a pane of glass whose caustic is a picture, a prism
whose fan is as wide as wanted, a pair of glasses without colour. 'abbe design pane --help' and so
on show the options.
"""
UNITS = {"": 1, "um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1, "in": 0.0254, "ft": 0.3048}
GLASSES = ("fused-silica", "n-bk7", "k5", "n-bak4", "n-baf10", "f2", "sf10", "sf11", "n-sf11",
           "pmma", "fluorite")
VEIL = 0.02  # of the even light, the least that falls everywhere: light cannot be torn apart
SIDES = 16, 1024
LUMINANCE = (0.2126, 0.7152, 0.0722)  # of linear Rec.709
BLACK = 0.002  # of white; margins that are darker get no light at all
SLACK = 1.25  # by which a cut is beyond its limits when its design stops before the end
SAMPLES = 7  # wavelengths of the picture that is predicted


def number(text):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number")
    return value


def length(text):
    found = re.fullmatch(r"\s*([0-9.eE+-]+?)\s*([a-z]*)\s*", text)
    if found is None or found[2] not in UNITS:
        raise argparse.ArgumentTypeError(f"'{text}' is not a length such as 0.1, 10cm or 4in")
    value = number(found[1]) * UNITS[found[2]]
    if not 1e-6 <= value <= 1e6:
        raise argparse.ArgumentTypeError(f"'{text}' is not from a micrometre to 1e6 m")
    return value


def light(text):
    if text == "sun":
        return None
    parts = text.split(",")
    try:
        place = tuple(number(part.strip()) for part in parts)
    except argparse.ArgumentTypeError:
        place = ()
    if len(place) != 3:
        raise argparse.ArgumentTypeError(f"'{text}' is neither sun nor a lamp's place X,Y,Z in m, "
                                         "such as 0,0,1")
    return place


def degrees(least, most):
    def read(text):
        value = number(text)
        if not least < value < most:
            raise argparse.ArgumentTypeError(f"{text} is not between {least} and {most} degrees")
        return math.radians(value)
    return read


def _parser(verb, usage, about, epilog):
    out = Parser(prog=f"abbe design {verb}", usage=usage, allow_abbrev=False, description=about,
                 epilog=epilog, formatter_class=argparse.RawDescriptionHelpFormatter)
    out.add_argument("--materials", metavar="TABLE", default="default",
                     help="the table of materials: default, thesis or a file (default)")
    out.add_argument("--json", action="store_true", help="what is found as JSON")
    return out


def _pane_parser():
    out = _parser("pane", "abbe design pane TARGET.png -o pane.obj [-o pane.stl] [OPTION...]",
                  "A pane, flat on the side of the light, that throws a picture on a screen behind it.",
                  "examples:\n  abbe design pane face.png -o pane.obj --scene pane.yaml\n"
                  "  abbe trace pane.yaml -o pane.exr --png traced.png\n"
                  "  abbe design pane face.png -o pane.stl --size 15cm --distance 1 --light 0,0,2")
    out._negative_number_matcher = re.compile(r"-[\d.]")  # a place may begin with one
    out.add_argument("target", nargs="?", help=argparse.SUPPRESS)
    add = out.add_argument
    add("-o", "--output", metavar="FILE", action="append", type=target(".obj", ".stl"),
        help="the pane: .obj in metres with its normals, or .stl in millimetres; may be repeated")
    add("--scene", metavar="FILE.yaml", type=target(".yaml"),
        help="a scene of the light, the pane and the screen, for abbe trace; needs an .obj")
    add("--png", metavar="FILE.png", type=target(".png"),
        help="the picture that it will throw, in colour")
    add("--size", metavar="LENGTH", type=length, default=0.1, help="of the pane, across (10cm)")
    add("--distance", metavar="LENGTH", type=length, default=0.5,
        help="from the pane to the screen (50cm)")
    add("--picture", metavar="LENGTH", type=length,
        help="of the picture, across (as wide as the pane's light without a cut)")
    add("--thickness", metavar="LENGTH", type=length, default=0.01, help="of the pane, mean (1cm)")
    add("--material", metavar="NAME", default="pmma", help="of the pane (pmma)")
    add("--light", metavar="sun|X,Y,Z", type=light, default=None,
        help="the sun, straight on, or a lamp's place from the middle of the pane, m (sun)")
    add("--white", metavar="X", type=number,
        help="how bright the picture's white is, in units of the even light without a cut (as "
        "bright as there is light for); what is left falls evenly on the picture")
    add("--depth", metavar="LENGTH", type=length, help="the deepest cut that can be made")
    add("--radius", metavar="LENGTH", type=length, help="the smallest radius that can be cut")
    add("--cells", metavar="N", type=count(16, 2048),
        help="places across that the height is known at (1.5 a pixel)")
    add("-q", "--quiet", action="store_true", help="no progress")
    return out


def _read(path):
    """The linear luminance of a PNG, from 0 to 1, its largest being 1."""
    try:
        with open(path, "rb") as file:
            if file.read(8) != b"\x89PNG\r\n\x1a\n":
                raise pane.Refused(f"{path}: it is no PNG; the picture that is wanted is a PNG file")
    except OSError as error:
        raise pane.Refused(f"{path}: {error.strerror}") from None
    values = pane.decoded(abbe.load(path).rgb.astype(float)) @ LUMINANCE
    if not all(SIDES[0] <= side <= SIDES[1] for side in values.shape):
        raise pane.Refused(f"{path}: it has {values.shape[1]} x {values.shape[0]} pixels; a side is "
                           f"from {SIDES[0]} to {SIDES[1]}")
    if values.max() - values.min() < 1 / 255:
        raise pane.Refused(f"{path}: it is blank; a pane throws a picture that is brighter in some "
                           "places than in others")
    return values / values.max()


def _grey(luminance):
    return abbe.Picture(np.repeat(luminance[:, :, None], 3, 2), space="rec709")


def _lit(q, picture):
    """The rectangle (top, bottom, left, right) that light is sent to: without black margins, unless
    they get what a darker white leaves."""
    box = []
    for axis in (1, 0):
        lit, count = np.flatnonzero((picture > BLACK).any(axis)), picture.shape[1 - axis]
        ends = max(lit[0] - 1, 0), min(lit[-1] + 2, count)
        box += ends if q.white is None and SIDES[0] <= ends[1] - ends[0] < 0.9 * count else (0, count)
    return box


def _wanted(q, picture, box):
    """The target in units of the even light, in the rectangle: white times the picture, and the rest
    as a veil."""
    most = (1 - VEIL) / picture.mean()
    white = most if q.white is None else q.white
    if not 0 < white <= most * (1 + 1e-9):
        raise pane.Refused(
            f"--white {white:g} is not above 0" if white <= 0 else
            f"{q.target}: with a white of {white:g} times the even light it throws "
            f"{white * picture.mean() + VEIL:.3g} times the light that there is; --white may be "
            f"{math.floor(100 * most) / 100:g} at the most")
    lit = picture[box[0]:box[1], box[2]:box[3]]
    return white * lit + (1 - white * picture.mean()) * picture.size / lit.size


def _limits(q, face, slack=1):
    """The depth and the least radius of a dip; refused where they cannot be cut, by more
    than the slack."""
    depth, radius = float(np.ptp(face.h)), float(pane.dip_radius(face))
    so_far = "without the picture's details " if slack > 1 else ""
    if q.depth is not None and depth > slack * q.depth:
        raise pane.Refused(f"{so_far}the cut is {1e3 * depth:.3g} mm deep, and --depth is "
                           f"{1e3 * q.depth:g} mm; a larger --distance, a smaller --size or a "
                           "darker --white makes it flatter")
    if q.radius is not None and slack * radius < q.radius:
        raise pane.Refused(f"{so_far}the smallest dip has a radius of {1e3 * radius:.3g} mm, and "
                           f"--radius is {1e3 * q.radius:g} mm; a larger --distance or a darker --white makes "
                           "it rounder")
    if face.h.max() > slack * 0.9 * q.thickness:
        raise pane.Refused(f"{so_far}the cut goes {1e3 * face.h.max():.3g} mm deep from the mean face, "
                           f"through a pane that is {1e3 * q.thickness:g} mm thick; make --thickness or "
                           "--distance larger")
    return depth, radius


def _designed(q, wanted, setup, n):
    """pane.design, which stops as soon as the cut is clearly beyond what can be made."""
    on = not q.quiet and sys.stderr.isatty()

    def progress(done, face):
        if on:
            print(f"\rpane {100 * done:3.0f} %", end="", file=sys.stderr, flush=True)
        _limits(q, face, SLACK)
    try:
        return pane.design(wanted, setup, n, progress=progress)
    finally:
        if on:
            print("\r\033[K", end="", file=sys.stderr)


def _predict(setup, face, material):
    """The picture in linear Rec.709, in units of the even light, and how far colours are apart: the
    root of the mean square of landings about their mean, in pixels."""
    nm, weights = abbe.weights(SAMPLES, space="rec709")
    luminance = weights @ LUMINANCE
    faces = [pane.Face(setup, face.h, n) for n in material.n(nm)]
    rgb = sum(pane.thrown(one)[:, :, None] * weight for one, weight in zip(faces, weights))
    share, square = luminance / luminance.sum(), 0
    for part in ("u", "v"):
        mean = sum(s * getattr(one, part) for s, one in zip(share, faces))
        square += sum(s * (getattr(one, part) - mean)**2 for s, one in zip(share, faces))
    y = rgb @ LUMINANCE
    return rgb / y.mean(), float(np.sqrt(np.mean(square)))


def _write(path, data):
    """Beside its target until it is on the disk, and renamed: the old file or the new one."""
    folder, name = os.path.split(os.path.realpath(path))
    beside = os.path.join(folder, f".abbe-{os.getpid()}-0.part")
    try:
        with open(beside, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, os.path.join(folder, name))
    except OSError as error:
        with contextlib.suppress(OSError):
            os.unlink(beside)
        raise pane.Refused(f"{path}: could not be written and is as it was: {error.strerror}") from None


def _pane(argv):
    parser = _pane_parser()
    q = parser.known(argv)
    if q.target is None:
        parser.error("which picture? Give a PNG file")
    if not q.output:
        parser.error("where to? Give -o FILE.obj or -o FILE.stl")
    files = [*q.output, *filter(None, (q.scene, q.png))]
    real = [os.path.realpath(name) for name in [q.target, *files]]
    if len(set(real)) < len(real):
        parser.error("two files have one name: the target and all that is written differ")
    meshes = [name for name in q.output if name.lower().endswith(".obj")]
    if q.scene and not meshes:
        parser.error("--scene needs the pane as an .obj, which keeps its normals: -o FILE.obj")
    if q.light is not None and q.light[2] <= q.thickness:
        parser.error(f"--light {q.light[2]:g} m is not above the pane, whose back is at "
                     f"{q.thickness:g} m")
    picture = _read(q.target)
    box = _lit(q, picture)
    wanted = _wanted(q, picture, box)
    material = abbe.Materials(q.materials)[q.material]
    nm, weights = abbe.weights(SAMPLES)
    n = float(np.average(material.n(nm), weights=weights[:, 1]))
    if not 1.05 < n < 4 or np.max(material.k(nm)) > 1e-3:
        raise pane.Refused(f"--material {q.material}: a pane is of a clear material")
    rows, columns = picture.shape
    cells = q.cells or round(1.5 * columns)
    if not 16 <= round(cells * rows / columns) <= 2048:
        raise pane.Refused(f"--cells {cells}: a picture of {columns} x {rows} pixels has "
                           f"{round(cells * rows / columns)} of them down; 16 to 2048 are right")
    setup = pane.Setup(picture.shape, q.size, q.distance, q.thickness, q.light, q.picture, cells)
    face = pane.Face(setup, _designed(q, wanted, setup.part(*box), n).h, n)
    depth, radius = _limits(q, face)
    rgb, blur = _predict(setup, face, material)
    same = abbe.compare(_grey(picture), _grey(rgb @ LUMINANCE), best_scale=True, structure=True)
    found = {"ssim": same["ssim"],
             "white": wanted.max(), "floor": np.percentile((rgb @ LUMINANCE)[box[0]:box[1], box[2]:box[3]], 5)
             / wanted.max(),
             "depth_mm": 1e3 * depth, "dip_radius_mm": 1e3 * radius,
             "picture_mm": 1e3 * setup.picture, "pixel_mm": 1e3 * setup.pixel,
             "colour_blur_pixels": blur, "colour_blur_mm": 1e3 * setup.pixel * blur,
             "sun_blur_mm": 0 if q.light else 1e3 * q.distance * math.radians(pane.SUN_DEGREES)}
    for name in q.output:
        _write(name, (solid.obj if name in meshes else solid.stl)(face))
    if q.scene:
        folder = os.path.dirname(q.scene) or "."
        table = (q.materials if q.materials in ("default", "thesis")
                 else os.path.relpath(q.materials, folder))
        _write(q.scene, solid.scene(setup, os.path.relpath(meshes[0], folder), table, q.material,
                                    f"a pane that throws {os.path.basename(q.target)}")
               .encode(errors="surrogateescape"))
    if q.png:
        abbe.Picture(rgb / wanted.max(), space="rec709").save(q.png, view="Plain")
    if q.json:
        print(json.dumps(found, indent=2))
        return
    print(f"picture     {found['picture_mm']:.4g} mm across, white {found['white']:.3g} times the "
          f"even light; predicted SSIM {found['ssim']:.3f}\n"
          f"floor       the darkest twentieth gets {100 * found['floor']:.2g} % of white's light\n"
          f"cut         {found['depth_mm']:.3g} mm deep, the smallest dip's radius "
          f"{found['dip_radius_mm']:.3g} mm\n"
          f"colours     {blur:.2f} pixels apart ({found['colour_blur_mm']:.2g} mm)")
    if not q.light:
        print(f"sun         its disk, which is left out, blurs by {found['sun_blur_mm']:.2g} mm "
              f"({found['sun_blur_mm'] / found['pixel_mm']:.2g} pixels)")


def _indices(q, names):
    """{name: the indices at d, F, C and at the wavelengths seen} of what is clear there."""
    table, out = abbe.Materials(q.materials), {}
    every = names or (GLASSES if q.materials == "default" else list(table))
    nm = np.concatenate([prism.LINES, prism.SEEN])
    for name in every:
        material = table[name]
        try:
            n, k = material.n(nm), material.k(nm)
        except abbe.Error:
            if names:
                raise
            continue
        if k.max() < 1e-4 and n[0] > 1.01 and n[1] > n[2]:
            out[name] = n
        elif names:
            raise pane.Refused(f"{name}: it is no clear glass with colours to spread")
    return out


def _shown(q, columns, rows):
    if q.json:
        print(json.dumps([dict(zip(columns, row)) for row in rows], indent=2))
        return
    print(" ".join(f"{name:>13}" for name in columns))
    for row in rows:
        print(" ".join(f"{v:>13}" if isinstance(v, str) else f"{v:>13.5g}" for v in row))


def _prism(argv):
    parser = _parser("prism", "abbe design prism --deviation DEG | --spread DEG [OPTION...]",
                     "The apex of a prism at minimum deviation, in degrees, for each glass.",
                     "examples:\n  abbe design prism --deviation 45 --material sf10\n"
                     "  abbe design prism --deviation 45 --spread 2\n"
                     "  abbe design prism --spread 1 --material n-bk7")
    add = parser.add_argument
    add("--deviation", metavar="DEG", type=degrees(0, 180), help="of the line d")
    add("--spread", metavar="DEG", type=degrees(0, 90), help="from the line C to the line F; with "
        "--deviation the glasses are in the order of how near they come")
    add("--material", metavar="NAME", action="append", help="a glass; may be repeated (all clear)")
    q = parser.known(argv)
    if q.deviation is None and q.spread is None:
        parser.error("what for? Give --deviation DEG or --spread DEG")
    rows = []
    for name, n in _indices(q, q.material).items():
        apex = (prism.apex_for(q.deviation, n[0]) if q.deviation is not None
                else prism.apex_for_spread(q.spread, n))
        if not 0 < apex < 2 * np.arcsin(1 / n[0]):
            continue
        deviation, incidence = prism.least_deviation(apex, n[0])
        through = pane.fresnel(np.cos(incidence), np.cos(apex / 2), 1, n[0], faces=2)
        spread = prism.spread_of(apex, n)
        if math.isfinite(spread):
            rows.append((name, *np.degrees([apex, incidence, deviation, spread]), through))
    if not rows:
        raise pane.Refused("no glass of these does that before its second face turns light back; ask "
                           "for less, or for a glass of higher index")
    wanted = math.degrees(q.spread or 0)
    rows.sort(key=lambda row: abs(row[4] - wanted) if q.deviation and wanted else row[1])
    _shown(q, ("glass", "apex", "incidence", "deviation", "spread", "transmitted"), rows)


def _achromat(argv):
    parser = _parser("achromat", "abbe design achromat --deviation DEG | --focal LENGTH [OPTION...]",
                     "Pairs of glasses that bring the lines F and C together: two prisms, cemented base "
                     "to apex,\nor two thin lenses. The pairs with the least colour left from 436 to 656 "
                     "nm come first.",
                     "examples:\n  abbe design achromat --deviation 10 --glasses n-bk7,f2\n"
                     "  abbe design achromat --focal 20cm")
    add = parser.add_argument
    add("--deviation", metavar="DEG", type=degrees(0, 90), help="of the pair of prisms, of the line d")
    add("--focal", metavar="LENGTH", type=length, help="of the pair of lenses, at the line d")
    add("--glasses", metavar="A,B", help="two or more, comma-separated (all clear ones)")
    add("--count", metavar="N", type=count(1, 100000), default=5,
        help="pairs that are shown (5)")
    q = parser.known(argv)
    if (q.deviation is None) == (q.focal is None):
        parser.error("what for? Give --deviation DEG for prisms or --focal LENGTH for lenses")
    glasses = _indices(q, q.glasses.split(",") if q.glasses else None)
    if len(glasses) < 2:
        parser.error("a pair is of two glasses")
    rows = []
    for a, first in glasses.items():
        for b, second in glasses.items():
            if prism.abbe_number(first) < prism.abbe_number(second) + 1:
                continue
            if q.focal is not None:
                pair = prism.lens_pair(q.focal, first, second)
                seen = prism.pair_focal(pair, (first[0], second[0]), (first[3:], second[3:]))
            else:
                pair = prism.prism_pair(q.deviation, first, second)
                seen = np.degrees(prism.pair_deviation(pair, first[3:], second[3:]))
                pair = np.degrees(pair)
            if np.all(np.isfinite(seen)) and np.all(np.abs(pair) < (90 if q.deviation else np.inf)):
                rows.append((a, b, *pair, float(np.ptp(seen))))
    if not rows:
        raise pane.Refused("no pair of these does that; the glasses are too much alike, or the "
                           "deviation is too large")
    rows.sort(key=lambda row: row[4])
    _shown(q, ("first", "second", *(("apex 1", "apex 2", "left, deg") if q.deviation is not None
                                    else ("f 1, m", "f 2, m", "left, m"))), rows[:q.count])


def main():
    """Exit codes: 0 done, 1 failed, 2 used wrongly."""
    word = sys.argv[1] if len(sys.argv) > 1 else ""
    if word not in VERBS:
        wants = word in ("--help", "-h", "-?")
        text = USAGE if wants or not word else (
            f"abbe design: there is no '{word}'; there are {', '.join(VERBS)}{near(word, VERBS)}\n"
            "Try 'abbe design --help'.\n")
        (sys.stdout if wants else sys.stderr).write(text)
        return 0 if wants else 2
    try:
        {"pane": _pane, "prism": _prism, "achromat": _achromat}[word](sys.argv[2:])
        sys.stdout.flush()
    except (pane.Refused, abbe.Error, OSError) as error:
        sys.stderr.write(f"abbe design {word}: {error}\n")
        return 1
    except KeyboardInterrupt:
        sys.stderr.write(f"abbe design {word}: stopped\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
