"""The packages: those of the tree, and the demo's scene, which is installed beside the code that shows it."""

from __future__ import annotations

from setuptools import find_packages, setup

setup(packages=[*find_packages(include=["autocolor*", "ramtek_emu*"]), "autocolor.demo_scene"])
