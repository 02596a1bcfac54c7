"""The settings that a sweep measures: lists of values for each axis, all combinations of a part. An
axis that is not there has the contestant's default."""
import itertools

import abbe

from .table import MOST_ROWS, Setting, Wrong

TRACED = ("trace", "trace-filter")
PINHOLES = ("pinhole-64", "pinhole-256", "pinhole-1024")
PROFILES = ("default", "thesis", "thesis-cie", "shah2007", "shah2007-cie", "wyman2006",
            "wyman2006-cie", "wand2003", *TRACED, *PINHOLES)
# The first varies fastest.
AXES = ("wavelengths", "photons", "map", "samples", "upsample", "exits", "fill", "model", "profiles",
        "passes", "history", "direction", "share")
# What a request of the library calls them.
KEYS = {"map": "map_size", "samples": "supersample", "share": "energy_share"}
TRACE = {"passes": 4, "photons": 512}  # where none are asked for
# Exits and shares that plans have by themselves for a simple scene, so that the settings of all
# scenes are the same ones, as presets need them.
FIXED = {"exits": [8], "share": [0.01]}
FIXED_LAYERS = {"exits": [4], "share": [0.01]}


def _thesis(**axes):
    return {"profiles": ["thesis", "thesis-cie"], **axes}


def _wyman(**axes):
    return {"profiles": ["wyman2006", "wyman2006-cie"], **axes}


def _traced(photons, passes):
    return {"profiles": list(TRACED), "photons": photons, "passes": passes}


def _rough(wavelengths, photons, map, upsample, **axes):
    return {"wavelengths": wavelengths, "photons": photons, "map": map, "upsample": upsample, **axes}


def _fine(wavelengths, photons, map, samples=(1,), **axes):
    return {"wavelengths": wavelengths, "photons": photons, "map": map, "samples": samples, **axes}


def _layers(**axes):
    return {"model": ["layers"], "meshes": True, **axes}


_LEAST = {"exits": [2], "share": [0.1]}
_FILLS = ["points", "quads", "gather-eye", "gather-light"]
GRIDS = {
    # the shape of the Pareto front, in a few minutes
    "quick": [
        _rough([1], [12], [64], [4], **_LEAST),
        _rough([1, 3], [12], [64], [2], **_LEAST),
        _fine([3, 5], [24, 48], [128], share=[0.1]),
        _fine([3, 7, 21], [64, 128, 256], [512]),
        _fine([7], [64, 128, 256], [256, 1024]),
        _fine([7, 21], [512], [1024]),
        _fine([7], [256], [1024], fill=["none"]),
        _thesis(wavelengths=[7, 21], photons=[128, 512], map=[512, 1024]),
        _thesis(wavelengths=[7], photons=[512], fill=["none"]),
        {"profiles": ["shah2007", "shah2007-cie"], "photons": [64, 128, 256], "map": [768]},
        _wyman(photons=[256, 1024], map=[512], fill=_FILLS),
        _wyman(photons=[256], map=[512], fill=["gather-light"], history=[4]),
        _fine([3], [48], [256], history=[4]),
        _traced([256, 512], [2, 8]),
        _traced([1024], [2, 8, 16])],
    # all axes
    "full": [
        _fine([3, 5, 7, 14, 21, 41], [32, 64, 128, 256, 512], [256, 512, 1024, 2048]),
        _fine([7, 21], [128, 256, 512], [512, 1024], [2]),
        {"wavelengths": [7, 21, 81], "photons": [256, 512], "samples": [1], "fill": ["none"]},
        {"photons": [128, 256], "samples": [1], "exits": [1, 2, 4, 16]},
        {"photons": [128, 256], "samples": [1], "share": [0.1, 0.03, 0.001]},
        _thesis(wavelengths=[3, 7, 21, 41], photons=[64, 128, 256, 512, 1024],
                map=[512, 1024, 2048]),
        _thesis(wavelengths=[7, 21], photons=[512, 1024], fill=["none"]),
        {"profiles": ["shah2007"], "photons": [64, 128, 256, 512, 1024], "map": [512, 768, 1024]},
        {"profiles": ["shah2007-cie"], "wavelengths": [3, 7, 21],
         "photons": [64, 128, 256, 512, 1024], "map": [512, 768, 1024]},
        _wyman(photons=[256, 512, 1024, 2048], map=[512, 1024], fill=["gather-light"]),
        _wyman(photons=[256, 512, 1024, 2048], map=[512],
               fill=["points", "quads", "triangles", "gather-eye"]),
        _wyman(photons=[256, 1024], map=[512], fill=["gather-eye", "gather-light"],
               history=[2, 4]),
        {"photons": [64, 128, 256], "samples": [1], "history": [2, 4]},
        _traced([128, 256, 512, 1024, 2048], [2, 4, 8, 16, 32, 64])],
    # what many scenes in one run leave time for; presets are read off it
    "thin": [
        _rough([1], [12], [64], [4], **_LEAST),
        _rough([1, 3], [12], [64], [2], **_LEAST),
        _rough([3, 5], [24], [128], [2], share=[0.1]),
        _rough([5], [48], [128], [2]),
        _fine([3, 5], [16], [64], share=[0.1]),
        _fine([3, 5], [24], [128], share=[0.1]),
        _fine([5], [48], [128], share=[0.1, 0.01]),
        _fine([5], [24], [128]),
        _fine([5], [48], [128], [2]),
        _fine([7], [64], [256]),
        _fine([5, 7], [160], [512], share=[0.1]),
        _fine([7], [64, 128], [512]),
        _fine([21], [128], [512]),
        _fine([7], [192], [512]),
        {"wavelengths": [7], "photons": [256], "samples": [1, 2]},
        {"wavelengths": [21], "photons": [512], "samples": [2]},
        _fine([7], [128], [512], fill=["none"]),
        _layers(**_rough([1], [12], [64], [4], **_LEAST)),
        _layers(**_rough([1, 3], [24], [64], [2], **_LEAST)),
        _layers(**_rough([3], [64], [256], [2])),
        _layers(**_fine([1, 3], [24], [64], **_LEAST)),
        _layers(**_fine([3], [24], [128], share=[0.1, 0.01])),
        _layers(**_fine([3], [24, 64], [256], [2])),
        _layers(**_fine([3, 7], [64], [256])),
        _thesis(wavelengths=[7], photons=[64], map=[256]),
        _thesis(wavelengths=[7], photons=[128, 512], map=[512, 1024]),
        _thesis(wavelengths=[21], photons=[512]),
        _thesis(wavelengths=[7], photons=[512], fill=["none"]),
        {"profiles": ["shah2007", "shah2007-cie"], "photons": [64, 128, 512], "map": [768]},
        _wyman(photons=[512, 1024], map=[512],
               fill=["points", "quads", "triangles", "gather-eye", "gather-light"]),
        _wyman(photons=[1024], map=[512], fill=["gather-eye", "gather-light"], history=[4]),
        _fine([5], [48], [128], history=[4]),
        _fine([7], [128], [512], history=[4]),
        _traced([128, 256], [2, 4, 8]),
        _traced([512], [2, 4, 8, 16]),
        _traced([1024], [4, 8, 16])]}
