from __future__ import annotations

import subprocess
import sys

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
