"""The bearing bracket: the modeling scripts of the machined part, and finite elements for its stress."""
