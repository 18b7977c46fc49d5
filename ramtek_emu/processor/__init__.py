"""The processor: executes instructions, and keeps the status and the replies.

Every subject has a module of executors; `display` joins their tables. Uses the basic modules,
instruction_set, memory, drawing and video.
"""
