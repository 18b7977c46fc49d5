"""The monitor: the window that shows a field, what its user does there, and the pattern to judge it by.

Only `window` knows pygame. Uses the ground, display, and what a host calls: instructions.
"""
