"""Lights made of others: copies, mirrored ones, a new one that has a good place, and rigs.

Uses the tables of the scene.
"""
