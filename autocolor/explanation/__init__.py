"""The explanation of a pixel: every number from the rows of the tables to the color, by plain formulas.

It may use the wings above it, but none of their formulas; see `explain`.
"""
