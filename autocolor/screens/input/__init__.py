"""What the user does, as values: gestures of the mouse and of the joystick unit, and keys.

Uses the display's host port alone.
"""
