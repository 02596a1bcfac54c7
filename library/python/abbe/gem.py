"""Designs of gems, judged in a stone."""
import math
from collections import namedtuple
from ctypes import byref, c_double, c_void_p

from ._native import Handle, Watch, call, decode, plain, required, settings
from .picture import of_pointer

Number = namedtuple("Number", "value error text")
_ANGLES = {"head": "head_rad", "tilt": "tilt_rad", "step": "step_rad", "crown": "crown_rad",
           "pavilion": "pavilion_rad"}


class GemReport(Handle):
    """report["iso"] is a number with its standard error; keys() has the names of all."""

    free = "gem_report_free"

    def __init__(self, path, material, progress=None, **how):
        super().__init__(None)
        for key, name in _ANGLES.items():
            if how.get(key) is not None:
                how[name] = math.radians(how.pop(key))
        if how.get("width") is not None:
            how["width_m"] = how.pop("width")
        pointer = c_void_p()
        with Watch(progress) as function:
            call("gem_report_make", required(path, "path"), required(material, "material"),
                 *settings(how), function, None, byref(pointer))
        self._pointer = pointer
        self._numbers, index = {}, 0
        while (name := plain("gem_report_name")(pointer, index)) is not None:
            value, error = c_double(), c_double()
            call("gem_report_number", pointer, index, byref(value), byref(error))
            text = decode(plain("gem_report_text")(pointer, index))
            self._numbers[decode(name)] = Number(value.value, error.value, text)
            index += 1

    def keys(self):
        return self._numbers.keys()

    def __getitem__(self, name):
        return self._numbers[name]

    def maps(self):
        """All amounts a pixel, seen from above, as a Picture."""
        pointer = c_void_p()
        call("gem_report_maps", self._pointer, byref(pointer))
        return of_pointer(pointer)


def gem_report(path, material, **how):
    """Judges a design (.asc, .gem, .gcs) in a stone: tilt, head and step in degrees (tilt=0: not
    tilted, and no fire), crown and pavilion (main angles, in degrees), width in m, wavelengths, size, repeats, table."""
    return GemReport(path, material, **how)
