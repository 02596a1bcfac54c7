"""Where two pictures put a caustic's light and its hues, for script/witness: outlines.py NAME FIRST
SECOND DARK prints a row of its table. DARK is SECOND without its caustic; FIRST has it as a layer.

The outline is that of the brightest pixels which hold a share of the light; a hue is a sixth of the
circle of hues. Pixels are smoothed a little first, since noise alone would fray an outline.
"""
import sys

import abbe
import numpy

Y = numpy.array((0.2126390, 0.7151687, 0.0721923))


def smooth(rgb, sigma=1.0):
    """Light that would leave the picture stays at its edge."""
    reach = int(numpy.ceil(3 * sigma))
    kernel = numpy.exp(-0.5 * (numpy.arange(-reach, reach + 1) / sigma) ** 2)
    for axis in (0, 1):
        rgb = numpy.moveaxis(rgb, axis, 0)
        out, last = numpy.zeros_like(rgb), len(rgb) - 1
        for shift, weight in zip(range(-reach, reach + 1), kernel / kernel.sum()):
            numpy.add.at(out, numpy.clip(numpy.arange(last + 1) + shift, 0, last), weight * rgb)
        rgb = numpy.moveaxis(out, 0, axis)
    return rgb


def inside(light, share):
    """The brightest pixels that hold the share of the light."""
    bright = numpy.maximum(light, 0)
    order = numpy.argsort(-bright, axis=None, kind="stable")
    held = numpy.cumsum(bright.flat[order])
    mask = numpy.zeros(bright.size, dtype=bool)
    mask[order[:numpy.searchsorted(held, share * held[-1]) + 1]] = True
    return mask.reshape(bright.shape)


def rim(mask):
    """Pixels inside beside one outside or at the picture's edge, as places [n, 2]."""
    wide = numpy.pad(mask, 1)
    inner = wide[:-2, 1:-1] & wide[2:, 1:-1] & wide[1:-1, :-2] & wide[1:-1, 2:]
    return numpy.argwhere(mask & ~inner)


def apart(first, second):
    """Mean distance from each place to the nearest of the other side, both ways, pixels."""
    near = [min(numpy.hypot(*(places - at).T)) for here, places in ((first, second), (second, first))
            for at in here]
    return numpy.mean(near)


def hues(rgb):
    """Sixth of the circle of each pixel, and how far it is from grey."""
    most = rgb.argmax(axis=2)
    weight = rgb.max(axis=2) - rgb.min(axis=2)
    after, before = (numpy.take_along_axis(rgb, ((most + k) % 3)[..., None], 2)[..., 0] for k in (1, 2))
    angle = 2 * most + (after - before) / numpy.where(weight > 0, weight, 1)
    return numpy.floor(angle + 6.5).astype(int) % 6, weight


def agreement_of_hue(hue, first, second):
    """Overlap of the two distributions, distance of their centres; None where a side has none."""
    weight = [numpy.where(which == hue, size, 0) for which, size in (first, second)]
    if not all(one.sum() > 0 for one in weight):
        return None
    weight = [one / one.sum() for one in weight]
    places = numpy.indices(weight[0].shape)
    centre = [[(one * axis).sum() for axis in places] for one in weight]
    return numpy.minimum(*weight).sum(), numpy.hypot(*numpy.subtract(*centre))


def main(name, first, second, dark):
    rgb = [abbe.load(first).layer("caustic").astype(float),
           abbe.load(second).layer().astype(float) - abbe.load(dark).layer()]
    print(f"| {name} | {(rgb[1] @ Y).sum() / (rgb[0] @ Y).sum():.3f} |", end="")
    rgb = [smooth(one) for one in rgb]
    for share in (0.5, 0.9):
        a, b = (inside(one @ Y, share) for one in rgb)
        print(f" {(a & b).sum() / (a | b).sum():.2f}, {apart(rim(a), rim(b)):.1f} |", end="")
    told = [hues(one) for one in rgb]
    for hue in range(5):
        both = agreement_of_hue(hue, *told)
        print(" - |" if both is None else " %.2f, %.1f |" % both, end="")
    print()


main(*sys.argv[1:])
