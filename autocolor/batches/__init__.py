"""Batches: many variants of one scene or picture, each made at the cost of its edit, and animations.

Uses the wings up to images.
"""
