"""The video: what of the memories is shown, through which entries, and where the beam of the monitor is.

Reads the memories and never writes them. Uses the ground and memory.
"""
