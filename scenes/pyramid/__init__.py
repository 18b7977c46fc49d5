"""The pyramid on a plane of the paper's Figure 4."""
