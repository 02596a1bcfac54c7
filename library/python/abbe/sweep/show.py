"""Sweeps for people: the Pareto front as text, JSON, charts, and a page with pictures."""
import json
import math
import os

import abbe

from . import fronts, grids
from .table import NUMBERS, QUIET, SHOWN, TIMES, Wrong, short, written

SHOTS = ("reference", "cheapest", "middle", "accurate", "thesis", "thesis-cie")


def _line(row, columns):
    return f"{row.setting.label:<34}" + "".join(f" {short(row[name]):>12}" for name in columns)


def _head(columns):
    return " " * 34 + "".join(f" {name:>12}" for name in columns)


def text(table, time, error):
    front = table.front(time)
    facts = table.facts
    out = [f"{facts['scene']}, {facts['size']}: {len(table.rows)} settings, {len(front)} on the "
           f"Pareto front of {time} and {error}", "", _head(SHOWN)]
    out += [_line(row, SHOWN) for row in front]
    if front:
        out.append(f"the reference's own noise: {short(front[0][error + '_noise'])} of {error}")
    for profile, (words, _) in fronts.BASELINES.items():
        for clock in TIMES.values():
            out += _baseline(fronts.compare(table, profile, clock, error), words, clock)
    moving = [row for row in table.rows if row.setting.history > 1]
    if moving:
        columns = ("frame_ms", "after_1_de", "after_2_de", "after_4_de", "after_8_de")
        out += ["", "frames that follow one another, the scene at rest:", _head(columns)]
        out += [_line(row, columns) for row in moving]
    if table.unrest() > QUIET:
        out += ["", "note: the machine was busy: the median frame of half of the settings took more "
                f"than {100 * table.unrest():.0f} % longer than their fastest; measure again when "
                "it is quiet"]
    parts = fronts.decompose(table)
    if parts and math.isfinite(parts["sampling_and_reconstruction"]):
        out += ["", parts["words"]]
    return "\n".join(out)


def _baseline(c, words, clock):
    if c.front == 0:
        return []
    out = ["", f"{words}, by {clock}"]
    if c.row:
        out[-1] += ", at its own settings:"
        out += [_line(c.row, SHOWN),
                f"the default profile at its error: {short(c.speedup)} times as fast; in its time: "
                f"{short(c.ratio)} of its error"]
    return out + [f"against its own Pareto front of {c.front} settings: at least "
                  f"{short(c.front_speedup)} times as fast; at most {short(c.front_ratio)} of its "
                  f"error; {c.beaten} are beaten in both"]


def _known(value):
    return value if not isinstance(value, float) or math.isfinite(value) else None


def as_json(table, time, error):
    """docs/trade.md has the keys."""
    out = dict(table.facts) | {"time": time, "error": error}
    for profile, (_, key) in fronts.BASELINES.items():
        for name, clock in TIMES.items():
            c = fronts.compare(table, profile, clock, error)
            before = ("" if name == "frame" else name + "_") + key
            out |= {before + "equal_error_speedup": _known(c.speedup),
                    before + "equal_time_error_ratio": _known(c.ratio),
                    before + "front_speedup": _known(c.front_speedup),
                    before + "front_ratio": _known(c.front_ratio),
                    before + "front_points": c.front, before + "front_points_beaten": c.beaten}
    out["unrest"] = table.unrest()
    parts = fronts.decompose(table)
    if parts:
        out["decomposition"] = {key: _known(value) for key, value in parts.items()}
    out["rows"] = [row.setting.fields() | {key: _known(value) for key, value in row.items()} |
                   {"front": row.front} for row in table.rows]
    return json.dumps(out, indent="\t", ensure_ascii=False)


# ---- charts ----

def figures():
    """matplotlib's pyplot, drawing to files alone."""
    try:
        import matplotlib
    except ImportError:
        raise Wrong("--plot needs matplotlib, Debian's python3-matplotlib") from None
    matplotlib.use("Agg")
    matplotlib.rcParams |= {"svg.hashsalt": "abbe", "axes.grid": True, "grid.alpha": 0.3,
                            "legend.fontsize": "small"}
    from matplotlib import pyplot
    return pyplot


COLOURS = {profile: f"C{at}" for at, profile in enumerate(("default", *fronts.BASELINES))}


def _chart(axes, table, time, error, points):
    """Each profile's front, and with `points` every setting, the front of all with its labels."""
    known = [row for row in table.rows if math.isfinite(row[time]) and math.isfinite(row[error])]
    if not known:
        raise Wrong(f"{table.scene}: no setting has a known '{error}' and '{time}'")
    for profile in dict.fromkeys(row.setting.profile for row in known):
        own = [row for row in known if row.setting.profile == profile]
        colour = COLOURS.get(profile, "C9")
        at = [own[i] for i in fronts.order([r[time] for r in own], [r[error] for r in own])]
        axes.plot([r[time] for r in at], [r[error] for r in at], "-" if points else ".-",
                  color=colour, linewidth=1, label=None if points else profile)
        if points:
            axes.plot([r[time] for r in own], [r[error] for r in own], ".", color=colour,
                      label=profile)
    if points:
        front = [known[i] for i in fronts.order([r[time] for r in known], [r[error] for r in known])]
        axes.plot([r[time] for r in front], [r[error] for r in front], "o-", color="black",
                  markersize=4, linewidth=1.5, label="Pareto front")
        for row in front:
            axes.annotate(row.setting.label, (row[time], row[error]), fontsize="x-small",
                          xytext=(3, 3), textcoords="offset points")
    noise = [row[error + "_noise"] for row in known if row[error + "_noise"] > 0]
    if noise:
        mean = math.exp(sum(map(math.log, noise)) / len(noise))
        axes.axhline(mean, linestyle="--", color="grey", label="the reference's own noise")
    axes.set(xscale="log", yscale="log", xlabel=NUMBERS[time], ylabel=NUMBERS[error])


