"""Inspection: a stream of instructions under glass: any moment of it, and who wrote each pixel.

Uses the basic modules, instruction_set, memory, display and monitor. The display itself knows nothing of it.
"""
