"""Sessions that commands keep while they run, and those that did not end orderly.

Uses the journal and the screens.
"""
