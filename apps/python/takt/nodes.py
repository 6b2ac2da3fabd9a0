"""The state of a node, as taktd reports it ten times a second. Used by Bus."""
from __future__ import annotations

from dataclasses import dataclass

from .messages import node_status_t

# node_status_t::nmt_state and boot_state in words.
NMT_STATES = {0: "boot-up", 4: "stopped", 5: "operational", 127: "pre-operational"}
BOOT_STATES = ("idle", "booting", "ready", "failed", "lost")


@dataclass(frozen=True)
class Node:
    """One node of a bus."""

    name: str
    node_id: int
    state: str  # NMT state: "boot-up", "stopped", "operational", "pre-operational" or "unknown"
    boot: str  # "idle", "booting", "ready", "failed" or "lost"
    heartbeat_age: float | None  # seconds; None if no heartbeat has come
    error_register: int  # 0x1001
    emcys: tuple[int, ...]  # error codes, the newest first, at most ten
    holder: str  # the program that commands its outputs; empty if there is none


def node_of(status: node_status_t) -> Node:
    """The node that a node_status_t describes."""
    age = status.heartbeat_age_ms
    boot = status.boot_state
    return Node(name=status.name, node_id=status.node_id,
                state=NMT_STATES.get(status.nmt_state, "unknown"),
                boot=BOOT_STATES[boot] if 0 <= boot < len(BOOT_STATES) else "unknown",
                heartbeat_age=None if age < 0 else age / 1000,
                error_register=status.error_register,
                emcys=tuple(code & 0xFFFF for code in status.emcys), holder=status.holder)
