"""How much light reaches the eye: rays, light controls, the light equation, and the picture.

Also where a light shows in the picture, and how a drag there changes it: highlights and rims.

Uses `visibility`, `scene` and the ground.
"""
