"""From intensities to levels and words, and from words to colors: what the display holds for a picture.

May import from `lighting`, `scene`, and the modules that every package shares.
"""
