"""Requests to taktd: objects of devices by SDO, and commands of NMT. Used by Bus."""
from __future__ import annotations

import random
import time

from .link import SCHEMA, Link, Obstacle
from .messages import reply_t, request_t

# NMT commands, by their words for `takt nmt`. Before a command that ends the exchange of PDOs,
# taktd stops the axes in order; `stop_timeout` is at most 60 s.
NMT = {"start": 1, "stop": 2, "preop": 128, "reset": 129, "reset-comm": 130}
AFTER_AXES, STOP_TIME = ("stop", "preop"), 65.0


class Services:
    """Sends one request at a time. Motions go on while a request waits."""

    def __init__(self, link: Link):
        self._link = link
        self._number = random.randrange(1, 2**40)  # number of the newest request
        self._reply: reply_t | None = None  # the reply to it
        link.subscribe("REPLY", reply_t, self._on_reply)

    def read(self, node: str, index: int, sub: int) -> bytes:
        return self._access("sdo_upload", node, index, sub, b"")

    def write(self, node: str, index: int, sub: int, data: bytes) -> None:
        self._access("sdo_download", node, index, sub, bytes(data))

    def nmt(self, command: str, node: str) -> None:
        request = request_t()
        if command not in NMT:
            raise Obstacle("wrong use", f"'{command}' is not one of {', '.join(NMT)}")
        request.service, request.nmt_command = "nmt", NMT[command]
        request.data = b""
        request.node_id = 0 if node == "all" else self._node_id(node)
        seconds = STOP_TIME if command in AFTER_AXES else self._link.longest
        self._ask(request, f"{command} of {node}", seconds)

    def _access(self, service: str, node: str, index: int, sub: int, data: bytes) -> bytes:
        request = request_t()
        request.service, request.node_id = service, self._node_id(node)
        request.index, request.sub, request.data, request.size = index, sub, data, len(data)
        return self._ask(request, f"{node} 0x{index:04X}:{sub:02X}", self._link.longest)

    def _ask(self, request: request_t, what: str, seconds: float) -> bytes:
        request.utime, request.schema = int(time.time() * 1e6), SCHEMA
        self._number, self._reply = self._number + 1, None
        request.session, request.sender = self._link.session, self._link.sender
        request.id = self._number
        self._link.publish("REQUEST", request)
        if not self._link.wait(lambda: self._reply is not None, seconds):
            refusal = self._link.refused_envelope("REQUEST")
            raise Obstacle("refused" if refusal else "time over",
                           f"{what}: {refusal or 'taktd has not answered the request'}")
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

    def _on_reply(self, reply: reply_t) -> None:
        if (reply.schema, reply.sender, reply.id) == (SCHEMA, self._link.sender, self._number):
            self._reply = reply
