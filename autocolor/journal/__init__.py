"""The session of a studio: its history, its journal in the state folder, its script, and saving.

Uses the scene and the files.
"""
