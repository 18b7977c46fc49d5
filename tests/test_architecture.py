"""The plan of the house, read off its imports."""

from __future__ import annotations

import ast
import importlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[1]

PUBLIC_NAMES = {
    "autocolor": [
        "AutocolorError", "BlinnPhong", "CookTorrance", "Flap", "Flaps", "HalfSpace", "InputError",
        "LevelRange", "Light", "Mesh", "MeshScalar", "MissingInputError", "OutputError", "Paint", "Part",
        "Phong", "Picture", "Reflectance", "Rig", "Scalar", "Scene", "Studio", "Surface", "UnavailableError",
        "UsageError", "View", "WriteError", "demo", "image", "open_tables", "read_journal", "read_picture",
        "read_rig", "read_scene", "render", "save_image", "scene_of", "send_picture", "write_picture",
        "write_rig", "write_scene",
    ],
    "ramtek_emu": [
        "ColorsError", "Configuration", "ConfigurationError", "EntryFormat", "GMR_9300", "HostPort",
        "InstructionError", "JPL_9460", "Joystick", "ListingError", "MissingInputError", "NCAR_9460",
        "NoScreenError", "OutputError", "OutputExistsError", "PRINCETON_9300", "PortError", "Ramtek9300",
        "RamtekError", "Recorder", "ReplyError", "SnapshotError", "TcpPort", "Timing", "UnixPort",
        "WordsError", "WriteError", "read_snapshot", "write_snapshot",
    ],
}  # fmt: skip

WINGS = {
    "autocolor": (
        "errors", "logs", "arrays", "immutable", "checks", "modules", "scene", "visibility", "scalars",
        "lighting", "mapping", "files", "rendering", "sending", "journal", "studio", "images",
        "widgets", "screens", "commands", "__main__",
    ),
    "ramtek_emu": (
        "errors", "arrays", "checks", "timing", "configuration", "writing", "png",
        "command_line",
        "instruction_set", "memory", "drawing", "video", "processor", "instructions", "display",
        "host", "monitor", "snapshot", "commands", "__main__",
    ),
}  # fmt: skip
"""The wings of a package in the order of its data: each may use those before it and no other."""

USED_WHOLE: tuple[str, ...] = ()
"""The wings whose names are used from the wing itself, which imports them from all of its rooms."""

IN_THE_DIALECT = ("autocolor", "ramtek_emu")
"""The packages whose constants are Final and whose array types are all in arrays.py."""

TESTED_MODULE_BY_MODULE = ("autocolor", "ramtek_emu")
"""The packages of which every module has a file of tests at the mirrored place."""

KNOWING_THE_DISPLAY = (
    "autocolor.__main__", "autocolor.files.writing", "autocolor.images", "autocolor.lighting.picture",
    "autocolor.sending", "autocolor.studio",
)  # fmt: skip
WINGS_KNOWING_THE_DISPLAY = ("autocolor.commands", "autocolor.screens", "autocolor.widgets")
DOORS_OF_THE_DISPLAY = {
    "ramtek_emu", "ramtek_emu.command_line", "ramtek_emu.configuration",
    "ramtek_emu.errors", "ramtek_emu.host.port", "ramtek_emu.instructions", "ramtek_emu.png",
    "ramtek_emu.monitor.window", "ramtek_emu.writing",
}  # fmt: skip
OUTSIDE = {"numpy", "click", "PIL", "pygame"}

READING_FOR_US = {"meshio", "trimesh"}
"""The packages of the extra `meshes`."""


STILL_TWINS = {
    "Block", "Cells", "Grip", "Header", "Item", "Output", "Place", "Placement", "Polygons", "Session", "Side",
    "Source", "Steps", "Tables", "autocolor.files: formats",
}  # fmt: skip
"""Names that await another one."""


class Import(NamedTuple):
    """A module that another imports, and whether it does so when it is loaded itself."""

    target: str
    at_once: bool


