"""The session as a journal: its steps, the script that tells them, and the copy that is kept of it.

Uses the scene and the files.
"""
