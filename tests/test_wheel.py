"""The distribution: what the sdist and the wheel hold, and both commands from an installed wheel.

The wheel is built from the unpacked sdist, by the backend of pyproject.toml without isolation, and installed
without dependencies in a fresh environment that borrows those of this interpreter. Nothing is downloaded.
"""

from __future__ import annotations

import importlib.metadata
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path
from typing import NamedTuple

import pytest

from autocolor.files.paths import EXAMPLES

pytestmark = pytest.mark.thorough

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("autocolor", "ramtek_emu")

NOT_COPIED = shutil.ignore_patterns(".*", "__pycache__", "build", "dist", "*.egg-info", "results", "figures")
BUILD = "import sys, setuptools.build_meta as backend; getattr(backend, sys.argv[1])(sys.argv[2])"

MODULE = re.compile(
    r"(?:^# code object from '?|matches )(/.*/(?:autocolor|ramtek_emu)/.*\.py)\b", re.MULTILINE
)
"""A module that a verbose interpreter loads, compiled now or before."""


class Installed(NamedTuple):
    """A fresh environment with the wheel installed, and the names that the sdist and the wheel hold."""

    folder: Path
    in_sdist: set[str]
    in_wheel: set[str]

    @property
    def packages(self) -> Path:
        """Where the packages of the environment are."""
        folder = sysconfig.get_path("purelib", vars={"base": str(self.folder), "platbase": str(self.folder)})
        return Path(folder).resolve()

    def run(
        self, program: str, *arguments: str, cwd: Path, verbose: bool = False
    ) -> subprocess.CompletedProcess[str]:
        """A command of the environment, run to its end outside of the checkout."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        if verbose:
            environment["PYTHONVERBOSE"] = "1"
        command = [str(self.folder / "bin" / program), *arguments]
        return subprocess.run(
            command, cwd=cwd, env=environment, capture_output=True, text=True, check=True, timeout=60
        )


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The checkout as an sdist, the sdist as a wheel, and the wheel in a fresh environment."""
    if os.name != "posix":
        pytest.skip("the paths of a fresh environment are those of POSIX")
    folder = tmp_path_factory.mktemp("distribution")

    # Build from a copy: a build leaves folders behind, and takes up what an older one left.
    shutil.copytree(ROOT, folder / "copy", ignore=NOT_COPIED)
    run_backend("build_sdist", folder, cwd=folder / "copy")
    (sdist,) = folder.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        in_sdist = {name.partition("/")[2] for name in archive.getnames()}
        archive.extractall(folder / "unpacked", filter="data")
    (unpacked,) = (folder / "unpacked").iterdir()
    run_backend("build_wheel", folder, cwd=unpacked)
    (wheel,) = folder.glob("*.whl")

    environment = Installed(folder / "environment", in_sdist, set(zipfile.ZipFile(wheel).namelist()))
    venv.create(environment.folder, symlinks=True)
    python = environment.folder / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", str(python), "--disable-pip-version-check"]
    run_quietly([*pip, "install", "--quiet", "--no-deps", "--no-index", "--no-compile", str(wheel)], folder)
    # A .pth file appends: what is installed here comes before what this interpreter has.
    borrowed = dict.fromkeys((sysconfig.get_path("purelib"), sysconfig.get_path("platlib")))
    (environment.packages / "borrowed.pth").write_text("\n".join(borrowed) + "\n", encoding="utf-8")
    return environment


def run_backend(hook: str, into: Path, cwd: Path) -> None:
    run_quietly([sys.executable, "-c", BUILD, hook, str(into)], cwd)


def run_quietly(command: list[str], cwd: Path) -> None:
    done = subprocess.run(
        command,
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout


def files_of_packages() -> set[str]:
    """The files that an installation must have, by their paths in it."""
    modules = {path.relative_to(ROOT) for package in PACKAGES for path in (ROOT / package).rglob("*.py")}
    typed = {Path(package, "py.typed") for package in PACKAGES}
    web = {path.relative_to(ROOT) for path in (ROOT / "autocolor" / "web").glob("autocolor.*")}
    assert {path.suffix for path in web} == {".css", ".js"}
    examples = {
        Path("autocolor", "examples", name, path.name)
        for name in EXAMPLES
        for path in (ROOT / "scenes" / name).iterdir()
    }
    claims = {path.relative_to(ROOT) for path in (ROOT / "ramtek_emu" / "conformance").glob("*.jsonl")}
    assert claims
    return {path.as_posix() for path in modules | typed | web | examples | claims}


def test_the_wheel_holds_both_packages_and_the_examples_and_nothing_else(installed: Installed) -> None:
    packed = {name for name in installed.in_wheel if ".dist-info/" not in name}
    assert packed == files_of_packages()


def test_the_sdist_holds_what_the_tests_need(installed: Installed) -> None:
    tests = {path.relative_to(ROOT).as_posix() for path in (ROOT / "tests").rglob("*.py")}
    scenes = {path.relative_to(ROOT).as_posix() for path in (ROOT / "scenes").rglob("*.py")}
    kept = {path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").glob("*.*")}
    documents = kept | {"CHANGELOG.md", "CONTRIBUTING.md", "README.md", "pyproject.toml", "setup.py"}
    examples = {path.relative_to(ROOT).as_posix() for path in (ROOT / "examples").glob("*.*")}
    assert tests | scenes | documents | examples <= installed.in_sdist


def test_an_installed_command_says_its_version(installed: Installed, tmp_path: Path) -> None:
    version = importlib.metadata.version("autocolor")
    for program in PACKAGES:
        name = {"autocolor": "autocolor", "ramtek_emu": "ramtek"}[program]
        assert installed.run(name, "--version", cwd=tmp_path).stdout.split()[-1] == version


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_installed_example_is_the_scene_of_the_checkout(
    name: str, installed: Installed, tmp_path: Path
) -> None:
    example = installed.packages / "autocolor" / "examples" / name
    told = json.loads(installed.run("autocolor", "info", str(example), "--json", cwd=tmp_path).stdout)
    here = [sys.executable, "-m", "autocolor", "info", f"scenes/{name}", "--json"]
    expected = json.loads(subprocess.run(here, cwd=ROOT, capture_output=True, text=True, check=True).stdout)
    assert told["polygons"] == expected["polygons"] > 0
    assert told["lights"] == expected["lights"]


def test_the_installed_display_writes_its_pattern_without_a_screen(
    installed: Installed, tmp_path: Path
) -> None:
    installed.run("ramtek", "-o", "pattern.png", cwd=tmp_path)
    assert (tmp_path / "pattern.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("program", "arguments"), [("autocolor", ("info", "demo")), ("ramtek", ("-o", "pattern.png"))]
)
def test_the_code_that_runs_is_the_installed_one(
    program: str, arguments: tuple[str, ...], installed: Installed, tmp_path: Path
) -> None:
    (tmp_path / "demo").symlink_to(installed.packages / "autocolor" / "examples" / "coupe")
    told = installed.run(program, *arguments, cwd=tmp_path, verbose=True).stderr
    loaded = {Path(name).resolve() for name in MODULE.findall(told)}
    assert len(loaded) > 10
    assert all(path.is_relative_to(installed.packages) for path in loaded), loaded
