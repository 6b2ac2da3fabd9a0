"""Adds what pyproject.toml can't describe: the modules that the build of the package makes from share/lcm and share/eds."""
import pathlib
import subprocess
import sys

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = pathlib.Path(__file__).resolve().parent
SHARE = HERE.parent.parent / "share"
sys.path.insert(0, str(HERE))
from message_stubs import stub_of  # noqa: E402
from object_names import table_of  # noqa: E402


class BuildWithTypes(build_py):
    """Adds the types of the LCM messages with their hints, and the table of names of objects."""

    def run(self):
        super().run()
        folder = pathlib.Path(self.build_lib)
        package = folder / "takt"
        own = (package / "__init__.py").read_bytes()
        types = sorted((SHARE / "lcm").glob("*.lcm"))
        subprocess.run(["lcm-gen", "-p", "--ppath", folder, *types], check=True)
        for path in types:
            (package / f"{path.stem}.pyi").write_text(stub_of(path.stem, path.read_text()))
        (package / "__init__.py").write_bytes(own)  # removes the types that lcm-gen has appended: takt.messages has them
        (package / "objects.py").write_text(table_of(sorted((SHARE / "eds").glob("*.eds"))))


setup(cmdclass={"build_py": BuildWithTypes})
