"""The faults of a mesh as `autocolor validate` tells them: in sentences, as JSON, and in color.

Uses the scene, its faults among them, and the ground.
"""