def modules() -> dict[str, Path]:
    found = {}
    for package in PUBLIC_NAMES:
        for path in sorted((ROOT / package).rglob("*.py")):
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
            found[name] = path
    return found


MODULES = modules()


def imports_in(nodes: list[ast.stmt], name: str, is_package: bool, at_once: bool = True) -> Iterator[Import]:
    for node in nodes:
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield from imports_in(node.body, name, is_package, at_once=False)
            yield from imports_in(node.orelse, name, is_package, at_once)
        elif isinstance(node, ast.Import):
            yield from (Import(alias.name, at_once) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = name.split(".")
                kept = parts[: len(parts) - node.level + is_package]
                base = ".".join([*kept, *([node.module] if node.module else [])])
            for alias in node.names:
                whole = f"{base}.{alias.name}"
                yield Import(whole if whole in MODULES else base, at_once)
        else:
            inner = at_once and not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
            for field in ("body", "orelse", "finalbody", "handlers"):
                for child in getattr(node, field, None) or []:
                    body = child.body if isinstance(child, ast.ExceptHandler) else [child]
                    yield from imports_in(body, name, is_package, inner)


def imports_of(name: str) -> list[Import]:
    path = MODULES[name]
    return list(imports_in(ast.parse(path.read_text("utf-8")).body, name, path.stem == "__init__"))


def outer(target: str) -> str:
    return target.split(".")[0]


@pytest.mark.parametrize("name", [name for name in MODULES if outer(name) == "ramtek_emu"])
def test_the_display_knows_nothing_of_the_renderer(name: str) -> None:
    assert "autocolor" not in {outer(each.target) for each in imports_of(name)}


@pytest.mark.parametrize("name", [name for name in MODULES if outer(name) == "autocolor"])
def test_the_renderer_knows_the_display_only_where_they_meet_and_only_by_its_doors(name: str) -> None:
    used = {each.target for each in imports_of(name) if outer(each.target) == "ramtek_emu"}
    if name not in KNOWING_THE_DISPLAY and not name.startswith(WINGS_KNOWING_THE_DISPLAY):
        assert not used
    assert used <= DOORS_OF_THE_DISPLAY


def test_no_two_classes_share_a_name_and_no_two_modules_of_a_wing() -> None:
    places: dict[str, set[str]] = {}
    for name, path in MODULES.items():
        wing, stem = ".".join(name.split(".")[:2]), name.rpartition(".")[2]
        if path.stem != "__init__":
            places.setdefault(f"{wing}: {stem}", set()).add(name)
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ClassDef):
                places.setdefault(node.name, set()).add(name)
    both_publish = set.intersection(*map(set, PUBLIC_NAMES.values()))
    twins = {name for name, modules in places.items() if len(modules) > 1}
    assert twins - both_publish <= STILL_TWINS


def test_pygame_is_in_one_file() -> None:
    having = {name for name in MODULES for each in imports_of(name) if outer(each.target) == "pygame"}
    assert having == {"ramtek_emu.monitor.glass"}


def test_pillow_is_in_two_files_one_for_pictures_and_one_for_the_names_of_colors() -> None:
    found = {
        (name, each.at_once) for name in MODULES for each in imports_of(name) if outer(each.target) == "PIL"
    }
    # Colors written as "#rrggbb" need no Pillow: it is loaded for the first one that is not.
    assert found == {("ramtek_emu.png", True), ("autocolor.scene.kinds", False)}


def test_nothing_is_imported_that_is_no_dependency() -> None:
    used = {outer(each.target) for name in MODULES for each in imports_of(name)}
    assert used <= {*PUBLIC_NAMES, *OUTSIDE, *READING_FOR_US, *sys.stdlib_module_names}


def test_the_libraries_that_read_meshes_are_in_one_file_and_loaded_when_they_are_needed() -> None:
    found = {
        (name, each.at_once)
        for name in MODULES
        for each in imports_of(name)
        if outer(each.target) in READING_FOR_US
    }
    assert found == {("autocolor.files.meshes.foreign_worker", False)}


