"""The command line: `ramtek` and its commands. A command is a module, imported when the command is used.

Uses all other wings. Commands import most of them inside their functions, so that help is shown at once.
"""
