"""Shows that mutate.py finds the right places, and that it reports mutants that are caught and mutants that survive."""
import argparse
import contextlib
import io
import pathlib
import re
import shutil
import subprocess
import tempfile

import mutate
from cpp_tokens import Source
from mutant_build import Project
from mutations import instrumented, mutations_of

HERE = pathlib.Path(__file__).resolve().parent
# Text of a function body, and the changes that are found in it.
PLACES = {
    "return a < b;": {"return a <= b;", "return {};"},
    "return a ? b : c;  // a < b": {"return {};"},
    'call("a < b", R"(a && b)");': {""},
    "const auto x = f<3>(a) + 1;": {"f<3>(a) - 1", "f<3>(a) + 2"},
    "constexpr int x = 1;": set(),
    "static constexpr int x = 1;": set(),
    "static_assert(a < 1);": set(),
    "if constexpr (a < 1) {}": set(),
    "if constexpr (endian::native == endian::big) x = 1; y = 2;": {"y = 3;", ""},
    "if consteval { x = 1; }": {"x = 2;", ""},
    "switch (a) { case 1: default: ; }": set(),
    "if (!a) return;": {"a", "!(!a)"},
    "if (auto* p = f(1); p != nullptr) {}": {"f(2)", "p == nullptr", "!(p != nullptr)"},
    "if (a > T{0}) return;": {"a >= T{0}", "a > T{1}", "!(a > T{0})"},
    "while (a) { --b; }": {"!(a)", "++b;", ""},
    "for (int i = 0; i < n; ++i) {}": {"1", "i <= n", "!(i < n)", "--i"},
    "for (auto& x : list) x += 1;": {"x -= 1;", "x += 2;", ""},
    "sort(list, [](int a, int b) { return a > b; });": {"return a >= b;", ""},
    "sort(list, [](int a) -> bool { return a; });": {"return {};", ""},
    "text += \"a\";": {""},
    "list.reserve(a + b);": {"list.reserve(a - b);"},
    "const std::vector<int> x{0x1FU};": {"0x20U"},
    "x = std::min(a, 1'000);": {"x = std::max(a, 1'000);", "x = std::min(a, 1001);", ""},
    "return true;": {"return false;"},
    "return;": set(),
}
OUTSIDE = """struct S { S() : a_{1 + b} {} int a_ = 1; enum class E { e = 1 }; int f(int a = 1) const; };
consteval int g() { return 1; }
std::array<int, 3> table{1, 2, 3};
template <int N = 1> constexpr bool h(int a) noexcept { return a == N; }
"""
OUTSIDE_CHANGES = {"1 - b", "2 + b", "return a != N;", "return {};"}

CMAKE = """cmake_minimum_required(VERSION 3.25)
project(small CXX)
set(CMAKE_CXX_STANDARD 23)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
find_package(GTest REQUIRED)
add_executable(small code/small.cpp small_test.cpp)
target_include_directories(small PRIVATE ${CMAKE_SOURCE_DIR})
target_link_libraries(small PRIVATE GTest::gtest_main)
"""
# In the order of the text: caught, survives because no test reaches it, survives because the tests are weak, hangs.
SMALL = """int doubled(int a) { return a * 2; }
int unknown(int a) { return a - 7; }
bool is_small(int a) { return a < 10; }
int count(int n) {
  int counted = 0;
  while (counted != n) ++counted;
  return counted;
}
"""
SMALL_TEST = """#include <gtest/gtest.h>
int doubled(int);
bool is_small(int);
int count(int);
TEST(Small, doubled) { EXPECT_EQ(doubled(4), 8); }
TEST(Small, is_small) { is_small(1); }
TEST(Small, count) { EXPECT_EQ(count(3), 3); }
"""
EXPECTED = (  # line, word of the report, reason
    (1, "caught", "small Small.doubled"),
    (2, "SURVIVES", "no test reaches it"),
    (3, "SURVIVES", "1 tests reach it, none fails"),
    (6, "caught", "small Small.count takes too long"),
)


def wrong_places():
    for body, expected in PLACES.items():
        found = {mutation.changed for mutation in mutations_of(Source("a.cpp", f"void f() {{\n{body}\n}}"))}
        if found != expected:
            yield f"{body}: {sorted(found)}"
    found = {mutation.changed for mutation in mutations_of(Source("a.cpp", OUTSIDE))}
    if found != OUTSIDE_CHANGES:
        yield f"outside of functions: {sorted(found)}"
    source = Source("a.cpp", "void f() {\n  if (a)  // why\n    b = 1;\n}\n")
    [mutation] = [mutation for mutation in mutations_of(source) if mutation.changed == "b = 2;"]
    text = instrumented(source, [(7, mutation)])
    if "if (a)  // why\n    { if (::takt_mutant(7)) { b = 2; } else { b = 1; } }\n" not in text:
        yield f"instrumented: {text}"


def wrong_verdicts():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder, "small")
        for path, text in {"CMakeLists.txt": CMAKE, "code/small.cpp": SMALL, "small_test.cpp": SMALL_TEST}.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        (root / "test/mutation").mkdir(parents=True)
        for name in ("mutant.hpp", "reach_listener.cpp", "listen.cmake"):
            shutil.copy(HERE / name, root / "test/mutation")
        subprocess.run(["git", "init", "-q", root], check=True)
        project = Project(root, ("code",), (), ("small",), ("-G", "Ninja"))
        every = argparse.Namespace(seed=1, count=100, jobs=1, list=False, only=None, rooms=(), programs=("small",))
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            code = mutate.run(project, every, pathlib.Path(folder, "work"), set(), least_limit=1.0)
    told = told.getvalue()
    for line, word, by in EXPECTED:
        if not re.search(rf"{word} +code/small.cpp:{line} [a-z0-9+ ]+: {by}", told):
            yield f"not reported: line {line} {word}: {by}"
    if code != 1:
        yield "survivors without an explanation, and exit code 0"
    if list(wrong_places()) or re.search("does not compile|does not build", told):
        yield told


def self_test():
    complaints = [*wrong_places(), *wrong_verdicts()]
    for what in complaints:
        print(f"self-test: {what}")
    return 1 if complaints else 0
