"""Inspection: a stream of instructions under glass: any moment of it, and who wrote each pixel.

Uses the basic modules, instruction_set, memory, display, host and monitor. The display does not know it.
"""
