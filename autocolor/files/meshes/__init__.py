"""Mesh files: one file or folder for each format, registered where it is defined, and the registry.

Uses `files/repair` and the rooms of `files`.
"""
