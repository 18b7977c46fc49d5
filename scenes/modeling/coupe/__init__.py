"""The coupe: the modelling scripts of the built-in scene."""
