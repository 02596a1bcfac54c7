"""Scenes: opened, changed, looked at, rendered and traced."""
import math
from ctypes import byref, c_double, c_size_t, c_void_p

from ._native import (Handle, Progress, Watch, call, encode, pairs, plain, required, settings,
                      taken, texts, unpacked)
from .picture import of_pointer


def _three(values):
    if values is None:
        return None
    values = [float(value) for value in values]
    if len(values) != 3:
        raise ValueError(f"a place or direction has three numbers, not {len(values)}")
    return (c_double * 3)(*values)


def _value(key, value):
    value = unpacked(value)
    if value is None:
        raise TypeError(f"'{key}' is None; a value of the scene file is needed")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(key, one) for one in value) + "]"
    return str(value)


def _changes(values):
    return texts((f"{key}={_value(key, value)}" for key, value in values.items()), "a value of set")


class Scene(Handle):
    """A scene file; one that is not there is taken from those that came with Abbe.

    materials: default, thesis or a file instead of the scene's own table; stone: what its
    refractors are made of; set: {"camera.fov": 30, "lights.lamp.intensity": 2}.
    """

    free = "scene_free"

    def __init__(self, path, materials=None, stone=None, set=None):
        super().__init__(None)
        pointer = c_void_p()
        call("scene_open", required(path, "path"), encode(materials, "materials"),
             encode(stone, "stone"), *_changes(set or {}), byref(pointer))
        self._pointer = pointer

    def change(self, set):
        """Other values of the file: change({"lights.lamp.intensity": 2})."""
        call("scene_change", self._pointer, *_changes(set))

    def look(self, eye=None, target=None, up=None, fov=None):
        """Moves the camera: m, and degrees from bottom to top; None: as it is."""
        if fov is not None and not 0 < fov < 180:
            raise ValueError(f"fov is above 0 and below 180 degrees, not {fov}")
        call("scene_look", self._pointer, _three(eye), _three(target), _three(up),
             0.0 if fov is None else math.radians(fov))

    @property
    def camera(self):
        """{"eye": …, "target": …, "up": …, "fov": …}"""
        eye, target, up, fov = ((c_double * 3)() for _ in range(4))
        call("scene_camera", self._pointer, eye, target, up, fov)
        return {"eye": tuple(eye), "target": tuple(target), "up": tuple(up),
                "fov": math.degrees(fov[0])}

    def render(self, progress=None, **how):
        """The picture by OpenGL: width, height, wavelengths, photons, map_size, aovs, … progress
        is called with the share done; what it raises, or False, stops the work."""
        pointer = c_void_p()
        self._watched(progress, "scene_render", *settings(how), byref(pointer))
        return of_pointer(pointer)

    def map(self, light=None, bands=0):
        """Where a light's flux landed in the last rendered picture, W a texel."""
        pointer = c_void_p()
        call("scene_map", self._pointer, encode(light, "light"), c_size_t(bands), byref(pointer))
        return of_pointer(pointer)

    def trace(self, progress=None, **how):
        """The reference, with standard errors: passes, seconds, error, width, height, photons,
        bands, seed, filter, …"""
        pointer = c_void_p()
        self._watched(progress, "scene_trace", *settings(how), None, byref(pointer), None)
        return of_pointer(pointer)

    def trace_map(self, like=None, progress=None, **how):
        """The reference's map; like: a map whose texels it is to have."""
        pointer = c_void_p()
        self._watched(progress, "scene_trace", *settings(how),
                      None if like is None else like._pointer, None, byref(pointer))
        return of_pointer(pointer)

    def trace_both(self, like=None, progress=None, **how):
        """The reference and its map by the same passes."""
        picture, drawn = c_void_p(), c_void_p()
        self._watched(progress, "scene_trace", *settings(how),
                      None if like is None else like._pointer, byref(picture), byref(drawn))
        return of_pointer(picture), of_pointer(drawn)

    def plan(self, **how):
        """What a request of render() comes to, without rendering: its settings as they are
        resolved, and what the scene is: class, hash, size, mesh, mesh_faces, caustics, light_views,
        device (once something was rendered)."""
        pointer = c_void_p()
        call("scene_plan", self._pointer, *settings(how), byref(pointer))
        return pairs(taken(pointer))

    def place_map(self, backend=None):
        """Where the default picture's map would lie: a map of one texel, for `like`."""
        pointer = c_void_p()
        call("scene_place_map", self._pointer, encode(backend, "backend"), byref(pointer))
        return of_pointer(pointer)

    def lay_map(self, like):
        """Maps rendered from now on have the texels of that map; None: fitted to what lands."""
        call("scene_lay_map", self._pointer, None if like is None else like._pointer)

    def times(self, progress=None, **how):
        """How long frames of the last rendered picture take, ms, and that picture: frames (behind
        the median), enough_ms, baseline, camera."""
        return self._timed(progress, "scene_times", how)

    def trace_times(self, progress=None, **how):
        """The same of the tracer: passes, photons (a side), filter, width, height, frames."""
        return self._timed(progress, "scene_trace_times", how)

    def _timed(self, progress, name, how):
        picture, pointer = c_void_p(), c_void_p()
        self._watched(progress, name, *settings(how), byref(picture), byref(pointer))
        return pairs(taken(pointer)), of_pointer(picture)

    def _watched(self, progress, name, *arguments):
        with Watch(progress) as function:
            plain("scene_set_progress")(self._pointer, function, None)
            try:
                call(name, self._pointer, *arguments)
            finally:
                plain("scene_set_progress")(self._pointer, Progress(), None)


def presets(of, path=None):
    """What a file of presets (None: the shipped ones) promises of a class of scenes, as a dict with
    error, error_text, scenes, margin, time_margin and points, the cheapest first; empty where there
    is no such class."""
    pointer = c_void_p()
    call("presets_read", encode(path, "path"), required(of, "of"), byref(pointer))
    lines = taken(pointer).splitlines()
    out = pairs("\n".join(line for line in lines if not line.startswith("point=")))
    if lines:
        out["points"] = [pairs("\n".join(line.split(" "))) for line in lines
                         if line.startswith("point=")]
    return out
