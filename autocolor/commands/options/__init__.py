"""Options that several commands share, and their values.

Uses the scene, the mapping and the modules of `commands`.
"""
