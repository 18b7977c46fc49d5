"""The picture, and what all screens over it share: pointing, turning, dragging a highlight, watching.

Uses the session, the interface of screens, and `input`.
"""
