"""The plan of the house, read off its imports."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[1]

PUBLIC_NAMES = {
    "autocolor": [
        "AutocolorError", "BlinnPhong", "CookTorrance", "EditWarning", "Flap", "Flaps", "HalfSpace",
        "InputError",
        "LevelRange", "Light", "Mesh", "MeshScalar", "MissingInputError", "NamedView", "OutputError", "Paint",
        "Palette", "Part", "Phong", "Picture", "Reflectance", "Rig", "Scalar", "Scene", "Studio", "Surface",
        "UnavailableError", "UsageError", "Variant", "VariantWarning", "View", "WriteError", "animate",
        "batch", "batch_results", "demo", "frames", "grid", "image", "open_tables", "read_journal",
        "read_palette", "read_picture", "read_rig", "read_scene", "read_variants", "render", "save_image",
        "save_layers", "save_page", "save_words", "scene_of", "send_picture", "view", "write_palette",
        "write_picture", "write_rig", "write_scene",
    ],
    "ramtek_emu": [
        "ColorsError", "Configuration", "ConfigurationError", "EntryFormat", "FAMILY", "GMR_9300",
        "HostPort", "InstructionError", "JPL_9460", "Joystick", "ListingError", "MissingInputError",
        "NCAR_9460", "NoScreenError", "OutputError", "OutputExistsError", "PRINCETON_9300", "PortError",
        "Ramtek9300", "RamtekError", "Recorder", "ReplyError", "SnapshotError", "TcpPort", "Timing",
        "UnixPort", "WordsError", "WriteError", "read_snapshot", "write_snapshot",
    ],
}  # fmt: skip

WINGS = {
    "autocolor": (
        "errors", "logs", "arrays", "checks", "immutable", "budget", "threads", "scene", "visibility",
        "scalars",
        "lighting", "mapping", "files", "rendering", "sending", "images", "layers", "batches", "explanation",
        "journal", "web", "studio", "testing", "widgets", "screens", "commands", "__main__",
    ),
    "ramtek_emu": (
        "errors", "arrays", "checks", "timing", "configuration", "writing", "png", "films",
        "command_line",
        "instruction_set", "memory", "drawing", "video", "processor", "instructions", "display",
        "host", "monitor", "conformance", "snapshot", "inspection", "testing", "commands", "__main__",
    ),
}  # fmt: skip
"""The wings of a package in the order of its data: each may use those before it and no other."""

KNOWING_THE_DISPLAY = (
    "autocolor.__main__", "autocolor.batches.films", "autocolor.batches.making",
    "autocolor.batches.outputs", "autocolor.errors", "autocolor.files.writing", "autocolor.images",
    "autocolor.lighting.picture", "autocolor.sending", "autocolor.studio",
    "autocolor.testing", "autocolor.web.notebook",
)  # fmt: skip
WINGS_KNOWING_THE_DISPLAY = ("autocolor.commands", "autocolor.screens", "autocolor.widgets")
DOORS_OF_THE_DISPLAY = {
    "ramtek_emu", "ramtek_emu.command_line", "ramtek_emu.configuration",
    "ramtek_emu.errors", "ramtek_emu.films", "ramtek_emu.host.port",
    "ramtek_emu.instruction_set.disassembler", "ramtek_emu.instructions",
    "ramtek_emu.monitor.window", "ramtek_emu.png", "ramtek_emu.writing",
}  # fmt: skip
OUTSIDE = {"numpy", "click", "PIL", "platformdirs", "pygame"}

WINDOW_OF_THE_STUDIO = ("autocolor.studio", "autocolor.commands.window")
"""The one import from a wing below: a studio opens a window on itself when it is asked to."""

PLACES = {
    ("pygame",): {("ramtek_emu.monitor.glass", True)},
    # Colors written as "#rrggbb" need no Pillow: it is loaded for the first name.
    ("PIL",): {
        ("ramtek_emu.png", False), ("ramtek_emu.films", True), ("ramtek_emu.snapshot", False),
        ("autocolor.batches.outputs", False), ("autocolor.images", False), ("autocolor.scene.kinds", False),
        ("autocolor.web.page", False),
    },
    ("platformdirs",): {("autocolor.files.state", True)},
    ("vtkmodules",): {
        ("autocolor.files.foreign.vtk", True), ("autocolor.files.foreign.gltf", True),
    },
    ("meshio",): {("autocolor.files.foreign.solvers", True)},
    ("lib3mf",): {("autocolor.files.foreign.three_mf", True)},
    ("OpenEXR",): {("autocolor.layers", False)},
    ("tomlkit",): {("autocolor.files.scene_toml.toml_edit", True)},
    # The studio names the class of its widgets for type checkers.
    ("anywidget", "traitlets"): {("autocolor.web.notebook", False), ("autocolor.studio", False)},
    ("hypothesis",): {("autocolor.testing", True), ("ramtek_emu.testing", True)},
}  # fmt: skip
"""The modules that import a library, and whether they do so when they are loaded themselves."""


class Import(NamedTuple):
    """A module that another one imports, and whether it does so when it is loaded itself."""

    target: str
    at_once: bool


MODULES: dict[str, Path] = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
    for package in PUBLIC_NAMES
    for path in sorted((ROOT / package).rglob("*.py"))
}
TREES = {name: ast.parse(path.read_text("utf-8")) for name, path in MODULES.items()}


def imports_in(nodes: list[ast.stmt], at_once: bool = True) -> Iterator[Import]:
    """The imports of some statements; relative ones are refused by ruff."""
    for node in nodes:
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield from imports_in(node.body, at_once=False)
            yield from imports_in(node.orelse, at_once)
        elif isinstance(node, ast.Import):
            yield from (Import(alias.name, at_once) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                yield Import(full if full in MODULES else str(node.module), at_once)
        else:
            inner = at_once and not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
            for field in ("body", "orelse", "finalbody", "handlers"):
                for child in getattr(node, field, None) or []:
                    body = child.body if isinstance(child, ast.ExceptHandler) else [child]
                    yield from imports_in(body, inner)


IMPORTS = {
    name: [i for i in imports_in(tree.body) if (name, i.target, i.at_once) != (*WINDOW_OF_THE_STUDIO, False)]
    for name, tree in TREES.items()
}


def top(name: str) -> str:
    """The package of a module."""
    return name.split(".")[0]


def wing_of(name: str) -> str:
    """The wing of a module; empty for the package itself."""
    return [*name.split("."), ""][1]


def importers(packages: set[str]) -> set[tuple[str, bool]]:
    """The modules that import one of some packages, and whether they do so at once."""
    return {
        (name, i.at_once) for name, imports in IMPORTS.items() for i in imports if top(i.target) in packages
    }


def test_the_display_knows_nothing_of_the_renderer() -> None:
    assert {name for name, _ in importers({"autocolor"}) if top(name) == "ramtek_emu"} == set()


def test_the_renderer_knows_the_display_only_where_they_meet_and_only_by_its_doors() -> None:
    for name in MODULES:
        if top(name) == "autocolor":
            used = {i.target for i in IMPORTS[name] if top(i.target) == "ramtek_emu"}
            assert used <= DOORS_OF_THE_DISPLAY, name
            assert not used or name in KNOWING_THE_DISPLAY or name.startswith(WINGS_KNOWING_THE_DISPLAY), name


@pytest.mark.parametrize(("libraries", "places"), PLACES.items())
def test_a_library_is_in_its_place(libraries: tuple[str, ...], places: set[tuple[str, bool]]) -> None:
    assert importers(set(libraries)) == places


def test_nothing_is_imported_that_is_no_dependency() -> None:
    used = {top(i.target) for imports in IMPORTS.values() for i in imports}
    allowed = {*PUBLIC_NAMES, *OUTSIDE, *(name for names in PLACES for name in names)}
    assert used <= {*allowed, *sys.stdlib_module_names}


def test_constants_are_final_and_array_types_stand_in_one_module() -> None:
    for name, tree in TREES.items():
        for node in tree.body:
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            names = [
                n.id for target in targets if target for n in ast.walk(target) if isinstance(n, ast.Name)
            ]
            if any(constant.strip("_").isupper() for constant in names):
                assert isinstance(node, ast.AnnAssign), f"{name}: {names} must be Final"
                assert ast.unparse(node.annotation).startswith("Final"), f"{name}: {names} must be Final"
        assert ("NDArray" in MODULES[name].read_text("utf-8")) == (name == f"{top(name)}.arrays"), name


def test_every_wing_has_its_place_in_the_order() -> None:
    for package, order in WINGS.items():
        assert {wing_of(name) for name in MODULES if top(name) == package} == {"", *order}


def test_a_wing_says_what_it_is_and_imports_nothing() -> None:
    for name, path in MODULES.items():
        if path.stem == "__init__" and name not in (*PUBLIC_NAMES, "ramtek_emu.inspection"):
            what_it_is, *rest = TREES[name].body
            assert isinstance(what_it_is, ast.Expr), f"{path} must begin with a docstring"
            assert not rest, f"{path} must hold a docstring and nothing else"


def test_no_module_imports_from_a_wing_below_its_own() -> None:
    for name in MODULES:
        if name not in WINGS:
            package, order = top(name), WINGS[top(name)]
            above = order[: order.index(wing_of(name)) + 1]
            # The package itself names all of its modules: it stands below every wing.
            below = {
                i.target for i in IMPORTS[name] if top(i.target) == package and wing_of(i.target) not in above
            }
            assert below == set(), name


def test_no_modules_import_each_other_in_a_circle() -> None:
    state: dict[str, str] = {}

    def visit(name: str, path: tuple[str, ...]) -> None:
        assert state.get(name) != "open", f"circle: {' -> '.join((*path, name))}"
        if name in state:
            return
        state[name] = "open"
        for target, at_once in IMPORTS[name]:
            # A module of a package loads the package before it; that is no circle of theirs.
            if target in MODULES and not name.startswith(f"{target}.") and (at_once or name not in WINGS):
                visit(target, (*path, name))
        state[name] = "done"

    for name in MODULES:
        visit(name, ())


def test_no_two_classes_have_the_same_name() -> None:
    # An error that both packages publish is a class of each.
    of_both = set.intersection(*map(set, PUBLIC_NAMES.values()))
    names = Counter(
        (top(name) if node.name in of_both else "", node.name)
        for name, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
    )
    assert [name for name, count in names.items() if count > 1] == []


def run(code: str, timeout: float = 60) -> str:
    """What some code prints in a new interpreter."""
    ended = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=timeout, check=False
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


WITH_PYGAME = {"ramtek_emu.inspection.inspector", "ramtek_emu.monitor.glass", "ramtek_emu.monitor.window"}
WITH_PILLOW = {"ramtek_emu.films", "ramtek_emu.png", *WITH_PYGAME}
OF_EXTRAS = {"lib3mf", "meshio", "vtkmodules"}
"""The libraries that a module of theirs imports at once; it runs in a process of its own."""

IMPORTING_ALONE = """
import importlib, sys
import numpy, click

