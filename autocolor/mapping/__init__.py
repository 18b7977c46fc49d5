"""From intensities to levels and words, and from words to colors: what the display holds for a picture.

Uses `lighting`, `visibility`, `scene` and the ground.
"""
