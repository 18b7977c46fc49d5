"""Intensity to level to word, and word to color: what the display holds of a picture.

Uses `lighting`, `scene` and the ground.
"""
