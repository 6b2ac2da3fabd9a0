#!/usr/bin/env python3
"""instruction_bound_test.py COMPILER - what instruction_bound.py finds in the code of small functions that are known."""
import pathlib
import subprocess
import sys
import tempfile

from instruction_bound import Bound, SourceLoops, Unbounded
from machine_code import functions_of

SOURCE = """
extern "C" {
int outside(int);
int straight(int a, int b) { return a * b + 7; }
int longer_branch(int a, int b) {
  if (a > b) return a / b / 3 + a * b + a % 7;
  return b * b * 5 + a;
}
int ten(volatile int* a) {
  int sum = 0;
  for (int i = 0; i < 10; ++i) sum += *a;
  return sum;
}
int nested(volatile int* a) {
  int sum = 0;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 30; ++k) sum += *a;
  }
  return sum;
}
int same_begin(volatile int* a) {
  int sum = 0;
  for (int i = 0; i < 20; sum += i++) {
    while (*a > 5) sum += *a;
  }
  return sum;
}
void seldom(volatile int* a);
int with_cold_part(volatile int* a) {
  if (*a == 7) {
    seldom(a); seldom(a); seldom(a); seldom(a); seldom(a); seldom(a); seldom(a); seldom(a); seldom(a); seldom(a);
    seldom(a + *a / 3); seldom(a + *a / 5); seldom(a + *a / 7);
  }
  return *a + 1;
}
__attribute__((cold)) void seldom(volatile int* a) { *a = 1; }
int calls(volatile int* a) { return ten(a) + 1; }
int recursive(volatile int* a) { return *a == 0 ? 0 : recursive(a) + *a; }
int unknown(int a) { return outside(a) + 1; }
int computed(int (*call)(int)) { return call(1) + 1; }
int open_end(volatile int* a) {
  while (*a != 0) *a = *a - 1;
  return 0;
}
int table(int a, volatile int* b) {
  switch (a) {
    case 0: return *b + 1;
    case 1: return *b * 3;
    case 2: return *b - 7;
    case 3: return *b / 9;
    case 4: return *b ^ 5;
    case 5: return -*b;
    case 6: return *b % 11;
  }
  return 0;
}
}
int outside(int a) { return a; }
int main(int count, char**) { return straight(count, 2); }
"""
PASSES = {("code.cpp", "i < 10"): 10, ("code.cpp", "i < 20"): 20, ("code.cpp", "k < 30"): 30,
          ("code.cpp", "*a > 5"): 7}
failures = []


def check(what, good, told=""):
    print(f"{'ok' if good else 'FAIL'}    {what} {'' if good else told}")
    failures.extend([] if good else [what])


def main(compiler):
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder) / "code.cpp", pathlib.Path(folder) / "code"
        source.write_text(SOURCE)
        subprocess.run([compiler, "-O1", "-g1", "-fno-inline", "-fjump-tables", "-freorder-blocks-and-partition", source, "-o", program], check=True)
        functions = functions_of(str(program))
        loops = SourceLoops(source.parent, PASSES)

        def of(name, known=()):
            functions_known = {n: f for n, f in functions.items() if n != "outside" or n in known}
            return Bound(functions_known, loops).of(name)

        def refused(name):
            try:
                return f"a bound of {of(name)}"
            except Unbounded as why:
                return str(why)

        check("a straight function has all of its instructions", of("straight") == len(functions["straight"].code))
        longer = of("longer_branch")
        check("the longer branch counts", 10 < longer < len(functions["longer_branch"].code), longer)
        check("a loop has its passes", 10 * 3 <= of("ten") <= 11 * 6 + 10, of("ten"))
        check("an inner loop has those of both", 600 * 3 <= of("nested") <= 21 * (31 * 6 + 10) + 10, of("nested"))
        check("loops with one begin have the product", 20 * 7 * 3 <= of("same_begin"), of("same_begin"))
        cold = functions["with_cold_part"]
        first = [address for address in cold.code if address >= cold.entry][0]
        check("a function begins at its symbol, not in a longer cold part", first == cold.entry != min(cold.code), hex(cold.entry))
        check("the cold part counts", of("with_cold_part") > 13 * 3, of("with_cold_part"))
        check("a call counts", of("ten") < of("calls") <= of("ten") + 10, of("calls"))
        for name, why in (("recursive", "calls itself"), ("unknown", "bound is not known"), ("computed", "computed address"),
                          ("open_end", "PASSES does not have"), ("table", "jump through a table")):
            check(f"{name} has no bound", why in refused(name), refused(name))
        try:
            SourceLoops(source.parent, {("code.cpp", "j < 5"): 5})
            check("a loop that is not there is found", False)
        except Unbounded as why:
            check("a loop that is not there is found", "j < 5" in str(why))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
