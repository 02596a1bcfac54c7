"""Materials and the weights of wavelengths."""
from ctypes import POINTER, byref, c_double, c_size_t, c_void_p

import numpy

from ._native import Handle, call, decode, encode, plain, required

_doubles = POINTER(c_double)


class Materials(Handle):
    """A table of materials: "default", "thesis" or a file. materials["diamond"], len(materials),
    and a loop over their names."""

    free = "materials_free"

    def __init__(self, table="default"):
        super().__init__(None)
        pointer = c_void_p()
        call("materials_load", encode(table, "table"), byref(pointer))
        self._pointer = pointer

    def __len__(self):
        return plain("materials_count")(self._pointer)

    def __iter__(self):
        return (decode(plain("materials_name")(self._pointer, i)) for i in range(len(self)))

    def __getitem__(self, name):
        index = c_size_t()
        call("materials_find", self._pointer, required(name, "name"), byref(index))
        return Material(self, index.value)


class Material:
    """One of a table's."""

    def __init__(self, materials, index):
        self._materials, self._index = materials, index
        self.name = decode(plain("materials_name")(materials._pointer, index))

    def __repr__(self):
        return f"<abbe.Material {self.name}>"

    def _text(self, what):
        return decode(plain("materials_text")(self._materials._pointer, self._index, what))

    @property
    def description(self):
        return self._text(b"description")

    @property
    def source(self):
        return self._text(b"source")

    @property
    def warning(self):
        return self._text(b"warning")

    @property
    def range(self):
        """(from, to): the wavelengths in nm that its index is known at."""
        ends = c_double(), c_double()
        call("materials_range", self._materials._pointer, self._index, byref(ends[0]),
             byref(ends[1]))
        return ends[0].value, ends[1].value

    def _index_at(self, nm):
        nm = numpy.ascontiguousarray(nm, dtype=float)
        n, k = numpy.empty_like(nm), numpy.empty_like(nm)
        call("materials_index", self._materials._pointer, self._index,
             nm.ctypes.data_as(_doubles), nm.size, n.ctypes.data_as(_doubles),
             k.ctypes.data_as(_doubles))
        return n, k

    def n(self, nm):
        """The index at wavelengths in nm: an array of their shape, a number for a number."""
        return self._index_at(nm)[0].reshape(numpy.shape(nm))[()]

    def k(self, nm):
        """The imaginary part."""
        return self._index_at(nm)[1].reshape(numpy.shape(nm))[()]


def weights(count=7, range=(380, 780), illuminant="D65", space="xyz"):
    """(wavelengths [count] in nm, weights [count, 3]): what each sample adds to a colour."""
    nm, weight = numpy.empty(count), numpy.empty((count, 3))
    call("weights_fill", required(illuminant, "illuminant"), required(space, "space"), range[0],
         range[1], count,
         nm.ctypes.data_as(_doubles), weight.ctypes.data_as(_doubles))
    return nm, weight
