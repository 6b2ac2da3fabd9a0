"""Chooses mutants: seeded, and spread over the rooms in proportion to their code."""
import collections
import dataclasses
import hashlib
import pathlib

from cpp_tokens import Source
from mutations import Mutation, mutations_of

MOST_OF_A_ROOM = 1000


@dataclasses.dataclass(frozen=True)
class Mutant:
    number: int
    room: str
    mutation: Mutation

    @property
    def key(self):
        """Names the mutant in survivors.md; a change elsewhere in the tree does not change it."""
        return hashlib.sha256(f"{self.mutation.what}/{self.mutation.title()}".encode()).hexdigest()[:8]

    def where(self):
        return f"{self.mutation.path}:{self.mutation.line} {self.mutation.what}"


def read_sources(root, folders):
    for folder in folders:
        for file in sorted(pathlib.Path(root, folder).rglob("*.[hc]pp")):
            path = file.relative_to(root).as_posix()
            yield Source(path, file.read_text(encoding="utf-8"))


def shares(sizes, count):
    """`count` divided in proportion to the sizes, by the largest remainder."""
    whole = sum(sizes.values())
    exact = {name: count * size / whole for name, size in sizes.items()}
    given = {name: int(share) for name, share in exact.items()}
    by_remainder = sorted(exact, key=lambda name: given[name] - exact[name])
    for name in by_remainder[:count - sum(given.values())]:
        given[name] += 1
    return given


class Choice:
    """All mutations of the sources, and the share of each room."""

    def __init__(self, sources, seed, count):
        self.rooms = collections.defaultdict(list)
        self.spans = collections.defaultdict(list)  # of the chosen places of each file
        # A room has its own numbers: where one mutant replaces another, the sources of other rooms stay as they are.
        self.numbered = collections.Counter()
        sizes, seen = collections.Counter(), collections.Counter()
        ranked = collections.defaultdict(list)
        for source in sources:
            room = source.path.rpartition("/")[0]
            sizes[room] += source.code_lines()
            for mutation in mutations_of(source):
                key = (mutation.what, mutation.title())
                ranked[room].append((mutation.rank(seed, seen[key]), mutation))
                seen[key] += 1
        self.places = sum(map(len, ranked.values()))
        self.lines = sum(sizes.values())
        self.shares = shares({room: size for room, size in sizes.items() if ranked[room]}, count)
        self.waiting = {room: iter([mutation for _, mutation in sorted(found, key=lambda pair: pair[0])])
                        for room, found in ranked.items()}

    def take(self, room, count):
        """The next mutants of a room, at most one at each place."""
        taken = []
        while len(taken) < count and (mutation := next(self.waiting[room], None)):
            begin, end = mutation.span
            spans = self.spans[mutation.path]
            if all(end <= other_begin or other_end <= begin for other_begin, other_end in spans):
                spans.append((begin, end))
                self.numbered[room] += 1
                number = MOST_OF_A_ROOM * list(self.shares).index(room) + self.numbered[room]
                taken.append(Mutant(number, room, mutation))
        return taken
