"""One setting, rendered or traced, timed as the median of warmed frames and held against the
reference: its picture pixel by pixel, its receiver map in the reference's layout."""
import hashlib
import math
import os
import shutil
import subprocess
import tempfile
import time

import abbe
import numpy

from . import fronts, grids
from .table import Row, Table, Wrong

BANDS = 8          # in which maps are compared over wavelength
ENOUGH_MS = 3000   # slow frames vary less: three suffice where they took more
STAMP = "abbe:sweep"  # says for which scene and request a reference was traced
DEFAULTS = {"passes": 64, "texels": 256}


def compare(reference, test, scaled=False):
    """Over all of it and over the reference's caustic, where it has one; scaled: times the factor
    of least squares, or black where none above 0 brings the two nearer."""
    def held(test, **how):
        try:
            return abbe.compare(reference, test, mask="caustic", **how)
        except abbe.Error:
            return abbe.compare(reference, test, **how)

    if not scaled:
        return held(test), 1.0
    try:
        out = held(test, best_scale=True)
        return out, out.scale
    except abbe.Error:
        black = abbe.Picture(numpy.zeros(test.shape), channels=test.channels)
        for name, text in test.attributes.items():
            black[name] = text
        return held(black), 0.0


class Sweep:
    """A scene with its reference: what settings are held against."""

    def __init__(self, path, materials=None, backend="auto", frames=5, size=None):
        self.path, self.materials, self.backend, self.frames = path, materials, backend, frames
        self.scene = self.open()
        self.size = size
        self.picture = self.map = self.matched_picture = self.matched_map = None
        self.files = {"reference": "", "reference map": ""}
        self.light = None
        self.model = ""
        self.laid = None

    def open(self):
        return abbe.Scene(self.path, materials=self.materials)

    @property
    def shape(self):
        width, height = self.size or map(int, self.scene.plan()["size"].split("x"))
        if self.picture is not None:
            height, width, _ = self.picture.shape
        return {"width": width, "height": height}

    # ---- the references ----

    def load(self, picture, drawn):
        """Files that the user names; either may be None."""
        if picture:
            self.picture, self.files["reference"] = abbe.load(picture), picture
        if drawn:
            self.map, self.files["reference map"] = abbe.load(drawn), drawn

    def find(self, beside, kind, matched, seed, passes, texels, photons, progress):
        """The reference beside the table, traced where it is not of this scene and request. Written
        and read again, so that every run has the same one to the bit."""
        stem = os.path.splitext(beside)[0] + "-" + kind
        names, checkpoint = (stem + ".exr", stem + "-map.exr"), stem + ".checkpoint"
        plan = self.scene.plan()
        size = self.shape
        stamp = (f"scene {plan['hash']}, {size['width']} x {size['height']} pixels, {texels} texels "
                 f"a side, {BANDS} bands, {passes} passes of {photons or 0} photons, "
                 f"{'matched' if matched else 'full'}")
        found = [_stamped(name, stamp) for name in names]
        if None in found:
            self.scene.lay_map(None)
            traced = self.scene.trace_both(
                like=self.scene.place_map(self.backend), progress=progress, passes=passes, photons=photons,
                bands=BANDS, seed=seed, map_size=texels, checkpoint=checkpoint,
                physics="matched" if matched else "full", **size)
            for picture, name in zip(traced, names):
                picture[STAMP] = stamp
                picture.save(name)
            found = [abbe.load(name) for name in names]
        if os.path.exists(checkpoint):
            os.unlink(checkpoint)
        if kind == "matched":
            self.matched_picture, self.matched_map = found
        else:
            self.picture, self.map = found
            self.files = {"reference": names[0], "reference map": names[1]}

    def ready(self):
        """After the references: which light's map is compared, and what the model leaves out."""
        self.light = None if self.map is None else self.map.attributes.get("abbe:map_light")
        if self.matched_picture is None:
            return
        picture, _ = compare(self.picture, self.matched_picture)
        drawn, _ = compare(self.map, self.matched_map)

        def noise(comparison, metric):
            both = comparison.both_noise(metric)
            return both if math.isfinite(both) else comparison.value(metric).noise

        self.model = fronts.model_text((
            picture["ciede2000_mean"], noise(picture, "ciede2000_mean"), drawn["relative_rmse"],
            noise(drawn, "relative_rmse"), drawn.value("energy_ratio", masked=False).value))

    def table(self):
        """An empty one with what its rows will belong to."""
        if "device" not in self.scene.plan():
            self.scene.render(width=16, height=16, backend=self.backend)
        plan, size = self.scene.plan(), self.shape
        digest = hashlib.sha256()
        for image in (self.picture, self.map):
            if image is not None:
                digest.update(repr(image.shape).encode() + image.pixels.tobytes())
        return Table({
            "program": f"abbe {abbe.version()}", "scene": self.path, "scene hash": plan["hash"],
            "class": plan["class"], "size": f"{size['width']}x{size['height']}", **self.files,
            "reference hash": digest.hexdigest()[:16], "model": self.model,
            "frames": self.frames, "device": plan["device"], "machine": machine(),
            "date": time.strftime("%Y-%m-%d", time.gmtime())})

    # ---- one setting ----

    def measure(self, setting, progress=None):
        """Its row, and what was rendered."""
        row = Row(setting)
        if setting.traced:
            numbers, picture = self.scene.trace_times(
                progress=progress, passes=setting.passes, photons=setting.photons,
                filter=setting.profile == "trace-filter", frames=self.frames, enough_ms=ENOUGH_MS,
                **self.shape)
            row.update(numbers, camera_ms=numbers["frame_ms"])
            if self.picture is not None:
                self._compare_picture(row, picture, False)
            return row, picture
        scene = self.scene if setting.history < 2 else self.open()
        plain = setting.profile == "default" or setting.profile in grids.PINHOLES
        self._lay(scene)
        how = grids.request(setting) | self.shape | {"backend": self.backend}
        drawn = scene.render(**how)
        scaled = drawn["abbe:unit"] == "display brightness"
        if setting.history > 1 and self.picture is not None:
            self._compare_history(row, scene, how, drawn, scaled)
        numbers, picture = scene.times(progress=progress, frames=self.frames, enough_ms=ENOUGH_MS)
        row.update({column: numbers[key] for column, key in (
            ("frame_ms", "frame_ms"), ("fastest_ms", "fastest_ms"), ("light_ms", "light_ms"),
            ("eye_ms", "eye_ms"), ("photons_hit", "photons"), ("hit_share", "refractor_share"),
            ("fill_invented", "invented"), ("fill_lost", "lost"),
            ("polygon_layers", "polygon_layers")) if key in numbers})
        if plain:
            row["baseline_ms"] = scene.times(baseline=3)[0]["baseline_ms"]
        if self.picture is not None:
            self._compare_picture(row, picture, scaled)
        if self.matched_picture is not None:
            self._compare_matched(row, "matched_de", "ciede2000_mean", self.matched_picture,
                                  picture, scaled)
        self._measure_map(row, scene, how, scaled)
        row["camera_ms"] = scene.times(camera=3)[0]["camera_ms"]
        return row, picture

    def _lay(self, scene):
        if self.map is not None and (scene is not self.scene or self.laid is not self.map):
            scene.lay_map(self.map)
            if scene is self.scene:
                self.laid = self.map

    def _compare_history(self, row, scene, how, drawn, scaled):
        for frame in range(1, 9):
            drawn = drawn if frame == 1 else scene.render(redraw=True, **how)
            if frame in (1, 2, 4, 8):
                held, _ = compare(self.picture, drawn, scaled)
                if held.masked:
                    row[f"after_{frame}_de"] = held["ciede2000_mean"]

    def _compare_picture(self, row, picture, scaled):
        held, row["scale"] = compare(self.picture, picture, scaled)
        for region, masked in (("picture", False), ("caustic", True)):
            if masked and not held.masked:
                continue
            for column, metric in (("de", "ciede2000_mean"), ("de95", "ciede2000_p95"),
                                   ("rmse", "relative_rmse")):
                _note(row, f"{region}_{column}", held.value(metric, masked))

    @staticmethod
    def _compare_matched(row, column, metric, reference, test, scaled):
        held, _ = compare(reference, test, scaled)
        _note(row, column, held.value(metric))

    def _measure_map(self, row, scene, how, scaled):
        """Bands are of one frame, and published methods have none."""
        plan = scene.plan(**how)
        published = plan["profile"] != "default"
        thesis = plan["profile"].startswith("thesis")
        if not plan["caustics"] or (published and plan["faces"] > 1):
            return
        if self.map is None and not thesis:
            return
        whole = published or plan["history"] > 1
        drawn = scene.map(self.light, bands=0 if whole else BANDS)
        if published:
            before = drawn
            if plan["fill"] == "smear":
                scene.render(**(how | {"fill": "none"}))
                before = scene.map(self.light)
                scene.render(**how)
            _note_fill(row, before, drawn)
        if self.map is None:
            return
        if published or drawn.shape[1] % self.map.shape[1] or drawn.shape[0] % self.map.shape[0]:
            drawn = drawn.resample(self.map)
        if self.matched_map is not None:
            self._compare_matched(row, "matched_map", "relative_rmse", self.matched_map, drawn,
                                  scaled)
        held, row["map_scale"] = compare(self.map, drawn, scaled)
        for column, metric, masked in (("map_rmse", "relative_rmse", None),
                                       ("map_bands", "bands_relative_rmse", None),
                                       ("map_uv", "uv_mean", None),
                                       ("map_energy", "energy_ratio", False)):
            _note(row, column, held.value(metric, masked))


