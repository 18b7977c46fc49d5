"""The interactive screens, which are drawn into the frame buffer by display instructions.

Uses `studio` and everything that `studio` uses.
"""
