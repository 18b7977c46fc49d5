"""The table store: a scene as one SQLite file, with a table for each table of the scene.

Uses `scene`, and of `files` what reads, writes and reports.
"""
