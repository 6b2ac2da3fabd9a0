#!/usr/bin/env python3
"""judge_many.py [--cases N] [--seed S] [--class NAME] - plans very many random tasks in C++ and judges the motions.

Each task is one axis. The tasks of eight classes are divided equally; --class chooses one of them, or `wide limits`, a class in
which a task may be refused because a number has too few digits. Each motion is integrated with more digits than the planner has:
it must end at its target to 1e-8 of its size and keep its limits to 1e-9. If ruckig has a result that does this, the motion
must not be slower. Both planners are timed in the same process. A failure is printed as a request of `takt trajectory`.
Exit code 1: a motion is wrong. The tasks depend only on --seed. Compiles the planner and, from its source package, ruckig.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
RUCKIG = "0.19.4"
FLAGS = ("-std=c++23", "-O3", "-DNDEBUG")


def ruckig_sources(folder):
    """The folder of the source package, which is fetched once."""
    package = folder / f"ruckig-{RUCKIG}"
    if not package.exists():
        subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", ":all:", "--dest", folder,
                        f"ruckig=={RUCKIG}"], check=True)
        shutil.unpack_archive(folder / f"ruckig-{RUCKIG}.tar.gz", folder)
    return package


def build(folder, with_ruckig):
    program = folder / ("judge_many" if with_ruckig else "judge_many_alone")
    sources = [ROOT / "test/motion/judge_many.cpp", *sorted((ROOT / "master/motion").glob("*.cpp"))]
    flags = [*FLAGS, "-I", ROOT, f"-DTAKT_RUCKIG={int(with_ruckig)}"]
    if with_ruckig:
        package = ruckig_sources(folder)
        sources += [source for source in sorted((package / "src/ruckig").glob("*.cpp")) if source.stem != "cloud_client"]
        flags += ["-isystem", package / "include"]
    subprocess.run(["c++", *flags, *sources, "-o", program], check=True)
    return program


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--class", dest="only")
    parser.add_argument("--without-ruckig", action="store_true")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build/judge_many")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    program = build(options.folder, not options.without_ruckig)
    only = ["--class", options.only] if options.only else []
    return subprocess.run([program, "--cases", str(options.cases), "--seed", str(options.seed), *only]).returncode


if __name__ == "__main__":
    sys.exit(main())
