"""Drawing: lines, curves, characters and areas, as words in the frame buffer.

Only geometry; the executors in processor decide what is drawn. Uses the basic modules and memory.
"""
