"""The video: the part of the memory on the screen, its colors, and the beam of the monitor.

Reads the memories and never writes them. Uses the basic modules and memory.
"""
