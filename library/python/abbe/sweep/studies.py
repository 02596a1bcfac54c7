"""Instead of a sweep: how a frame's time grows."""
import math
import os

from . import grids, show
from .table import Wrong, number, written

# What is changed, and the unit of its numbers.
SCALINGS = {"photons": "cells of the photon grid", "wavelengths": "wavelengths", "pixels": "pixels",
            "faces": "faces of the refractors",
            "share": "refractors' share of the view, 1: the scene's own"}
MOST_FACES = 2000000
PARTS = ("frame_ms", "light_ms", "eye_ms", "baseline_ms")


def _time(sweep, scene, setting, side):
    """Numbers of a frame at that size; nothing is compared."""
    scene.render(width=side, height=side, backend=sweep.backend, **grids.request(setting))
    out = scene.times(frames=sweep.frames, enough_ms=3000)[0]
    return out | scene.times(baseline=3)[0]


def _steps(sweep, base, side):
    """Axis, size, and how to time it, one thing changed at a time."""
    scene = sweep.scene
    for count in (side * eighths // 8 for eighths in (1, 2, 4, 8, 16)):
        yield "photons", count ** 2, scene, base.but(photons=count), side
    for count in (1, 3, 7, 14, 28, 56):
        yield "wavelengths", count, scene, base.but(wavelengths=count), side
    for pixels in (side // 4, side // 2, side, 2 * side):
        yield "pixels", pixels ** 2, scene, base, pixels
    finer = sweep.open()
    for step in range(4):
        faces = finer.plan()["mesh_faces"]
        if step > 0 and faces > MOST_FACES:
            break
        yield "faces", faces, finer, base, side
        finer.refine()
    half = math.radians(scene.camera["fov"]) / 2
    for share in (1 / 16, 1 / 4, 1, 2):
        scene.look(fov=math.degrees(2 * math.atan(math.tan(half) / math.sqrt(share))))
        yield "share", share, scene, base, side


def slope(points):
    """Of log time against log size, by least squares: 1 is proportional, 0 free."""
    x, y = ([math.log(value) for value in values] for values in zip(*points))
    spread = len(x) * sum(a * a for a in x) - sum(x) ** 2
    return (len(x) * sum(a * b for a, b in zip(x, y)) - sum(x) * sum(y)) / spread if spread else \
        math.nan


def scaling(sweep, q, bar):
    """From one setting of the default profile one thing is changed at a time, and the frame timed
    as a sweep times it. Faces are those of the refractors, each cut into four alike, so that the
    shape stays; the share of the view grows by a narrower field of view."""
    side = q.size[0] if q.size else 256
    if side < 16 or side % 8:
        raise Wrong(f"the base picture has {side} pixels a side; it may have 16 or more, in eights")
    if q.plot:
        show.figures()
    (base,), *_ = grids.expand(sweep.scene, [{"wavelengths": [7], "photons": [side // 2],
                                              "map": [2 * side], "samples": [1]}])
    rows = []
    try:
        for at, (axis, x, scene, setting, pixels) in enumerate(_steps(sweep, base, side)):
            bar.of("scaling", min(at, 23), 24)
            rows.append((axis, x, _time(sweep, scene, setting, pixels)))
    except KeyboardInterrupt:
        raise Wrong("stopped; nothing was written") from None
    bar.end()
    with written(q.output) as to:
        to.write(f"# scene: {sweep.path}\n# base: {base.label}\naxis,x,{','.join(PARTS)}\n")
        for axis, x, numbers in rows:
            to.write(",".join([axis, number(x), *(number(numbers[part]) for part in PARTS)]) + "\n")
    slopes = {axis: slope([(x, numbers["frame_ms"]) for name, x, numbers in rows if name == axis])
              for axis in SCALINGS}
    print(f"{sweep.path}; {base.label}\n\n| what grows | | frame, ms | light's passes | eye's passes "
          "| baseline |\n|---|---|---|---|---|---|")
    seen = set()
    for axis, x, numbers in rows:
        first = f"{SCALINGS[axis]} (slope {slopes[axis]:.2f})" if axis not in seen else ""
        seen.add(axis)
        print(f"| {first} | {x:.4g} | " + " | ".join(f"{numbers[part]:.1f}" for part in PARTS) + " |")
    if q.plot:
        _plot(q.plot, sweep, rows, slopes, base, side)


def _plot(path, sweep, rows, slopes, base, side):
    pyplot = show.figures()
    figure, axes = pyplot.subplots(figsize=(9.6, 5.6))
    faces = sweep.scene.plan()["mesh_faces"]
    at_base = {"photons": base.photons ** 2, "wavelengths": base.wavelengths, "pixels": side ** 2,
               "faces": faces or 1, "share": 1}
    for axis, text in SCALINGS.items():
        own = [(x / at_base[axis], numbers["frame_ms"]) for name, x, numbers in rows if name == axis]
        axes.plot(*zip(*own), "o-", markersize=4, label=f"{text} (slope {slopes[axis]:.2f})")
    times = [numbers["frame_ms"] for *_, numbers in rows]
    at = next(numbers["frame_ms"] for axis, x, numbers in rows
              if axis == "pixels" and x == side ** 2)
    # as far as the times go, so that the guide does not stretch the axis
    ends = [max(min(times) / at, 1 / 64), min(max(times) / at, 16)]
    axes.plot(ends, [at * end for end in ends], "--", color="grey", label="proportional")
    axes.set(xscale="log", yscale="log", xlabel="times the base setting's",
             ylabel="frame, ms (median)",
             title=f"{os.path.basename(sweep.path)}: how a frame's time grows")
    axes.legend()
    show.save(figure, path)
    pyplot.close(figure)
