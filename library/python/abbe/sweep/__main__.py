"""`abbe sweep`."""
import argparse
import os
import signal
import sys

import abbe

from .._arguments import Parser, choice, count, near, target
from . import grids, measure, presets, show
from .table import ERRORS, TIMES, Wrong, join, load

EPILOG = """\
The same command goes on where it was stopped. Given tables, it shows them.

examples:
  abbe sweep scenes/gem.yaml -o gem.csv --plot gem.png
  abbe sweep scenes/gem.yaml -o gem.csv --grid full --frames 9 --spp 256
  abbe sweep scenes/prism.yaml -o slit.csv --wavelengths 3,7,21 --photons 64,256
  abbe sweep scenes/gem.yaml -o gem.csv --reference gem.exr --reference-map map.exr
  abbe sweep gem.csv sphere.csv --report trade.md
  abbe sweep scenes/gem.yaml -o part-3.csv --reference gem.exr --part 3/8
  abbe sweep part-*.csv -o gem.csv
  abbe sweep scenes/gem.yaml -o gem.csv --decompose --report gem.md
  abbe sweep *.csv --write-presets presets.yaml
"""
MOST_VALUES = 16
# An axis: its least and most, or the words that it takes (None: the library's to refuse).
AXES = {"profiles": grids.PROFILES, "wavelengths": (1, 256), "photons": (1, 16384),
        "map": (1, 16384), "samples": (1, 4), "upsample": (1, 4), "fill": None, "model": None,
        "exits": (1, 64), "share": (1e-9, 1), "direction": None, "history": (1, 4),
        "passes": (1, 65536)}
TRACED = ("spp", "traced_photons", "texels", "physics", "decompose", "trace_only")


def _list(axis):
    def read(text):
        words, limits = text.split(","), AXES[axis]
        if "" in words or len(words) > MOST_VALUES:
            raise argparse.ArgumentTypeError(f"'{text}' is not a list such as 3,7,21 of at most "
                                             f"{MOST_VALUES} values")
        if limits is None:
            return words
        if isinstance(limits[0], str):
            return [choice(*limits)(word) for word in words]
        if axis != "share":
            return [count(*limits)(word) for word in words]
        try:
            values = [float(word) for word in words]
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is not a list of numbers") from None
        if not all(limits[0] <= value <= limits[1] for value in values):
            raise argparse.ArgumentTypeError(f"'{text}' is not of numbers from 1e-9 to 1")
        return values
    return read


def _size(text):
    try:
        width, height = map(int, text.split("x"))
        if width > 0 and height > 0:
            return width, height
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"'{text}' is not a size such as 512x512")


def _part(text):
    try:
        part, parts = map(int, text.split("/"))
        if 0 <= part < parts:
            return part, parts
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"'{text}' is no part such as 0/8, the first, to 7/8, the last")


def _error(text):
    if text not in ERRORS:
        raise argparse.ArgumentTypeError(f"'{text}' is no error{near(text, ERRORS)}; one is: "
                                         + " ".join(ERRORS))
    return text


