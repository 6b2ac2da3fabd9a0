"""Finds the places of a source where a mutant can be selected at run time.

A place is an expression that may be written twice: a whole statement, a condition, an initial value. Its form decides how both
versions stand side by side. No place is in a constant expression (constexpr variables, static_assert, enumerators, case
labels, template arguments, if constexpr), in a default member value, in a default argument, or outside of functions.
"""
import dataclasses

from cpp_tokens import Source

NO_FUNCTION = {"alignas", "decltype", "explicit", "noexcept", "requires"}  # their parentheses hold no parameters
NOT_MUTABLE = {"using", "typedef", "static_assert", "struct", "class", "enum", "union", "namespace", "constexpr", "break",
               "continue", "goto", "co_return", "co_yield", "assert"}
RETURN, CALL, CONDITION, VALUE = "return", "call", "condition", "value"
WRAPPED = {
    RETURN: "{{ if (::takt_mutant({id})) {changed} {original} }}",
    CALL: "{{ if (::takt_mutant({id})) {{ {changed} }} else {{ {original} }} }}",
    CONDITION: "(::takt_mutant({id}) ? static_cast<bool>({changed}) : static_cast<bool>({original}))",
    VALUE: "(::takt_mutant({id}) ? ({changed}) : ({original}))",
}


@dataclasses.dataclass(frozen=True)
class Place:
    """Tokens [begin, end) of the source; `hidden` are the ranges inside that are places themselves or no expression."""
    form: str
    begin: int
    end: int
    hidden: tuple
    deduced: bool  # the type that is returned follows from the returned value

    def visible(self, source):
        """The indices of the tokens that may change."""
        i = self.begin
        while i < self.end:
            inside = [end for begin, end in self.hidden if begin <= i < end]
            if inside:
                i = inside[0]
            elif source.word(i) == "<" and i in source.match:
                i = source.match[i] + 1
            else:
                yield i
                i += 1


