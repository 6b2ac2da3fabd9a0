"""What a mutant changes at a place: one operator, one constant, one statement."""
import dataclasses
import hashlib
import re

from cpp_tokens import Source
from statements import CALL, CONDITION, RETURN, WRAPPED, Place, Reader

SWAPPED = {
    "comparison boundary": {"<": "<=", "<=": "<", ">": ">=", ">=": ">"},
    "equality": {"==": "!=", "!=": "=="},
    "arithmetic": {"+": "-", "-": "+", "*": "+", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "*=": "+=", "/=": "*="},
    "bits": {"&": "|", "|": "&", "^": "&", "<<": ">>", ">>": "<<", "|=": "&=", "&=": "|=", "<<=": ">>=", ">>=": "<<="},
    "logic": {"&&": "||", "||": "&&"},
}
SWAPPED_WORDS = {"true": "false", "false": "true"}
SWAPPED_NAMES = {"min": "max", "max": "min"}  # behind std:: or ranges::
STEPPED = {"++": "--", "--": "++"}
JOINS_TEXT = {"+", "+=", "/", "<<"}  # beside text these put it together
# Calls that change nothing but the time or the memory that the program takes.
ONLY_TIME = {"reserve", "shrink_to_fit"}
NOTHING_RETURNED = {"{}", "false", "true", "0", "nullptr", "std::nullopt", "*this"}
INTEGER = re.compile(r"(0[xX][0-9a-fA-F']+|\d[\d']*)([a-zA-Z_]\w*)?$")


@dataclasses.dataclass(frozen=True)
class Mutation:
    """One change of one place."""
    source: Source
    place: Place
    what: str
    at: int  # the token of the change
    changed: str  # the new text of the whole place

    @property
    def path(self):
        return self.source.path

    @property
    def line(self):
        return self.source.line(self.source.tokens[self.at].begin)

    @property
    def original(self):
        return self.source.code(self.place.begin, self.place.end)

    @property
    def span(self):
        return self.source.tokens[self.place.begin].begin, self.source.tokens[self.place.end - 1].end

    def wrapped(self, number):
        return WRAPPED[self.place.form].format(id=number, changed=self.changed, original=self.original)

    def title(self):
        """Names the mutant for people and for survivors.md; a change elsewhere in the file does not change it."""
        return f"{self.path}: `{self.original}` -> `{self.changed or ';'}`"

    def rank(self, seed, again):
        """The seeded order. It depends on the text of the place alone, so that other changes of the tree keep it."""
        return hashlib.sha256(f"{seed}/{again}/{self.what}/{self.title()}".encode()).hexdigest()


def next_number(text):
    """The literal that is one larger; None if the text is no number of this kind."""
    if found := INTEGER.match(text):
        digits, suffix = found[1].replace("'", ""), found[2] or ""
        if digits[:2] in ("0x", "0X"):
            return f"{int(digits, 16) + 1:#x}{suffix}"
        return f"{int(digits) + 1}{suffix}" if digits == "0" or digits[0] != "0" else None
    found = re.match(r"(\d+)(\.\d*)", text)
    return f"{int(found[1]) + 1}{text[found.end(1):]}" if found else None


def changes(source, place):
    """(what, token, new text) of each change of one token."""
    visible = list(place.visible(source))
    texts = any(source.kind(i) == "string" for i in visible)
    for i in visible:
        token = source.tokens[i]
        text = token.text
        if token.kind == "number":
            if larger := next_number(text):
                yield "constant + 1", i, larger
        elif token.kind == "word":
            if text in SWAPPED_WORDS:
                yield "constant", i, SWAPPED_WORDS[text]
            elif text in SWAPPED_NAMES and source.word(i - 1) == "::" and source.word(i - 2) in ("std", "ranges"):
                yield "minimum and maximum", i, SWAPPED_NAMES[text]
        elif token.kind == "sign":
            if text == "!" and not token.binary:
                yield "removed negation", i, ""
            elif text in STEPPED:
                yield "step", i, STEPPED[text]
            elif token.binary and not (texts and text in JOINS_TEXT):
                for what, table in SWAPPED.items():
                    if text in table:
                        yield what, i, table[text]


def is_removable(source, place):
    """The statement is a call or an assignment, and not one that only takes time."""
    words = {source.word(i) for i in place.visible(source)}
    first = source.word(place.begin)
    return not words & ONLY_TIME and first not in ("static_cast", "throw", "delete", "(") and place.end - place.begin > 2


def mutations_of(source):
    """All mutations of one source, in the order of its text."""
    found = []
    for place in Reader(source).read():
        begin, end = place.begin, place.end
        found += [Mutation(source, place, what, at, source.code(begin, end, {at: text}))
                  for what, at, text in changes(source, place)]
        if place.form == CONDITION:
            found.append(Mutation(source, place, "negated condition", begin, f"!({source.code(begin, end)})"))
        elif place.form == CALL and is_removable(source, place):
            found.append(Mutation(source, place, "removed statement", begin, ""))
        elif place.form == RETURN and not place.deduced and source.code(begin + 1, end - 1) not in NOTHING_RETURNED:
            if end - begin > 3 or source.kind(begin + 1) != "number":
                found.append(Mutation(source, place, "returned value", begin, "return {};"))
    return sorted(found, key=lambda mutation: mutation.at)


def instrumented(source, mutants):
    """The text of a source with all its mutants, given as (number, mutation)."""
    text = source.text
    for number, mutation in sorted(mutants, key=lambda mutant: mutant[1].span, reverse=True):
        begin, end = mutation.span
        text = text[:begin] + mutation.wrapped(number) + text[end:]
    return '#include "test/mutation/mutant.hpp"\n' + text
