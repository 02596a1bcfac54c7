"""Of many costs and errors, those that no other beats in both; and what is read off them: how the
default profile stands against the others, and what an error is made of."""
import math
from collections import namedtuple

BASELINES = {  # against whom: in words, and what its keys in JSON begin with
    "thesis": ("thesis profile, with the best factor on its brightness", ""),
    "thesis-cie": ("thesis's method with CIE weights, in physical units", "vs_fair_"),
    "trace": ("tracer", "vs_trace_"),
    "trace-filter": ("tracer, filtered", "vs_filtered_"),
    "shah2007": ("caustics mapping, with the best factor on its brightness", "vs_shah2007_"),
    "shah2007-cie": ("caustics mapping with CIE weights, in physical units", "vs_fair_shah2007_"),
    "wyman2006": ("photons in image space, with the best factor on its brightness",
                  "vs_wyman2006_"),
    "wyman2006-cie": ("photons in image space with CIE weights, in physical units",
                      "vs_fair_wyman2006_")}


def order(cost, error):
    """Indices of those that no other beats, in the order of cost; of equal ones the first. What is
    not finite, or costs nothing, does not count."""
    known = [i for i in range(len(cost))
             if math.isfinite(cost[i]) and cost[i] > 0 and math.isfinite(error[i])]
    out, least = [], math.inf
    for i in sorted(known, key=lambda i: (cost[i], error[i], i)):
        if error[i] < least:
            out.append(i)
            least = error[i]
    return out


def knee(cost, error):
    """Where a front bends most: the point furthest below the line between its ends, in logarithms;
    without a bend the middle one."""
    count = len(cost)
    if count < 3:
        return count // 2
    x = [math.log(value) for value in cost]
    y = [math.log(max(value, 1e-12)) for value in error]
    best, most = count // 2, 1e-9
    for i in range(1, count - 1):
        below = y[0] + (y[-1] - y[0]) * (x[i] - x[0]) / (x[-1] - x[0]) - y[i]
        if below > most:
            best, most = i, below
    return best


def accurate(error, slack):
    """The cheapest point of a front whose error is at most that share above the least."""
    least = min(error, default=math.inf)
    return next((i for i, value in enumerate(error) if value <= least * (1 + slack)), 0)


# ---- the default profile against a baseline ----

Comparison = namedtuple("Comparison", "row speedup ratio front beaten front_speedup front_ratio")


def _is_own(s, profile):
    """The published settings."""
    if s.profile != profile:
        return False
    if profile.startswith("shah2007"):
        return s.photons == 128 and s.map == 768
    if profile.startswith("wyman2006"):
        return s.photons == 1024 and s.map == 512 and s.fill == "gather-light"
    return s.wavelengths == 7 and s.photons == 512 and s.map == 1024 and s.fill == "smear"


def compare(table, profile, time, error):
    """How much sooner the default profile has a baseline's error, and how much of it is left in its
    time: of the baseline's own settings, and of every point of its front, where the hardest answer
    counts. Points are measured ones. NaN: not known, or never reached."""
    plain = [row for row in table.rows
             if row.setting.profile == "default" and row.setting.history < 2]

    def meet(ms, wrong):
        sooner = min((row[time] for row in plain
                      if row[error] <= wrong and math.isfinite(row[time])), default=math.nan)
        nearer = min((row[error] for row in plain
                      if row[time] <= ms and math.isfinite(row[error])), default=math.nan)
        return ms / sooner, nearer / wrong if wrong > 0 else math.nan

    own = [row for row in table.rows if _is_own(row.setting, profile)]
    row = max(own, key=lambda row: row.setting.history, default=None)
    cost = table.column(time, lambda s: s.profile == profile)
    wrong = table.column(error)
    met = [meet(cost[i], wrong[i]) for i in order(cost, wrong)]
    beaten = sum((speedup > 1 and ratio <= 1) or (speedup >= 1 and ratio < 1)
                 for speedup, ratio in met)
    # one point that is not reached at all is worse than any number
    speedups, ratios = [m[0] for m in met] or [math.nan], [m[1] for m in met] or [math.nan]
    speedup, ratio = meet(row[time], row[error]) if row else (math.nan, math.nan)
    return Comparison(row, speedup, ratio, len(met), beaten,
                      math.nan if any(map(math.isnan, speedups)) else min(speedups),
                      math.nan if any(map(math.isnan, ratios)) else max(ratios))


