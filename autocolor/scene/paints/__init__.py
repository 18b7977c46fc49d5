"""Paints that can be chosen: finishes, which are kinds of paint, and swatches, which are colors.

Uses the tables of the scene.
"""
