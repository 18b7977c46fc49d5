"""The packages: those of the tree, and the example scenes, which are installed beside them."""

from __future__ import annotations

from setuptools import find_packages, setup

EXAMPLES = {f"autocolor.examples.{name}": f"scenes/{name}" for name in ("coupe", "bracket", "row", "pyramid")}

setup(
    packages=[*find_packages(include=["autocolor*", "ramtek_emu*"]), *EXAMPLES],
    package_dir=EXAMPLES,
    package_data={name: ["scene.toml", "*.obj", "*.ply"] for name in EXAMPLES},
)
