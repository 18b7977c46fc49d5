"""The bearing bracket: the modeling scripts of the machined part, and the small finite-element program for its stress."""