def _parser():
    out = Parser(
        prog="abbe sweep", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=EPILOG,
        usage="abbe sweep SCENE.yaml -o FILE.csv\n       abbe sweep FILE.csv... [-o ALL.csv]",
        allow_abbrev=False, description="Renders a scene with many settings and says what each "
        "costs, in time, and how far it is\nfrom a traced reference: which settings are worth their "
        "time, and what published methods\ngive for it.")
    out.add_argument("files", nargs="*", help=argparse.SUPPRESS)
    add = out.add_argument
    add("-o", "--output", metavar="FILE.csv", type=target(".csv"),
        help="the table; rows that it holds are not measured again. Given tables: all of their rows")
    add("--plot", metavar="FILE", type=target(".png", ".svg", ".pdf"),
        help="error against time, log-log; of several tables a row of charts each")
    add("--report", metavar="FILE.md", type=target(".md"),
        help="a page with the Pareto front and pictures beside it")
    add("--write-presets", metavar="FILE.yaml", type=target(".yaml"),
        help="presets off the Pareto fronts of the given tables")
    add("--presets", metavar="FILE.yaml",
        help="say what these promise beside what was met (the shipped ones)")
    add("--error", metavar="COLUMN", type=_error, default="caustic_de",
        help="that makes the Pareto front: caustic_de, map_rmse, picture_de, ... (caustic_de)")
    add("--time", metavar="|".join(TIMES), type=choice(*TIMES), default="frame",
        help="that makes the Pareto front: a frame once the scene stands, one after a camera's "
        "move, or a whole process with its shaders cached or not (frame)")
    add("--json", action="store_true", help="all rows as JSON on standard output")
    add("-q", "--quiet", action="store_true", help="no progress")
    add = out.add_argument_group("settings").add_argument
    names = (*grids.GRIDS, "presets")
    add("--grid", metavar="|".join(names), type=choice(*names), help="a named set of settings; "
        "presets: do they keep their promise here? (quick)")
    for axis, words in (
            ("profiles", ",".join(grids.PROFILES) + " (all)"), ("wavelengths", "such as 3,7,21"),
            ("photons", "sides of the photon grid"), ("map", "sides of the spectral map"),
            ("samples", "a pixel side"), ("upsample", "pixels a sample side"),
            ("fill", "auto,none; of wyman2006 points,quads,..."),
            ("model", "of transport: auto, layers, hierarchy, ..."),
            ("exits", "followed at the most"), ("share", "of their light below which paths end"),
            ("direction", "that wyman2006's photons take light from: own,mean,direct"),
            ("history", "frames that a picture is made of, 1 to 4: the error after 1, 2, 4 and 8"),
            ("passes", "of the tracer, each of photons x photons photons")):
        add("--" + axis, metavar="LIST", type=_list(axis), help=words)
    add("--frames", metavar="N", type=count(1, 1000), default=5,
        help="warm up, then the median of N (5)")
    add("--processes", action="store_true", help="time whole processes too: warm ones, and cold "
        "ones of each contestant's front")
    add("--size", metavar="WxH", type=_size, help="pixels; the scene's own without")
    add("--backend", metavar="NAME", type=choice("cpu", "gpu", "auto"), default="auto",
        help="cpu, gpu, or auto: a GPU where there is one (auto)")
    add("--materials", metavar="TABLE", help="a table instead of the scene's")
    add("--list", action="store_true", help="only say which settings the grid has")
    add("--part", metavar="K/N", type=_part, help="only every N-th setting from the K-th on, 0/8 to "
        "7/8, into a table of its own")
    add = out.add_argument_group("the reference").add_argument
    add("--reference", metavar="FILE.exr", help="a traced picture (traced and kept beside it)")
    add("--reference-map", metavar="FILE.exr", help="a traced receiver map")
    add("--spp", metavar="N", type=count(2, 1000000), help="passes of the reference (64)")
    add("--traced-photons", metavar="N", type=count(1, 1 << 30),
        help="photons a pass (1048576)")
    add("--texels", metavar="N", type=count(1, 16384),
        help="side of the reference's map (256)")
    add("--decompose", action="store_true", default=None,
        help="trace matched physics too: what is the model's, and what is sampling's?")
    add("--trace-only", action="store_true", default=None,
        help="trace the references, for sweeps to come, and measure nothing")
    add("--physics", metavar="NAME", type=choice("full", "matched"),
        help="of the reference: full or matched (full)")
    return out


