"""What a sweep has measured: settings, times and errors of one scene at one size against one
reference on one machine, as CSV. Comments "# fact: text" say what it belongs to."""
import math
import os
import statistics
import tempfile

from . import fronts

SETTINGS = ("profile", "wavelengths", "photons", "map", "samples", "fill", "exits", "share", "model",
            "upsample", "passes", "history", "polygons", "direction")
WORDS = ("profile", "fill", "model", "polygons", "direction")
# A number's column and what it is. Beside an error against the reference stands what the
# reference's own noise alone would make of it.
NUMBERS = {
    "frame_ms": "frame, ms", "fastest_ms": "fastest frame, ms", "light_ms": "light's passes, ms",
    "eye_ms": "eye's passes, ms", "camera_ms": "frame after a camera's move, ms",
    "baseline_ms": "surfaces alone, ms", "warm_ms": "whole process, shaders cached, ms",
    "cold_ms": "whole process, no shader cached, ms",
    "photons_hit": "photons that meet refractors",
    "hit_share": "share of the first light's photons",
    "polygon_layers": "polygons over a pixel, mean",
    "own_de": "caustic, mean CIEDE2000 by its own halves",
    "after_1_de": "caustic, mean CIEDE2000 of the first frame",
    "after_2_de": "of the second frame", "after_4_de": "of the fourth frame",
    "after_8_de": "of the eighth frame",
    "fill_invented": "light that the fill adds, share of the map's",
    "fill_lost": "light that the fill drops, share of the map's", "map_scale": "factor on the map",
    "map_rmse": "map's caustic, relative RMSE", "map_rmse_noise": "noise of it",
    "map_uv": "map's caustic, u'v' distance", "map_uv_noise": "noise of it",
    "map_bands": "map's caustic, relative RMSE of the bands", "map_bands_noise": "noise of it",
    "map_energy": "map's energy ratio", "map_energy_noise": "noise of it",
    "scale": "factor on the picture",
    "caustic_de": "caustic, mean CIEDE2000", "caustic_de_noise": "noise of it",
    "caustic_de95": "caustic, 95 % CIEDE2000", "caustic_de95_noise": "noise of it",
    "caustic_rmse": "caustic, relative RMSE", "caustic_rmse_noise": "noise of it",
    "picture_de": "picture, mean CIEDE2000", "picture_de_noise": "noise of it",
    "picture_de95": "picture, 95 % CIEDE2000", "picture_de95_noise": "noise of it",
    "picture_rmse": "picture, relative RMSE", "picture_rmse_noise": "noise of it",
    "matched_de": "caustic against matched physics, mean CIEDE2000",
    "matched_de_noise": "noise of it",
    "matched_map": "map's caustic against matched physics, relative RMSE",
    "matched_map_noise": "noise of it"}
ERRORS = [name for name in NUMBERS if name + "_noise" in NUMBERS and name != "map_energy"]
FACTS = ("program", "scene", "scene hash", "class", "size", "reference", "reference map",
         "reference hash", "model", "frames", "device", "machine", "date")
TIMES = {"frame": "frame_ms", "camera": "camera_ms", "warm": "warm_ms", "cold": "cold_ms"}
SHOWN = ("frame_ms", "warm_ms", "cold_ms", "caustic_de", "caustic_rmse", "map_rmse", "map_energy",
         "picture_de")
COLUMNS = (*SETTINGS, *NUMBERS, "front")
MOST_ROWS = 4096
QUIET = 0.15  # by that share a quiet machine's median is above its fastest


class Wrong(Exception):
    """What cannot be done, as a sentence."""


def short(value):
    """A number for people: three digits, "-" where it is not known."""
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def number(value):
    """The shortest text that reads back the same."""
    return str(int(value)) if float(value).is_integer() and abs(value) < 1e15 else repr(float(value))


