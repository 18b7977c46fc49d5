"""The command that asks the tables of a scene, its prompt, and the ways to print answers.

Uses `files.store`.
"""
