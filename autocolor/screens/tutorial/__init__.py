"""The tutorial: lessons, and the panel that shows them over the screens.

Uses the session, the widgets, and scenes.
"""
