"""The files that the program keeps for itself in the platform's folder for them: recent files, their lock.

Uses the modules of `files`, `scene.columns` and the ground.
"""
