"""The video: which part of the memory is shown, in which colors, and where the beam of the monitor is.

Reads the memories and never writes them. Uses the basic modules and memory.
"""
