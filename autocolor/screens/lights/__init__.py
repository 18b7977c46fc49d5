"""The lights screen, and the rows for the parameters of a light.

Uses the session, the interface of screens, and `picture`.
"""