# ---- what an error is made of ----

def model_text(numbers):
    return "caustic_de {} ({}), map_rmse {} ({}), map_energy {}".format(*map(repr, numbers))


def _model(table):
    """Errors of matched physics against full: de, its noise, map, its noise, energy."""
    words = table.facts["model"].replace("(", "").replace(")", "").replace(",", "").split()
    try:
        return [float(words[i]) for i in (1, 2, 4, 5, 7)]
    except (IndexError, ValueError):
        return [math.nan] * 5


def _above_noise(error, noise):
    return math.sqrt(max(error * error - noise * noise, 0)) if math.isfinite(noise) else error


def _with_fewer(table, s, what):
    """The rest of the row with at most half of one kind of sample and else the same."""
    fewer = [row for row in table.rows if 2 * row.setting.fields()[what] <= s.fields()[what] and
             row.setting.but(**{what: s.fields()[what]}) == s]
    best = max(fewer, key=lambda row: row.setting.fields()[what], default=None)
    return best["matched_de"] if best else math.nan


def decompose(table):
    """Of what the error of the default profile's most accurate setting is made: parts by name and
    `words`; None where there is no such setting."""
    plain = [row for row in table.rows if row.setting.profile == "default"]
    row = min((row for row in plain if math.isfinite(row["caustic_de"])),
              key=lambda row: row["caustic_de"], default=None)
    if row is None:
        return None
    de, de_noise, _, _, energy = _model(table)
    bare = [one for one in plain if one.setting.fill == "none" and
            table.find(one.setting.but(fill="bridge"))]
    bare = max(bare, key=lambda one: one.setting.photons * one.setting.wavelengths, default=None)
    filled = table.find(bare.setting.but(fill="bridge")) if bare else None
    out = {"total": row["caustic_de"], "model": de,
           "sampling_and_reconstruction": row["matched_de"],
           "with_fill": filled["matched_de"] if filled else math.nan,
           "without_fill": bare["matched_de"] if bare else math.nan}
    out["words"] = _say(row, out, de_noise, energy, {what: _with_fewer(table, row.setting, what)
                                                    for what in ("photons", "wavelengths")})
    return out


def _say(row, part, model_noise, energy, fewer):
    total, model, rest = part["total"], part["model"], part["sampling_and_reconstruction"]
    words = [f"What is left: {row.setting.label} has {total:.3g} "
             f"({row['caustic_de_noise']:.2g} of it noise)."]
    if math.isfinite(model) and math.isfinite(rest):
        words.append("Matched physics, which leaves out what the model does, is itself "
                     f"{model:.3g} ({model_noise:.2g}) away from full; the setting is {rest:.3g} "
                     f"({row['matched_de_noise']:.2g}) away from matched physics.")
        own, left = _above_noise(model, model_noise), _above_noise(rest, row["matched_de_noise"])
        if max(own, left) < 0.1 * total:
            words.append("Both are noise: a longer reference would tell more.")
        elif own > 1.5 * left:
            words.append("So most of it is the model's.")
        elif left > 1.5 * own:
            words.append("So most of it is sampling and reconstruction.")
        else:
            words.append("So the model has about as much of it as sampling and reconstruction.")
    if math.isfinite(energy) and math.isfinite(row["map_energy"]):
        words.append(f"The model keeps {100 * energy:.1f} % of the map's light, and the setting "
                     f"has {100 * row['map_energy']:.1f} %.")
    for what, before in fewer.items():
        if math.isfinite(before) and math.isfinite(rest):
            pays = rest < 0.95 * before
            words.append(f"With fewer {what} it was {before:.3g}: more of them would "
                         + ("help on." if pays else "not help."))
    if math.isfinite(part["with_fill"]) and math.isfinite(part["without_fill"]):
        words.append("Reconstruction: the bridge between wavelengths turns "
                     f"{part['without_fill']:.3g} into {part['with_fill']:.3g}.")
    if math.isfinite(row["fill_invented"]) and math.isfinite(row["fill_lost"]):
        words.append(f"The fill adds {row['fill_invented']:.1g} and drops {row['fill_lost']:.1g} "
                     "of the map's light.")
    return " ".join(words)