@pytest.mark.parametrize("name", [name for name in MODULES if outer(name) in IN_THE_DIALECT])
def test_constants_are_final_and_array_types_stand_in_one_module(name: str) -> None:
    source = MODULES[name].read_text("utf-8")
    for node in ast.parse(source).body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        names = [
            each.id for target in targets if target for each in ast.walk(target) if isinstance(each, ast.Name)
        ]
        if any(each.strip("_").isupper() for each in names):
            assert isinstance(node, ast.AnnAssign), f"{names} must be Final"
            assert ast.unparse(node.annotation).startswith("Final"), f"{names} must be Final"
    assert ("NDArray" in source) == (name == f"{outer(name)}.arrays")


@pytest.mark.parametrize("package", TESTED_MODULE_BY_MODULE)
def test_every_module_has_its_tests_at_the_mirrored_place(package: str) -> None:
    modules = [path for path in (ROOT / package).rglob("*.py") if not path.stem.startswith("__")]
    mirrored = {ROOT / "tests" / path.relative_to(ROOT).with_name(f"test_{path.name}") for path in modules}
    assert sorted(str(path.relative_to(ROOT)) for path in mirrored if not path.is_file()) == []


def wing_of(name: str) -> str:
    return [*name.split("."), ""][1]


@pytest.mark.parametrize("package", WINGS)
def test_every_wing_has_its_place_in_the_order(package: str) -> None:
    assert {wing_of(name) for name in MODULES if outer(name) == package} == {"", *WINGS[package]}


@pytest.mark.parametrize("package", WINGS)
def test_a_wing_says_what_it_is_and_imports_nothing_unless_it_is_used_whole(package: str) -> None:
    for path in (ROOT / package).glob("*/__init__.py"):
        wing = f"{package}.{path.parent.name}"
        what_it_is, *rest = ast.parse(path.read_text("utf-8")).body
        assert isinstance(what_it_is, ast.Expr), f"{path} must begin with a docstring"
        if wing in USED_WHOLE:
            rooms = {each.target for each in imports_of(wing) if outer(each.target) == package}
            assert rooms == {name for name in MODULES if name.startswith(f"{wing}.")}
        else:
            assert not rest, f"{path} must hold a docstring and nothing else"


@pytest.mark.parametrize("name", [name for name in MODULES if outer(name) in WINGS and name not in WINGS])
def test_no_module_imports_from_a_wing_below_its_own(name: str) -> None:
    package, order = outer(name), WINGS[outer(name)]
    above = ("", *order[: order.index(wing_of(name)) + 1])
    used = {each.target for each in imports_of(name) if outer(each.target) == package}
    # The package itself names all of its modules: it stands below every wing.
    assert package not in used
    assert {target for target in used if wing_of(target) not in above} == set()


def test_no_modules_import_each_other_in_a_circle() -> None:
    state: dict[str, str] = {}

    def counts(name: str, each: Import) -> bool:
        """Whether an import links two files: in a package with wings also one that is made later."""
        if each.target not in MODULES or name.startswith(f"{each.target}."):
            # A module of a package loads the package before it; that is no circle of theirs.
            return False
        return each.at_once or (outer(name) in WINGS and name not in WINGS)

    def visit(name: str, path: tuple[str, ...]) -> None:
        assert state.get(name) != "open", f"circle: {' -> '.join((*path, name))}"
        if name in state:
            return
        state[name] = "open"
        for each in imports_of(name):
            if counts(name, each):
                visit(each.target, (*path, name))
        state[name] = "done"

    for name in MODULES:
        visit(name, ())


def run(code: str, timeout: float = 60) -> str:
    return subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=timeout
    ).stdout


