"""Finds the axes of a bus that a program commands. Used by Axes."""
from __future__ import annotations

from .link import Link, Obstacle

LAYOUT_TIME = 1.5  # seconds for the speed axes of a layout, which come once a second


def find_axes(link: Link, names: tuple[str, ...]) -> list:
    """Puts the axes with these names into link.axes, in the order of the names. Without names,
    takes all axes with positions, or all speed axes if no axis has a position. For speed axes,
    returns their speed_axis_t and leaves link.axes empty."""
    inverters = _inverters(link, names)
    with_position = [axis for axis in link.found_axes if axis.name not in inverters]
    if inverters and (set(names) & set(inverters) if names else not with_position):
        chosen = list(names) or list(inverters)
        if len(set(chosen)) < len(chosen) or not set(chosen) <= set(inverters):
            raise Obstacle("wrong use", f"bus {link.bus} does not have all of these axes as speed "
                                        "axes, or one is named twice: use one Axes for speed axes "
                                        "and one for axes with positions")
        return [inverters[name] for name in chosen]
    known = {axis.name: axis for axis in with_position}
    for name in names:
        if name not in known or names.count(name) > 1:
            raise Obstacle("wrong use", f"bus {link.bus} has no axis '{name}', or it is named "
                                        "twice; the axes are: "
                                        f"{', '.join([*known, *inverters]) or 'none'}")
    link.axes = [known[name] for name in names] if names else with_position
    if not link.axes:
        raise Obstacle("wrong use", f"bus {link.bus} has no axis: no node has 6040 and 6041 in its "
                                    "PDOs, or the words of an inverter")
    return []


def _inverters(link: Link, names: tuple[str, ...]) -> dict:
    """Returns the speed axes of the bus by name. Waits for them if the names may be those of speed
    axes."""
    with_position = {axis.name for axis in link.found_axes if axis.has_target}
    wanted, begin = set(names) - with_position if names else not with_position, link.now()
    while wanted and not link.speed_words() and link.now() < begin + LAYOUT_TIME:
        link.serve(0.05)
    return {words.node: words for words in link.speed_words()}