def _note(row, column, value):
    row[column], row[column + "_noise"] = value.value, value.noise


def _note_fill(row, before, after):
    """What a pass that fills the map adds to its Y here and takes off there."""
    a, b = (image.pixels[:, :, 1].astype(float) for image in (before, after))
    if a.sum() > 0:
        row["fill_invented"] = numpy.maximum(b - a, 0).sum() / a.sum()
        row["fill_lost"] = numpy.maximum(a - b, 0).sum() / a.sum()


def _stamped(name, stamp):
    if not os.path.exists(name):
        return None
    try:
        image = abbe.load(name)
    except abbe.Error:
        return None
    return image if image.attributes.get(STAMP) == stamp else None


def machine():
    name = "unknown processor"
    with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
        for line in file:
            if line.startswith("model name"):
                name = line.partition(":")[2].strip()
                break
    return f"{name}, {os.cpu_count()} threads"


# ---- whole processes ----

class Processes:
    """`abbe render` or `abbe trace` with a row's setting, by the clock: cold, with an empty cache of
    shaders, and warm, with one that such a process has filled."""

    CACHES = ("MESA_SHADER_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH")

    def __init__(self, sweep):
        self.sweep = sweep
        self.program = os.environ.get("ABBE_PROGRAM") or shutil.which("abbe")
        if not self.program:
            raise Wrong("--processes runs the program abbe, and there is none on the path; name it "
                        "in ABBE_PROGRAM")
        self.folder = tempfile.TemporaryDirectory(prefix="abbe-process-")

    def _command(self, setting):
        sweep, size = self.sweep, self.sweep.shape
        out = [self.program, "trace" if setting.traced else "render", sweep.path, "--quiet", "-o",
               os.path.join(self.folder.name, "picture.exr"), "--size",
               f"{size['width']}x{size['height']}"]
        if sweep.materials:
            out += ["--materials", sweep.materials]
        if setting.traced:
            out += ["--spp", setting.passes, "--photons", setting.photons ** 2, "--seed", 20261]
            return [*map(str, out)] + ["--filter"] * (setting.profile == "trace-filter")
        how = grids.request(setting)
        names = {"map_size": "map", "supersample": "samples", "energy_share": "share"}
        drop = {"upsample" if setting.upsample == 1 else "supersample"}
        if setting.profile != "default" and setting.profile not in grids.PINHOLES:
            drop |= {"exits", "energy_share"}
        for key, value in how.items():
            if key not in drop:
                out += ["--" + names.get(key, key), value]
        return [*map(str, out), "--backend", sweep.backend]

    def _run(self, command, cache):
        start = time.perf_counter()
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, check=False,
                              env=os.environ | dict.fromkeys(self.CACHES, cache))
        if done.returncode != 0:
            raise Wrong("the command did not end well: " + " ".join(command))
        return 1e3 * (time.perf_counter() - start)

    def measure(self, row, cold):
        command = self._command(row.setting)
        if cold:
            cache = tempfile.mkdtemp(dir=self.folder.name)
        else:
            cache = os.path.join(self.folder.name, "shaders")
            os.makedirs(cache, exist_ok=True)
        # the first fills what is missing in the cache, so it is not warm; the tracer needs none
        first = None if row.setting.traced else self._run(command, cache)
        row["warm_ms"] = self._run(command, cache)
        if cold:
            row["cold_ms"] = row["warm_ms"] if first is None else first
            shutil.rmtree(cache)
