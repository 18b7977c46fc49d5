"""The instruction set: its table, and instructions as words, as values and as text.

Converts words to instructions and back; executes nothing. Uses the basic modules: errors, arrays, checks,
timing, configuration.
"""
