"""The processor: executes instructions, and keeps the status and the replies.

There is one module of executors for each subject; `display` unites their tables. Uses the basic modules,
instruction_set, memory, drawing and video.
"""
