"""Presets off sweeps: the file that `abbe render --preset` reads (gl/accuracy/preset.h), and what it
promises beside what a sweep met."""
import json
import math
import re

import abbe

from . import fronts
from .grids import preset_setting
from .table import NUMBERS, Wrong, geometric_mean, number, written

SLACK = 0.02       # within it of the least error more time buys nothing that one sees
MOST_SHARE = 0.01  # what gives up paths sooner may leave out all that another scene is made of
YARDSTICK = {"profile": "trace", "passes": 2, "photons": 128}
TOOLS = {"render": "default", "trace": "trace", "trace-filter": "trace-filter"}
# What `accurate` is nowhere coarser than, and finer in the first two.
USUAL = {"wavelengths": 7, "photons": 256, "map": 1024, "samples": 2, "exits": 8}

HEAD = """\
# Settings that are worth their time, read off sweeps; made by
#   abbe sweep SWEEP.csv... --write-presets FILE
# and not by hand. Times are the cheapest setting's, geometric means over the scenes,
# times the worst of the scenes' ratios to it; error is the worst of
# them and least the best; draft, balanced and accurate count the points from 0.
# What is promised of another scene is error times margin, and the time times
# time_margin: the most by which a scene of margin_scenes was worse than the others
# had promised (0: the class has too few, and the widest of the others is taken).
"""


def is_fine(s):
    """Nowhere coarser than a plan's own choice, and of more wavelengths and photons."""
    return (s.wavelengths > USUAL["wavelengths"] and s.photons > USUAL["photons"] and
            s.map >= USUAL["map"] and s.samples >= USUAL["samples"] and s.upsample == 1 and
            s.exits >= USUAL["exits"] and s.share <= MOST_SHARE and s.fill == "bridge" and
            s.model == "auto")


def _quoted(text):
    return text if re.fullmatch(r"[A-Za-z][\w ,.'-]*", text) else json.dumps(text,
                                                                             ensure_ascii=False)


def _names(tables):
    return ", ".join(table.scene.partition(".")[0] for table in tables)


class _Front:
    """The settings that all sweeps of a class have: the worst error, and the cheapest setting's
    light's and eye's times, times the worst of the scenes' ratios to it."""

    def __init__(self, tables, error):
        self.tables, self.error = tables, error
        settings = [row.setting for row in tables[0].rows
                    if row.setting.profile == "default" and row.setting.share <= MOST_SHARE
                    and row.setting.history < 2 and self._rows(row.setting)]
        means = {s: [geometric_mean(row[part] for row in self._rows(s))
                     for part in ("light_ms", "eye_ms")] for s in settings}
        self.base = min(settings, key=lambda s: sum(means[s]), default=None)
        self.cost = {s: [means[self.base][k] * max(r[k] for r in self._ratios(s))
                         for k in range(2)] for s in settings}
        worst = {s: max(row[error] for row in self._rows(s)) for s in settings}
        at = fronts.order([sum(self.cost[s]) for s in settings], [worst[s] for s in settings])
        self.front = [settings[i] for i in at]
        self.worst = [worst[s] for s in self.front]
        self.costs = [sum(self.cost[s]) for s in self.front]

    def _rows(self, setting):
        """Of each table; none where one does not have it whole."""
        rows = [table.find(setting) for table in self.tables]
        known = all(row and row["light_ms"] > 0 and row["eye_ms"] > 0 and
                    math.isfinite(row[self.error]) for row in rows)
        return rows if known else []

    def _ratios(self, setting):
        return [(row["light_ms"] / base["light_ms"], row["eye_ms"] / base["eye_ms"])
                for row, base in zip(self._rows(setting), self._rows(self.base))]

    def margins(self):
        """Error's and time's: the worst that leaving one scene out would have been wrong by."""
        error = time = 1.0
        for s in self.front if len(self.tables) > 1 else ():
            rows, ratios, bases = self._rows(s), self._ratios(s), self._rows(self.base)
            for i, row in enumerate(rows):
                others = [k for k in range(len(rows)) if k != i]
                promised = max(rows[k][self.error] for k in others)
                if promised > 0:
                    error = max(error, row[self.error] / promised)
                light, eye = (max(ratios[k][part] for k in others) for part in range(2))
                time = max(time, (row["light_ms"] + row["eye_ms"]) /
                           (bases[i]["light_ms"] * light + bases[i]["eye_ms"] * eye))
        return error, time

    def write(self, of, widest, to):
        many = len(self.tables) > 1
        error, time = self.margins() if many else widest
        fine = [i for i, s in enumerate(self.front) if is_fine(s)]
        least = min((self.worst[i] for i in fine), default=math.inf)
        best = next((i for i in fine if self.worst[i] <= (1 + SLACK) * least), None)
        last = fronts.accurate(self.worst, SLACK) if best is None else best
        to.write(f"- class: {_quoted(of)}\n  scenes: {_quoted(_names(self.tables))}\n"
                 f"  margin: {error:.4g}\n  time_margin: {time:.4g}\n"
                 f"  margin_scenes: {len(self.tables) if many else 0}\n  draft: 0\n"
                 f"  balanced: {fronts.knee(self.costs[:last + 1], self.worst[:last + 1])}\n" +
                 ("  # accurate: no setting that is finer than the defaults is on the front\n"
                  if best is None else f"  accurate: {best}\n") + "  front:\n")
        for s, worst in zip(self.front, self.worst):
            least = min(row[self.error] for row in self._rows(s))
            to.write(f"  - {{wavelengths: {s.wavelengths}, photons: {s.photons}, map: {s.map}, "
                     f"samples: {s.samples}, upsample: {s.upsample}, fill: {s.fill}, exits: "
                     f"{s.exits}, share: {number(s.share)},\n     model: {s.model}, light_ms: "
                     f"{self.cost[s][0]:.2f}, eye_ms: {self.cost[s][1]:.2f}, error: {worst:.4g}, "
                     f"least: {least:.4g}}}\n")


