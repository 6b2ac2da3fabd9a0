"""Objects of devices by SDO, through taktd. Used by takt_axes."""
from __future__ import annotations

import random
import time

from takt import reply_t, request_t

from takt_link import SCHEMA, Link, Obstacle


class Services:
    """One request at a time. Motions go on while a request waits."""

    def __init__(self, link: Link):
        self._link = link
        self._number = random.randrange(1, 2**40)  # of the newest request
        self._reply = None  # to it
        link.subscribe("REPLY", self._on_reply)

    def read(self, node: str, index: int, sub: int) -> bytes:
        return self._ask("sdo_upload", node, index, sub, b"")

    def write(self, node: str, index: int, sub: int, data: bytes) -> None:
        self._ask("sdo_download", node, index, sub, bytes(data))

    def _ask(self, service: str, node: str, index: int, sub: int, data: bytes) -> bytes:
        request, what = request_t(), f"{node} 0x{index:04X}:{sub:02X}"
        request.service, request.node_id = service, self._node_id(node)
        request.index, request.sub, request.data, request.size = index, sub, data, len(data)
        request.utime, request.schema = int(time.time() * 1e6), SCHEMA
        self._number, self._reply = self._number + 1, None
        request.session, request.sender = self._link.session, self._link.sender
        request.id = self._number
        self._link.publish("REQUEST", request)
        if not self._link.wait(lambda: self._reply is not None, self._link.longest):
            raise Obstacle("time over", f"{what}: taktd has not answered the SDO request")
        if not self._reply.good:
            raise Obstacle("refused", f"{what}: {self._reply.text}")
        return bytes(self._reply.data)

    def _node_id(self, name: str) -> int:
        found = {signal.node: signal.node_id for signal in self._link.signals.values()}
        found |= {node.name: node.node_id for node in self._link.nodes.values() if node.name}
        if name not in found:
            raise Obstacle("wrong use", f"bus {self._link.bus} has no node '{name}'; the nodes "
                                        f"are: {', '.join(found)}")
        return found[name]

    def _on_reply(self, channel: str, data: bytes) -> None:
        reply = reply_t.decode(data)
        if (reply.schema, reply.sender, reply.id) == (SCHEMA, self._link.sender, self._number):
            self._reply = reply
