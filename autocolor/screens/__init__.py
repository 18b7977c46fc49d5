"""The interactive screens: everything on them is words in the frame buffer, drawn by instructions alone.

Uses `studio` and the wings before it.
"""
