"""What there is: mesh, parts, surfaces, lights and view as values that never change, and the scene they make.

Uses the ground alone: `errors`, `logs`, `arrays`, `immutable` and `checks`.
"""
