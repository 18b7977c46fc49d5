from __future__ import annotations

import importlib.metadata
import subprocess
import sys

import pytest

import ramtek_emu

HEAVY = ("numpy", "pygame", "PIL")


def modules_after(program: str) -> set[str]:
    script = f"{program}\nimport sys; print(*sorted(sys.modules))"
    run = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    return set(run.stdout.split())


def test_the_public_names_are_sorted_and_importable() -> None:
    assert list(ramtek_emu.__all__) == sorted(ramtek_emu.__all__)
    for name in ramtek_emu.__all__:
        assert (
            getattr(ramtek_emu, name).__name__ == name
            if hasattr(getattr(ramtek_emu, name), "__name__")
            else True
        )
    assert set(ramtek_emu.__all__) <= set(dir(ramtek_emu))


def test_importing_the_package_and_its_command_loads_nothing_heavy() -> None:
    assert not modules_after("import ramtek_emu, ramtek_emu.__main__") & set(HEAVY)


def test_only_the_window_loads_pygame_and_only_pictures_load_pillow() -> None:
    loaded = modules_after("import ramtek_emu; ramtek_emu.Ramtek9300().field()")
    assert not loaded & {"pygame", "PIL"}


def test_the_package_lists_its_public_names_and_no_other() -> None:
    program = "import ramtek_emu, ramtek_emu.commands.ramtek; ramtek_emu.Ramtek9300; print(*dir(ramtek_emu))"
    listed = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    ).stdout.split()
    assert {name for name in listed if not name.startswith("__")} == set(ramtek_emu.__all__)
    assert {"__version__", "__doc__", "__name__", "__file__", "__all__"} <= set(listed)


def test_the_version_is_the_version_of_the_installed_package(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def version(name: str) -> str:
        asked.append(name)
        return "1.2.3"

    monkeypatch.setattr(importlib.metadata, "version", version)
    assert ramtek_emu.__version__ == "1.2.3"
    assert asked == ["autocolor"]


def test_a_package_that_is_not_installed_has_a_version_too(monkeypatch: pytest.MonkeyPatch) -> None:
    def version(name: str) -> str:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    assert ramtek_emu.__version__ == "0+unknown"
    assert "importlib.metadata" not in modules_after("import ramtek_emu")
