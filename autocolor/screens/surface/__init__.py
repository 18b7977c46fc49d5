"""The screens of the chosen surface: its colors and their blend, and its reflectance.

Uses the session, the interface of screens, and the screens over the picture.
"""
