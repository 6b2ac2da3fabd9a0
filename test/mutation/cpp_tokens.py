"""Tokens of a C++ source that clang-format has formatted, with their brackets matched.

Comments and preprocessor lines are no tokens. The format of the tree decides what a compiler decides by meaning: a binary
operator has blanks on both sides, the brackets of template arguments have not.
"""
import bisect
import dataclasses
import re

PATTERN = re.compile(
    r"""(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\.|\\\n)*)
      |(?P<string>(?:u8|[uUL])?R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"\w*|(?:u8|[uUL])?"(?:\\.|[^"\\\n])*"\w*)
      |(?P<char>(?:u8|[uUL])?'(?:\\.|[^'\\\n])+')
      |(?P<number>\.?\d(?:'?[\w.]|(?<=[eEpP])[+-])*)
      |(?P<word>[A-Za-z_]\w*)
      |(?P<sign><=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|\.\*|[^\s\w])""",
    re.VERBOSE | re.MULTILINE | re.DOTALL)
OPENS = {"(": ")", "[": "]", "{": "}"}


@dataclasses.dataclass(frozen=True)
class Token:
    kind: str
    text: str
    begin: int
    end: int
    binary: bool  # has blanks on both sides


class Source:
    """The tokens of one text. `match` leads from each opening bracket to its closing one, also of template arguments."""

    def __init__(self, path, text):
        self.path, self.text = path, text
        self.tokens = [Token(found.lastgroup if found.lastgroup != "mark" else "string", found[0], found.start(), found.end(),
                             text[found.start() - 1:found.start()].isspace() and text[found.end():found.end() + 1].isspace())
                       for found in PATTERN.finditer(text) if found.lastgroup != "skip"]
        self.match = {}
        self.match_brackets()
        self.match_angles()
        self.lines = [found.start() for found in re.finditer(r"^", text, re.MULTILINE)]

    def match_brackets(self):
        opened = []
        for i, token in enumerate(self.tokens):
            if token.kind != "sign":
                continue
            if token.text in OPENS:
                opened.append(i)
            elif opened and token.text == OPENS[self.tokens[opened[-1]].text]:
                self.match[opened.pop()] = i
            elif token.text in OPENS.values():
                raise ValueError(f"{self.path}:{self.line(token.begin)}: {token.text} closes nothing")

    def match_angles(self):
        """Template arguments end before the bracket around them, so a search never leaves that bracket."""
        opened = []
        for i, token in enumerate(self.tokens):
            if token.kind != "sign":
                continue
            if token.text == "<" and not token.binary and i > 0 and self.tokens[i - 1].text != "operator":
                opened.append(i)
            elif token.text in (">", ">>") and not token.binary:
                for _ in token.text:
                    if opened and self.tokens[opened[-1]].text == "<":
                        self.match[opened.pop()] = i
            elif token.text in OPENS:
                opened.append(i)
            elif token.text in OPENS.values():
                while opened and self.tokens[opened[-1]].text == "<":
                    opened.pop()
                if opened:
                    opened.pop()

    def word(self, i):
        return self.tokens[i].text if 0 <= i < len(self.tokens) else ""

    def kind(self, i):
        return self.tokens[i].kind if 0 <= i < len(self.tokens) else ""

    def line(self, offset):
        return bisect.bisect_right(self.lines, offset)

    def after(self, i):
        """The index after token i, or after the bracket that it opens."""
        return self.match.get(i, i) + 1

    def find(self, texts, i, end):
        """The index of the first token of `texts` in [i, end) that is in no bracket; `end` if there is none."""
        while i < end:
            if self.tokens[i].text in texts and self.tokens[i].kind == "sign":
                return i
            i = self.after(i)
        return end

    def split(self, i, end):
        """The parts of [i, end) between the commas that are in no bracket."""
        while i < end:
            comma = self.find((",",), i, end)
            yield i, comma
            i = comma + 1

    def code(self, i, end, changes=()):
        """The text of the tokens [i, end) on one line, without comments; `changes` maps indices to other texts."""
        changes = dict(changes)
        parts = []
        for at in range(i, end):
            token = self.tokens[at]
            if at > i and token.begin > self.tokens[at - 1].end:
                parts.append(" ")
            parts.append(changes.get(at, token.text))
        return "".join(parts)

    def code_lines(self):
        return len({self.line(token.begin) for token in self.tokens})