class _Pictures:
    """The fronts of whole pictures, one of each tool: what its process takes, against its error. A
    scene's times are told by the yardstick, a short frame of the tracer; so are the tracer's errors,
    by what the yardstick says of its own."""

    def __init__(self, tables, error):
        self.tables, self.error = tables, error
        rows = [next((row for row in table.rows if all(
            row.setting.fields()[key] == value for key, value in YARDSTICK.items())), None)
            for table in tables]
        self.known = all(row and row["frame_ms"] > 0 and row["own_de"] > 0 for row in rows)
        if self.known:
            self.ms, self.de = ([row[key] for row in rows] for key in ("frame_ms", "own_de"))
            self.base_ms, self.base_de = geometric_mean(self.ms), geometric_mean(self.de)

    def _common(self, setting):
        """Each table's time and error as what the class has in common; none where one is not
        known."""
        out = []
        for table, ms, de in zip(self.tables, self.ms, self.de):
            row = table.find(setting)
            if not row or not row["warm_ms"] > 0 or not math.isfinite(row[self.error]):
                return []
            out.append((row["warm_ms"] / ms * self.base_ms,
                        row[self.error] * (self.base_de / de if setting.traced else 1)))
        return out

    def front(self, tool):
        known = [(row.setting, self._common(row.setting)) for row in self.tables[0].rows
                 if row.setting.profile == TOOLS[tool] and row.setting.share <= MOST_SHARE
                 and row.setting.history < 2]
        points = [(s, max(ms for ms, _ in all_), max(e for _, e in all_), min(e for _, e in all_))
                  for s, all_ in known if all_]
        return [points[i] for i in fronts.order([p[1] for p in points], [p[2] for p in points])]

    def margins(self, tool):
        error = time = 1.0
        for s, *_ in self.front(tool) if len(self.tables) > 1 else ():
            common = self._common(s)
            for i, (ms, wrong) in enumerate(common):
                others = common[:i] + common[i + 1:]
                most = max(e for _, e in others)
                if most > 0:
                    error = max(error, wrong / most)
                time = max(time, ms / max(t for t, _ in others))
        return error, time

    def write(self, widest, to):
        many = len(self.tables) > 1
        to.write(f"  pictures:\n    base_ms: {self.base_ms:.2f}\n    base_error: {self.base_de:.4g}\n"
                 f"    margin_scenes: {len(self.tables) if many else 0}\n")
        for tool in TOOLS:
            points = self.front(tool)
            error, time = self.margins(tool) if many else widest[tool]
            if points:
                to.write(f"    {tool}:\n      margin: {error:.4g}\n      time_margin: {time:.4g}\n"
                         "      front:\n")
            for s, ms, worst, least in points:
                how = f"passes: {s.passes}, " if s.traced else (
                    f"wavelengths: {s.wavelengths}, map: {s.map}, samples: {s.samples}, upsample: "
                    f"{s.upsample}, fill: {s.fill},\n         exits: {s.exits}, share: "
                    f"{number(s.share)}, model: {s.model}, ")
                to.write(f"      - {{photons: {s.photons}, {how}ms: {ms:.1f}, error: {worst:.4g}, "
                         f"least: {least:.4g}}}\n")


