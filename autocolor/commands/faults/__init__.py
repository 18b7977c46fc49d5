"""The faults of a mesh as `autocolor validate` tells them: in sentences, as JSON, and in color.

Uses the faults of the scene, the mapping and the ground.
"""
