"""Signed envelopes, for a bus that has keys. share/doc/security.md describes them."""
from __future__ import annotations

import hashlib
import hmac
import os
import random
import stat
import struct
import time

from .messages import envelope_t

MAC_SIZE = 32  # bytes, at the end of the encoded envelope
OLDEST = 1_000_000  # largest difference between utime and the clock of the receiver, microseconds


def read_keys(path: str) -> dict[str, bytes]:
    """Returns {name: secret} of a key file. Raises ValueError with the reason if it refuses the
    file, by the rules of taktd."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as wrong:
        raise ValueError(f"key file {path}: {wrong.strerror}") from None
    try:
        info = os.fstat(descriptor)
        if not stat.S_ISREG(info.st_mode):
            raise ValueError(f"key file {path}: it is not a regular file")
        if info.st_uid not in (0, os.geteuid()):
            raise ValueError(f"key file {path}: it belongs to another user")
        if info.st_mode & 0o077:
            raise ValueError(f"key file {path}: users other than its owner can access it: chmod 600 {path}")
        with open(descriptor, encoding="utf-8", closefd=False) as file:
            lines = [words for line in file if (words := line.partition("#")[0].split())]
    finally:
        os.close(descriptor)
    if not lines:
        raise ValueError(f"key file {path}: the file has no key")
    try:
        keys = {name: bytes.fromhex(secret) for name, secret in lines}
    except ValueError:
        keys = {}
    if len(keys) != len(lines) or any(len(secret) != 32 for secret in keys.values()):
        raise ValueError(f"key file {path}: each line needs a unique name and 64 hexadecimal digits")
    return keys


class Envelopes:
    """Seals messages with the first key, and opens those that one of the keys has signed."""

    def __init__(self, keys: dict[str, bytes]):
        self.keys = keys
        self.own_key = next(iter(keys))
        self.instance = random.SystemRandom().getrandbits(63)
        self.counter = 0  # increases with each envelope of this instance
        # The newest counter of each sender, by key and instance.
        self.counters: dict[tuple[str, int], int] = {}

    def seal(self, channel: str, session: int, message: bytes) -> bytes:
        """Returns the encoded envelope of an encoded message."""
        self.counter += 1
        envelope = envelope_t()
        envelope.utime, envelope.schema, envelope.session = time.time_ns() // 1000, 1, session
        envelope.instance, envelope.counter = self.instance, self.counter
        envelope.key, envelope.channel = self.own_key, channel
        envelope.size, envelope.data = len(message), message
        envelope.mac = bytes(MAC_SIZE)
        signed = envelope.encode()[:-MAC_SIZE]
        return signed + mac_of(signed, self.keys[self.own_key])

    def open(self, data: bytes) -> envelope_t | None:
        """Returns the envelope; None if it is forged, altered, repeated, too old or out of order."""
        try:
            envelope = envelope_t.decode(data)
        except (ValueError, struct.error):
            return None
        secret, sender = self.keys.get(envelope.key), (envelope.key, envelope.instance)
        signed = data[:-MAC_SIZE]
        if secret is None or not hmac.compare_digest(mac_of(signed, secret), bytes(envelope.mac)):
            return None
        if abs(time.time_ns() // 1000 - envelope.utime) > OLDEST:
            return None
        if envelope.counter <= self.counters.get(sender, 0):
            return None
        self.counters[sender] = envelope.counter
        return envelope


def envelopes_of(path: str | None, check: bool | None) -> tuple[Envelopes | None, bool]:
    """Returns the envelopes of a program, and whether the program accepts only signed messages. If
    an argument is None, TAKT_KEYS or TAKT_CHECK_IMAGES of the environment decides. Raises
    ValueError with the reason if the key file is refused."""
    path = os.environ.get("TAKT_KEYS") if path is None else path
    check = os.environ.get("TAKT_CHECK_IMAGES") == "true" if check is None else check
    if check and not path:
        raise ValueError("TAKT_CHECK_IMAGES and check_images need a key file: TAKT_KEYS=FILE or "
                         "keys")
    return Envelopes(read_keys(path)) if path else None, check


def mac_of(signed: bytes, secret: bytes) -> bytes:
    return hashlib.blake2b(signed, key=secret, digest_size=MAC_SIZE).digest()
