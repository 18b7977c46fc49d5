"""Drawing: lines, curves, characters and areas, as words in the frame buffer.

The geometry of each figure; what the host asked for is decided in processor. Uses the ground,
instruction_set and memory.
"""
