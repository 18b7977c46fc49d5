"""The commands that print, ask and change the tables of a scene, the prompt, and the ways to print answers.

Uses `files`, its store above all, and the modules of `commands`.
"""
