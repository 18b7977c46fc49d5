"""Widgets: what screens are made of, drawn by instructions: areas, items, pages, rows of a menu, bars.

Uses the ground, the columns of the scene, the words of `mapping`, and `sending`; knows no studio.
"""
