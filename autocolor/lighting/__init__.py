"""How much light reaches the eye: rays, light controls, light planes, their sum, and the picture.

Also where a light shows in the picture, and how it changes when it is dragged there: highlights and rims.

Uses `visibility`, `scene` and the ground.
"""
