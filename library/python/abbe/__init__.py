"""Abbe: what light does in gems, prisms and glass, rendered, traced and compared.

    import abbe
    scene = abbe.Scene("scenes/gem.yaml")
    picture = scene.render(width=128, height=128)
    truth = scene.trace(width=128, height=128, passes=16)
    print(abbe.compare(truth, picture, mask="caustic")["ciede2000_mean"])

Lengths are in metres, wavelengths in nanometres, angles in degrees. Everything that fails raises
abbe.Error with a sentence that says why.
"""
from ._native import Error, version
from .comparison import Comparison, compare, flicker
from .gem import GemReport, gem_report
from .materials import Material, Materials, weights
from .picture import Picture, load
from .scene import Scene, presets

__version__ = version()
__all__ = ["Comparison", "Error", "GemReport", "Material", "Materials", "Picture", "Scene",
           "compare", "flicker", "gem_report", "load", "presets", "version", "weights"]