GRIDS["thin"] = [(FIXED_LAYERS if "model" in part else FIXED) | part for part in GRIDS["thin"]]


def request(setting):
    """What the library is asked for: abbe.Scene.render(**request(setting))."""
    out = {KEYS.get(axis, axis): setting.fields()[axis]
           for axis in ("wavelengths", "photons", "map", "samples", "upsample", "exits", "fill",
                        "model", "share", "profile")}
    if setting.profile in PINHOLES:
        out |= {"profile": "default", "transport": "pinhole",
                "pinholes": int(setting.profile.split("-")[1])}
    if setting.direction:
        out["direction"] = setting.direction
    if setting.history > 1:
        out["history"] = setting.history
    return out


def setting_of(plan, **more):
    """The setting of a resolved request."""
    plain = plan["profile"] == "default"
    own = {axis: plan[KEYS.get(axis, axis)]
           for axis in ("profile", "wavelengths", "photons", "map", "upsample", "fill", "model",
                        "exits")}
    # without effect in published methods: one setting whatever was asked
    own |= {"samples": plan["supersample"] if plain else 1,
            "share": float(plan["energy_share"]) if plain else 0.01,
            "history": max(plan["history"], 1)}
    return Setting(**(own | more))


def _render(scene, axes):
    profile = axes.pop("profiles", "default")
    axes.pop("passes", None)
    if axes.get("history", 1) < 2:  # which alone all profiles know
        axes.pop("history", None)
    how = {KEYS.get(axis, axis): value for axis, value in axes.items()} | {"profile": profile}
    if profile in PINHOLES:
        how |= {"profile": "default", "transport": "pinhole",
                "pinholes": int(profile.split("-")[1])}
    plan = scene.plan(**how)
    own = scene.plan(**{key: value for key, value in how.items() if key != "direction"})
    direction = axes.get("direction", "auto")
    same = direction == "auto" or plan["direction"] == own["direction"]
    return setting_of(plan, profile=profile, direction="" if same else direction)


def expand(scene, parts):
    """Every setting of the parts once, resolved by the scene's plan, in order; how many a
    contestant cannot make of this scene, and why the first cannot."""
    out, refused, why, traceable = {}, 0, None, None
    general = bool(scene.plan()["mesh"])
    for part in parts:
        if part.get("meshes") and not general:
            continue
        axes = [axis for axis in AXES if axis in part]
        for values in itertools.product(*(part[axis] for axis in reversed(axes))):
            chosen = dict(zip(reversed(axes), values))
            profile = chosen.get("profiles", "default")
            try:
                if profile in TRACED:
                    if traceable is None:
                        traceable = _try_trace(scene)
                    if traceable:
                        raise traceable
                    setting = Setting(profile=profile, **{key: chosen.get(key, usual)
                                                          for key, usual in TRACE.items()})
                else:
                    setting = _render(scene, chosen)
            except abbe.Error as error:
                refused += 1
                why = why or error
                continue
            out.setdefault(setting)
            if len(out) > MOST_ROWS:
                raise Wrong(f"the grid has more than {MOST_ROWS} settings; give shorter lists")
    if not out:
        raise Wrong(f"no setting of the grid can be rendered for this scene: {why}")
    return list(out), refused, why


def _try_trace(scene):
    """Why the tracer does not know the scene; False where it does."""
    try:
        scene.trace(width=1, height=1, photons=1, passes=1)
    except abbe.Error as error:
        return error
    return False


def of_presets(scene, path):
    """The settings of the presets' front for the scene, to see whether they keep their promise."""
    of = scene.plan()["class"]
    front = abbe.presets(of, path)
    if not front:
        raise Wrong(f"no preset is known for scenes of the class '{of}'; make some with "
                    "'abbe sweep SWEEP.csv --write-presets FILE'")
    return [preset_setting(point) for point in front["points"]]


def preset_setting(point):
    return setting_of(point | {"profile": "default"})
