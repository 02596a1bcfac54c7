"""Pictures: numpy arrays in and out, OpenEXR files, files for a display."""
import math
from ctypes import POINTER, addressof, byref, c_float, c_void_p

import numpy

from ._native import Handle, call, decode, plain, required, settings, texts


class Picture(Handle):
    """Named channels of float32, scene-linear, row 0 at the top.

    Picture(array) copies an array [height, width, channels] or [height, width]; `channels` names
    them (R, G, B of three, Y of one), `space` says what R, G, B are: acescg, rec709 or xyz.
    """

    free = "picture_free"

    def __init__(self, array, channels=None, space=None, *, _pointer=None):
        super().__init__(_pointer)
        if _pointer is not None:
            return
        array = numpy.asarray(array)
        if array.ndim == 2:
            array = array[:, :, None]
        if array.ndim != 3:
            raise ValueError("a picture is an array [height, width] or [height, width, channels], "
                             f"not one of {array.ndim} axes")
        height, width, count = array.shape
        if channels is None:
            channels = {1: ["Y"], 3: ["R", "G", "B"], 4: ["R", "G", "B", "A"]}.get(count)
        if channels is None or len(channels) != count:
            raise ValueError(f"{count} channels want as many names: channels=[…]")
        data = numpy.ascontiguousarray(array, dtype=numpy.float32)
        pointer = c_void_p()
        call("picture_make", width, height, count, texts(channels, "channels")[0],
             data.ctypes.data_as(POINTER(c_float)), byref(pointer))
        self._pointer = pointer
        if space is not None:
            self["abbe:space"] = space

    @property
    def channels(self):
        """Names of the channels in their order."""
        count = plain("picture_channels")(self._pointer)
        return [decode(plain("picture_channel")(self._pointer, i)) for i in range(count)]

    @property
    def shape(self):
        """(height, width, channels)"""
        return tuple(plain("picture_" + side)(self._pointer)
                     for side in ("height", "width", "channels"))

    @property
    def pixels(self):
        """All channels as the picture's own memory: [height, width, channels] float32. What is
        written into it is written into the picture, which lives as long as the array."""
        shape = self.shape
        pixels = plain("picture_pixels")(self._pointer)
        buffer = (c_float * math.prod(shape)).from_address(addressof(pixels.contents))
        buffer.picture = self
        return numpy.frombuffer(buffer, dtype=numpy.float32).reshape(shape)

    def __array__(self, dtype=None, copy=None):
        pixels = self.pixels
        return pixels if dtype is None else pixels.astype(dtype)

    def layer(self, name=""):
        """The channels of a layer as a copy: layer("caustic") has caustic.R, caustic.G, caustic.B;
        layer() R, G, B (or X, Y, Z); layer("Z") one channel, without its axis."""
        names = self.channels
        if name in names:
            return self.pixels[:, :, names.index(name)].copy()
        prefix = name + "." if name else ""
        for letters in ("RGB", "XYZ"):
            wanted = [prefix + letter for letter in letters]
            if all(one in names for one in wanted):
                return self.pixels[:, :, [names.index(one) for one in wanted]]
        raise KeyError(f"the picture has no layer '{name}'; its channels are {', '.join(names)}")

    @property
    def rgb(self):
        """R, G, B (or X, Y, Z) as a copy, [height, width, 3]."""
        return self.layer()

    @property
    def attributes(self):
        """The texts of the file's header."""
        out, index = {}, 0
        while (name := plain("picture_attribute_name")(self._pointer, index)) is not None:
            out[decode(name)] = decode(plain("picture_attribute")(self._pointer, name))
            index += 1
        return out

    def __getitem__(self, name):
        text = plain("picture_attribute")(self._pointer, required(name, "name"))
        if text is None:
            raise KeyError(name)
        return decode(text)

    def __setitem__(self, name, text):
        call("picture_set_attribute", self._pointer, required(name, "name"), required(text, name))

    def resample(self, like):
        """This map's light in the texels of another map of the same light."""
        pointer = c_void_p()
        call("picture_resample", self._pointer, like._pointer, byref(pointer))
        return of_pointer(pointer)

    def save(self, path, **how):
        """As OpenEXR; for a screen where the path ends with .png, .webp, .jpg, .gif or .avif, through
        OpenColorIO: with exposure (stops), view, display, config, layer, bits."""
        if not str(path).lower().endswith((".png", ".webp", ".jpg", ".jpeg", ".gif", ".avif")):
            if how:
                raise TypeError("an OpenEXR file takes no settings: " + ", ".join(how))
            call("picture_save", self._pointer, required(path, "path"))
            return
        call("picture_save_png", self._pointer, required(path, "path"), *settings(how))


def of_pointer(pointer):
    """The picture that the library made."""
    return Picture(None, _pointer=pointer)


def load(path):
    """A picture from an OpenEXR, Radiance or PNG file, or by the header of an ENVI cube."""
    pointer = c_void_p()
    call("picture_load", required(path, "path"), byref(pointer))
    return of_pointer(pointer)
