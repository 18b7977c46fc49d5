"""The file screen, and what other programs change in the file that is shown.

Uses the modules of `screens` that any screen may use, `files` and the studio.
"""