class Setting(tuple):
    """One contestant's setting, every field resolved; of the tracer photons and passes count."""

    def __new__(cls, **fields):
        usual = {"wavelengths": 0, "map": 0, "samples": 1, "fill": "none", "exits": 0,
                 "share": 0.01, "model": "auto", "upsample": 1, "passes": 0, "history": 1,
                 "polygons": "", "direction": ""}
        return super().__new__(cls, ((usual | fields)[name] for name in SETTINGS))

    def __getattr__(self, name):
        try:
            return self[SETTINGS.index(name)]
        except ValueError:
            raise AttributeError(name) from None

    def fields(self):
        return dict(zip(SETTINGS, self))

    def but(self, **fields):
        return Setting(**(self.fields() | fields))

    @property
    def traced(self):
        return self.profile in ("trace", "trace-filter")

    @property
    def label(self):
        """For charts: "w7 p256 m1024 s2", with what else is unusual; "trace 4 x p512"."""
        if self.traced:
            return f"{self.profile} {self.passes} x p{self.photons}"
        plain = self.profile == "default"
        return "".join((
            "" if plain else self.profile + " ",
            f"w{self.wavelengths} p{self.photons} m{self.map} s{self.samples}",
            f"/{self.upsample}" if self.upsample > 1 else "",
            " no fill" if self.fill == "none" else
            " " + self.fill if self.profile.startswith("wyman2006") else "",
            f" e{self.exits}" if plain and self.exits < 4 else "",
            f" share {number(self.share)}" if plain and self.share != 0.01 else "",
            " " + self.model if plain and self.model != "auto" else "",
            f" h{self.history}" if self.history > 1 else "",
            *(" " + word for word in (self.polygons, self.direction) if word)))


class Row(dict):
    """Numbers by column, NaN where one is not known, of a setting."""

    def __init__(self, setting, numbers=()):
        super().__init__(dict.fromkeys(NUMBERS, math.nan) | dict(numbers))
        self.setting = setting
        self.front = False


