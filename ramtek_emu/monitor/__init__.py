"""The monitor: the window that shows fields, its keys and mouse, and a test pattern.

Only `glass` knows pygame. Uses the basic modules, video, instructions and display.
"""
