"""How much light reaches the eye: rays, light controls, light planes, their sum, and the picture.

Uses `visibility`, `scene` and the ground.
"""
