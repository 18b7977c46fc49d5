"""What is computed from the node table and the polygon table alone: normals, fans, planes that are shared.

Uses the ground, and of `scene` only its own rooms.
"""
