"""How far a picture or map is from a reference."""
from collections import namedtuple
from ctypes import byref, c_double, c_void_p

import numpy

from ._native import Handle, call, decode, encode, plain, required, settings
from .picture import Picture

Value = namedtuple("Value", "value noise limit verdict")


class Comparison(Handle):
    """comparison["ciede2000_mean"] is the metric's value, of the mask where there is one.

    value(name, masked) has with it what the reference's noise alone would give (noise), up to where
    that explains the value (limit), and the verdict in words.
    """

    free = "comparison_free"

    def __init__(self, reference, test, mask=None, **how):
        super().__init__(None)
        reference, test = _picture(reference), _picture(test)
        drawn = None if mask is None or isinstance(mask, str) else _picture(mask)
        if isinstance(mask, str):
            how["mask"] = mask
        pointer = c_void_p()
        call("comparison_make", reference._pointer, test._pointer,
             None if drawn is None else drawn._pointer, *settings(how), byref(pointer))
        self._pointer = pointer
        self.masked = mask is not None

    @property
    def metrics(self):
        """Names of all metrics."""
        out, index = [], 0
        while (name := plain("comparison_metric")(index)) is not None:
            out.append(decode(name))
            index += 1
        return out

    def value(self, metric, masked=None):
        """(value, noise, limit, verdict); NaN stands for what is not known."""
        masked = self.masked if masked is None else masked
        numbers = [c_double() for _ in range(3)]
        call("comparison_value", self._pointer, required(metric, "metric"), masked,
             *(byref(number) for number in numbers))
        verdict = plain("comparison_verdict")(self._pointer, required(metric, "metric"), masked)
        return Value(*(number.value for number in numbers), decode(verdict))

    def both_noise(self, metric, masked=None):
        """What the noise of both alone would give; NaN where the test has no standard errors."""
        masked = self.masked if masked is None else masked
        return plain("comparison_both_noise")(self._pointer, required(metric, "metric"), masked)

    @property
    def scale(self):
        """The factor that the test was multiplied by; 1 without best_scale."""
        return plain("comparison_scale")(self._pointer)

    def __getitem__(self, metric):
        return self.value(metric).value

    def pixels(self, masked=None):
        """How many were compared."""
        return plain("comparison_pixels")(self._pointer,
                                          self.masked if masked is None else masked)

    def plot(self, path, range=0, title=None):
        """Where the test is brighter (red) or darker (blue), as .png or .svg."""
        call("comparison_draw", self._pointer, required(path, "path"), float(range),
             encode(title, "title"))


def _picture(value):
    return value if isinstance(value, Picture) else Picture(value)


def compare(reference, test, mask=None, **how):
    """Holds a picture against a reference; arrays are taken as linear Rec.709. mask: "caustic", or
    a picture or array, above 0.5 inside."""
    return Comparison(reference, test, mask, **how)


def flicker(frames, references=None, layer=""):
    """How a series of pictures errs over time: a row (error, change, ghost) for each.

    error: root mean square of the frame less its reference. change: the same of what that
    difference has changed since the last frame. ghost: the frame's light where the reference has
    less than a thousandth of its mean, as a share of the reference's light. The first two are
    relative to the root mean square of the reference; without references, of the frame. NaN
    stands for what is not known.
    """
    rows, before = [], None
    for i, frame in enumerate(frames):
        test = _picture(frame).layer(layer).astype(float)
        truth = None if references is None else _picture(references[i]).layer(layer).astype(float)
        now = test if truth is None else test - truth
        size = numpy.sqrt(numpy.mean((test if truth is None else truth) ** 2))
        change = numpy.nan if before is None else numpy.sqrt(numpy.mean((now - before) ** 2)) / size
        before = now
        if truth is None:
            rows.append((numpy.nan, change, numpy.nan))
            continue
        light = truth.sum(axis=2)
        ghost = test.sum(axis=2)[light <= 1e-3 * light.mean()].sum() / light.sum()
        rows.append((numpy.sqrt(numpy.mean(now ** 2)) / size, change, ghost))
    return numpy.array(rows)
