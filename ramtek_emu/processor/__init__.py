"""The processor: executes instructions, and keeps the status and the replies.

One module of executors for each subject; `executors` brings them together. Uses the basic modules,
instruction_set, memory, drawing and video.
"""
