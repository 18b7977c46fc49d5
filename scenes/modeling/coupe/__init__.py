"""The coupe: the modeling scripts of the built-in scene."""
