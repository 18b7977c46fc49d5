"""Words that stand for quantized normals: the table computes the light, so that a light moves by loads alone.

Uses the rest of `mapping`, `lighting`, `visibility`, `scene` and the ground.
"""
