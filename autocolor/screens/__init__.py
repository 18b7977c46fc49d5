"""The interactive screens, which are drawn into the frame buffer by display instructions.

May import from `studio` and everything that `studio` uses.
"""
