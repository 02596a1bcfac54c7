"""libabbe.so by ctypes: the functions with their types, errors as exceptions, settings as texts."""
import ctypes
import os
from ctypes import (CFUNCTYPE, POINTER, Structure, byref, c_bool, c_char, c_char_p, c_double,
                    c_float, c_int, c_size_t, c_void_p)

from . import _place


class Error(RuntimeError):
    """What failed, as a sentence; `code` is the number of the result (base/error.h)."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


Error.__module__ = "abbe"


class _ErrorStruct(Structure):
    _fields_ = [("code", c_int), ("text", c_char * 1024)]


Progress = CFUNCTYPE(c_bool, c_void_p, c_double)
_handle = c_void_p
_out = POINTER(c_void_p)
_texts = POINTER(c_char_p)
_doubles = POINTER(c_double)
_error = POINTER(_ErrorStruct)

# Name: what it returns (None: nothing; int: an abbe_result), and what it takes.
_FUNCTIONS = {
    "version": (c_char_p, []),
    "picture_make": (int, [c_size_t, c_size_t, c_size_t, _texts, POINTER(c_float), _out]),
    "picture_load": (int, [c_char_p, _out]),
    "picture_free": (None, [_handle]),
    "picture_width": (c_size_t, [_handle]),
    "picture_height": (c_size_t, [_handle]),
    "picture_channels": (c_size_t, [_handle]),
    "picture_channel": (c_char_p, [_handle, c_size_t]),
    "picture_pixels": (POINTER(c_float), [_handle]),
    "picture_attribute_name": (c_char_p, [_handle, c_size_t]),
    "picture_attribute": (c_char_p, [_handle, c_char_p]),
    "picture_set_attribute": (int, [_handle, c_char_p, c_char_p]),
    "picture_save": (int, [_handle, c_char_p]),
    "picture_save_png": (int, [_handle, c_char_p, _texts, c_size_t]),
    "scene_open": (int, [c_char_p, c_char_p, c_char_p, _texts, c_size_t, _out]),
    "scene_free": (None, [_handle]),
    "scene_change": (int, [_handle, _texts, c_size_t]),
    "scene_look": (int, [_handle, _doubles, _doubles, _doubles, c_double]),
    "scene_camera": (int, [_handle, _doubles, _doubles, _doubles, _doubles]),
    "scene_set_progress": (None, [_handle, Progress, c_void_p]),
    "scene_render": (int, [_handle, _texts, c_size_t, _out]),
    "scene_map": (int, [_handle, c_char_p, c_size_t, _out]),
    "scene_trace": (int, [_handle, _texts, c_size_t, _handle, _out, _out]),
    "text_free": (None, [_handle]),
    "scene_plan": (int, [_handle, _texts, c_size_t, _out]),
    "scene_place_map": (int, [_handle, c_char_p, _out]),
    "scene_lay_map": (int, [_handle, _handle]),
    "scene_times": (int, [_handle, _texts, c_size_t, _out, _out]),
    "scene_trace_times": (int, [_handle, _texts, c_size_t, _out, _out]),
    "picture_resample": (int, [_handle, _handle, _out]),
    "presets_read": (int, [c_char_p, c_char_p, _out]),
    "comparison_both_noise": (c_double, [_handle, c_char_p, c_bool]),
    "comparison_scale": (c_double, [_handle]),
    "comparison_make": (int, [_handle, _handle, _handle, _texts, c_size_t, _out]),
    "comparison_free": (None, [_handle]),
    "comparison_metric": (c_char_p, [c_size_t]),
    "comparison_value": (int, [_handle, c_char_p, c_bool, _doubles, _doubles, _doubles]),
    "comparison_verdict": (c_char_p, [_handle, c_char_p, c_bool]),
    "comparison_pixels": (c_size_t, [_handle, c_bool]),
    "comparison_draw": (int, [_handle, c_char_p, c_double, c_char_p]),
    "materials_load": (int, [c_char_p, _out]),
    "materials_free": (None, [_handle]),
    "materials_count": (c_size_t, [_handle]),
    "materials_name": (c_char_p, [_handle, c_size_t]),
    "materials_find": (int, [_handle, c_char_p, POINTER(c_size_t)]),
    "materials_text": (c_char_p, [_handle, c_size_t, c_char_p]),
    "materials_range": (int, [_handle, c_size_t, _doubles, _doubles]),
    "materials_index": (int, [_handle, c_size_t, _doubles, c_size_t, _doubles, _doubles]),
    "weights_fill": (int, [c_char_p, c_char_p, c_double, c_double, c_size_t, _doubles, _doubles]),
    "gem_report_make": (int, [c_char_p, c_char_p, _texts, c_size_t, Progress, c_void_p, _out]),
    "gem_report_free": (None, [_handle]),
    "gem_report_name": (c_char_p, [_handle, c_size_t]),
    "gem_report_text": (c_char_p, [_handle, c_size_t]),
    "gem_report_number": (int, [_handle, c_size_t, _doubles, _doubles]),
    "gem_report_maps": (int, [_handle, _out]),
}


def _load():
    """The library at ABBE_LIBRARY, else the one that was installed with this module, else the
    system's."""
    beside = os.path.join(os.path.dirname(os.path.realpath(_place.__file__)), _place.LIBRARY)
    chosen = os.environ.get("ABBE_LIBRARY")
    path = chosen or (beside if os.path.exists(beside) else _place.SONAME)
    library = ctypes.CDLL(path)
    for name, (returns, takes) in _FUNCTIONS.items():
        function = getattr(library, "abbe_lib_" + name)
        function.restype = c_int if returns is int else returns
        function.argtypes = takes + [_error] if returns is int else takes
    library.abbe_result_text.restype = c_char_p
    library.abbe_result_text.argtypes = [c_int]
    return library


