"""Snapshots: a whole display in a file, and back from it within bounds.

Uses the basic modules, memory, video, processor and display.
"""