def write(path, tables, names, error):
    """The presets' file off tables of one run."""
    first = tables[0].facts
    for table, name in zip(tables, names):
        if not table.facts["class"]:
            raise Wrong(f"{name}: it does not name its scene's class; sweep the scene again")
        for fact in ("program", "machine", "device", "size"):
            if table.facts[fact] != first[fact]:
                raise Wrong(f"{names[0]} and {name} are of different {fact}s, '{first[fact]}' and "
                            f"'{table.facts[fact]}'; presets are read off sweeps of one run")
    telling = [table for table in tables if table.tells(error)]
    classes = {}
    for table, name in zip(tables, names):
        classes.setdefault(table.facts["class"], name)
    fronts_of, pictures_of = {}, {}
    for of, name in classes.items():
        own = [table for table in telling if table.facts["class"] == of]
        fronts_of[of] = _Front(own, error) if own else None
        if not own or not fronts_of[of].front:
            raise Wrong(f"{name}: its class, {of}, has no setting of the default profile whose "
                        f"{error} is known in all its sweeps")
        pictures_of[of] = _Pictures(own, error)
    margins = [front.margins() for front in fronts_of.values()]
    widest = tuple(max(m[k] for m in margins) for k in range(2))
    known = [pictures for pictures in pictures_of.values() if pictures.known]
    widest_of = {tool: tuple(max((p.margins(tool)[k] for p in known), default=1) for k in range(2))
                 for tool in TOOLS}
    run = "; ".join([first[fact] for fact in ("date", "program", "machine", "device", "size")] +
                    [f"medians of {first['frames']} frames"])
    with written(path) as to:
        to.write(f"{HEAD}error: {error}\nwhat: {_quoted(NUMBERS[error])}\nrun: {_quoted(run)}\n")
        for table in tables:
            if table not in telling:
                to.write("# left out, for its reference's noise explains its errors: "
                         f"{table.scene}\n")
        to.write("classes:\n")
        for of, front in fronts_of.items():
            front.write(of, widest, to)
            if pictures_of[of].known:
                pictures_of[of].write(widest_of, to)


def promises(table, path):
    """What a file of presets promises, beside what the table met; nothing where it promises
    nothing of such a table."""
    front = abbe.presets(table.facts["class"] or "none", path)
    if not front or front["error"] not in NUMBERS:
        return []
    points = front["points"]
    base = table.find(preset_setting(points[0]))
    if base is None:
        return []
    speed = {part: base[part] / max(points[0][part], 0.01) for part in ("light_ms", "eye_ms")}
    lines = [f"presets, {front['error_text']}, made on {front['scenes']}; margin "
             f"{front['margin']:.3g} for the error, {front['time_margin']:.3g} for the time:"]
    for point in points:
        row = table.find(preset_setting(point))
        if row is None:
            continue
        met, ms = row[front["error"]], sum(point[part] * speed[part] for part in speed)
        lines.append(f"{point['point']:<9} {row.setting.label:<24} error {point['error']:.3g} "
                     f"promised, {met:.3g} met{'' if met <= point['error'] else ' (MORE)'}; "
                     f"{ms:.0f} ms promised, {row['frame_ms']:.3g} met")
    return lines
