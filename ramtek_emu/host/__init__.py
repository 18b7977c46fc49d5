"""The host: how its words reach a display and replies come back, in this process, on a pipe and over TCP.

Uses the basic modules, instruction_set and display.
"""