class Reader:
    def __init__(self, source: Source):
        self.source, self.places, self.deduced = source, [], False

    def read(self):
        self.scope(0, len(self.source.tokens))
        return self.places

    # Declarations of a namespace or a class.

    def scope(self, i, end):
        while i < end:
            i = self.declaration(i, end)

    def declaration(self, i, end):
        source = self.source
        if source.word(i) in ("public", "private", "protected") and source.word(i + 1) == ":":
            return i + 2
        words, parameters, assigned = set(), False, False
        while i < end:
            text = source.word(i)
            if source.kind(i) == "word":
                words.add(text)
            if text == ";":
                return i + 1
            if text == "(" and not assigned and source.word(i - 1) not in NO_FUNCTION:
                parameters = True
            elif text == "=" and source.word(i - 1) != "operator":
                assigned = True
            elif text == ":" and parameters and not assigned:
                i = self.member_values(i + 1, end)
                continue
            elif text == "{" and source.kind(i) == "sign" and not assigned:
                close = source.match[i]
                if "namespace" in words or ("extern" in words and not parameters):
                    self.scope(i + 1, close)
                    return close + 1
                if parameters:
                    self.deduced = "auto" in words
                    if "consteval" not in words:
                        self.block(i + 1, close)
                    return close + 1
                if words & {"class", "struct", "union"} and "enum" not in words:
                    self.scope(i + 1, close)
            i = source.after(i)
        return end

    def member_values(self, i, end):
        """The list of values of a constructor; returns the index of its body."""
        source = self.source
        while i < end:
            opened = source.find(("(", "{"), i, end)
            if opened == end:
                return end
            close = source.match[opened]
            self.values(opened + 1, close)
            i = close + 1
            if source.word(i) == "...":
                i += 1
            if source.word(i) != ",":
                return i
            i += 1
        return end

    # Statements of a function.

    def block(self, i, end):
        while i < end:
            i = self.statement(i, end)

    def statement(self, i, end):
        source, text = self.source, self.source.word(i)
        if text == "{":
            self.block(i + 1, source.match[i])
            return source.match[i] + 1
        if text == "[" and source.word(i + 1) == "[":
            return self.statement(source.match[i] + 1, end)
        if text in ("if", "while", "switch", "for"):
            return self.controlled(i, end)
        if text in ("do", "try", "else"):
            return self.statement(i + 1, end)
        if text == "catch":
            return self.statement(source.match[i + 1] + 1, end)
        if text in ("case", "default"):
            return source.find((":",), i, end) + 1
        close = source.find((";",), i, end)
        if text in NOT_MUTABLE or source.word(i + 1) == "constexpr":
            return close + 1
        if text == "return":
            if close > i + 1:
                self.place(RETURN, i, close + 1)
        elif not self.definition(i, close):
            self.place(CALL, i, close + 1)
        return close + 1

    def controlled(self, i, end):
        """if, while (also of do), switch, for: their conditions, then the statement behind them."""
        source, text = self.source, self.source.word(i)
        constant = source.word(i + 1) == "constexpr"
        opened = source.find(("(", "{"), i, end)
        if source.word(opened) == "{":  # if consteval
            return self.statement(opened, end)
        close = source.match[opened]
        parts, begin = [], opened + 1
        while begin <= close:
            semicolon = source.find((";",), begin, close)
            parts.append((begin, semicolon))
            begin = semicolon + 1
        if text == "for" and len(parts) == 3:
            self.definition(*parts[0])
            self.place(CONDITION, *parts[1])
            self.place(VALUE, *parts[2])
        elif text != "for" and not constant:
            if len(parts) == 2:
                self.definition(*parts[0])
            if not self.definition(*parts[-1]):
                self.place(VALUE if text == "switch" else CONDITION, *parts[-1])
        if source.word(close + 1) == ";":
            return close + 2
        kept = len(self.places)
        behind = self.statement(close + 1, end)
        if constant and "endian" in source.code(opened, close):  # code for other processors, which is not compiled
            del self.places[kept:]
        return behind

    def definition(self, i, end):
        """Takes the initial values of `auto x = 1` or `T x{1}`. Returns false if [i, end) defines nothing."""
        source = self.source
        equal = source.find(("=",), i, end)
        if equal < end:
            if not self.names(i, equal):
                return False
            first = source.find((",",), equal, end)
            self.place(VALUE, equal + 1, first)
            return True
        opened = source.find(("{", "("), i, end)
        if opened < end and self.names(i, opened):
            self.values(opened + 1, source.match[opened])
            return True
        return opened == end and self.names(i, end)

    def names(self, i, end):
        """[i, end) is a type and a name, not a call or the left side of an assignment."""
        source = self.source
        if end - i < 2:
            return False
        if source.word(end - 1) == "]":  # structured binding
            return source.word(i) in ("auto", "const")
        if source.kind(end - 1) != "word" or source.word(i) in ("return", "throw", "delete", "co_await"):
            return False
        before = source.tokens[end - 2]
        return before.kind == "word" or (before.text in (">", ">>", "*", "&", "&&") and not before.binary and end - 2 > i)

    def values(self, i, end):
        """The values between braces or parentheses."""
        source = self.source
        for begin, comma in source.split(i, end):
            if source.word(begin) == "." and source.word(begin + 2) == "=":
                begin += 3
            if source.word(begin) != "{" and source.word(comma - 1) != "...":
                self.place(VALUE, begin, comma)

    def place(self, form, i, end):
        """A place, if it has tokens that may change; and the places in its lambdas."""
        hidden = []
        at = i
        while at < end:
            body = self.lambda_body(at, end)
            if body is None:
                at += 1
                continue
            outside, self.deduced = self.deduced, "->" not in map(self.source.word, range(at, body))
            self.block(body + 1, self.source.match[body])
            self.deduced = outside
            hidden.append((at, self.source.match[body] + 1))
            at = self.source.match[body] + 1
        if i < end and self.source.word(i) != "{":
            self.places.append(Place(form, i, end, tuple(hidden), self.deduced))

    def lambda_body(self, i, end):
        """The index of the body's brace if a lambda begins at token i."""
        source = self.source
        if source.word(i) != "[" or source.word(i + 1) == "[" or i not in source.match:
            return None
        before = i - 1
        if source.word(before) in (")", "]") or (source.kind(before) in ("word", "string") and source.word(before) != "return"):
            return None
        opened = source.find(("{", ",", ";", "=", ")", "}", "]"), source.match[i] + 1, end)
        return opened if opened < end and source.word(opened) == "{" else None
