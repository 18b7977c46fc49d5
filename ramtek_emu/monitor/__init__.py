"""The monitor: the window that shows fields, its keys and mouse, and a test pattern.

Only `window` knows pygame. Uses the ground, display, and what a host calls: instructions.
"""
