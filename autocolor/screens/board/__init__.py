"""The board: the screen that is shown, its menu and the message line, and what pointing and keys lead to.

Uses the session, the interface of screens, `input` and `bindings`.
"""
