"""The memories: words, entries, characters, cursors and the sticky parameters, and the order of a scan.

They hold what instructions wrote and count the writes; nothing here knows how a picture is drawn or shown.
Uses the basic modules and instruction_set.
"""
