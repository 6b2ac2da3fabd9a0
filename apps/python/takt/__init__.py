"""takt in Python: programs that command CANopen devices through a running taktd.

    import takt

    with takt.Axes("demo", "shoulder", "elbow") as axes:
        axes.enable()
        axes.move(1.5, 0.5, velocity=3, acceleration=20)

    with takt.Bus("demo") as bus:
        print(bus.signal("shoulder.position_actual_value"), bus.sdo_read("shoulder.statusword"))

`Bus` has the image of a bus, its events and nodes, set-points, and the objects of its devices.
`Axes` is a `Bus` that also moves axes. A call that something blocks raises `Obstacle`, whose text
names the cause. The types of the LCM messages are names of this package, too: `takt.image_t`.
share/doc/python.md describes the package, share/doc/axis_library.md all calls.

The package needs the module `lcm` and no other. It starts no threads, and takes messages only while
a call waits. Use each object in one thread only.
"""
from pkgutil import extend_path

# In the tree of sources, the types that lcm-gen has made are in another folder `takt`.
__path__ = extend_path(__path__, __name__)

from .axes import Axes
from .bus import Bus
from .envelopes import Envelopes, read_keys
from .image import Image
from .link import Obstacle
from .nodes import Node
from .messages import *  # last, so that the name of a type means the class and not its module
from .messages import __all__ as _types

__version__ = "0.1.0"
__all__ = ["Axes", "Bus", "Envelopes", "Image", "Node", "Obstacle", "read_keys", *_types]