def forget(prefix):
    for loaded in list(sys.modules):
        if loaded == prefix or loaded.startswith(prefix + "."):
            del sys.modules[loaded]

def allow(libraries):
    for library in ("pygame", "PIL"):
        forget(library)
        if library not in libraries:
            sys.modules[library] = None  # To import it raises ImportError.

for wing, name, libraries in {modules!r}:
    forget(wing)
    allow(libraries)
    try:
        importlib.import_module(name)
    except ImportError as error:
        if (error.name or "").partition(".")[0] in {of_extras!r}:
            continue
        raise SystemExit(f"{{name}} does not import alone: {{error}}")
    if libraries:
        forget("ramtek_emu")
"""


@pytest.mark.parametrize("package", WINGS)
def test_every_module_imports_alone_and_only_the_window_loads_pygame(package: str) -> None:
    # A wing never imports a later one, so that the wings before it can stay loaded.
    modules = [
        (
            f"{package}.{wing}",
            name,
            ["pygame"] * (name in WITH_PYGAME) + ["PIL"] * (name in WITH_PILLOW),
        )
        for wing in WINGS[package]
        if wing != "__main__"
        for name in MODULES
        if (top(name), wing_of(name)) == (package, wing)
    ]
    run(IMPORTING_ALONE.format(modules=modules, of_extras=OF_EXTRAS), timeout=300)


def test_the_packages_import_no_numpy_no_screen_and_no_hypothesis() -> None:
    code = (
        "import sys, autocolor, ramtek_emu;"
        "print([name for name in ('numpy', 'pygame', 'PIL', 'hypothesis') if name in sys.modules])"
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
import autocolor, autocolor.files.opening, autocolor.commands.demo
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
        if isinstance(statement, ast.ImportFrom) and statement.module != "typing"
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
