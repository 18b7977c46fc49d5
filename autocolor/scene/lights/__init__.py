"""Lights and their controls as data; what they follow; copies, new ones that have a good place, and rigs.

Uses the columns, the geometry and the view of the scene.
"""
