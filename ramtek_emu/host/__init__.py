"""The host: how its words reach a display and replies come back, here, by a pipe, TCP, Unix socket or device.

Uses the basic modules, instruction_set, memory, instructions and display.
"""
