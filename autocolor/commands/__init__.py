"""The command line: one module for each command, imported only when the command is used.

May import from all other packages.
"""
