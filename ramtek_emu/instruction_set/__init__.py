"""The instruction set: its table, and instructions as words, as values and as text.

The words of a stream become instructions here and instructions become words; nothing is executed. Uses the
basic modules: errors, arrays, checks, timing, configuration.
"""
