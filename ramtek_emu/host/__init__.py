"""The host: the ways of its words to a display, and of the replies: a pipe, TCP, a Unix socket, a device.

Uses the basic modules, instruction_set, memory, instructions and display.
"""
