"""The conformance suite: claims about a display as data, which any emulator can be tested with.

Reads the claims of the `.jsonl` files beside this module and runs them on the display of this package, or on
a command that serves a display on a pipe. Uses instruction_set, display and host.
"""
