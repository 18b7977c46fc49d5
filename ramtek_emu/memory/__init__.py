"""The memories: words, entries, characters, cursors and the sticky parameters, and the order of a scan.

The memories store words and count the writes; drawing and video are elsewhere.
Uses the basic modules and instruction_set.
"""