def save(figure, path):
    figure.tight_layout()
    try:
        figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)
    except OSError as error:
        raise Wrong(f"{path}: it cannot be written: {error.strerror}") from None


def plot(path, tables, time, error):
    """Error against time, log-log; of several tables a row of charts each, one for each time."""
    pyplot = figures()
    times = [time] if len(tables) == 1 else [
        clock for clock in TIMES.values()
        if any(math.isfinite(row[clock]) for table in tables for row in table.rows)]
    if not times:
        raise Wrong("no setting has a known time to draw")
    single = len(tables) == 1
    figure, axes = pyplot.subplots(len(tables), len(times), squeeze=False, figsize=(
        (11, 5.6) if single else (4.2 * len(times), 2.8 * len(tables))))
    for line, table in zip(axes, tables):
        for ax, clock in zip(line, times):
            _chart(ax, table, clock, error, single)
            ax.set_title(f"{table.scene}, {table.facts['size']}")
    axes[0][0].legend()
    save(figure, path)
    pyplot.close(figure)


# ---- the page ----

def shots(path, tables):
    """The files of the page's pictures: "PAGE-SCENE-what.png", and "PAGE-SCENE-2-what.png" for a
    second table of a scene of that name."""
    stem, out, seen = os.path.splitext(path)[0], [], {}
    for table in tables:
        scene = table.scene.partition(".")[0]
        turn = seen[scene] = seen.get(scene, 0) + 1
        scene += f"-{turn}" if turn > 1 else ""
        out.append({what: f"{stem}-{scene}-{what}.png" for what in SHOTS})
    return out


def _take(table, files, front, baselines, time, error, backend):
    """The reference, three settings of the front and the thesis's; name and words of each that could
    be made: scenes and references are read from the paths in the table."""
    width, height = map(int, table.facts["size"].split("x"))
    rows = dict(zip(SHOTS[1:4], (front[0], front[len(front) // 2], front[-1]) if front else ()))
    rows |= {what: row for what, row in baselines.items() if what in SHOTS and row}
    out = []
    try:
        abbe.load(table.facts["reference"]).save(files["reference"])
        out.append((files["reference"], "reference"))
    except abbe.Error:
        pass
    try:
        scene = abbe.Scene(table.facts["scene"])
    except abbe.Error:
        return out
    for what, row in rows.items():
        s = row.setting
        try:
            picture = scene.trace_times(
                passes=s.passes, photons=s.photons, filter=s.profile == "trace-filter", width=width,
                height=height)[1] if s.traced else scene.render(
                    width=width, height=height, backend=backend, **grids.request(s))
            # a best factor on the brightness is part of what was compared
            picture.pixels[:] *= row["scale"] if math.isfinite(row["scale"]) else 1
            picture.save(files[what])
        except abbe.Error:
            continue
        out.append((files[what], f"{what}: {s.label}, {short(row[time])} ms, {short(row[error])}"))
    return out


def _cells(to, cells):
    to.write("| " + " | ".join(cells) + " |\n")


def _rule(to, count):
    to.write("|" + "---|" * count + "\n")


def page(path, tables, time, error, backend):
    """Markdown, with pictures beside it."""
    names = shots(path, tables)
    with written(path) as to:
        to.write(f"# Time against error\n\nThe Pareto front of {NUMBERS[time]} and {NUMBERS[error]};"
                 " in brackets what the reference's own noise makes of an error.\n\n")
        for table, files in zip(tables, names):
            _write_sweep(to, table, files, time, error, backend)


def _write_sweep(to, table, files, time, error, backend):
    facts, front = table.facts, table.front(time)
    baselines = {profile: fronts.compare(table, profile, time, error).row
                 for profile in fronts.BASELINES}
    to.write(f"## {table.scene}\n\n")
    made = _take(table, files, front, baselines, time, error, backend)
    if made:
        _cells(to, [f"![{words}]({os.path.basename(name)})" for name, words in made])
        _rule(to, len(made))
        _cells(to, [words for _, words in made])
    if len(made) < len(SHOTS):
        to.write(f"\n{len(SHOTS) - len(made)} pictures are missing: the scene, its reference or a "
                 "setting is gone.\n")
    to.write(f"\n{facts['size']} pixels, medians of {facts['frames']} frames. {facts['machine']}. "
             f"{facts['device']}. {facts['date']}.\n\n")
    _cells(to, [f"of {len(table.rows)} settings, the Pareto front",
                *(NUMBERS[name] for name in SHOWN)])
    _rule(to, len(SHOWN) + 1)
    rows = [("", row) for row in front]
    rows += [("baseline: ", row) for row in baselines.values() if row and not row.front]
    for words, row in rows:
        noise = {name: row.get(name + "_noise", math.nan) for name in SHOWN}
        _cells(to, [words + row.setting.label, *(
            short(row[name]) + (f" ({short(noise[name])})" if math.isfinite(noise[name]) else "")
            for name in SHOWN)])
    to.write("\n")
    _cells(to, ["the default profile against the", "by", "as fast at its error",
                "of its error in its time", "as fast, over its front",
                "of the error, over its front", "points of it beaten in both"])
    _rule(to, 7)
    for profile, (words, _) in fronts.BASELINES.items():
        for clock in TIMES.values():
            c = fronts.compare(table, profile, clock, error)
            if c.front:
                _cells(to, [words, NUMBERS[clock], *map(short, (c.speedup, c.ratio, c.front_speedup,
                                                               c.front_ratio)),
                            f"{c.beaten} of {c.front}"])
    parts = fronts.decompose(table)
    if parts:
        to.write(f"\n{parts['words']}\n")
    to.write("\n")
