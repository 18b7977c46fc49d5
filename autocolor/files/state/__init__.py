"""What is kept in the user's state folder: which files were opened, and the locks of running sessions.

Uses the ground alone.
"""