_library = _load()


def encode(text, name):
    """A text or path as C has it; None stays None. name: the argument's, for errors."""
    if text is None:
        return None
    if not isinstance(text, (str, bytes, os.PathLike)):
        raise TypeError(f"{name} is a text or a path, not {text!r}")
    encoded = os.fsencode(text)
    if b"\0" in encoded:
        raise ValueError(f"{name} is {text!r}; a text has no NUL")
    return encoded


def required(text, name):
    """encode() of what may not be None."""
    if text is None:
        raise TypeError(f"{name} is None; a text or a path is needed")
    return encode(text, name)


def decode(text):
    return None if text is None else os.fsdecode(text)


def plain(name):
    """A function that cannot fail."""
    return getattr(_library, "abbe_lib_" + name)


def call(name, *arguments):
    """A function that can fail: Error where it does."""
    error = _ErrorStruct()
    code = getattr(_library, "abbe_lib_" + name)(*arguments, byref(error))
    if code == 0:
        return
    text = error.text.decode("utf-8", "replace") or _library.abbe_result_text(code).decode()
    raise Error(code, text)


def taken(pointer):
    """The text that the library gave, which is freed."""
    try:
        return decode(ctypes.string_at(pointer.value))
    finally:
        plain("text_free")(pointer)


def pairs(text):
    """Lines KEY=VALUE as a dict, numbers as numbers."""
    return dict(_pair(line) for line in text.splitlines())


def _pair(line):
    key, _, value = line.partition("=")
    try:
        return key, float(value) if "." in value or "e" in value else int(value)
    except ValueError:
        return key, value


def version():
    """The release of the library."""
    return plain("version")().decode()


def texts(values, name):
    """char *[] and its count."""
    encoded = [required(value, name) for value in values]
    return (c_char_p * max(len(encoded), 1))(*encoded), c_size_t(len(encoded))


def unpacked(value):
    """Python's own numbers and lists of numpy's."""
    return value.tolist() if hasattr(value, "tolist") else value


def _value_text(key, value):
    value = unpacked(value)
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, list) and len(value) == 1:
        value = value[0]
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{key} is a number or a text, not {value!r}") from None
    return str(int(number)) if number.is_integer() and abs(number) < 2**53 else repr(number)


def settings(values):
    """A request as texts KEY=VALUE; None: not said."""
    return texts((f"{key}={_value_text(key, value)}" for key, value in values.items()
                  if value is not None), "a setting")


class Handle:
    """Something of the library's, freed with this object."""

    free = ""

    def __init__(self, pointer):
        self._pointer = pointer

    def __del__(self):
        pointer, self._pointer = getattr(self, "_pointer", None), None
        if pointer is not None:
            plain(self.free)(pointer)


class Watch:
    """A progress function whose exception, as that of Ctrl-C, stops the work and is raised after
    it."""

    def __init__(self, progress):
        self.raised = None

        def told(_, done):
            try:
                return progress is None or progress(done) is not False
            except BaseException as error:  # pylint: disable=broad-except
                self.raised = error
                return False

        self.function = Progress(told)

    def __enter__(self):
        return self.function

    def __exit__(self, kind, error, trace):
        if self.raised is not None:
            raise self.raised from None
