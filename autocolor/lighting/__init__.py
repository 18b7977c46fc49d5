"""How much light reaches the eye: rays, reflection, light controls, light planes, and the picture.

Uses `visibility`, `scene` and the ground.
"""
