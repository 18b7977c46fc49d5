"""The command line of the studio: one file a command, each loaded only when it is named.

Uses every other wing.
"""
