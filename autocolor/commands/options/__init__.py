"""Options that several commands share, and their values.

Uses the scene, `files.scenes` and the modules of `commands`.
"""
