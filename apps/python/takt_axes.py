"""The name of earlier versions for `takt.Axes` and `takt.Obstacle`. Programs of 0.x may keep it."""
import pathlib

import takt

# A program of an earlier version may have a package `takt` that has only the types of lcm-gen.
_library = str(pathlib.Path(__file__).with_name("takt"))
if _library not in takt.__path__:
    takt.__path__.append(_library)

from takt.axes import Axes  # noqa: E402
from takt.link import Obstacle  # noqa: E402

__all__ = ["Axes", "Obstacle"]
