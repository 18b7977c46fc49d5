"""How much light reaches the eye from what is seen: rays, light controls, light planes, and the picture.

Uses `visibility`, `scene` and the ground.
"""
