"""The light and view screen, Figure 5: its three views, the lines of the object, the marks and the handles.

Uses the session, the interface of screens, and the edits of `picture`.
"""
