from __future__ import annotations

import importlib.metadata
import subprocess
import sys

import pytest

import ramtek_emu


def printed(program: str) -> set[str]:
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    return set(run.stdout.split())


def test_only_what_is_used_is_loaded() -> None:
    loaded = "; import sys; print(*sys.modules)"
    imported = printed(f"import ramtek_emu, ramtek_emu.__main__{loaded}")
    assert not imported & {"numpy", "pygame", "PIL", "importlib.metadata"}
    drawn = f"import ramtek_emu; ramtek_emu.Ramtek9300().send(ramtek_emu.instructions.reset()){loaded}"
    assert not printed(drawn) & {"pygame", "PIL"}


def test_the_package_lists_its_public_names_and_no_other() -> None:
    program = "import ramtek_emu, ramtek_emu.commands.ramtek; ramtek_emu.Ramtek9300; print(*dir(ramtek_emu))"
    listed = printed(program)
    assert {name for name in listed if not name.startswith("__")} == set(ramtek_emu.__all__)
    assert {"__version__", "__doc__", "__name__", "__file__", "__all__"} <= listed
    with pytest.raises(AttributeError):
        _ = ramtek_emu.nothing


def test_the_version_is_the_version_of_the_installed_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.metadata, "version", lambda name: f"1.2.3 of {name}")
    assert ramtek_emu.__version__ == "1.2.3 of autocolor"

    def version(name: str) -> str:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    assert ramtek_emu.__version__ == "0+unknown"
