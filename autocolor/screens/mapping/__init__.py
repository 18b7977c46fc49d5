"""The mapping screen: how intensities become levels.

Uses the session, the interface of screens, `input` and `picture`.
"""