def _check(parser, q):
    """What does not go together."""
    files = q.files
    if not files:
        parser.error("which scene? Give a file such as scenes/gem.yaml")
    q.lists = {axis: getattr(q, axis) for axis in AXES if getattr(q, axis) is not None}
    q.traced = any(getattr(q, name) is not None for name in TRACED)
    q.tables = files[0].endswith(".csv")
    if q.tables:
        if q.part or q.lists or q.grid:
            parser.error(f"'{files[0]}' is a table: it is shown, and nothing is measured")
        return
    if q.write_presets:
        parser.error("--write-presets reads tables: give SWEEP.csv..., and no scene")
    if len(files) > 1:
        parser.error(f"one scene at a time: '{files[0]}' and '{files[1]}'")
    if not q.output and not q.list:
        parser.error("where to? Give -o FILE.csv")
    if q.lists and q.grid:
        parser.error("--grid and lists such as --wavelengths 3,7: one or the other")
    if (q.reference or q.reference_map) and q.traced:
        parser.error("--spp, --texels, --physics, --decompose, --trace-only and --traced-photons "
                     "are for a reference that is traced, and one is given")
    if q.decompose and q.physics == "matched":
        parser.error("--decompose traces full and matched physics; --physics asks for one of them")
    if q.reference and q.size:
        parser.error("--size goes with a reference that is traced; the given one has its own")


def _protect(parser, q, tables):
    """What is written may be nothing that is read, or written for something else."""
    reads = [(name, "the scene" if not q.tables else "a table") for name in q.files
             if not q.tables or name != q.output]
    reads += [(getattr(q, name), "--" + name.replace("_", "-"))
              for name in ("reference", "reference_map", "presets", "materials")]
    reads += [(table.facts[fact], "the table's source") for table in tables
              for fact in ("scene", "reference", "reference map")]
    writes = [(getattr(q, name), "--" + name.replace("_", "-"))
              for name in ("output", "plot", "report", "write_presets")]
    if q.report:
        writes += [(name, "the report's picture") for files in show.shots(q.report, tables)
                   for name in files.values()]
    seen = {os.path.realpath(name): what for name, what in reads if name}
    for name, what in writes:
        if not name:
            continue
        if os.path.realpath(name) in seen:
            parser.error(f"{what} '{name}' would be written over {seen[os.path.realpath(name)]}")
        seen[os.path.realpath(name)] = what
        folder = os.path.dirname(name) or "."
        if not os.path.isdir(folder):
            raise Wrong(f"{name}: there is no folder {folder} to write it in")


class Bar:
    """What is under way, in a line of a terminal; and where a signal is heeded, so that none comes
    between the library and what it calls. The second one ends at once."""

    def __init__(self, quiet):
        self.on = not quiet and sys.stderr.isatty()
        self.what, self.before, self.share = "", 0, 1
        self.stopped = False

    def stop(self, *_):
        if self.stopped:
            raise KeyboardInterrupt
        self.stopped = True

    def __call__(self, done):
        if self.stopped:
            raise KeyboardInterrupt
        if self.on:
            done = self.before + self.share * done
            sys.stderr.write(f"\r{self.what:<10} {100 * done:3.0f} %")
            sys.stderr.flush()

    def of(self, what, at=0, count=1):
        self.what, self.before, self.share = what, at / count, 1 / count
        self(0)
        return self

    def end(self):
        if self.on:
            sys.stderr.write("\r\033[K")


def _settings(q, sweep, bar):
    if q.grid == "presets":
        out = grids.of_presets(sweep.scene, q.presets)
    else:
        parts = grids.GRIDS[q.grid or "quick"]
        if q.lists:
            parts = [{"profiles": list(grids.PROFILES)} | q.lists]
        out, refused, why = grids.expand(sweep.scene, parts)
        if refused and not q.quiet:
            bar.end()
            print(f"note: {refused} settings of the grid are left out; the first: {why}",
                  file=sys.stderr)
    if q.part:
        chosen = out[q.part[0]::q.part[1]]
        if not chosen:
            raise Wrong(f"--part {q.part[0]}/{q.part[1]} has none of {len(out)} settings")
        return chosen
    return out


def _find_references(q, sweep, bar):
    if q.reference or q.reference_map:
        sweep.load(q.reference, q.reference_map)
    else:
        how = {"passes": q.spp or 64, "texels": q.texels or 256, "photons": q.traced_photons}
        try:
            sweep.find(q.output, "reference", q.physics == "matched", 0,
                       progress=bar.of("reference"), **how)
            if q.decompose:  # noise of its own: what the two have in common must not cancel
                sweep.find(q.output, "matched", True, 1, progress=bar.of("matched"), **how)
        except KeyboardInterrupt:
            raise Wrong("stopped while the reference was traced; what is done is kept, and the same "
                        "command goes on") from None
    sweep.ready()


