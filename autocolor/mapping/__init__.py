"""From intensities to levels and words, and from words to colors: the words and entries of a picture.

Uses `lighting`, `visibility`, `scene` and the ground.
"""