def test_each_module_imports_alone_and_only_the_window_loads_pygame() -> None:
    # One fresh interpreter forks for each module, as loading numpy once is enough, one on each processor.
    names = [name for name in MODULES if not name.endswith("__main__")]
    code = f"""
import importlib, os, sys
import numpy
names, running = list({names!r}), {{}}
while names or running:
    while names and len(running) < (os.cpu_count() or 1):
        name = names.pop()
        child = os.fork()
        if child == 0:
            importlib.import_module(name)
            window = name in ("ramtek_emu.monitor.glass", "ramtek_emu.monitor.window")
            if ("pygame" in sys.modules) != window:
                print(name, "and pygame", flush=True)
            if "PIL" in sys.modules and name != "ramtek_emu.png" and not window:
                print(name, "and Pillow", flush=True)
            os._exit(0)
        running[child] = name
    child, status = os.wait()
    name = running.pop(child)
    if status:
        print(name, "does not import alone", flush=True)
"""
    if not hasattr(os, "fork"):
        pytest.skip("needs os.fork")
    output = run(code, timeout=300)
    assert [line for line in output.splitlines() if not line.startswith("pygame")] == []


def test_the_packages_import_no_numpy_and_no_screen() -> None:
    code = (
        "import sys, autocolor, ramtek_emu;"
        "print([name for name in ('numpy', 'pygame', 'PIL') if name in sys.modules])"
    )
    assert run(code).strip() == "[]"


@pytest.mark.parametrize("package", PUBLIC_NAMES)
def test_the_public_names_are_these_and_can_be_imported(package: str) -> None:
    module = importlib.import_module(package)
    assert sorted(module.__all__) == sorted(PUBLIC_NAMES[package])
    for name in PUBLIC_NAMES[package]:
        assert getattr(module, name) is not None
        assert name in dir(module)
    with pytest.raises(AttributeError, match=f"module '{package}' has no attribute 'nothing'"):
        _ = module.nothing


def test_the_renderer_names_what_is_public_and_nothing_else_whatever_was_imported() -> None:
    code = """
import autocolor, autocolor.files.scene_sources, autocolor.commands.demo
from autocolor import *
print([name for name in dir(autocolor) if not name.startswith("__")])
print([name for name in autocolor.__all__ if name not in globals()])
"""
    named, missing = run(code).splitlines()
    assert named == str(sorted(PUBLIC_NAMES["autocolor"]))
    assert missing == "[]"


def test_the_renderer_tells_its_version_also_where_it_is_not_installed() -> None:
    code = """
import importlib.metadata, autocolor
print(isinstance(autocolor.__version__, str))
del autocolor.__version__
def missing(name):
    raise importlib.metadata.PackageNotFoundError(name)
importlib.metadata.version = missing
print(autocolor.__version__, "__version__" in dir(autocolor))
"""
    assert run(code).splitlines() == ["True", "0+unknown True"]


@pytest.mark.parametrize("package", PUBLIC_NAMES)
def test_what_type_checkers_see_is_what_can_be_imported(package: str) -> None:
    tree = ast.parse((ROOT / package / "__init__.py").read_text("utf-8"))
    seen = {
        alias.asname
        for node in tree.body
        if isinstance(node, ast.If)
        for statement in node.body
        if isinstance(statement, ast.ImportFrom)
        for alias in statement.names
    }
    assert seen == set(PUBLIC_NAMES[package])


@pytest.mark.parametrize("package", PUBLIC_NAMES)
def test_no_public_name_is_hidden_by_a_module_of_the_same_name(package: str) -> None:
    modules = {name.removeprefix(f"{package}.").split(".")[0] for name in MODULES if name != package}
    assert modules.isdisjoint(PUBLIC_NAMES[package])


def test_a_scene_is_rendered_and_shown_without_a_screen() -> None:
    code = """
import sys
import autocolor, numpy
from ramtek_emu import Ramtek9300
mesh = autocolor.Mesh(numpy.eye(3), numpy.array([[0, 1, 2]]), numpy.array([0]), ("part",))
autocolor.Studio(autocolor.scene_of(mesh), Ramtek9300())
print("pygame" in sys.modules)
"""
    assert run(code).strip() == "False"
