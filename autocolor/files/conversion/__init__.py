"""Writing a scene or a mesh in any format that is written, and telling what that format does not hold.

Uses the formats, the store, the writing of scenes, the modules of `files`, `scene` and the ground.
"""
