"""The command line: `ramtek` and its commands, one module for each, imported when the command is used.

Uses all other wings, most of them only inside a command, so that help is shown at once.
"""
