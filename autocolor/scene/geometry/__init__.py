"""What is computed from the node table and the polygon table alone: normals, fans, curvatures, shared planes.

Uses the ground, and of `scene` only its own rooms; `faults` alone uses the mesh.
"""
