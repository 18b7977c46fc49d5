"""The scalar screen: which scalar colors the surfaces, its color scale, bands and limits.

Uses the session, the interface of screens, and `picture`.
"""