class Table:
    """Rows of one sweep, and the facts that they belong to."""

    def __init__(self, facts=(), rows=()):
        self.facts = dict.fromkeys(FACTS, "")
        for name, text in dict(facts).items():
            self.set(name, text)
        self.rows = list(rows)

    def set(self, name, text):
        self.facts[name] = "".join(c if c >= " " else " " for c in str(text))[:255]

    @property
    def scene(self):
        """The scene file's name."""
        return os.path.basename(self.facts["scene"])

    def find(self, setting):
        return next((row for row in self.rows if row.setting == setting), None)

    def add(self, row):
        if self.find(row.setting):
            raise Wrong(f"the setting '{row.setting.label}' is there twice")
        if len(self.rows) == MOST_ROWS:
            raise Wrong(f"a sweep holds at most {MOST_ROWS} settings")
        self.rows.append(row)

    def column(self, name, counts=lambda setting: True):
        return [row[name] if counts(row.setting) else math.nan for row in self.rows]

    def mark(self, time, error, profile=None):
        """Marks the Pareto front: over all rows, or over one profile's alone. Pictures of several
        frames are on none, for a frame's time is not what their error takes."""
        cost = self.column(time, lambda s: s.history < 2 and profile in (None, s.profile))
        order = fronts.order(cost, self.column(error))
        for at, row in enumerate(self.rows):
            row.front = at in order

    def front(self, time):
        return sorted((row for row in self.rows if row.front), key=lambda row: row[time])

    def tells(self, error):
        """Whether the default profile's errors are more than the reference's own noise."""
        return not any(row[error + "_noise"] > 0.9 * row[error] for row in self.rows
                       if row.setting.profile == "default")

    def unrest(self):
        """By which share a median is above its fastest frame: the median over the rows."""
        over = [row["frame_ms"] / row["fastest_ms"] - 1 for row in self.rows
                if row["fastest_ms"] > 0]
        over = sorted(value for value in over if math.isfinite(value) and value > 0)
        return over[len(over) // 2] if over else 0.0

    def agree(self, name, other):
        """Refuses rows that do not belong together."""
        for fact in ("program", "scene hash", "size", "reference hash", "model", "device",
                     "machine"):
            if self.facts[fact] != other.facts[fact]:
                raise Wrong(f"{name}: its rows were measured with the {fact} '{self.facts[fact]}', "
                            f"and now it is '{other.facts[fact]}'; they do not compare, so give "
                            "another file or remove it")

    def save(self, path):
        with written(path) as to:
            for fact, text in self.facts.items():
                if text:
                    to.write(f"# {fact}: {text}\n")
            to.write(",".join(COLUMNS) + "\n")
            for row in self.rows:
                cells = [value if isinstance(value, str) else number(value)
                         for value in row.setting]
                cells += [number(value) if math.isfinite(value) else "" for value in row.values()]
                to.write(",".join(cells) + ("," + "yes" if row.front else ",") + "\n")


class written:
    """A text file that is there as a whole or not at all."""

    def __init__(self, path):
        self.path = path

    def __enter__(self):
        folder = os.path.dirname(self.path) or "."
        try:
            self.file = tempfile.NamedTemporaryFile("w", dir=folder, prefix=".abbe-", delete=False,
                                                    encoding="utf-8")
        except OSError as error:
            raise Wrong(f"{self.path}: it cannot be written: {error.strerror}") from None
        return self.file

    def __exit__(self, kind, error, trace):
        try:
            self.file.close()
            if kind is None:
                mask = os.umask(0)
                os.umask(mask)
                os.chmod(self.file.name, 0o666 & ~mask)
                os.replace(self.file.name, self.path)
                return
        except OSError as wrong:
            os.unlink(self.file.name)
            raise Wrong(f"{self.path}: it cannot be written: {wrong.strerror}") from None
        os.unlink(self.file.name)


def _cell(name, line, column, text):
    def wrong(right):
        return Wrong(f"{name}:{line}: {column} '{text[:40]}' is not {right}")

    if column in WORDS:
        least = column not in ("polygons", "direction")
        if not least <= len(text) < (16 if least else 32):
            raise wrong(f"a word of {least:d} to {15 if least else 31} letters")
        return text
    if text == "" and column in NUMBERS:
        return math.nan
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise wrong("a number")
    if column == "share" and not value > 0:
        raise wrong("a share above 0")
    if column in NUMBERS or column == "share":
        return value
    if not (0 <= value <= 1e9 and value.is_integer()):
        raise wrong("a whole number from 0 to 1e9")
    return int(value)


def load(name):
    """A table; what is none is refused with its line and cell."""
    try:
        with open(name, encoding="utf-8") as file:
            lines = file.read().splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise Wrong(f"{name}: it cannot be read: "
                    f"{getattr(error, 'strerror', 'it is no text')}") from None
    table, header = Table(), False
    for at, line in enumerate(lines, 1):
        if line.startswith("#"):
            fact, _, text = line[2:].partition(": ")
            if fact in FACTS:
                table.set(fact, text)
        elif line and not header:
            header = True
            cells = line.split(",")
            for i in range(max(len(cells), len(COLUMNS))):
                seen = cells[i] if i < len(cells) else ""
                right = COLUMNS[i] if i < len(COLUMNS) else ""
                if seen != right:
                    raise Wrong(f"{name}:{at}: column {i + 1} is '{seen[:40]}' where a sweep has "
                                f"'{right}'; it is no table of this version's 'abbe sweep'")
        elif line:
            cells = line.split(",")
            if len(cells) != len(COLUMNS):
                raise Wrong(f"{name}:{at}: the row has {len(cells)} cells, not {len(COLUMNS)}")
            values = {column: _cell(name, at, column, text)
                      for column, text in zip(COLUMNS[:-1], cells)}
            row = Row(Setting(**{key: values.pop(key) for key in SETTINGS}), values)
            row.front = cells[-1] == "yes"
            try:
                table.add(row)
            except Wrong as wrong:
                raise Wrong(f"{name}:{at}: {wrong}") from None
    if not header:
        raise Wrong(f"{name}: it has no line of column names")
    return table


def join(tables, names):
    """All rows of tables of one sweep, under the first's facts."""
    out = Table(tables[0].facts)
    for table, name in zip(tables, names):
        table.agree(name, tables[0])
        for row in table.rows:
            try:
                out.add(row)
            except Wrong as wrong:
                raise Wrong(f"{name}: {wrong}") from None
    return out


def geometric_mean(values):
    return math.exp(statistics.fmean(math.log(value) for value in values))
