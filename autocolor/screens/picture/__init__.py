"""The picture and the screens over it: pointing, turning, dragging highlights, watching, steps, and a split.

Uses the session, the interface of screens, and `input`.
"""
