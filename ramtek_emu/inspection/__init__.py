"""Inspection: a display after any instruction of a stream, and the instructions that wrote a pixel.

Uses the basic modules, instruction_set, memory, display, host and monitor. The display does not know it.
"""