def _measure(q, sweep, settings, bar):
    """The whole table; each row is kept as it comes."""
    now = sweep.table()
    table = now
    if os.path.exists(q.output):
        table = load(q.output)
        table.agree(q.output, now)

    def keep():
        table.mark(TIMES[q.time], q.error)
        table.save(q.output)

    missing = [setting for setting in settings if table.find(setting) is None]
    try:
        for at, setting in enumerate(missing):
            try:
                table.add(sweep.measure(setting, bar.of("sweep", at, len(missing)))[0])
            except abbe.Error as error:
                raise Wrong(f"{setting.label}: {error}") from None
            keep()
        keep()
        if q.processes:
            _time_processes(sweep, table, bar, keep)
    except KeyboardInterrupt:
        raise Wrong(f"stopped; {len(table.rows)} of {len(settings)} settings are in {q.output}, and "
                    "the same command goes on") from None
    return table


def _time_processes(sweep, table, bar, keep):
    """Cold ones take long and differ little, so they are run for each contestant's own fronts."""
    cold = set()
    for error in ("caustic_de", "caustic_rmse"):
        for profile in {row.setting.profile for row in table.rows}:
            table.mark("frame_ms", error, profile)
            cold |= {row.setting for row in table.rows if row.front}

    def is_timed(row):
        return row.setting.history > 1 or (row["warm_ms"] > 0 and (
            row["cold_ms"] > 0 or row.setting not in cold))

    processes = measure.Processes(sweep)
    missing = [row for row in table.rows if not is_timed(row)]
    for at, row in enumerate(missing):
        bar.of("processes", at, len(missing))
        try:
            processes.measure(row, row.setting in cold)
        except Wrong:
            bar(0)  # a signal ends these too
            raise
        keep()
    keep()


def _show(q, tables):
    time = TIMES[q.time]
    if q.plot:
        show.plot(q.plot, tables, time, q.error)
    if q.report:
        show.page(q.report, tables, time, q.error, q.backend)
    if q.write_presets:
        presets.write(q.write_presets, tables, q.files, q.error)
    for table in tables:
        print(show.as_json(table, time, q.error) if q.json else show.text(table, time, q.error))
    if (q.grid == "presets" or q.presets) and not q.json:
        for table in tables:
            for line in presets.promises(table, q.presets):
                print(line)


def _run(parser, q, bar):
    if q.tables:
        tables = [load(name) for name in q.files]
        _protect(parser, q, tables)
        if q.output:
            tables = [join(tables, q.files)]
        for table in tables:
            table.mark(TIMES[q.time], q.error)
        if q.output:
            tables[0].save(q.output)
        return _show(q, tables)
    _protect(parser, q, [])
    scene = q.files[0]
    sweep = measure.Sweep(scene, q.materials, q.backend, q.frames, q.size)
    settings = _settings(q, sweep, bar)
    if q.list:
        for setting in settings:
            print(setting.label)
        return None
    _find_references(q, sweep, bar)
    if q.trace_only:
        return None
    table = _measure(q, sweep, settings, bar)
    bar.end()
    _protect(parser, q, [table])
    return _show(q, [table])


def main():
    """Exit codes: 0 done, 1 failed, 2 used wrongly."""
    parser = _parser()
    q = parser.known()
    _check(parser, q)
    bar = Bar(q.quiet)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, bar.stop)
    try:
        _run(parser, q, bar)
        sys.stdout.flush()
    except (Wrong, abbe.Error, OSError) as error:
        bar.end()
        sys.stderr.write(f"{parser.prog}: {error}\n")
        return 1
    except KeyboardInterrupt:
        bar.end()
        sys.stderr.write(f"{parser.prog}: stopped\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
